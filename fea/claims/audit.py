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

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from typing import Any

from fea.claims.data import Tree, case_tree, flapping_tree, look_up, system_tree
from geometry.base.errors import CaseError
from geometry.mechanisms.flapping import FlappingWing
from loads.case.case_file import built_in_cases, read_case, read_companion
from loads.sources.claim import Claim, Printed, Source, System, TableSystem, read_printed, read_source, sources
from loads.sources.expression import Path, evaluate
from loads.sources.quantity import ANGLE, Value
from loads.text.explain import printable

FIDELITIES = ("solid", "beam")
SOLID_LEFT_OUT = "the solid model, which runs with --fidelity solid"
ZERO = 1e-9
"""Share of the printed figure below which ours is rounding error."""
SAMPLING = 1e-3
"""Share of a figure below which what its name says is taken for the figure itself."""
_CELLS = {
    "ground_d_mm": ("ground", "", "mm"),
    "grashof_satisfied": ("grashof", "", ""),
    "phase_lag_deg": ("published.phase_lag", "metrics.phase_lag", "deg"),
    "oscillation_deg": ("published.oscillation", "metrics.oscillation", "deg"),
    "asymmetry_deg": ("published.asymmetry", "metrics.asymmetry", "deg"),
}
"""Columns of a table of designs: our quantity, what the name says, unit."""


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

    ours   our value in the unit of the published figure, as text; None where there is none
    note   one plain sentence or two
    """

    claim: Claim
    finding: Finding
    ours: str | None
    note: str


class _NotStatedError(Exception):
    """A path led to what the source does not state."""


class _Names:
    """Paths of one claim: the source's systems, its figures, the claim's case, and what is not stated."""

    def __init__(self, tree: Mapping[str, Any], given: Mapping[str, str], missing: Mapping[str, str]) -> None:
        self.tree, self.given, self.missing = tree, given, missing
        self.depth = 0

    def __call__(self, path: Path) -> Value | str:
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


def check_claims(
    name: str, *, overrides: Iterable[str] = (), fidelity: str = "solid", threads: int = 2
) -> tuple[ClaimResult, ...]:
    """Re-derive the claims of a case or of a source document.

    name       a source (``owl-wing``: all its claims), a built-in case (the claims of any source that belong to it,
               and its own), or the path of a case file (its own ``[[claims]]``)
    overrides  entries of the case to set anew, as ``path=value``
    fidelity   "beam" leaves out the claims that need a solid model: they cannot be re-derived then

    Raises ``CaseError`` for a name that is neither, and for a claim that cannot be read.
    """
    if fidelity not in FIDELITIES:
        raise CaseError(f"fidelity: '{fidelity}' is unknown; choose one of {', '.join(FIDELITIES)}")
    overrides = tuple(overrides)
    solve = partial(_tree_of, threads=threads, fidelity=fidelity)
    found: list[ClaimResult] = []
    for source in sources():
        record = read_source(source)
        if source == name:
            found += _check_source(record, None, solve)
        elif any(claim.case == name for claim in record.claims):
            found += _check_source(record, name, partial(solve, overrides={name: overrides}))
    if name in built_in_cases() or not found:
        case = read_case(name, overrides)
        tree = case_tree(case, name, fidelity=fidelity, threads=threads)
        found += [check_claim(claim, _Names(tree, {}, claim.not_stated)) for claim in case.claims]
    elif overrides and name in sources():
        raise CaseError(f"--set: '{name}' is a source document, not a case; name a case to set its entries anew")
    return tuple(found)


def check_all(*, fidelity: str = "solid", threads: int = 2) -> dict[str, tuple[ClaimResult, ...]]:
    """Re-derive the claims of every source document, by its name."""
    return {name: check_claims(name, fidelity=fidelity, threads=threads) for name in sources()}


def _tree_of(
    system: System | str, *, fidelity: str, threads: int, overrides: Mapping[str, tuple[str, ...]] | None = None
) -> Mapping[str, Any]:
    """Return the quantities of a system, or of a built-in case by its name."""
    if isinstance(system, str):
        case = read_case(system, (overrides or {}).get(system, ()))
        return case_tree(case, system, fidelity=fidelity, threads=threads)
    return system_tree(system, fidelity=fidelity, threads=threads)


def _check_source(source: Source, case: str | None, solve: Callable[..., Mapping[str, Any]]) -> list[ClaimResult]:
    """Re-derive the claims of a source: all, or those of one case."""
    systems = {
        key: partial(solve, system) for key, system in source.systems.items() if not isinstance(system, TableSystem)
    }
    cases = Tree(**{name: partial(solve, name) for name in built_in_cases()})
    found = []
    for claim in source.claims:
        if case is not None and claim.case != case:
            continue
        branches: dict[str, Callable[[], Any]] = dict(systems)
        if claim.case is not None and claim.case in cases:
            tree = cases[claim.case]
            branches |= {key: partial(tree.__getitem__, key) for key in tree}
        found.append(check_claim(claim, _Names(Tree(**branches), source.given, source.not_stated | claim.not_stated)))
    for key, system in source.systems.items():
        if case is None and isinstance(system, TableSystem):
            found += check_table(key, system)
    return found


def check_claim(claim: Claim, names: Callable[[Path], Value | str]) -> ClaimResult:
    """Re-derive one claim; raises ``CaseError`` where an expression is wrong."""
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
        finding = Finding.DOES_NOT_FOLLOW
        subject = "it" if printed else "the answer"
        note = f"By the source's own figures {subject} is {_shown(stated, claim, printed)}{_off(stated, printed)}."
        if ours is not None and _agrees(ours, claim, printed, allowed):
            note += " The printed figure itself is right."
        elif ours is not None and shown != _shown(stated, claim, printed):
            note += f" Re-derived, {subject} is {shown}."
    elif ours is not None and not _agrees(ours, claim, printed, allowed):
        finding = Finding.DOES_NOT_HOLD
        note = f"Re-derived, {'it' if printed else 'the answer'} is {shown}{_off(ours, printed)}."
        if stated is not None:
            note += " The printed figure does follow from the source's own relation."
    elif ours is None and stated is None:
        finding = Finding.CANNOT_BE_REDERIVED
        note = f"The source does not state {' and '.join(dict.fromkeys(missing))}."
        if SOLID_LEFT_OUT in missing:
            note = f"This run leaves out {SOLID_LEFT_OUT}."
    else:
        finding = Finding.HOLDS
        how = " within its printed digits" if not claim.tolerance else f" within {claim.tolerance}"
        if any(_cut_off(value, claim, printed, allowed) for value in (stated, ours)):
            how = ", cut off after its printed digits and not rounded"
        note = f"It follows{how}." if printed else "So it is."
        if means is not None and _apart(means, claim, printed):
            note = (
                f"It follows from the source's own definition; what its name says is {_shown(means, claim, printed)}."
            )
    return ClaimResult(claim=claim, finding=finding, ours=shown, note=f"{note} {claim.note}".strip())


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


def _off(value: Value | str, printed: Printed | None) -> str:
    """Say how far off the printed figure is: a factor, a share, or a wrong sign."""
    if printed is None or isinstance(value, str):
        return ""
    ours = value.to(printed.unit)
    if printed.number == 0.0 or abs(ours) < ZERO * abs(printed.number):
        return ", where the source prints zero" if printed.number == 0.0 else ""
    if value.dimensions == ANGLE:
        apart = printed.number - ours
        return f": the printed figure is {abs(apart):.2g} {printed.unit} too {'large' if apart > 0.0 else 'small'}"
    ratio = printed.number / ours
    if ratio < 0.0:
        turned = abs(abs(ours) - abs(printed.number)) <= printed.half * 1.000001
        return ", so only the sign is wrong" if turned else ", of the other sign"
    power = round(math.log10(ratio)) if ratio > 0.0 else 0
    if power and abs(ratio / 10.0**power - 1.0) < 0.01:
        much = "large" if power > 0 else "small"
        return f": the printed figure is {10 ** abs(power)} times too {much}"
    if ratio > 1.5 or ratio < 1.0 / 1.5:
        much, factor = ("large", ratio) if ratio > 1.0 else ("small", 1.0 / ratio if ratio else math.inf)
        return f": the printed figure is {factor:.3g} times too {much}"
    return f": the printed figure is {abs(ratio - 1.0) * 100.0:.2g} % too {'large' if ratio > 1.0 else 'small'}"


def check_table(name: str, table: TableSystem) -> list[ClaimResult]:
    """Re-derive every published cell of a table of flapping-wing designs; claims are named ``table.model.column``.

    A cell that does not hold, but stands in another row of the column where it does hold, is told as such: figures
    slip into the wrong row when tables are copied.
    """
    text = read_companion(built_in_cases()[0], table.file)
    found: list[ClaimResult] = []
    for row in csv.DictReader(io.StringIO("".join(x for x in text.splitlines(True) if not x.startswith("#")))):
        lengths = ("crank_a_mm", "coupler_b_mm", "rocker_c_mm", "width_x_mm", "height_y_mm")
        crank, coupler, rocker, width, height = (float(row[column]) for column in lengths)
        tree = flapping_tree(FlappingWing(crank=crank, coupler=coupler, rocker=rocker, width=width, height=height))
        where = f"{row['table']}.{row['model']}"
        names = _Names({name: {row["table"]: {row["model"]: tree}}}, {}, {})
        for column, (quantity, means, unit) in _CELLS.items():
            if not row[column]:
                continue
            prefix = f"{name}.{where}."
            claim = Claim(
                name=f"{where}.{column}",
                quantity=prefix + quantity,
                means=prefix + means if means else "",
                published=f"{row[column]} {unit}".strip(),
                source=f"{table.source}, table {row['table']}, row {row['model']}",
            )
            found.append(check_claim(claim, names))
    return [_with_twin(result, found) for result in found]


def _with_twin(result: ClaimResult, all_cells: list[ClaimResult]) -> ClaimResult:
    if not result.finding.refutes:
        return result
    table, _, column = result.claim.name.split(".")
    twins = [
        other.claim.name
        for other in all_cells
        if other.finding is Finding.HOLDS
        and other.claim.name.split(".")[2] == column
        and other.claim.published == result.claim.published
    ]
    if not twins:
        return result
    near = min(twins, key=lambda twin: twin.split(".")[0] != table)
    return replace(
        result, note=f"{result.note} The same figure stands in row {near.rpartition('.')[0]}, where it holds."
    )
