"""Results of built-in cases that tests of several files read: solved once per process, and frozen."""

from functools import cache
from typing import Any
from unittest.mock import patch

from fea.check.run import check_case
from fea.claims.audit import ClaimResult
from fea.claims.sources import check_all
from fea.outcomes.result import CheckResult
from loads.case.case import Case
from loads.case.case_file import read_case


@cache
def by_hand(name: str, *overrides: str) -> CheckResult:
    """Check a built-in case by hand calculation, with entries set anew."""
    return check_case(read_case(name, overrides), name=name, fidelity="beam")


@cache
def claims() -> dict[str, tuple[ClaimResult, ...]]:
    """Return the claims of every source document, by its name; their hand calculations are those of ``by_hand``."""

    def shared(case: Case, *, name: str, fidelity: str, **options: Any) -> CheckResult:
        assert case == read_case(name)
        return by_hand(name) if fidelity == "beam" else check_case(case, name=name, fidelity=fidelity, **options)

    with patch("fea.claims.data.check_case", shared):
        return check_all()
