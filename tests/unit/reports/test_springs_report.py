"""Springs, tendons and stops in the console, the page, the record and the drawing."""

import numpy as np
import pytest
import solved
from PIL import Image
from sprung_cases import CROWN, case_of, stands
from told import not_covered, render, result_record
from told_motion import rows

from alula.fea.check.anchor import anchor_loads
from alula.fea.check.run import check_case
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.figures.drawings import linkage_drawing
from alula.reports.figures.sheet.style import SPRING
from alula.reports.figures.sprung import coil, spiral, stop_mark
from alula.reports.sections.springs import holding_sentence, spring_sentences

PEDAL = "spring-pedal"
WITHOUT_FOOT = ['load_cases.foot.forces.0.force=["0 N", "0 N"]']


@pytest.fixture(scope="module")
def balanced():
    return solved.by_hand(PEDAL)


@pytest.fixture(scope="module")
def stopped():
    return check_case(read_case(PEDAL, WITHOUT_FOOT), fidelity="beam")


def test_the_balance_is_told_with_its_stiffness(balanced):
    standing = balanced.load_cases["foot"].standing
    assert holding_sentence(standing) == (
        "The pose balances by itself at pedal = 85.44 deg, and is stable: its stiffness is 4886 N·mm/rad"
    )
    assert list(spring_sentences(standing)) == [
        "Spring return: 76.51 mm long, pulls with 25.21 N",
        "Stop up: joint O at 85.44 deg, at most 100.0 deg",
        "Stop down: joint O at 85.44 deg, at least 65.00 deg",
    ]
    page = render(balanced, {})
    assert "The pose balances by itself at pedal = 85.44 deg" in page
    assert "Drive torque on pedal" not in page


def test_what_is_not_covered_of_springs_is_said_where_there_are_some(balanced):
    assert "no mass, no friction" in dict(not_covered(balanced))["Springs and stops"]
    assert "Springs and stops" not in dict(not_covered(solved.by_hand("owl-wing-closed")))


def test_a_stop_that_is_reached_is_named(stopped):
    """Taken about O: spring, piston and weight against the stop."""
    found = stopped.load_cases["foot"]
    [spring] = found.standing.springs
    tip, eye = stopped.pose.position("pedal", "H"), stopped.pose.position("frame", "S")
    pull = float(spring.effort) * (eye - tip) / np.linalg.norm(eye - tip)
    rod = -found.reactions.joints["R"].force[:2]
    at = stopped.pose.position("pedal", "R")
    moment = tip[0] * pull[1] - tip[1] * pull[0] + at[0] * rod[1] - at[1] * rod[0]
    assert found.standing.contact == pytest.approx(-moment, rel=0.01)  # the pedal's own weight is what is left
    assert holding_sentence(found.standing).startswith("Stop 'up' is reached and bears 4665 N·mm clockwise on pedal")
    record = result_record(stopped)["load_cases"]["foot"]
    assert record["drive_torque"] == 0.0
    assert record["standing"]["held_by"] == "stop"
    assert record["standing"]["contact"] == pytest.approx(-4665.0, abs=0.5)
    assert [stop["reached"] for stop in record["standing"]["stops"]] == [True, False]


def test_the_ground_bears_the_other_end_of_the_spring(balanced):
    """All on the ground is what acts on the linkage from outside: 40 N, -100 N and its weight."""
    anchor = anchor_loads(balanced.load_cases["foot"])
    assert "springs at S" in anchor.joints
    assert anchor.total[0] == pytest.approx(-60.0, abs=1e-9)
    assert -1.0 < anchor.total[1] < 0.0


def test_the_drawing_shows_spring_and_stops(balanced, tmp_path):
    path = tmp_path / "linkage.png"
    path.write_bytes(linkage_drawing(balanced, "foot").png())
    pixels = np.asarray(Image.open(path).convert("RGB")).astype(int)
    colour = np.array([int(SPRING[i : i + 2], 16) for i in (1, 3, 5)])
    assert np.count_nonzero(np.abs(pixels - colour).sum(axis=-1) < 12) > 500


def test_a_motion_tells_its_springs():
    moved = solve_case_motion(read_case(PEDAL, ["load_cases.foot.own_weight=false", "motion.poses=8"]))
    table = rows(moved, "springs.csv")
    angle = np.radians(np.linspace(100.0, 65.0, 8))
    length = np.hypot(80.0 * np.cos(angle) + 70.0, 80.0 * np.sin(angle) - 75.0)
    assert list(table[0])[-2:] == ["return length [mm]", "return pull [N]"]
    assert [float(row["return length [mm]"]) for row in table] == pytest.approx(length, rel=1e-6)
    assert [float(row["return pull [N]"]) for row in table] == pytest.approx(0.8 * (length - 45.0), rel=1e-6)


def test_lines_of_springs_end_where_they_should():
    line = coil(np.array([1.0, 2.0]), np.array([5.0, 5.0]), 0.3)
    assert line[0] == pytest.approx([1.0, 2.0])
    assert line[-1] == pytest.approx([5.0, 5.0])
    assert np.abs((line - line[0]) @ np.array([-3.0, 4.0]) / 5.0).max() == pytest.approx(0.3)
    assert spiral(np.zeros(2), 0.5, 2.0)[-1] == pytest.approx(2.0 * np.array([np.cos(0.5), np.sin(0.5)]))
    assert stop_mark(np.zeros(2), 0.0, 2.0)[:, 0].min() == pytest.approx(0.0)  # all hatches are behind the wall


def test_a_slider_tells_lengths():
    pose = {"coordinate": "T", "travel": "60 mm", "equilibrium": True,
            "near": {"bar": "50 deg", "rod": "-50 deg", "block": "0 deg"}}  # fmt: skip
    _, found = stands(case_of(CROWN, pose=pose, stops={"out": {"joint": "T", "at_most": "72 mm"}}))
    assert "Stop 'out' is reached and bears −" in holding_sentence(found)
    assert "N on block along joint T, the opposite on base" in holding_sentence(found)
    assert "Stop out: joint T at 72.00 mm, at most 72.00 mm" in list(spring_sentences(found))
