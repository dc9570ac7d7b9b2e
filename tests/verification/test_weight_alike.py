"""What a link weighs is the same in statics, over a motion and in an envelope."""

from pathlib import Path

import numpy as np
import pytest

from alula.fea.motion.link_history import link_histories
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.masses import laden_masses, part_masses

LADEN = str(Path(__file__).parents[1] / "unit" / "loads" / "four-bar-laden.toml")
RANGE = 'motion={range=["40 deg", "60 deg"], poses=3}'
CARRIED = {
    "none": "carried=[]",
    "spread along a link": 'carried=[{link="rocker", start="O4", end="P", mass="3 g"}]',
    "at a point": 'carried=[{link="rocker", at="P", mass="3 g"}]',
    "a body at a point": 'carried=[{link="rocker", at="P", mass="3 g", centroid=["150 mm", "12 mm"]}]',
}


@pytest.mark.parametrize("carried", CARRIED.values(), ids=CARRIED.keys())
def test_statics_motion_and_envelope_weigh_alike(carried: str) -> None:
    case = read_case(LADEN, [carried, RANGE, 'load_cases.turning.speed="0 rpm"'])
    statics = solve_case_statics(case).reactions["turning"]
    moved = solve_case_motion(case)
    assert moved.torque["turning"][0] == pytest.approx(statics.drive_torque, rel=1e-9)
    for name, reaction in statics.joints.items():
        np.testing.assert_allclose(moved.forces["turning"].forces[name][0], reaction.force[:2], atol=1e-9)
    own = part_masses(case)
    mass = sum(laden.mass for laden in laden_masses(case, own).values())
    assert mass == pytest.approx(sum(part.mass for part in own.values()) + (0.0 if carried == "carried=[]" else 3e-6))
    anchored = statics.joints["O2"].wrench[:2] + statics.joints["O4"].wrench[:2]
    np.testing.assert_allclose(anchored, [0.0, mass * 9810.0], atol=1e-9)
    for link in case.checked_links:
        (history,) = link_histories(moved, link)
        held = history.chosen(0)
        weight = own[link].mass * held.inertia.specific_force[:2]
        lines = sum((line.force[:2] for line in held.lines), np.zeros(2))
        pins = sum((pin.wrench[:2] for pin in (*held.pins, *held.ends)), np.zeros(2))
        np.testing.assert_allclose(weight + lines + pins, 0.0, atol=1e-9)


def test_a_stated_total_at_a_point_stands_for_the_weight() -> None:
    total = 'load_cases.turning.forces=[{link="rocker", at="P", force=["0 N", "-0.3 N"]}]'
    still = ["load_cases.turning.own_weight=false", 'load_cases.turning.speed="0 rpm"', "carried=[]"]
    case = read_case(LADEN, [total, RANGE, *still])
    statics = solve_case_statics(case).reactions["turning"]
    anchored = statics.joints["O2"].wrench[:2] + statics.joints["O4"].wrench[:2]
    np.testing.assert_allclose(anchored, [0.0, 0.3], atol=1e-12)
    assert solve_case_motion(case).torque["turning"][0] == pytest.approx(statics.drive_torque)
