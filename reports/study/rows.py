"""The points of a study one by one: what became of each, for tables, for CSV and as plain data."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from alula.fea.common.verdict import Verdict
from alula.fea.study.margin import margin, nearest, sense_of
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import Store
from alula.fea.tolerance.result import ToleranceNumber
from alula.reports.sections.data import entries
from alula.reports.sections.section import Number, Section
from alula.reports.words.numbers import digits_beside


@dataclass(frozen=True, kw_only=True)
class Row:
    """A point with what became of it.

    Attributes
    ----------
    position : int
        Of the point in its plan, from 0.
    parameters : mapping of str to object
    answer : VariantResult
    attempts : int
    """

    position: int
    parameters: Mapping[str, object]
    answer: VariantResult
    attempts: int

    @cached_property
    def nearest(self) -> VariantNumber | None:
        """The check that is nearest to its limit, or farthest beyond."""
        return nearest(self.answer)

    @property
    def margin(self) -> float:
        """By what factor the nearest check keeps its limit with the worse end of its band; 0 where nothing is known."""
        return 0.0 if self.nearest is None else margin(self.nearest)

    @property
    def merit(self) -> tuple[int, float] | None:
        """What the best point has most of: the verdict, then the margin; None where nothing was checked."""
        if self.answer.verdict is None or self.nearest is None:
            return None
        return (Verdict.FAIL, Verdict.UNDECIDED, Verdict.PASS).index(self.answer.verdict), self.margin

    @property
    def mass(self) -> float | None:
        """Of all links [g]; None where they were not weighed."""
        found = [f.value for f in self.answer.numbers if f.quantity == "mass" and f.subject == "the linkage"]
        return found[0] if found else None

    @property
    def outcome(self) -> str:
        """The verdict, or the state where there is none."""
        return str(self.answer.verdict or self.answer.state)

    @property
    def stated(self) -> str:
        """Its values, such as ``parts.bar.thickness = 3 mm, parts.bar.width = 8 mm``."""
        return ", ".join(f"{path} = {value}" for path, value in self.parameters.items())


def study_rows(store: Store, positions: Sequence[int] | None = None) -> Iterator[Row]:
    """Yield points of a study that have a result, in order.

    Parameters
    ----------
    store : Store
    positions : sequence of int, optional
        These alone.

    Yields
    ------
    Row
    """
    for position, parameters, answer, attempts in store.rows(positions):
        yield Row(position=position, parameters=parameters, answer=answer, attempts=attempts)


def results_section(store: Store) -> Section:
    """Return all points with all their numbers, as plain data alone.

    Parameters
    ----------
    store : Store

    Returns
    -------
    Section
    """
    points = [
        {
            "position": row.position,
            "parameters": dict(row.parameters),
            **entries(row.answer, "state verdict sentence"),
            "attempts": row.attempts,
            "seconds": row.answer.seconds,
            "numbers": [found.__dict__ for found in row.answer.numbers],
        }
        for row in study_rows(store)
    ]
    return Section(key="results", data={**store.facts(), "counts": store.counts(), "results": points})


def lines(store: Store) -> Iterator[Sequence[object]]:
    """Yield the lines of a CSV file: one a point, with value and band of every number.

    Parameters
    ----------
    store : Store

    Yields
    ------
    sequence of object
        The first one names the columns.
    """
    names: dict[str, None] = {}
    paths: dict[str, None] = {}
    for row in study_rows(store):
        paths |= dict.fromkeys(row.parameters)
        names |= {title(found): None for found in row.answer.numbers}
    ends = {"": "value", " low": "low", " high": "high"}
    yield ["point", *paths, "state", "verdict", "sentence", *(name + end for name in names for end in ends)]
    for row in study_rows(store):
        known = {title(found): found for found in row.answer.numbers}
        values = [getattr(known.get(name), end, "") for name in names for end in ends.values()]
        stated = [row.parameters.get(path, "") for path in paths]
        yield [row.position, *stated, row.answer.state, row.answer.verdict or "", row.answer.sentence, *values]


def title(found: VariantNumber) -> str:
    """Return what a number is called among all of a study.

    Parameters
    ----------
    found : VariantNumber

    Returns
    -------
    str
        Such as ``safety factor of AE, flight``, with its unit.
    """
    where = f", {found.load_case}" if found.load_case else ""
    check = f" ({found.check})" if found.check else ""
    return f"{found.quantity} of {found.subject}{where}{check} [{found.unit}]"


def shown_unit(found: VariantNumber | ToleranceNumber) -> str:
    """Return the unit of a number, "" of a pure number.

    Parameters
    ----------
    found : VariantNumber or ToleranceNumber

    Returns
    -------
    str
    """
    return "" if found.unit == "1" else found.unit


def checked(found: VariantNumber) -> dict[str, Any]:
    """Return what a check looks at (``what``), its ``value`` with the band, and its ``limit``, as they are told.

    Parameters
    ----------
    found : VariantNumber
        Of a check.

    Returns
    -------
    dict
        A text and two numbers.
    """
    unit = shown_unit(found)
    value = found.band
    return {
        "what": f"{found.quantity} of {found.subject}",
        "value": Number(value, unit, digits_beside(value, found.limit)),
        "limit": Number(found.limit, unit, stated=True, sense=sense_of(found).value),
    }


def number_text(found: VariantNumber) -> str:
    """Return a checked number with its band and its limit.

    Parameters
    ----------
    found : VariantNumber
        Of a check.

    Returns
    -------
    str
        Such as ``safety factor of AE 2.1 (1.9 to 2.3) (≥ 1.5)``.
    """
    return "{what} {value} ({limit})".format(**checked(found))
