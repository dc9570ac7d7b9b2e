"""A study as columns: what varies, and what became of every point, as arrays that pictures are drawn from."""

from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import Quantity
from alula.fea.study.margin import least_margin, nearest
from alula.fea.study.numbers import VariantNumber
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import number_of
from alula.loads.sources.quantity import unit_of
from alula.reports.study.rows import Chosen, Row, study_rows, title

Real = NDArray[np.float64]
MOST_NUMBERS = 3
"""Numbers that are drawn of a study without checks, unless some are asked for."""
MOST_ROWS = 40
"""Points in the table of the page; of more, ``MOST_OF_A_KIND`` best, undecided and worst ones each."""
MOST_OF_A_KIND = 13


@dataclass(frozen=True, kw_only=True, eq=False)
class Parameter:
    """An entry that varies.

    Attributes
    ----------
    path : str
        As for ``--set``.
    unit : str
        "" for pure numbers and for words.
    values : ndarray, shape (n,)
        In that unit; for words their numbers in ``words``.
    words : tuple of str
        The values of an entry that is no quantity; empty for a quantity.
    """

    path: str
    unit: str
    values: Real
    words: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """The entry with its unit, as on an axis."""
        return f"{self.path} [{self.unit}]" if self.unit else self.path


@dataclass(frozen=True, kw_only=True, eq=False)
class Response:
    """A number of every point, with its band.

    Attributes
    ----------
    label : str
        What it is, with its unit, as on an axis.
    value, low, high : ndarray, shape (n,)
        NaN where a point has no such number.
    limit : float
        NaN without.
    """

    label: str
    value: Real
    low: Real
    high: Real
    limit: float = np.nan


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyColumns:
    """The points of a study that have a result.

    Attributes
    ----------
    facts : mapping
        Of the store: plan, versions, number of points.
    counts : mapping of str to int
        Points by verdict, or by state where there is none.
    outcome : ndarray of str, shape (n,)
        Verdict or state.
    position : ndarray of int, shape (n,)
        Of the point in its plan, from 0.
    parameters : tuple of Parameter
        What varies, without what is linked.
    margin : Response or None
        The least margin of all checks; None where nothing is checked.
    numbers : tuple of Response
        Those that were asked for; without checks, the first that vary.
    left_out : int
        Numbers that vary and are not drawn, where nothing is checked.
    safety_factor : Response or None
        The least of all links and load cases.
    mass : ndarray, shape (n,), or None
        Of all links [g]; None where no point was weighed.
    limiting : mapping
        What is nearest to its limit -> in how many points.
    sentences : mapping
        Why points were refused or crashed -> how many.
    rows : tuple of Row
        Of the table: all points, or the best, the first undecided and the worst; the first where nothing is checked.
    extremes : mapping of str to Row
        ``best`` and ``worst`` by verdict and margin; empty where nothing is checked, or none is better than another.
    """

    facts: Mapping[str, Any]
    counts: Mapping[str, int]
    outcome: NDArray[np.str_]
    position: NDArray[np.int64]
    parameters: tuple[Parameter, ...]
    margin: Response | None
    numbers: tuple[Response, ...]
    left_out: int
    safety_factor: Response | None
    mass: Real | None
    limiting: Mapping[str, int]
    sentences: Mapping[tuple[str, str], int]
    rows: tuple[Row, ...]
    extremes: Mapping[str, Row]

    @property
    def responses(self) -> tuple[Response, ...]:
        """What pictures show over the parameters: the least margin first."""
        return (*(() if self.margin is None else (self.margin,)), *self.numbers)


class _Columns:
    """Gathers numbers of one kind, point by point."""

    def __init__(self) -> None:
        self.found: dict[str, array[float]] = {}

    def add(self, name: str, point: int, ends: tuple[float, float, float]) -> None:
        """Keep value, low and high of a point."""
        self.found.setdefault(name, array("d")).extend((point, *ends))

    def response(self, name: str, count: int, limit: float = np.nan) -> Response | None:
        """Return the column of a name; None where no point has it."""
        if name not in self.found:
            return None
        ends, known = np.full((3, count), np.nan), np.frombuffer(self.found[name]).reshape(-1, 4)
        ends[:, known[:, 0].astype(np.intp)] = known[:, 1:].T
        return Response(label=name.removesuffix(" [1]"), value=ends[0], low=ends[1], high=ends[2], limit=limit)


MARGIN = "least margin (1 at the limit)"
SAFETY_FACTOR = "least safety factor"


def read_study(store: Store, wanted: Sequence[str] = ()) -> StudyColumns:
    """Read a study for its pictures.

    Parameters
    ----------
    store : Store
    wanted : sequence of str, optional
        Parts of the names of numbers to be drawn.

    Returns
    -------
    StudyColumns

    Raises
    ------
    CaseError
        For a study without points, and a number that no point has.
    """
    numbers, ours, gathered = _Columns(), _Columns(), _Gathered()
    for row in study_rows(store):
        gathered.add(row)
        _add(row, gathered.count - 1, numbers, ours)
    if not gathered.count:
        raise CaseError("study: no point of it has a result yet; go on with 'alula study', then draw it")
    facts, count = store.facts(), gathered.count
    margin = ours.response(MARGIN, count, 1.0)
    limits = gathered.limits
    shown, left_out = _chosen(numbers, count, wanted, checked=margin is not None)
    mass = ours.response("mass", count)
    return StudyColumns(
        facts=facts,
        counts=store.counts(),
        outcome=np.array(gathered.outcomes),
        position=np.array(gathered.positions),
        parameters=_parameters(gathered.stated, set(facts["plan"]["link"])),
        margin=margin,
        numbers=shown,
        left_out=left_out,
        safety_factor=ours.response(SAFETY_FACTOR, count, limits.pop() if len(limits) == 1 else np.nan),
        mass=None if mass is None else mass.value,
        limiting=dict(gathered.limiting.most_common()),
        sentences=dict(gathered.sentences.most_common()),
        rows=gathered.table,
        extremes=gathered.extremes,
    )


