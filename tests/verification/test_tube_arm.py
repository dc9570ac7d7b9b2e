"""Arms of tubes, flat lugs on the wall: volume by closed form, balance, and the tube's forces and stress beside one."""

import math
import re
import tomllib

import pytest

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.fea.refine.refinement import Effort
from alula.geometry.base.errors import CaseError
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body, reentrant_edges
from alula.geometry.parts.part import Body, Pin, Tube
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

OUTER, INNER, WIDTH, THICK, PIN, UP = 10.0, 7.0, 6.0, 4.0, 3.0, 18.0
CASE = f"""
schema_version = 1
title = "Lever of a tube with a lug"
large_displacement = "off"
[links.base]
ground = true
points.A = ["0 mm", "0 mm"]
points.P = ["100 mm", "20 mm"]
[links.rod]
points.Q = ["0 mm", "0 mm"]
points.P = ["60 mm", "0 mm"]
[links.lever]
part = "tube"
points.A = ["0 mm", "0 mm"]
points.M = ["40 mm", "0 mm"]
points.B = ["100 mm", "0 mm"]
points.Q = ["40 mm", "20 mm"]
arms.Q = "M"
[joints]
A = {{ links = ["base", "lever"], pin_diameter = "3 mm" }}
Q = {{ links = ["lever", "rod"], pin_diameter = "3 mm" }}
P = {{ links = ["base", "rod"], pin_diameter = "3 mm" }}
[pose]
near = {{ lever = "0 deg", rod = "0 deg" }}
[parts.tube]
shape = "tube"
material = "pvc-paredes-2018"
outer_diameter = "{OUTER} mm"
inner_diameter = "{INNER} mm"
eyes = "none"
fillet_radius = "1 mm"
arm_width = "8 mm"
arm_thickness = "{THICK} mm"
[load_cases.tip]
forces = [{{ link = "lever", at = "B", force = ["0 N", "-0.01 N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 2
"""


def tube(fillet: float, eyes: str = "none", arm: float = UP) -> Body:
    """A tube from 0 to 60 mm with an arm at 30 mm, up to a pin so high above the axis; 0 without one."""
    sizes = {
        "outer_diameter": OUTER,
        "inner_diameter": INNER,
        "fillet_radius": fillet,
        "arm_width": WIDTH,
        "arm_thickness": THICK,
    }
    part = Tube.model_validate(
        {"shape": "tube", "material": "pvc", "eyes": eyes} | {name: f"{size} mm" for name, size in sizes.items()}
    )
    pins = [Pin(name=name, x=x, y=0.0, diameter=PIN) for name, x in (("A", 0.0), ("B", 60.0))]
    pins += [Pin(name="Q", x=30.0, y=arm, diameter=PIN, foot=(30.0, 0.0))] if arm else []
    return Body(part=part, pins=tuple(pins), ends=(), holes=())


@pytest.mark.parametrize(("up", "eyes"), [(UP, "none"), (-UP, "round")])
def test_mass_and_centroid_of_an_arm(up: float, eyes: str) -> None:
    """What the arm adds: a box from the wall y = √(R² - z²) to the pin, half a disc, less the hole.

    The centroid of the half disc is 4r/3π from the pin. The kernel's volumes of tubes are good to 1e-5.
    """
    radius, half = OUTER / 2.0, THICK / 2.0
    inside = half * math.sqrt(radius**2 - half**2) + radius**2 * math.asin(half / radius)  # ∫ √(R² - z²) dz
    square = 2.0 * half * (radius**2 - half**2 / 3.0)  # ∫ (R² - z²) dz
    disc, hole = math.pi * WIDTH**2 / 8.0 * THICK, math.pi * PIN**2 / 4.0 * THICK
    volume = WIDTH * (UP * THICK - inside) + disc - hole
    moment = WIDTH * (UP**2 * THICK - square) / 2.0 + disc * (UP + 2.0 * WIDTH / (3.0 * math.pi)) - hole * UP
    with_arm, without = (mass_properties(tube(0.0, eyes, arm)) for arm in (up, 0.0))
    assert with_arm.volume - without.volume == pytest.approx(volume, rel=1e-4)
    assert with_arm.volume * with_arm.centroid[1] == pytest.approx(math.copysign(moment, up), rel=1e-4)


def test_the_fillet_leaves_no_sharp_edge_and_the_ring_is_flat() -> None:
    filleted = tube(1.0)
    assert reentrant_edges(filleted) == []
    assert {round(math.degrees(edge.angle)) for edge in reentrant_edges(tube(0.0))} >= {270}
    mesh = mesh_body(filleted, COARSE)
    assert {name for name in mesh.surfaces if name.endswith("Q")} == {"bore:Q", "top:Q", "bottom:Q"}
    assert mesh.areas["bore:Q"] == pytest.approx(math.pi * PIN * THICK, rel=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('at = "B"', 'at = "M"', "point 'M' of link 'lever' is where an arm starts, and no load enters there"),
        ('arms.Q = "M"', 'arms.Q = "A"', "arm of a tube from 'A' to 'Q' starts on its plain wall"),
        ('arm_width = "8 mm"', "", "arm_width and arm_thickness are the two sides of one section"),
    ],
)
def test_what_does_not_fit_is_named(old: str, new: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        validate(tomllib.loads(CASE.replace(old, new)))


def test_moments_beside_the_arm_and_the_stress_away_from_it() -> None:
    """By hand: the rod pulls with 10 mN · 100 mm/20 mm, and the tube bears 0.4 and -0.6 N·mm beside the arm.

    So small a load does not bend the tube by enough for compression to add to its moments.
    """
    case = validate(tomllib.loads(CASE))
    found = check_case(case, fidelity="solid", effort=Effort(max_meshes=1), threads=1).load_cases["tip"]
    link = found.links["lever"]
    assert link.beam.forces.at(40.0, "before")[[0, 1, 5]] == pytest.approx([-0.05, -0.01, 0.4], rel=1e-4)
    assert link.beam.forces.at(40.0, "after")[[0, 1, 5]] == pytest.approx([0.0, -0.01, -0.6], rel=1e-4, abs=1e-9)
    modulus = math.pi / 32.0 * (OUTER**4 - INNER**4) / OUTER
    assert {row.x < 40.0 for row in link.comparisons} == {True, False}
    for row in link.comparisons:
        moment = 0.01 * (row.x if row.x < 40.0 else 100.0 - row.x)
        assert row.solid == pytest.approx(moment / modulus, rel=0.02)
    assert math.hypot(*link.location[1:]) > OUTER / 2.0  # the peak is in the fillet at the arm's foot
    assert abs(link.location[0] - 40.0) < 6.0
    assert link.von_mises_max.low > 0.6 / modulus


def test_the_arm_bends_as_a_cantilever_at_the_wall() -> None:
    """By hand: 50 mN at 20 mm less the tube's radius on the lug's own section."""
    found = check_case(validate(tomllib.loads(CASE)), fidelity="beam").load_cases["tip"]
    moment = 0.05 * (20.0 - OUTER / 2.0)
    (said,) = re.findall(r"by hand the arm to Q bears (\S+) MPa", " ".join(map(told, found.links["lever"].notes)))
    assert float(said) == pytest.approx(moment * 6.0 / (THICK * 8.0**2), rel=5e-3)
    assert found.checks[0].verdict is Verdict.UNDECIDED
    assert "has arms" in told(found.checks[0].reason)
