"""The points of a study as tables: for the terminal, for CSV and as plain data."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fea.common.band import Band
from fea.common.verdict import Verdict
from fea.study.margin import margin, nearest, sense_of
from fea.study.numbers import VariantNumber, VariantResult
from fea.study.store import Store
from geometry.base.version import result_stamp
from reports.tables.data import finite
from reports.words.terminal import say, say_table
from reports.words.wording import band, number

if TYPE_CHECKING:
    from rich.console import Console


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

    @property
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
    rows, facts = list(study_rows(store)), store.facts()
    told = ", ".join(f"{count} {name}" for name, count in sorted(store.counts().items()))
    what, total = f"{facts['plan']['case']} ({facts['plan']['analysis']})", facts["points"]
    say(console, f"Study of {what}: {len(rows)} of {total} points; {told or 'none yet'}.")
    judged = [row for row in rows if row.answer.verdict is not None and row.nearest is not None]
    if judged:
        _extremes(judged, console)
    undecided = [row for row in judged if row.answer.verdict is Verdict.UNDECIDED]
    if undecided:
        say(console, f"Undecided: {_numbers(undecided)}.")
    paths = list(dict.fromkeys(path for row in rows for path in row.parameters))
    heads = [("point", True), *((path, False) for path in paths), ("verdict", False), ("nearest to its limit", False)]
    cells = [_cells(row, paths) for row in rows[:most]]
    if any(row.mass is not None for row in rows):
        heads.append(("mass\n[g]", True))
        cells = [[*line, "" if r.mass is None else number(r.mass, 4)] for line, r in zip(cells, rows, strict=False)]
    say_table(console, heads, cells)
    if len(rows) > most:
        say(console, f"{len(rows) - most} more points: --most {len(rows)}, or all numbers with --csv FILE.")


def _extremes(judged: Sequence[Row], console: "Console") -> None:
    best, worst = max(judged, key=lambda row: row.merit), min(judged, key=lambda row: row.merit)
    for which, row in (("Best", best), ("Worst", worst)):
        stated = ", ".join(f"{path} = {value}" for path, value in row.parameters.items())
        say(console, f"{which}: point {row.position} ({stated}): {row.outcome}, {nearest_text(row)}.")


def _numbers(rows: Sequence[Row]) -> str:
    shown = ", ".join(str(row.position) for row in rows[:20])
    return f"points {shown}" + (f" and {len(rows) - 20} more" if len(rows) > 20 else "")


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
    sign = sense_of(found).value
    return f"{found.quantity} of {found.subject} {band(value)}{unit} ({sign} {found.limit:g})"
