"""Links in compression against Euler's load, and against the frame's own linear stability."""

import tomllib

import numpy as np
import pytest

from fea.beam import euler_load
from fea.buckling_check import column
from fea.check import check_case
from fea.corotational import buckling_factor
from fea.frame import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support, solve_frame
from fea.verdict import Verdict
from geometry.part import Section
from loads.case_file import read_case, validate

STRUT = """
schema_version = 1
title = "Arm propped by a slender strut"
large_displacement = "off"
joint_model = "{joints}"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["40 mm", "-100 mm"]
[links.arm]
part = "arm"
points.O = ["0 mm", "0 mm"]
points.B = ["40 mm", "0 mm"]
[links.strut]
part = "strut"
points.P = ["0 mm", "0 mm"]
points.B = ["100 mm", "0 mm"]
points.H = ["{tip} mm", "0 mm"]
[joints]
O = {{ links = ["frame", "arm"], pin_diameter = "2 mm" }}
B = {{ links = ["arm", "strut"], pin_diameter = "2 mm" }}
P = {{ links = ["frame", "strut"], pin_diameter = "2 mm" }}
[pose.near]
arm = "0 deg"
strut = "90 deg"
[parts.arm]
shape = "bar"
material = "pvc-paredes-2018"
width = "4 mm"
thickness = "4 mm"
eye_diameter = "8 mm"
eye_thickness = "4 mm"
fillet_radius = "1 mm"
[parts.strut]
shape = "bar"
material = "pvc-paredes-2018"
width = "4 mm"
thickness = "2 mm"
eye_diameter = "8 mm"
eye_thickness = "2 mm"
fillet_radius = "1 mm"
[load_cases.push]
forces = [{{ link = "strut", at = "{at}", force = ["0 N", "{force} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 3.0
"""


def strut(force, *, at="B", tip=120.0, joints="pinned"):
    return validate(tomllib.loads(STRUT.format(force=force, at=at, tip=tip, joints=joints)))


def buckling(case):
    result = check_case(case, fidelity="beam").load_cases["push"]
    return result, {check.link: check for check in result.checks if check.name == "buckling"}


def critical(case, length, k):
    material = case.material_of("strut")
    return euler_load(material.youngs_modulus, 4.0 * 2.0**3 / 12.0, length, k)


@pytest.mark.parametrize(
    ("share", "verdict"), [(1.001, "fail"), (0.999, "undecided"), (0.34, "undecided"), (0.2, "pass")]
)
def test_strut_beyond_euler_fails_whatever_its_stress(share, verdict):
    load = share * critical(strut(-1.0), 100.0, 1.0)
    result, found = buckling(strut(-load))
    assert found["strut"].verdict is Verdict(verdict)
    assert found["strut"].value.value == pytest.approx(1.0 / share, rel=1e-6)
    strength = next(c for c in result.checks if c.name == "strength" and c.link == "strut")
    assert strength.value.value > 3.0 * strength.limit
    assert "pinned at both ends" in found["strut"].reason


def test_idle_link_is_no_unbalanced_one():
    # The arm lies across the strut's force: all that statics leaves on it is rounding.
    result, found = buckling(strut(-1.0))
    assert result.links["arm"].safety_factor.value == np.inf
    assert "arm" not in found


def test_tension_cannot_buckle():
    assert "strut" not in buckling(strut(50.0))[1]


def test_overhang_and_bonded_pins_count_as_cantilevers():
    _, pinned = buckling(strut(-1.0))
    _, overhang = buckling(strut(-1.0, at="H"))
    _, bonded = buckling(strut(-1.0, joints="bonded"))
    assert pinned["strut"].value.value == pytest.approx(critical(strut(-1.0), 100.0, 1.0), rel=1e-6)
    assert overhang["strut"].value.value == pytest.approx(critical(strut(-1.0), 120.0, 2.0), rel=1e-6)
    assert "beyond its pins" in overhang["strut"].reason
    assert "bonded" in bonded["strut"].reason


def test_driven_link_is_built_in_at_its_drive_and_free_at_the_other_end():
    case = read_case("owl-wing-static", [])
    links = check_case(case, name="owl-wing-static", fidelity="beam").load_cases["weight"].links
    assert case.drive.link == "AE"
    driven, rod = (column(case, link, links[link].beam) for link in ("AE", "GF"))
    assert (driven.effective_length, rod.effective_length) == (2.0, 1.0)
    assert driven.length == pytest.approx(190.0)


SECTION = Section(area=8.0, i_y=2.0, i_z=3.0, torsion=4.0, half_y=1.0, half_z=1.0, round=False)
FREE = frozenset({"uy"})
PLANE = frozenset({"uz", "rx", "ry"})


def frame_factor(stations, pinned, load, built_in=False):
    """Second way to a critical load [N]: the frame's stability in its plane, pushed at its last station."""
    elements = tuple(
        FrameElement(nodes=(i, i + 1), section=SECTION, young=2900.0, poisson=0.0) for i in range(len(stations) - 1)
    )
    held = [Support(node=i, dofs=PLANE) for i in range(len(stations)) if i not in pinned]
    held += [Support(node=i, dofs=PLANE | FREE | ({"ux"} if i == 0 else set())) for i in pinned if i or not built_in]
    if built_in:
        held.append(Support(node=0, dofs=ALL_DOFS))
    model = FrameModel(
        nodes=np.array([[x, 0.0, 0.0] for x in stations]),
        elements=elements,
        supports=tuple(held),
        loads=(NodeLoad(node=len(stations) - 1, wrench=np.array([-load, 0.0, 0.0, 0.0, 0.0, 0.0])),),
    )
    solve_frame(model)
    return load * buckling_factor(model)


def test_frame_agrees_with_euler_pinned_and_built_in():
    # Shear takes 1/(1 + P/(κGA)) of it: 0.1 % here.
    assert frame_factor([0.0, 100.0], (0, 1), 1.0) == pytest.approx(euler_load(2900.0, 3.0, 100.0), rel=3e-3)
    assert frame_factor([0.0, 100.0], (0,), 1.0, True) == pytest.approx(euler_load(2900.0, 3.0, 100.0, 2.0), rel=3e-3)


@pytest.mark.parametrize("overhang", [1.0, 10.0, 50.0, 100.0, 300.0])
def test_cantilever_of_whole_length_bounds_an_overhang_from_below(overhang):
    exact = frame_factor([0.0, 100.0, 100.0 + overhang], (0, 1), 1.0)
    bound = euler_load(2900.0, 3.0, 100.0 + overhang, 2.0)
    assert bound < exact
    assert exact < 4.0 * bound
