"""Verdicts: pass, fail, or undecided where the error band straddles the limit."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from fea.band import Band


class Verdict(StrEnum):
    """The answer of a check."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"

    @property
    def exit_status(self) -> int:
        """Status of the command that ends with this verdict."""
        return {"pass": 0, "fail": 1, "undecided": 3}[self.value]


@dataclass(frozen=True, kw_only=True)
class CheckOutcome:
    """One check of one link under one load case.

    quantity   what was checked: "safety factor", "displacement"
    unit       of value and limit; "" for a pure number
    reason     one sentence that says why the verdict is what it is
    """

    name: str
    link: str
    load_case: str
    quantity: str
    unit: str
    value: Band
    limit: float
    verdict: Verdict
    reason: str


def at_least(value: Band, limit: float) -> Verdict:
    """Decide on the whole band whether a number is at least its limit."""
    if value.low >= limit:
        return Verdict.PASS
    return Verdict.FAIL if value.high < limit else Verdict.UNDECIDED


def at_most(value: Band, limit: float) -> Verdict:
    """Decide on the whole band whether a number is at most its limit."""
    if value.high <= limit:
        return Verdict.PASS
    return Verdict.FAIL if value.low > limit else Verdict.UNDECIDED


def overall(verdicts: Iterable[Verdict]) -> Verdict:
    """Any fail gives fail, else any undecided gives undecided; nothing checked is undecided."""
    found = set(verdicts)
    for verdict in (Verdict.FAIL, Verdict.UNDECIDED, Verdict.PASS):
        if verdict in found:
            return verdict
    return Verdict.UNDECIDED
