"""Links in compression against Euler's load, and against the linear stability of frames."""

import tomllib
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest
from euler_column import euler_load

from alula.fea.beam.column_factor import AxialForce, column_factors
from alula.fea.buckling.buckling import beyond_strength
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support
from alula.fea.nonlinear.stability import buckling_factor
from alula.geometry.parts.part import Section
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

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
material = "{arm}"
width = "4 mm"
thickness = "4 mm"
eye_diameter = "8 mm"
eye_thickness = "4 mm"
fillet_radius = "1 mm"
[parts.strut]
shape = "bar"
material = "pvc-paredes-2018"
width = "{width} mm"
thickness = "{thickness} mm"
eye_diameter = "8 mm"
eye_thickness = "{thickness} mm"
fillet_radius = "1 mm"
[load_cases.push]
forces = [{{ link = "strut", at = "{at}", force = ["0 N", "{force} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 3.0
"""


def strut(force, *, at="B", tip=120.0, joints="pinned", width=2.0, thickness=4.0, arm="pvc-paredes-2018"):
    """A strut 100 mm between its pins; by default it is weak in the linkage's plane, where its pins let it turn."""
    text = STRUT.format(force=force, at=at, tip=tip, joints=joints, width=width, thickness=thickness, arm=arm)
    return validate(tomllib.loads(text))


def buckling(case):
    result = check_case(case, fidelity="beam").load_cases["push"]
    return result, {check.link: check for check in result.checks if check.name == "buckling"}


def critical(case, length, k):
    material = case.material_of("strut")
    return euler_load(material.youngs_modulus, 4.0 * 2.0**3 / 12.0, length, k)


@pytest.mark.parametrize(
    ("share", "verdict"), [(1.001, "fail"), (0.999, "undecided"), (0.34, "undecided"), (0.2, "pass")]
)
def test_strut_weak_in_its_plane_fails_beyond_euler_whatever_its_stress(share, verdict):
    load = share * critical(strut(-1.0), 100.0, 1.0)
    result, found = buckling(strut(-load))
    assert found["strut"].verdict is Verdict(verdict)
    assert found["strut"].value.value == pytest.approx(1.0 / share, rel=1e-4)
    strength = next(c for c in result.checks if c.name == "strength" and c.link == "strut")
    assert strength.value.value > 3.0 * strength.limit
    assert "free to turn on pins at 0 and 100 mm" in told(found["strut"].reason)


@pytest.mark.parametrize(("share", "verdict"), [(1.5, "undecided"), (3.99, "undecided"), (4.01, "fail")])
def test_strut_weak_across_its_plane_fails_only_where_pins_that_keep_its_angle_do_not_save_it(share, verdict):
    """Four times Euler's load holds with both ends kept in their angle; how stiffly pins keep it is not known."""
    _, found = buckling(strut(-share * critical(strut(-1.0), 100.0, 1.0), width=4.0, thickness=2.0))
    assert found["strut"].value.value == pytest.approx(1.0 / share, rel=1e-4)
    assert found["strut"].value.high == pytest.approx(4.0 / share, rel=1e-4)
    assert found["strut"].verdict is Verdict(verdict)


def test_idle_link_is_no_unbalanced_one():
    # The arm lies across the strut's force: all that statics leaves on it is rounding.
    result, found = buckling(strut(-1.0))
    assert result.links["arm"].safety_factor.value == np.inf
    assert "arm" not in found


def test_tension_cannot_buckle():
    assert "strut" not in buckling(strut(50.0))[1]


@pytest.mark.parametrize("joints", ["pinned", "bonded"])
@pytest.mark.parametrize(("width", "thickness"), [(2.0, 4.0), (4.0, 2.0)])
@pytest.mark.parametrize(("at", "tip"), [("B", 120.0), ("H", 112.0), ("H", 120.0), ("H", 150.0), ("H", 250.0)])
def test_the_band_holds_the_factor_of_the_whole_frame(joints, width, thickness, at, tip):
    """Beside an arm of steel the strut alone buckles, held by neighbours as stiff as they are: the true factor."""
    case = strut(-5.0, at=at, tip=tip, joints=joints, width=width, thickness=thickness, arm="steel-wire")
    result, found = buckling(case)
    true, band = result.large_displacement.buckling, found["strut"].value
    assert band.low < true < band.high * (1.0 + 1e-3)  # the frame's elements leave that much
    if joints == "pinned" and width < thickness:
        # In the plane the pins let it turn, and nothing is left open but the shear of the frame.
        assert true == pytest.approx(band.value, rel=5e-3)
    else:
        assert band.value < true


def test_the_band_of_a_driven_link_holds_the_factor_of_the_frame_that_sways():
    case = validate(tomllib.loads(PARALLELOGRAM))
    result = check_case(case, fidelity="beam").load_cases["push"]
    found = {check.link: check for check in result.checks if check.name == "buckling"}
    left, sways = found["left"].value, result.large_displacement.buckling
    stiffness = case.material_of("left").youngs_modulus * case.part_of("left").section.i_z
    assert left.low == pytest.approx(stiffness * (np.pi / 2.0 / 120.0) ** 2 / 0.1 / 3.0, rel=1e-4)
    assert left.value == pytest.approx(stiffness * (np.pi / 120.0) ** 2 / 0.1, rel=1e-4)
    # Built in at the drive's joint and pinned at the other, tan(kL) = kL: less than built in at both, out of the plane.
    assert left.high == pytest.approx(stiffness * (4.493409 / 120.0) ** 2 / 0.1, rel=1e-4)
    assert left.low < sways < left.high


PARALLELOGRAM = """
schema_version = 1
title = "Two cranks under a coupler"
large_displacement = "off"
[links.ground]
ground = true
points = { A = ["0 mm", "0 mm"], D = ["90 mm", "0 mm"] }
[links.left]
part = "rod"
points = { A = ["0 mm", "0 mm"], B = ["120 mm", "0 mm"] }
[links.top]
part = "rod"
points = { B = ["0 mm", "0 mm"], C = ["90 mm", "0 mm"] }
[links.right]
part = "rod"
points = { D = ["0 mm", "0 mm"], C = ["120 mm", "0 mm"] }
[joints]
A = { links = ["ground", "left"], pin_diameter = "1 mm" }
B = { links = ["left", "top"], pin_diameter = "1 mm" }
C = { links = ["top", "right"], pin_diameter = "1 mm" }
D = { links = ["ground", "right"], pin_diameter = "1 mm" }
[pose]
coordinate = "left"
angle = "90 deg"
near = { top = "0 deg", right = "90 deg" }
[drive]
link = "left"
joint = "A"
[parts.rod]
shape = "tube"
material = "pvc-paredes-2018"
outer_diameter = "2 mm"
inner_diameter = "1 mm"
eye_diameter = "3 mm"
eye_thickness = "3 mm"
fillet_radius = "0.2 mm"
[load_cases.push]
forces = [
  { link = "left", at = "B", force = ["0 N", "-0.1 N"] },
  { link = "right", at = "C", force = ["0 N", "-0.1 N"] },
]
[checks.strength]
type = "safety-factor"
minimum = 3.0
"""


def test_the_rocker_of_the_starter_in_warm_pvc_does_not_buckle():
    """80 mm between its pins and 40 mm beyond them; pushed more between them than beyond."""
    tables = tomllib.loads(files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8"))
    tables["parts"]["bar"]["material"] = "pvc-u"
    tables["conditions"] = {"duration": "10000 h", "temperature": "35 degC"}
    tables["large_displacement"] = "off"
    result = check_case(validate(tables), fidelity="beam").load_cases["lift"]
    (rocker,) = [c for c in result.checks if (c.name, c.link) == ("buckling", "rocker")]
    assert rocker.value.value == pytest.approx(4.74 * 0.9027, abs=0.02)  # the modulus at 35 degC, from 23 and 37.8 degC
    assert rocker.verdict is Verdict.PASS


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


@pytest.mark.parametrize("overhang", [0.0, 1.0, 10.0, 50.0, 100.0, 300.0])
def test_column_with_an_overhang_is_that_of_the_frame(overhang):
    ends = [0.0, 100.0, 100.0 + overhang] if overhang else [0.0, 100.0]
    exact = frame_factor(ends, (0, 1), 1.0)
    force = AxialForce(breaks=np.array([0.0, 100.0 + overhang]), values=np.ones((1, 3, 1)))
    (found,) = column_factors(force, 2900.0 * 3.0, held=(0.0, 100.0))
    assert found == pytest.approx(exact, rel=3e-3)


def factor_of(*pressed, breaks=(0.0, 100.0), **supports):
    values = np.array([[[a], [(a + b) / 2.0], [b]] for a, b in pressed])
    return column_factors(AxialForce(breaks=np.array(breaks), values=values), 100.0, **supports)[0]


@pytest.mark.parametrize(
    ("supports", "k"),
    [
        ({"held": (0.0, 100.0)}, 1.0),
        ({"built_in": (0.0,)}, 2.0),
        ({"built_in": (100.0,)}, 2.0),
        ({"built_in": (0.0, 100.0)}, 0.5),
        ({"built_in": (0.0,), "held": (100.0,)}, np.pi / 4.493409457909064),
        ({"held": (0.0, 50.0, 100.0)}, 0.5),
    ],
)
def test_column_agrees_with_euler(supports, k):
    assert factor_of((1.0, 1.0), **supports) == pytest.approx(euler_load(1.0, 100.0, 100.0, k), rel=2e-4)


def test_column_under_its_own_weight():
    """Built in below, free above: (q L) = 7.837 E I/L² (Timoshenko & Gere, 2nd ed., section 2.12, eq. 2-57)."""
    assert factor_of((1.0, 0.0), built_in=(0.0,)) == pytest.approx(7.837 * 100.0 / 100.0**2, rel=1e-3)


def test_column_whose_force_steps_or_pulls_or_is_not_known():
    halves = {"breaks": (0.0, 50.0, 100.0), "held": (0.0, 100.0)}
    # Stretched over one half it takes more, and pulled all along it never buckles.
    assert factor_of((1.0, 1.0), (-1.0, -1.0), **halves) > 2.0 * factor_of((1.0, 1.0), (1.0, 1.0), **halves)
    assert factor_of((-1.0, -1.0), (-2.0, -1.0), **halves) == np.inf
    both = AxialForce(breaks=np.array([0.0, 100.0]), values=np.array([[[1.0, np.nan]] * 3]))
    known, unknown = column_factors(both, 100.0, held=(0.0, 100.0))
    assert known == pytest.approx(euler_load(1.0, 100.0, 100.0), rel=1e-4)
    assert np.isnan(unknown)
    # Nothing acts beyond the breaks, where a pin may stand.
    assert factor_of((1.0, 1.0), breaks=(20.0, 80.0), held=(0.0, 100.0)) > euler_load(1.0, 100.0, 100.0)


def test_a_link_beyond_its_strength_is_told_beside_its_elastic_answer():
    result, found = buckling(strut(-0.5, at="H", tip=120.0))
    assert "elastic and void" not in told(found["strut"].reason)
    strong = {link: r.beam for link, r in result.links.items()}
    weak = strong | {"strut": replace(strong["strut"], strength=0.99 * strong["strut"].worst.equivalent)}
    assert beyond_strength(strong) is None
    assert "strut bears" in told(beyond_strength(weak))