class _Gathered:
    """What is kept of the points besides their numbers."""

    def __init__(self) -> None:
        self.outcomes: list[str] = []
        self.positions: list[int] = []
        self.stated: list[Mapping[str, object]] = []
        self.chosen = Chosen(MOST_OF_A_KIND)
        self.rows: list[Row] = []
        self.limits: set[float] = set()
        self.limiting: Counter[str] = Counter()
        self.sentences: Counter[tuple[str, str]] = Counter()

    @property
    def count(self) -> int:
        """How many points there are so far."""
        return len(self.outcomes)

    @property
    def extremes(self) -> dict[str, Row]:
        """The best and the worst point."""
        return self.chosen.ends

    @property
    def table(self) -> tuple[Row, ...]:
        """The points of the page's table."""
        if self.count <= MOST_ROWS or not self.chosen.best:
            return tuple(self.rows)
        kinds = (self.chosen.best, self.chosen.open, self.chosen.worst[::-1])
        return tuple({row.position: row for rows in kinds for row in rows}.values())

    def add(self, row: Row) -> None:
        """Keep a point."""
        self.chosen.add(row)
        self.outcomes.append(row.outcome)
        self.positions.append(row.position)
        self.stated.append(row.parameters)
        if len(self.rows) < MOST_ROWS:
            self.rows.append(row)
        if row.answer.sentence:
            self.sentences[row.outcome, row.answer.sentence] += 1
        if (found := row.nearest) is None or row.answer.verdict is None:
            return
        self.limiting[f"{found.quantity} of {found.subject}"] += 1
        self.limits |= {one.limit for one in row.answer.numbers if one.quantity == Quantity.SAFETY_FACTOR.value}


def _add(row: Row, point: int, numbers: _Columns, ours: _Columns) -> None:
    """Gather the numbers of a point."""
    if nearest(row.answer) is not None:
        ours.add(MARGIN, point, least_margin(row.answer))
    factors = [one for one in row.answer.numbers if one.check and one.quantity == Quantity.SAFETY_FACTOR.value]
    if factors:
        ours.add(SAFETY_FACTOR, point, _least(factors))
    if row.mass is not None:
        ours.add("mass", point, (row.mass,) * 3)
    for one in row.answer.numbers:
        numbers.add(title(one), point, (one.value, one.low, one.high))


def _least(found: Sequence[VariantNumber]) -> tuple[float, float, float]:
    """Value, low and high of the least of several numbers; one that is not known may be anything from 0."""
    ends = np.array([(one.value, one.low, one.high) for one in found])
    known = ~np.isnan(ends).any(axis=1)
    if not known.any():
        return (np.nan, 0.0, np.inf)
    value, low, high = ends[known].min(axis=0)
    return float(value), float(low) if known.all() else 0.0, float(high)


def _chosen(numbers: _Columns, count: int, wanted: Sequence[str], *, checked: bool) -> tuple[tuple[Response, ...], int]:
    """Return the numbers to be drawn, and how many more there are."""
    columns = (numbers.response(name, count) for name in numbers.found)
    varying = [column for column in columns if column is not None and _varies(column.value)]
    if wanted:
        found = [column for column in varying if any(text.lower() in column.label.lower() for text in wanted)]
        for text in wanted:
            if not any(text.lower() in column.label.lower() for column in found):
                names = "; ".join(dict.fromkeys(column.label.partition(" of ")[0] for column in varying))
                raise CaseError(f"--number '{text}': no number of that name varies in this study; there are: {names}")
        return tuple(found), 0
    if checked:
        return (), 0
    return tuple(varying[:MOST_NUMBERS]), max(len(varying) - MOST_NUMBERS, 0)


def _varies(values: Real) -> bool:
    known = values[np.isfinite(values)]
    return known.size > 1 and bool(np.ptp(known) > 1e-9 * np.abs(known).max())


def _parameters(stated: Sequence[Mapping[str, object]], linked: Iterable[str]) -> tuple[Parameter, ...]:
    paths = dict.fromkeys(path for point in stated for path in point)
    found = (_parameter(path, [point.get(path) for point in stated]) for path in paths if path not in linked)
    return tuple(one for one in found if np.unique(one.values).size > 1)


def _parameter(path: str, stated: Sequence[object]) -> Parameter:
    """Return an entry's values as quantities of one unit, or else as words."""
    split = [number_of(value) for value in stated]
    known = [one for one in split if one is not None]
    units = list(dict.fromkeys(unit for _, unit in known))
    if len(known) == len(split) and len({_dimensions(unit) for unit in units}) == 1:
        sizes = {unit: _size(unit) / _size(units[0]) for unit in units}
        return Parameter(path=path, unit=units[0], values=np.array([number * sizes[unit] for number, unit in known]))
    texts = ["not stated" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
             for value in stated]  # fmt: skip
    words = tuple(dict.fromkeys(texts))
    places = {word: i for i, word in enumerate(words)}
    return Parameter(path=path, unit="", values=np.array([float(places[t]) for t in texts]), words=words)


def _dimensions(unit: str) -> object:
    try:
        return unit_of(unit)[1]
    except CaseError:
        return unit


def _size(unit: str) -> float:
    try:
        return unit_of(unit)[0]
    except CaseError:
        return 1.0
