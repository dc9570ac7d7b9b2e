"""The least size that passes and the greatest that fails, each over its whole band; what lies between is open.

Hand calculation of at most 33 steps says where to look. The model that decides goes from there to both sides, in
strides that double, until one value passes and one fails, and halves what lies between. Where margins shrink with
growing values, the greatest value that passes is sought. Where hand calculation crosses the limit more than once, the
model decides a step of each stretch: a value that fails beyond one that passes is told.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from alula.fea.common.verdict import Verdict
from alula.fea.sizing.search import Search
from alula.fea.study.margin import counterpart, margin, nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.geometry.base.errors import CaseError
from alula.loads.text.caveat import Caveat

SCANNED = 33
"""Steps at most that are calculated by hand before any solid."""


@dataclass(frozen=True, kw_only=True)
class Sized:
    """What a search for a size found.

    Attributes
    ----------
    path : str
        The entry.
    values : tuple
        All steps, as a case file states them.
    results : mapping of int to VariantResult
        By number of the step: those that were decided.
    rising : bool
        True where larger values pass, False where smaller ones do.
    passing, failing : int or None
        Steps: the first that passes, and the last before it that fails; None where there is none.
    turns : tuple of int
        Steps that fail beyond one that passes.
    caveats : tuple of Caveat
        What a verdict of the case stands on that no check judges.
    """

    path: str
    values: tuple[object, ...]
    results: Mapping[int, VariantResult]
    rising: bool
    passing: int | None
    failing: int | None
    turns: tuple[int, ...]
    caveats: tuple[Caveat, ...]

    @property
    def opened(self) -> tuple[int, ...]:
        """Steps that were tried and are undecided."""
        tried = sorted(self.results.items())
        return tuple(step for step, result in tried if result.verdict is Verdict.UNDECIDED)

    def limit(self, step: int) -> VariantNumber | None:
        """Return what limits a step.

        Parameters
        ----------
        step : int

        Returns
        -------
        VariantNumber or None
            The check that is nearest to its limit.
        """
        return nearest(self.results[step]) if step in self.results else None

    def gain(self, step: int) -> float | None:
        """Return by what share one more step raises what limits a step.

        Parameters
        ----------
        step : int
            Of a result.

        Returns
        -------
        float or None
            From the nearest solved step on its passing side, a share a step; None where there is none.
        """
        limit, sense = self.limit(step), 1 if self.rising else -1
        others = [other for other in self.results if (other - step) * sense > 0 and self._same(other, limit)]
        if limit is None or not others:
            return None
        other = min(others, key=lambda other: abs(other - step))
        there = self._same(other, limit)
        assert there is not None
        before, after = margin(limit, worst=False), margin(there, worst=False)
        if not (0.0 < before < math.inf and 0.0 < after < math.inf):
            return None
        return float((after / before) ** (1.0 / abs(other - step))) - 1.0

    def _same(self, step: int, limit: VariantNumber | None) -> VariantNumber | None:
        """The same check at another step."""
        return None if limit is None else counterpart(self.results[step], limit)


def least_size(search: Search, path: str, values: Sequence[object], *, caveats: tuple[Caveat, ...] = ()) -> Sized:
    """Find the value nearest to failing that passes over its whole band.

    Parameters
    ----------
    search : Search
        That varies this one entry.
    path : str
        The entry.
    values : sequence
        Its steps, ascending, as a case file states them.
    caveats : tuple of Caveat, optional
        Of the case; handed on.

    Returns
    -------
    Sized

    Raises
    ------
    CaseError
        Where the case's own rules refuse every value, or no check decides any.
    """
    steps = _Steps(search, path, tuple(values))
    margins = _margins_by_hand(steps)
    rising = margins[max(margins)] >= margins[min(margins)]
    order = range(len(values)) if rising else range(len(values) - 1, -1, -1)
    _bracket(steps, order, order.index(min(margins, key=lambda step: abs(margins[step]))), _stretches(margins))
    results = steps.decided
    passing = [step for step in order if steps.verdict(step) is Verdict.PASS]
    failing = [step for step in order if steps.verdict(step) is Verdict.FAIL]
    best = passing[0] if passing else None
    beyond = [] if best is None else [step for step in failing if order.index(step) > order.index(best)]
    before = [step for step in failing if step not in beyond]
    return Sized(
        path=path,
        values=steps.values,
        results=results,
        rising=rising,
        passing=best,
        failing=before[-1] if before else None,
        turns=tuple(sorted(beyond)),
        caveats=caveats,
    )


class _Steps:
    """The values of an entry with what was decided of them."""

    def __init__(self, search: Search, path: str, values: tuple[object, ...]) -> None:
        self._search, self._path, self.values, self.workers = search, path, values, search.workers
        self.decided: dict[int, VariantResult] = {}

    def by_hand(self, steps: Sequence[int]) -> list[VariantResult]:
        found = self._search.at([{self._path: self.values[step]} for step in steps], "beam")
        if self._search.fidelity in ("beam", "frame"):
            self.decided.update(zip(steps, found, strict=True))
        return found

    def decide(self, steps: Sequence[int]) -> None:
        new = [step for step in dict.fromkeys(steps) if step not in self.decided]
        found = self._search.at([{self._path: self.values[step]} for step in new]) if new else []
        self.decided.update(zip(new, found, strict=True))

    def verdict(self, step: int) -> Verdict | None:
        """The verdict of a step; None where it was refused or crashed, or not decided."""
        result = self.decided.get(step)
        return result.verdict if result is not None and result.state == "done" else None


def _margins_by_hand(steps: _Steps) -> dict[int, float]:
    """Return step -> logarithm of the margin by hand calculation, which is 0 at the limit."""
    last = len(steps.values) - 1
    count = min(SCANNED, last + 1)
    tried = sorted({round(i * last / max(count - 1, 1)) for i in range(count)})
    results = dict(zip(tried, steps.by_hand(tried), strict=True))
    known = {step: result for step, result in results.items() if result.state == "done"}
    if not known:
        ends, sentence = f"{steps.values[0]} to {steps.values[-1]}", next(iter(results.values())).sentence
        raise CaseError(f"size: no value from {ends} makes a case; the first: {sentence}")
    return {step: _log_margin(result) for step, result in known.items()}


def _stretches(margins: Mapping[int, float]) -> list[int]:
    """Return the middle of each stretch of steps that hand calculation has on one side of the limit."""
    runs = [[step for step, _ in run] for _, run in groupby(margins.items(), key=lambda item: item[1] >= 0.0)]
    return [run[len(run) // 2] for run in runs]


def _bracket(steps: _Steps, order: Sequence[int], guess: int, stretches: Sequence[int]) -> None:
    """Decide steps until what fails, what is open and what passes are next to each other.

    `order` has the steps from the failing side to the passing one, `guess` counts in it. The search goes from the guess
    in strides that double, and then splits what is left into as many pieces as there are workers, and one more.
    """
    steps.decide([order[guess], order[min(guess + 1, len(order) - 1)]])
    looked = len(stretches) < 3
    while True:
        wanted = _next(steps, order, guess, lambda verdict: verdict is Verdict.PASS)
        wanted += _next(steps, order, guess, lambda verdict: verdict not in (Verdict.FAIL, None))
        if not wanted and not looked:
            wanted, looked = list(stretches), True
        if not wanted:
            return
        steps.decide(wanted)


def _next(steps: _Steps, order: Sequence[int], guess: int, holds: "Callable[[Verdict | None], bool]") -> list[int]:
    """Return the steps to decide next in search of the first that holds; none once the one before it does not hold."""
    told = {place: holds(steps.verdict(step)) for place, step in enumerate(order) if step in steps.decided}
    first = min((place for place, held in told.items() if held), default=len(order))
    last = max((place for place, held in told.items() if not held and place < first), default=-1)
    if first == len(order):
        places = [min(last + max(last - guess, 1), len(order) - 1)]
        if places[0] in told:  # the far end is no case, though some before it may be one that passes
            failed = max((place for place in told if steps.verdict(order[place]) is not None), default=-1)
            places = _between(steps, failed, min((place for place in told if place > failed), default=failed))
    elif last == -1:
        places = [max(first - max(guess - first, 1), 0)]
    else:
        places = _between(steps, last, first)
    return [order[place] for place in places if place not in told]


def _between(steps: _Steps, last: int, first: int) -> list[int]:
    """Return where to split what lies between two places, into one piece more than there are workers."""
    pieces = min(steps.workers + 1, first - last)
    return [last + (first - last) * i // pieces for i in range(1, pieces)]


def _log_margin(result: VariantResult) -> float:
    """Logarithm of the least margin that is known; what only a solid tells, such as notches, says nothing of where."""
    known = [margin(n, worst=False) for n in result.numbers if n.verdict is not None and not math.isnan(n.value)]
    return math.log(min(max(min(known, default=0.0), 1e-9), 1e9))
