"""A new kind of check goes from its entry to an outcome by what stands in ``tests/reach_check.py`` and nothing else."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from reach_check import REACH, ReachCase, ReachCheck, reach_outcomes

from alula.fea.asked.asked import asks
from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE, Verdict
from alula.fea.whole import outcomes

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
    assert others == [check for one in plain.load_cases.values() for check in one.checks]
