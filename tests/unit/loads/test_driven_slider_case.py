"""A case whose slider is driven by its travel, from the entries to tables and reports."""

import json
import math
import re
import tomllib

import numpy as np
import pytest
from slotted_cases import piston_entries
from told_motion import pictures, printed, record, rows, texts

from alula.fea.check.anchor import anchor_loads
from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.statics.effort import DriveEffort

A = 40.0


def case_with(**changes: dict) -> Case:
    data = piston_entries()
    for table, more in changes.items():
        data[table] = {key: value for key, value in (data.get(table, {}) | more).items() if value is not None}
    return validate(data)


def test_the_piston_holds_what_pushes_it_at_every_travel() -> None:
    data = piston_entries()
    data["load_cases"]["brake"] = {"forces": [{"link": "rod", "at": "C", "force": ["-20 N", "5 N"]}]}
    moved = solve_case_motion(validate(data))
    assert (moved.effort, moved.motion.unit) == (DriveEffort.FORCE, "mm")
    assert moved.torque["brake"] == pytest.approx(np.full(13, 20.0), abs=1e-9)
    assert moved.motion.travel("S") == pytest.approx(np.linspace(90.0, 150.0, 13), abs=1e-10)
    assert moved.motion.times[-1] == pytest.approx(60.0 / 400.0)
    assert moved.dead_points == ()


def test_its_tables_and_summary_tell_travels_and_forces() -> None:
    data = piston_entries()
    data["load_cases"]["brake"] = {"forces": [{"link": "rod", "at": "C", "force": ["-20 N", "5 N"]}]}
    moved = solve_case_motion(validate(data))
    found = json.loads(json.dumps(record(moved)))
    assert (found["motion"]["unit"], found["motion"]["first"], found["motion"]["last"]) == ("mm", 90.0, 150.0)
    assert found["motion"]["speed_mm_per_s"] == [400.0, 400.0]
    assert found["load_cases"]["brake"]["drive_force"]["first"] == pytest.approx(20.0)
    assert "drive_torque" not in found["load_cases"]["brake"]
    assert "From S = 90 to 150 mm, driven at piston, in 13 poses and 0.1500 s" in texts(moved, "motion")[0]
    [drive] = [line.split() for line in printed(moved).splitlines() if line.startswith("drive force on piston")]
    assert drive[4:7] == ["N", "20.00", "20.00"]
    torque, links = rows(moved, "torque.csv"), rows(moved, "links.csv")
    assert float(torque[0]["S travel [mm]"]) == 90.0
    assert float(torque[-1]["force on piston [N]"]) == pytest.approx(20.0)
    first, last = (float(links[i]["crank angle [deg]"]) for i in (0, -1))
    assert first == pytest.approx(math.degrees(moved.motion.angle("crank")[0]))
    assert last < first
    assert "crank speed over speed of S [rad/mm]" in links[0]


def test_figures_of_it_are_drawn() -> None:
    drawn = pictures(solve_case_motion(validate(piston_entries())))
    assert {"link-angles", "paths", "torque"} <= drawn.keys()
    assert all(picture.png().startswith(b"\x89PNG") for picture in drawn.values())


