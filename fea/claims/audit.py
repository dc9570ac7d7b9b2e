"""Re-derives published figures and says of each whether it holds.

A claim has up to three expressions: ``stated`` (the source's own arithmetic), ``quantity`` (our value) and
``means`` (what the figure's name says, where the source's definition says something else). In this order:

    does-not-follow      ``stated`` gives another number than the printed one
    does-not-hold        ``quantity`` gives another number
    cannot-be-rederived  neither can be worked out, since the source leaves out what they need
    holds                all else; with ``means`` apart from it, the note tells both

Sources round their figures or cut them off: a figure of two digits or more holds where either gives it, and the note
says which.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from alula.fea.claims.data import look_up
from alula.fea.common.reason import Reason, reason
from alula.geometry.base.errors import CaseError
from alula.loads.sources.claim import Claim, Printed, read_printed
from alula.loads.sources.expression import Path, evaluate
from alula.loads.sources.quantity import ANGLE, Value
from alula.loads.text.explain import printable

SOLID_LEFT_OUT = "the solid model, which runs with --fidelity solid"
ZERO = 1e-9
"""Share of the printed figure below which ours is rounding error."""
SAMPLING = 1e-3
"""Share of a figure below which what its name says is taken for the figure itself."""


class Finding(Enum):
    """What became of a claim."""

    HOLDS = "holds"
    DOES_NOT_HOLD = "does-not-hold"
    DOES_NOT_FOLLOW = "does-not-follow"
    CANNOT_BE_REDERIVED = "cannot-be-rederived"

    @property
    def refutes(self) -> bool:
        """Whether the published figure is contradicted; what cannot be re-derived is not."""
        return self in (Finding.DOES_NOT_HOLD, Finding.DOES_NOT_FOLLOW)


@dataclass(frozen=True, kw_only=True)
class ClaimResult:
    """A claim and what became of it.

    Attributes
    ----------
    claim : Claim
        As the source publishes it.
    finding : Finding
        What became of it.
    ours : str or None
        Our value in the unit of the published figure, as text; None where there is none.
    notes : tuple of Reason or str
        What was found, and what the file of claims says to it.
    """

    claim: Claim
    finding: Finding
    ours: str | None
    notes: tuple[Reason | str, ...]


class _NotStatedError(Exception):
    """A path led to what the source does not state."""


class Names:
    """Paths of one claim: the source's systems, its figures, the claim's case, and what is not stated."""

    def __init__(self, tree: Mapping[str, Any], given: Mapping[str, str], missing: Mapping[str, str]) -> None:
        self.tree, self.given, self.missing = tree, given, missing
        self.depth = 0

    def __call__(self, path: Path) -> Value | str:
        """Return the value at a path."""
        if path[0] == "not_stated" and len(path) == 2 and path[1] in self.missing:
            raise _NotStatedError(self.missing[path[1]])
        if path[0] == "given" and len(path) == 2 and path[1] in self.given:
            self.depth += 1
            if self.depth > 10:
                raise CaseError(f"given.{path[1]}: it refers to itself; write its value")
            try:
                return evaluate(self.given[path[1]], self)
            finally:
                self.depth -= 1
        if path[0] in ("given", "not_stated"):
            known = self.given if path[0] == "given" else self.missing
            raise CaseError(f"'{printable('.'.join(path))}' is unknown; choose among {', '.join(known) or 'none'}")
        if path[0] == "solid" and "solid" not in self.tree and "beam" in self.tree:
            raise _NotStatedError(SOLID_LEFT_OUT)
        return look_up(self.tree, path)


def check_claim(claim: Claim, names: Callable[[Path], Value | str]) -> ClaimResult:
    """Re-derive one claim.

    Parameters
    ----------
    claim : Claim
        The claim.
    names : callable
        Returns the value of a path.

    Returns
    -------
    ClaimResult
        The claim with its finding.

    Raises
    ------
    CaseError
        Where an expression is wrong.
    """
    printed = read_printed(claim.published)
    missing: list[str] = []

    def value(text: str) -> Value | str | None:
        if not text:
            return None
        try:
            return evaluate(text, names)
        except _NotStatedError as error:
            missing.append(str(error))
            return None
        except CaseError as error:
            raise CaseError(f"claims.{claim.name}: {error}") from None

    stated, ours, means = value(claim.stated), value(claim.quantity), value(claim.means)
    allowed = claim.allowed(printed)
    shown = _shown(ours if ours is not None else stated, claim, printed)
    if stated is not None and not _agrees(stated, claim, printed, allowed):
        finding, own = Finding.DOES_NOT_FOLLOW, _shown(stated, claim, printed)
        notes = [reason("by_the_sources_own_figures", figure=bool(printed), shown=own, off=_off(stated, printed))]
        if ours is not None and _agrees(ours, claim, printed, allowed):
            notes.append(reason("printed_figure_is_right"))
        elif ours is not None and shown != own:
            notes.append(reason("rederived", figure=bool(printed), shown=shown, off=None))
    elif ours is not None and not _agrees(ours, claim, printed, allowed):
        finding = Finding.DOES_NOT_HOLD
        notes = [reason("rederived", figure=bool(printed), shown=shown, off=_off(ours, printed))]
        if stated is not None:
            notes.append(reason("figure_follows_from_own_relation"))
    elif ours is None and stated is None:
        finding = Finding.CANNOT_BE_REDERIVED
        notes = [reason("source_does_not_state", missing=tuple(dict.fromkeys(missing)))]
        if SOLID_LEFT_OUT in missing:
            notes = [reason("run_leaves_out_solid")]
    else:
        finding = Finding.HOLDS
        if means is not None and _apart(means, claim, printed):
            notes = [reason("follows_from_own_definition", shown=_shown(means, claim, printed))]
        elif printed is None:
            notes = [reason("so_it_is")]
        elif any(_cut_off(value, claim, printed, allowed) for value in (stated, ours)):
            notes = [reason("follows_cut_off")]
        else:
            notes = [reason("follows_within", tolerance=claim.tolerance or None)]
    return ClaimResult(claim=claim, finding=finding, ours=shown, notes=(*notes, *((claim.note,) if claim.note else ())))


def _agrees(value: Value | str, claim: Claim, printed: Printed | None, allowed: float) -> bool:
    if printed is None or isinstance(value, str):
        if printed is not None or not isinstance(value, str):
            raise CaseError(
                f"claims.{claim.name}: published '{printable(claim.published)}' and its quantity are not of one kind; "
                "compare a number with a number, or words with words"
            )
        return value.casefold() == claim.published.strip().casefold()
    rounded = abs(_number(value, claim, printed) - printed.number) <= allowed
    return rounded or _cut_off(value, claim, printed, allowed)


def _cut_off(value: Value | str | None, claim: Claim, printed: Printed | None, allowed: float) -> bool:
    """Whether the printed digits, two at least, begin the value but are not the nearest to it."""
    if value is None or isinstance(value, str) or printed is None or claim.tolerance:
        return False
    beyond = math.copysign(1.0, printed.number) * _number(value, claim, printed) - abs(printed.number)
    unit = 2.0 * printed.half
    return abs(printed.number) > 9.5 * unit and allowed < beyond < unit * (1.0 - ZERO)


def _apart(means: Value | str, claim: Claim, printed: Printed | None) -> bool:
    """Whether what the name says differs by more than the source's coarse sampling of a turn can make it."""
    allowed = claim.allowed(printed)
    if printed is not None:
        allowed = max(allowed, SAMPLING * abs(printed.number))
    return not _agrees(means, claim, printed, allowed)


