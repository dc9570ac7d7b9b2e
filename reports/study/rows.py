"""The points of a study as tables: for the terminal, for CSV and as plain data."""

from bisect import insort
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from alula.fea.common.band import Band
from alula.fea.common.verdict import Verdict
from alula.fea.study.margin import margin, nearest, sense_of
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import Store
from alula.geometry.base.version import result_stamp
from alula.reports.tables.data import finite
from alula.reports.words.numbers import band, number
from alula.reports.words.terminal import say, say_table

if TYPE_CHECKING:
    from rich.console import Console


ALIKE = "No point is best or worst: each is open by a check that is not known, or whose band leaves no margin."


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
    def merit(self) -> tuple[int, float]:
        """What the best point has most of: the verdict, then the margin."""
        return (Verdict.FAIL, Verdict.UNDECIDED, Verdict.PASS).index(self.answer.verdict or Verdict.FAIL), self.margin

    @property
    def mass(self) -> float | None:
        """Of all links [g]; None where they were not weighed."""
        found = [f.value for f in self.answer.numbers if f.quantity == "mass" and f.subject == "the linkage"]
        return found[0] if found else None

    @property
    def outcome(self) -> str:
        """The verdict, or the state where there is none."""
        return str(self.answer.verdict or self.answer.state)


def study_rows(store: Store) -> Iterator[Row]:
    """Yield the points of a study in order.

    Parameters
    ----------
    store : Store

    Yields
    ------
    Row
    """
    for position, parameters, answer, attempts in store.rows():
        yield Row(position=position, parameters=parameters, answer=answer, attempts=attempts)


def as_record(store: Store) -> dict[str, Any]:
    """Return a study as plain data.

    Parameters
    ----------
    store : Store

    Returns
    -------
    dict
        Numbers that are not known are None.
    """
    facts = store.facts()
    points = [
        {
            "position": row.position,
            "parameters": dict(row.parameters),
            "state": row.answer.state,
            "verdict": row.answer.verdict,
            "sentence": row.answer.sentence,
            "attempts": row.attempts,
            "seconds": row.answer.seconds,
            "numbers": [found.__dict__ for found in row.answer.numbers],
        }
        for row in study_rows(store)
    ]
    return dict(finite({**result_stamp(), **facts, "counts": store.counts(), "results": points}, {}))


def columns(store: Store) -> Iterator[Sequence[object]]:
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
    ends = ("", " low", " high")
    yield ["point", *paths, "state", "verdict", "sentence", *(name + end for name in names for end in ends)]
    for row in study_rows(store):
        known = {title(found): found for found in row.answer.numbers}
        values = [
            ("" if name not in known else getattr(known[name], end.strip() or "value"))
            for name in names
            for end in ends
        ]
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


def print_study(store: Store, console: "Console", most: int) -> None:
    """Print a study: its counts, the best, the worst and the undecided points, and the table.

    Parameters
    ----------
    store : Store
    console : rich.console.Console
    most : int
        Rows of the table.
    """
    facts, chosen, shown, count, weighed = store.facts(), Chosen(), list[Row](), 0, False
    paths: dict[str, None] = {}
    for row in study_rows(store):
        count += 1
        chosen.add(row)
        weighed = weighed or row.mass is not None
        paths |= dict.fromkeys(row.parameters)
        if len(shown) < most:
            shown.append(row)
    told = ", ".join(f"{number} {name}" for name, number in sorted(store.counts().items()))
    what, total = f"{facts['plan']['case']} ({facts['plan']['analysis']})", facts["points"]
    say(console, f"Study of {what}: {count} of {total} points; {told or 'none yet'}.")
    for which, row in chosen.ends.items():
        stated = ", ".join(f"{path} = {value}" for path, value in row.parameters.items())
        say(console, f"{which.capitalize()}: point {row.position} ({stated}): {row.outcome}, {nearest_text(row)}.")
    if len(chosen.undecided) > 1 and not chosen.ends:
        say(console, ALIKE)
    if chosen.undecided:
        say(console, f"Undecided: {_numbers(chosen.undecided)}.")
    heads = [("point", True), *((path, False) for path in paths), ("verdict", False), ("nearest to its limit", False)]
    cells = [_cells(row, list(paths)) for row in shown]
    if weighed:
        heads.append(("mass\n[g]", True))
        cells = [[*line, "" if r.mass is None else number(r.mass, 4)] for line, r in zip(cells, shown, strict=True)]
    say_table(console, heads, cells)
    if count > most:
        say(console, f"{count - most} more points: --most {count}, or all numbers with --csv FILE.")


class Chosen:
    """The best and the worst of the points that have a verdict and a margin, and which of them are undecided.

    Parameters
    ----------
    most : int
        Points of each kind that are kept.

    Attributes
    ----------
    undecided : list of int
        Positions of all.
    open : list of Row
        The first undecided.
    """

    def __init__(self, most: int = 1) -> None:
        self._most = most
        self._best: list[tuple[int, float, int, Row]] = []
        self._worst: list[tuple[int, float, int, Row]] = []
        self.undecided: list[int] = []
        self.open: list[Row] = []

    @property
    def best(self) -> list[Row]:
        """The best points, the best first; of equal ones, the first."""
        return [row for *_, row in self._best]

    @property
    def worst(self) -> list[Row]:
        """The worst points, the worst first; of equal ones, the first."""
        return [row for *_, row in self._worst]

    @property
    def ends(self) -> dict[str, Row]:
        """The best and the worst point; empty where no point is better than another."""
        if not self._best or self.best[0].merit == self.worst[0].merit:
            return {}
        return {"best": self.best[0], "worst": self.worst[0]}

    def add(self, row: Row) -> None:
        """Take a point into account.

        Parameters
        ----------
        row : Row
        """
        if row.answer.verdict is None or row.nearest is None:
            return
        verdict, margin = row.merit
        for kept, sign in ((self._best, -1), (self._worst, 1)):
            place = sign * verdict, sign * margin, row.position
            if len(kept) < self._most or place < kept[-1][:3]:
                insort(kept, (*place, row), key=lambda one: one[:3])
                del kept[self._most :]
        if row.answer.verdict is Verdict.UNDECIDED:
            self.undecided.append(row.position)
            if len(self.open) < self._most:
                self.open.append(row)


def _numbers(positions: Sequence[int]) -> str:
    shown = ", ".join(map(str, positions[:20]))
    return f"points {shown}" + (f" and {len(positions) - 20} more" if len(positions) > 20 else "")


def _cells(row: Row, paths: Sequence[str]) -> list[str]:
    return [str(row.position), *(str(row.parameters.get(path, "")) for path in paths), row.outcome, nearest_text(row)]


def nearest_text(row: Row) -> str:
    """Return the check that is nearest to its limit, with its number; the sentence of a point without one.

    Parameters
    ----------
    row : Row

    Returns
    -------
    str
    """
    found = row.nearest
    if found is None:
        return row.answer.sentence
    return number_text(found)


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
    value = Band(value=found.value, low=found.low, high=found.high)
    unit = "" if found.unit == "1" else f" {found.unit}"
    shown = band(value) if value.unknowable else f"{band(value)}{unit}"
    return f"{found.quantity} of {found.subject} {shown} ({sense_of(found).value} {found.limit:g}{unit})"