def test_its_check_holds_the_piston() -> None:
    """A moment on the crank alone: the piston's force is M/(ds/dphi), and the frame is held at the slider."""
    case = validate(piston_entries())
    result = check_case(case, fidelity="beam")
    reactions = result.load_cases["brake"].reactions
    pose = result.pose
    crank, rod = pose.angles["crank"], pose.angles["rod"]
    slope = -A * math.sin(crank - rod) / math.cos(rod)  # ds/dphi
    assert reactions.drive_force == pytest.approx(300.0 / slope, rel=1e-12)
    assert reactions.drive_torque == 0.0
    assert reactions.joints["S"].wrench[0] == pytest.approx(reactions.drive_force)
    assert result.load_cases["brake"].large_displacement.state == "small"
    assert LINKAGE in {check.subject for check in result.load_cases["brake"].checks}
    # The guide's force acts where the piston stands: the ground holds the moment on the crank, and no force.
    assert anchor_loads(result.load_cases["brake"]).total == pytest.approx([0, 0, 0, 0, 0, -300.0], abs=1e-9)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"pose": {"coordinate": "O"}}, r"pose.coordinate: 'O' is no slider or slot.*; choose one of S"),
        ({"pose": {"angle": "10 deg"}}, r"pose.angle: the travel fixes the pose already"),
        ({"pose": {"travel": "130"}}, "unit"),
        ({"motion": {"travel": ["90 mm", "170 mm"]}}, None),
        (
            {"motion": {"travel": None, "range": ["0 deg", "30 deg"], "travel_speed": None}},
            r"motion: .*is a slider, so",
        ),
        ({"motion": {"speed": "3 rpm"}}, "no angular speed"),
        ({"motion": {"travel": ["90 mm", "90 mm"]}}, "same travel"),
        ({"motion": {"travel_speed": "3 rpm"}}, "speed"),
        ({"motion": {"coordinate": "crank"}}, r"motion.coordinate: 'crank' is no slider or slot"),
        ({"load_cases": {"brake": {"speed": "3 rpm"}}}, r"load_cases.brake.speed: .*is a slider; leave it out"),
        (
            {"checks": {"motor": {"type": "motor", "voltage": "6 V", "current": "1 A", "efficiency": 0.5}}},
            r"checks.motor: a motor turns, but the drive pushes slider 'S'",
        ),
    ],
)
def test_what_does_not_fit_is_refused(changes: dict, words: str | None) -> None:
    if words is None:
        with pytest.raises(CaseError, match=r"driven by S, the linkage comes to a dead point at S = 158.745079 mm"):
            solve_case_motion(case_with(**changes))
        return
    with pytest.raises(CaseError, match=words):
        case_with(**changes)


def test_a_crank_driven_pose_may_move_by_its_pistons_travel() -> None:
    """The motion's coordinate need not be the pose's."""
    data = piston_entries()
    data["pose"] = {"coordinate": "crank", "angle": "60 deg", "near": {"rod": "-25 deg", "piston": "0 deg"}}
    data["motion"] = {"coordinate": "S", "travel": ["100 mm", "140 mm"], "poses": 5}
    moved = solve_case_motion(validate(data))
    assert moved.motion.travel("S") == pytest.approx([100.0, 110.0, 120.0, 130.0, 140.0], abs=1e-10)


def test_a_braked_piston_stops_where_its_energy_ends() -> None:
    moving = {"travel_speed": "100 mm/s", "travel_acceleration": "-1 m/s^2"}
    with pytest.raises(CaseError, match=r"slows down to a stop at 95 mm"):
        solve_case_motion(case_with(motion=moving))


def test_an_envelope_over_a_travel_is_refused() -> None:
    from alula.fea.motion.envelope import envelope_case

    with pytest.raises(CaseError, match=r"motion.travel: an envelope is drawn over the direction of a link"):
        envelope_case(validate(piston_entries()))


def test_the_report_of_its_check_tells_the_travel_and_the_force() -> None:
    from told import render

    result = check_case(validate(piston_entries()), fidelity="beam")
    page = render(result, {})
    assert "The pose is fixed by joint S, whose travel is" in page
    assert re.search(r"whose travel is\s+130(\.0+)? mm", page)
    assert "Drive force on" in page
    assert "Drive torque" not in page


TRAMMEL = """
schema_version = 1
title = "A rod on two sliders"
massless = ["s1", "s2"]
links.base = { ground = true, points.S1 = ["0 mm", "0 mm"], points.S2 = ["0 mm", "0 mm"] }
links.s1.points = { Q = ["10 mm", "0 mm"], A = ["0 mm", "0 mm"] }
links.s2.points = { Q = ["10 mm", "0 mm"], B = ["0 mm", "0 mm"] }
links.rod.points = { A = ["0 mm", "0 mm"], B = ["100 mm", "0 mm"], P = ["50 mm", "0 mm"] }
joints.g1 = { links = ["base", "s1"], type = "slider", points = ["S1", "A"] }
joints.g2 = { links = ["base", "s2"], type = "slider", points = ["S2", "B"], direction = "90 deg" }
joints.A = { links = ["rod", "s1"] }
joints.B = { links = ["rod", "s2"] }
pose = { coordinate = "rod", angle = "140 deg", near = { s1 = "0 deg", s2 = "0 deg" } }
drive = { link = "s1", joint = "g1" }
load_cases.lift.forces = [{ link = "rod", at = "P", force = ["0 N", "-20 N"] }]
"""


def test_ways_to_hold_need_a_revolute_joint_on_the_ground() -> None:
    validate(tomllib.loads(TRAMMEL))
    with pytest.raises(CaseError, match="ways_to_hold: no revolute joint on the ground"):
        validate(tomllib.loads(TRAMMEL + '[ways_to_hold]\nlink = "rod"\nat = "P"\n'))