def _number(value: Value, claim: Claim, printed: Printed) -> float:
    try:
        return value.to(printed.unit)
    except CaseError as error:
        raise CaseError(f"claims.{claim.name}: {error}") from None


def _shown(value: Value | str | None, claim: Claim, printed: Printed | None) -> str | None:
    """Return a value in the unit of the published figure, with some two digits more than that has."""
    if value is None or isinstance(value, str):
        return value
    if printed is None:
        return None
    number = _number(value, claim, printed)
    size = abs(printed.number)
    if abs(number) < ZERO * size:
        number = 0.0
    digits = 6 if size == 0.0 else math.ceil(math.log10(size / printed.half)) + 2
    return f"{number:.{min(max(digits, 4), 15)}g} {printed.unit}".strip()


def _off(value: Value | str, printed: Printed | None) -> Reason | None:
    """Return how far off the printed figure is: a factor, a share, or a wrong sign."""
    if printed is None or isinstance(value, str):
        return None
    ours = value.to(printed.unit)
    if printed.number == 0.0 or abs(ours) < ZERO * abs(printed.number):
        return reason("source_prints_zero") if printed.number == 0.0 else None
    if value.dimensions == ANGLE:
        apart = printed.number - ours
        return reason("figure_is_off_by", much=float(f"{abs(apart):.2g}"), unit=printed.unit, large=apart > 0.0)
    ratio = printed.number / ours
    if ratio < 0.0:
        turned = abs(abs(ours) - abs(printed.number)) <= printed.half * 1.000001
        return reason("only_the_sign_is_wrong") if turned else reason("of_the_other_sign")
    power = round(math.log10(ratio)) if ratio > 0.0 else 0
    if power and abs(ratio / 10.0**power - 1.0) < 0.01:
        return reason("figure_is_off_by_power", times=10 ** abs(power), large=power > 0)
    if ratio > 1.5 or ratio < 1.0 / 1.5:
        factor = ratio if ratio > 1.0 else 1.0 / ratio if ratio else math.inf
        return reason("figure_is_off_by_times", times=factor, large=ratio > 1.0)
    return reason("figure_is_off_by", much=float(f"{abs(ratio - 1.0) * 100.0:.2g}"), unit="%", large=ratio > 1.0)
