"""A link held by one joint, such as a servo's arm: a cantilever, whose answers are known in closed form."""

import math
import tomllib
from typing import Any

import pytest

from alula.fea.check.run import check_case
from alula.fea.outcomes.result import CheckResult
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion

LENGTH, WIDTH, THICKNESS, FORCE, YOUNG, SHEAR = 60.0, 8.0, 4.0, 2.0, 2500.0, 2500.0 / 2.72
SERVO = """
schema_version = 1
title = "servo arm"
checks.strength = { type = "safety-factor", minimum = 0.05 }
joints.O = { links = ["base", "arm"], pin_diameter = "4 mm" }
pose = { coordinate = "arm", angle = "0 deg" }
drive = { link = "arm", joint = "O" }
motion = { range = ["0 deg", "90 deg"], poses = 2 }
[links]
base = { ground = true, points.O = ["0 mm", "0 mm"], points.Z = ["0 mm", "-20 mm"] }
arm = { part = "bar", points.O = ["0 mm", "0 mm"], points.P = ["60 mm", "0 mm"] }
[parts]
bar = { shape = "bar", material = "stiff", width = "8 mm", thickness = "4 mm", fillet_radius = "2 mm" }
[materials.stiff]
title = "a plastic"
density = "1240 kg/m^3"
youngs_modulus = "2.5 GPa"
poissons_ratio = 0.36
yield_strength = "40 MPa"
strength = "yield"
sources = { density = "made up", youngs_modulus = "made up", poissons_ratio = "made up", yield_strength = "made up" }
status = { density = "assumed", youngs_modulus = "assumed", poissons_ratio = "assumed", yield_strength = "assumed" }
[load_cases.tip]
forces = [{ link = "arm", at = "P", force = ["0 N", "-2 N"] }]
"""
SECOND = THICKNESS * WIDTH**3 / 12.0
BENT = FORCE * LENGTH**3 / (3.0 * YOUNG * SECOND)
SHEARED = FORCE * LENGTH / ((10.0 * 1.36 / (12.0 + 11.0 * 0.36)) * SHEAR * WIDTH * THICKNESS)


def tables(**changes: Any) -> dict[str, Any]:
    return tomllib.loads(SERVO) | changes


def checked(fidelity: str = "beam", **changes: Any) -> CheckResult:
    return check_case(validate(tables(**changes)), name="servo", fidelity=fidelity)  # type: ignore[arg-type]


def test_torque_joint_force_bending_stress_and_deflection() -> None:
    """Torque P L; stress P L/W; deflection P L³/(3 E I) + P L/(κ G A), from the line that turns with the bore."""
    case = checked().load_cases["tip"]
    assert case.reactions.drive_torque == pytest.approx(FORCE * LENGTH)
    link = case.links["arm"]
    assert link.von_mises_max.value == pytest.approx(FORCE * LENGTH / (THICKNESS * WIDTH**2 / 6.0), rel=0.01)
    assert link.displacement_max.value == pytest.approx(BENT + SHEARED, rel=1e-6)


def test_the_frame_moves_the_tip_as_a_cantilever() -> None:
    check = {"type": "displacement", "at": "P", "maximum": "1 mm"}
    [tip] = [found for found in checked(checks={"tip": check}).load_cases["tip"].checks if found.name == "tip"]
    assert tip.value is not None
    assert tip.value.value == pytest.approx(BENT + SHEARED, rel=1e-3)


def test_the_solid_bends_as_a_cantilever_that_begins_within_its_eye() -> None:
    """The eye of 12.8 mm hardly bends: between the closed forms from the eye's rim and, with shear, from its pin."""
    free = FORCE * (LENGTH - 6.4) ** 3 / (3.0 * YOUNG * SECOND)
    moved = checked("solid").load_cases["tip"].links["arm"].displacement_max
    assert free < moved.value < BENT + SHEARED


def test_it_buckles_as_a_post_that_is_held_at_its_foot() -> None:
    """Euler, held at one end: π² E I/(4 L²), about the weak axis."""
    euler = math.pi**2 * YOUNG * WIDTH * THICKNESS**3 / 12.0 / (4.0 * LENGTH**2)
    push = {"forces": [{"link": "arm", "at": "P", "force": ["-20 N", "0 N"]}]}
    found = [c for c in checked(load_cases={"push": push}).load_cases["push"].checks if c.name == "buckling"]
    assert any(c.link == "arm" and c.value and c.value.value == pytest.approx(euler / 20.0, rel=2e-3) for c in found)


def test_a_hanging_pendulum_needs_no_torque_and_a_level_one_its_weight_times_lever() -> None:
    weight = {"hang": {"own_weight": True}}
    hanging = checked(load_cases=weight, pose={"coordinate": "arm", "angle": "-90 deg"}).load_cases["hang"].reactions
    level = checked(load_cases=weight).load_cases["hang"].reactions
    assert hanging.drive_torque == pytest.approx(0.0, abs=1e-9)
    # The disc of the eye is centred on the pin; of the bar's rectangle what lies in it does not count twice.
    lever = THICKNESS * (WIDTH * LENGTH**2 / 2.0 - (6.4**2 * WIDTH - WIDTH**3 / 12.0) / 2.0)
    assert level.drive_torque == pytest.approx(9810.0 * 1.24e-9 * lever, rel=3e-3)  # the fillets add 0.1 %


def test_its_motion_between_two_poses() -> None:
    torque = solve_case_motion(validate(tables())).torque["tip"]
    assert torque == pytest.approx([FORCE * LENGTH, 0.0], abs=1e-9)


def test_a_full_turn_of_two_poses_is_refused() -> None:
    with pytest.raises(CaseError, match=r"motion: a full turn needs at least 3 poses"):
        validate(tables(motion={"turn": True, "poses": 2}))


def test_a_link_without_joint_is_refused() -> None:
    loose = {"points": {"X": ["0 mm", "0 mm"], "Y": ["9 mm", "0 mm"]}}
    with pytest.raises(CaseError, match=r"links.loose: it has no joint, so nothing holds it; add a joint"):
        validate(tables(links=tables()["links"] | {"loose": loose}))
