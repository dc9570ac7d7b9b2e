"""A new kind of check goes from its entry to an outcome by what its example holds, and nothing else."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from force_check import BY_FORCE, FORCE, TOLD, ForceCase, ForceCheck
from reach_check import REACH, ReachCase, ReachCheck, reach_outcomes

from alula.fea.asked.asked import asks
from alula.fea.check.kinds import BY_HAND
from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE, Quantity, Verdict
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.whole import outcomes
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.check import modes
from alula.reports.check.modes import mode_parts, mode_records

FOUR_BAR = Path(__file__).resolve().parents[3] / "loads" / "cases" / "four-bar.toml"


@pytest.mark.parametrize(
    ("limits", "verdicts"),
    [(["200 mm", "100 mm"], [Verdict.PASS, Verdict.FAIL]), (["100 mm", "200 mm"], [Verdict.FAIL, Verdict.PASS])],
)
def test_a_new_kind_of_check_is_judged_beside_the_others(monkeypatch, limits, verdicts) -> None:
    monkeypatch.setitem(outcomes.KINDS, ReachCheck, reach_outcomes)
    tables = tomllib.loads(FOUR_BAR.read_text(encoding="utf-8"))
    for number, limit in enumerate(limits):
        tables["checks"][f"reach {number}"] = {"type": "reach", "maximum": limit}
    case = ReachCase.model_validate(tables)
    assert asks(case, ReachCheck)
    result = check_case(case, fidelity="beam")
    every = [check for found in result.load_cases.values() for check in found.checks]
    found = [check for check in every if check.quantity is REACH]
    assert [check.verdict for check in found] == verdicts
    assert {(check.subject, check.load_case) for check in found} == {(LINKAGE, next(iter(case.load_cases)))}
    rocker = np.linalg.norm([100.0, 0.0] + 120.0 * np.array([np.cos(a := result.pose.angles["rocker"]), np.sin(a)]))
    assert found[0].value.value == pytest.approx(rocker)
    assert result.verdict is Verdict.FAIL
    assert not any(load_case.gives_way for load_case in result.load_cases.values())
    others = [check for check in every if check.quantity is not REACH]
    plain = check_case(case.model_copy(update={"checks": {k: c for k, c in case.checks.items() if "reach" not in k}}),
                       fidelity="beam")  # fmt: skip
    assert repr(others) == repr([check for one in plain.load_cases.values() for check in one.checks])


@pytest.fixture
def force_case(monkeypatch):
    """Return a four-bar whose joints A and B have limits between their forces, and those of the first load case."""
    of_check = Quantity.of_check
    monkeypatch.setattr(Quantity, "of_check", lambda kind: FORCE if kind == "force" else of_check(kind))
    monkeypatch.setitem(BY_HAND, ForceCheck, BY_FORCE)
    monkeypatch.setitem(modes.KINDS, "forces", TOLD)
    tables = tomllib.loads(FOUR_BAR.read_text(encoding="utf-8"))
    tables["checks"]["force"] = {"type": "force", "maximum": "1 N", "joints": ["A", "B"]}
    tables["motion"]["poses"] = 7
    return ForceCase.model_validate(tables)


def test_a_new_kind_of_check_from_loads_is_judged_in_a_pose_and_over_a_motion_and_told(force_case):
    result = next(iter(check_case(force_case, fidelity="beam").load_cases.values()))
    found = {check.subject.name: check for check in result.checks if check.quantity is FORCE}
    stands = result.large_displacement.reactions or result.reactions
    forces = {joint: stands.joints[joint].magnitude for joint in ("A", "B")}
    assert {joint: check.value.value for joint, check in found.items()} == pytest.approx(forces)
    assert {check.verdict for check in found.values()} == {Verdict.FAIL}
    records = mode_records(result)["forces"]
    assert [(one["check"], one["joint"]) for one in records] == [("force", "A"), ("force", "B")]
    assert [one["across"] for one in records] == pytest.approx([forces["A"], forces["B"]])
    [table] = [part for part in mode_parts(result) if part.key == "forces"]
    assert [str(cell) for cell in table.rows[0][:2]] == ["force", "A"]
    moved = solve_case_motion(force_case)
    every = np.ones(7, dtype=bool)
    over = {one.subject.name: one for one in envelope_outcomes(moved, {}, every) if one.quantity is FORCE}
    most = {joint: np.linalg.norm(moved.forces[result.name].forces[joint], axis=1).max() for joint in ("A", "B")}
    assert {joint: one.value.value for joint, one in over.items()} == pytest.approx(most)
