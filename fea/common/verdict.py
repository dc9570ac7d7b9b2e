"""Verdicts: pass, fail, or undecided where the error band straddles the limit."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from fea.common.band import Band

SAFETY_FACTOR = "safety factor"
LOAD_SHARE = "share of the load that is held"
BUCKLING_FACTOR = "buckling factor"
DRIVE_POWER = "drive power"
LINKAGE = "the linkage"
"""Stands in the place of a link where a check is about all of them."""
PIN = "pin "
"""Begins what stands in the place of a link where a check is about the pin of a joint."""

POINT = "point "
"""Begins what stands in the place of a link where a check is about a point of the linkage."""


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

    link       its name; "pin " and the joint's name for a pin, "point H of CH" for a point, "the linkage" for all
               together
    quantity   what was checked: "safety factor", "displacement" of a point, "deflection from its pins" of a link
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

    @property
    def at_least(self) -> bool:
        """True where the quantity must be at least its limit, False where it must be at most that."""
        return self.quantity in (SAFETY_FACTOR, LOAD_SHARE, BUCKLING_FACTOR)

    @property
    def what(self) -> str:
        """What was checked, for people: a link of that name, a pin, a point or the whole linkage."""
        return self.link if self.link == LINKAGE or self.link.startswith((PIN, POINT)) else f"link {self.link}"


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
