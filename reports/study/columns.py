"""A study as columns: what varies, and what became of every point, as arrays that pictures are drawn from."""

from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import Verdict
from alula.fea.study.margin import least_margin
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import number_of
from alula.loads.sources.quantity import unit_of
from alula.reports.figures.study.points import Parameter, Real, Response
from alula.reports.study.rows import Row, study_rows, title

MOST_NUMBERS = 3
"""Numbers that are drawn of a study without checks, unless some are asked for."""
MOST_ROWS = 40
"""Points in the table; of more, a third each of the best, the first undecided and the worst."""
MARGIN = "least margin (1 at the limit)"
_Kept = dict[str, "array[float]"]
"""Name of a number -> place of a point, value, low and high, one point after another."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StudyColumns:
    """The points of a study that have a result.

    Attributes
    ----------
    facts : mapping
        Of the store: plan, versions, number of points.
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
    mass : ndarray, shape (n,), or None
        Of all links [g]; None where no point was weighed.
    limiting : mapping
        What is nearest to its limit -> in how many points.
    sentences : mapping
        State and why points have it -> their positions.
    undecided : tuple of int
        Positions.
    rows : tuple of Row
        Of the table: all points, or the best, the first undecided and the worst; the first where nothing is checked.
    extremes : mapping of str to Row
        ``best`` and ``worst`` by verdict and margin; empty where nothing is checked, or none is better than another.
    """

    facts: Mapping[str, Any]
    outcome: NDArray[np.str_]
    position: NDArray[np.int64]
    parameters: tuple[Parameter, ...]
    margin: Response | None
    numbers: tuple[Response, ...]
    left_out: int
    mass: Real | None
    limiting: Mapping[str, int]
    sentences: Mapping[tuple[str, str], Sequence[int]]
    undecided: tuple[int, ...]
    rows: tuple[Row, ...]
    extremes: Mapping[str, Row]

    @property
    def responses(self) -> tuple[Response, ...]:
        """What pictures show over the parameters: the least margin first."""
        return (*(() if self.margin is None else (self.margin,)), *self.numbers)


def read_study(store: Store, wanted: Sequence[str] = (), most: int = MOST_ROWS) -> StudyColumns:
    """Read a study, point by point.

    Parameters
    ----------
    store : Store
    wanted : sequence of str, optional
        Parts of the names of numbers to be told and drawn.
    most : int, optional
        Points that the table shows.

    Returns
    -------
    StudyColumns

    Raises
    ------
    CaseError
        For a number that no point has.
    """
    facts = store.facts()
    outcome, position, stated, merits = list[str](), list[int](), list[Mapping[str, object]](), list[Any]()
    numbers: _Kept = {}
    ours: _Kept = {}
    limiting, sentences = Counter[str](), dict[tuple[str, str], list[int]]()
    for point, row in enumerate(study_rows(store)):
        outcome.append(row.outcome)
        position.append(row.position)
        stated.append(row.parameters)
        merits.append(row.merit)
        if row.answer.sentence:
            sentences.setdefault((row.outcome, row.answer.sentence), []).append(row.position)
        for one in row.answer.numbers:
            _add(numbers, title(one), point, (one.value, one.low, one.high))
        if row.mass is not None:
            _add(ours, "mass", point, (row.mass,) * 3)
        if row.nearest is None or row.merit is None:
            continue
        limiting[f"{row.nearest.quantity} of {row.nearest.subject}"] += 1
        _add(ours, MARGIN, point, least_margin(row.answer))
    count = len(outcome)
    margin, mass = _response(ours, MARGIN, count, 1.0), _response(ours, "mass", count)
    shown, left_out = _chosen(numbers, count, wanted, checked=margin is not None)
    known = [i for i, merit in enumerate(merits) if merit is not None]
    worst = sorted(known, key=merits.__getitem__)  # of equal ones, the first
    best = sorted(known, key=lambda i: tuple(-one for one in merits[i]))
    undecided = [i for i in known if outcome[i] == Verdict.UNDECIDED.value]
    places = list(range(min(count, most)))
    if count > most and known:
        part = max(most // 3, 1)
        places = list(dict.fromkeys((*best[:part], *undecided[:part], *worst[:part][::-1])))
    differ = bool(known) and merits[best[0]] != merits[worst[0]]
    ends = {"best": best[0], "worst": worst[0]} if differ else {}
    rows = {row.position: row for row in study_rows(store, [position[i] for i in (*places, *ends.values())])}
    return StudyColumns(
        facts=facts,
        outcome=np.array(outcome),
        position=np.array(position),
        parameters=_parameters(stated, set(facts["plan"]["link"])),
        margin=margin,
        numbers=shown,
        left_out=left_out,
        mass=None if mass is None else mass.value,
        limiting=dict(limiting.most_common()),
        sentences=dict(sorted(sentences.items(), key=lambda item: -len(item[1]))),
        undecided=tuple(position[i] for i in undecided),
        rows=tuple(rows[position[i]] for i in places),
        extremes={which: rows[position[i]] for which, i in ends.items()},
    )


def _add(kept: _Kept, name: str, point: int, ends: tuple[float, float, float]) -> None:
    """Keep value, low and high of a point."""
    kept.setdefault(name, array("d")).extend((point, *ends))


def _response(kept: _Kept, name: str, count: int, limit: float = np.nan) -> Response | None:
    """Return the numbers of a name for all points; None where no point has it."""
    if name not in kept:
        return None
    ends, known = np.full((3, count), np.nan), np.frombuffer(kept[name]).reshape(-1, 4)
    ends[:, known[:, 0].astype(np.intp)] = known[:, 1:].T
    return Response(label=name.removesuffix(" [1]"), value=ends[0], low=ends[1], high=ends[2], limit=limit)


def _chosen(numbers: _Kept, count: int, wanted: Sequence[str], *, checked: bool) -> tuple[tuple[Response, ...], int]:
    """Return the numbers to be drawn, and how many more there are."""
    columns = (_response(numbers, name, count) for name in numbers)
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
    units = {unit: _unit(unit) for _, unit in known}
    if len(known) == len(split) and len({dimensions for _, dimensions in units.values()}) == 1:
        first = known[0][1]
        values = [number * (units[unit][0] / units[first][0]) for number, unit in known]
        return Parameter(path=path, unit=first, values=np.array(values))
    texts = ["not stated" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
             for value in stated]  # fmt: skip
    words = tuple(dict.fromkeys(texts))
    places = {word: i for i, word in enumerate(words)}
    return Parameter(path=path, unit="", values=np.array([float(places[t]) for t in texts]), words=words)


def _unit(unit: str) -> tuple[float, object]:
    """Return size and dimensions of a unit; one that nobody knows is of a kind of its own."""
    try:
        return unit_of(unit)
    except CaseError:
        return 1.0, unit
