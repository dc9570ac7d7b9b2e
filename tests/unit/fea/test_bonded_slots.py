"""Bonded joints do not bond what slides, by closed forms of beams; a frame at a dead point is refused."""

import math
import tomllib
from importlib.resources import files

import pytest

from alula.fea.check.run import check_case
from alula.fea.standing.joint_forces import joint_forces
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.actions import acting_loads

STARTER = files("alula.loads") / "cases" / "four-bar.toml"
LENGTH = 200.0
POST = {
    "shape": "bar",
    "material": "pvc-paredes-2018",
    "width": "4 mm",
    "thickness": "3 mm",
    "fillet_radius": "0.2 mm",
    "eye_diameter": "7 mm",
    "eye_thickness": "3 mm",
}


def beam(end):
    """A bar bonded to the ground at A, under 1 N across and 2 N along at its middle, its end S held as ``end``."""
    return validate(
        {
            "schema_version": 1,
            "title": "a beam",
            "links": {
                "ground": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "S": [f"{LENGTH} mm", "0 mm"]}},
                "bar": {
                    "part": "post",
                    "points": {"A": ["0 mm", "0 mm"], "M": [f"{LENGTH / 2} mm", "0 mm"], "S": [f"{LENGTH} mm", "0 mm"]},
                },
            },
            "joints": {
                "A": {"links": ["ground", "bar"], "pin_diameter": "2 mm"},
                "S": {"type": end, "links": ["ground", "bar"], "pin_diameter": "2 mm"},
            },
            "joint_model": "bonded",
            "pose": {"near": {"bar": "0 deg"}},
            "parts": {"post": POST},
            "load_cases": {"push": {"forces": [{"link": "bar", "at": "M", "force": ["2 N", "-1 N"]}]}},
        }
    )


def end_reaction(case):
    pose = case.solve_pose()
    found = joint_forces(case, pose, acting_loads(case, case.load_cases["push"], pose.placement, {}))
    return found, found.reactions.joints["S"].wrench


@pytest.mark.parametrize(
    ("end", "across", "moment"),
    # Fixed at A and simply held at S: 5 P/16; fixed at both: P/2 and P L/8 (Roark, beams under a load at midspan).
    [("pin-in-slot", 5.0 / 16.0, 0.0), ("slider", 0.5, LENGTH / 8.0)],
)
def test_what_slides_bears_nothing_along_its_slot(end, across, moment):
    found, wrench = end_reaction(beam(end))
    assert wrench[0] == pytest.approx(0.0, abs=1e-9)
    assert wrench[1] == pytest.approx(across, rel=5e-3)  # slender, but shear bends a little
    assert abs(wrench[5]) == pytest.approx(moment, rel=5e-3, abs=1e-9)
    assert found.condition < 1e9
    assert found.reactions.joints["A"].wrench[:2] == pytest.approx([-2.0, 1.0 - wrench[1]])


def test_a_beam_with_a_slot_at_its_end_bears_stress():
    result = check_case(beam("pin-in-slot"), fidelity="beam").load_cases["push"]
    bar = result.links["bar"].beam
    # The largest moment is at A, 3 P L/16; with W = b h^2/6 and N = 2 N over the section.
    assert bar.worst.equivalent == pytest.approx(3.0 * LENGTH / 16.0 * 6.0 / (3.0 * 4.0**2) + 2.0 / 12.0, rel=0.02)


@pytest.mark.parametrize(("off", "refused"), [(0.0, True), (1e-7, True), (1.0, False)])
def test_a_frame_at_a_dead_point_is_refused_as_equilibrium_is(off, refused):
    """The rocker drives while crank and coupler stand in one line: a load out of the plane calls for a frame."""
    data = tomllib.loads(STARTER.read_text(encoding="utf-8"))
    angle = math.degrees(math.acos((100.0**2 + 160.0**2 - 80.0**2) / (2.0 * 100.0 * 160.0))) + off
    data["pose"] = {"coordinate": "crank", "angle": f"{angle!r} deg", "near": {"coupler": "24 deg", "rocker": "55 deg"}}
    data["drive"] = {"link": "rocker", "joint": "O4"}
    data["load_cases"] = {"up": {"forces": [{"link": "rocker", "at": "P", "force": ["0 N", "-1 N", "1 N"]}]}}
    case = validate(data)
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["up"], pose.placement, {})
    if refused:
        with pytest.raises(CaseError, match="dead point of the driven link 'rocker'"):
            joint_forces(case, pose, loads)
    else:
        assert joint_forces(case, pose, loads).solution is not None
