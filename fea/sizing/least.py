"""The least size that passes and the greatest that fails, each over its whole band; what lies between is open.

Hand calculation of all steps says where to look. The model that decides goes from there to both sides, in strides that
double, until one value passes and one fails, and halves what lies between. Where margins shrink with growing values,
the greatest value that passes is sought. Where hand calculation crosses the limit more than once, the model decides a
step of each stretch: a value that fails beyond one that passes is told.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from fea.common.verdict import Verdict
from fea.sizing.search import Search
from fea.study.margin import margin, nearest
from fea.study.numbers import VariantNumber, VariantResult
from geometry.base.errors import CaseError

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
    """

    path: str
    values: tuple[object, ...]
    results: Mapping[int, VariantResult]
    rising: bool
    passing: int | None
    failing: int | None
    turns: tuple[int, ...]

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
        if limit is None:
            return None
        named = (limit.check, limit.subject, limit.load_case, limit.quantity)
        found = self.results[step].numbers
        return next((n for n in found if (n.check, n.subject, n.load_case, n.quantity) == named), None)


def least_size(search: Search, path: str, values: Sequence[object]) -> Sized:
    """Find the value nearest to failing that passes over its whole band.

    Parameters
    ----------
    search : Search
        That varies this one entry.
    path : str
        The entry.
    values : sequence
        Its steps, ascending, as a case file states them.

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
    boundary = _Boundary(steps, rising)
    boundary.bracket(min(margins, key=lambda step: abs(margins[step])))
    boundary.look_at(_stretches(margins))
    results = steps.decided
    found = {step: result.verdict for step, result in results.items() if result.state == "done"}
    passing = [step for step, verdict in found.items() if verdict is Verdict.PASS]
    failing = [step for step, verdict in found.items() if verdict is Verdict.FAIL]
    best = _extreme(passing, least=rising)
    beyond = [] if best is None else [step for step in failing if (step > best) == rising]
    below = [step for step in failing if step not in beyond]
    return Sized(
        path=path,
        values=steps.values,
        results=results,
        rising=rising,
        passing=best,
        failing=_extreme(below, least=not rising),
        turns=tuple(sorted(beyond)),
    )


def _extreme(steps: Sequence[int], *, least: bool) -> int | None:
    return (min if least else max)(steps, default=None)


class _Steps:
    """The values of an entry with what was decided of them."""

    def __init__(self, search: Search, path: str, values: tuple[object, ...]) -> None:
        self._search, self._path, self.values = search, path, values
        self.decided: dict[int, VariantResult] = {}

    def by_hand(self, steps: Sequence[int]) -> list[VariantResult]:
        found = self._search.at([{self._path: self.values[step]} for step in steps], "beam")
        if self._search.fidelity in ("beam", "frame"):
            self.decided.update(zip(steps, found, strict=True))
        return found

    def decide(self, steps: Sequence[int]) -> None:
        new = [step for step in dict.fromkeys(steps) if step not in self.decided]
        found = self._search.at([{self._path: self.values[step]} for step in new])
        self.decided.update(zip(new, found, strict=True))

    def verdict(self, step: int) -> Verdict | None:
        """The verdict of a decided step; None where it was refused or crashed."""
        result = self.decided[step]
        return result.verdict if result.state == "done" else None


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


def _log_margin(result: VariantResult) -> float:
    number = nearest(result, worst=False)
    share = 0.0 if number is None else margin(number, worst=False)
    return math.log(min(max(share, 1e-9), 1e9))


class _Boundary:
    """Brackets the change of the verdict and halves the bracket."""

    def __init__(self, steps: _Steps, rising: bool) -> None:
        self._steps, self._sense, self._last = steps, 1 if rising else -1, len(steps.values) - 1

    def bracket(self, guess: int) -> None:
        """Decide steps until what fails, what is open and what passes are next to each other."""
        self._steps.decide([guess])
        passes = self._stride(guess, self._sense, lambda verdict: verdict is Verdict.PASS)
        fails = self._stride(guess, -self._sense, lambda verdict: verdict in (Verdict.FAIL, None))
        # Ends that were never reached count as just beyond the range.
        end = self._last + 1 if self._sense > 0 else -1
        start = -1 if self._sense > 0 else self._last + 1
        self._halve(start if fails is None else fails, end if passes is None else passes, Verdict.PASS)
        fails = self._nearest(Verdict.FAIL)
        opened = self._nearest_not(Verdict.FAIL, fails)
        if fails is not None and opened is not None:
            self._halve(fails, opened, None)

    def look_at(self, stretches: Sequence[int]) -> None:
        """Decide a step of each stretch where there are more than two, and where the first that passes begins."""
        if len(stretches) < 3:
            return
        self._steps.decide(stretches)
        passes = self._nearest(Verdict.PASS, first=True)
        before = [step for step in self._steps.decided if passes is not None and (passes - step) * self._sense > 0]
        other = [step for step in before if self._steps.verdict(step) is not Verdict.PASS]
        holds_not = _extreme(other, least=self._sense < 0)
        if passes is not None and holds_not is not None:
            self._halve(holds_not, passes, Verdict.PASS)

    def _stride(self, guess: int, sense: int, found: "Callable[[Verdict | None], bool]") -> int | None:
        """Go from the guess in strides that double until a verdict is found; None where the range ends before."""
        step, stride = guess, 1
        while not found(self._steps.verdict(step)):
            if step == (self._last if sense > 0 else 0):
                return None
            step = min(max(step + sense * stride, 0), self._last)
            stride *= 2
            self._steps.decide([step])
        return step

    def _halve(self, fails: int, holds: int, wanted: Verdict | None) -> None:
        """Halve between a step that does not hold and one that does: passes where that is wanted, else not fails."""
        while abs(holds - fails) > 1:
            middle = (fails + holds) // 2
            self._steps.decide([middle])
            verdict = self._steps.verdict(middle)
            keeps = verdict is Verdict.PASS if wanted is Verdict.PASS else verdict not in (Verdict.FAIL, None)
            fails, holds = (fails, middle) if keeps else (middle, holds)

    def _nearest(self, verdict: Verdict, *, first: bool = False) -> int | None:
        """The last step of a verdict, from what fails to what passes; the first one where that is wanted."""
        steps = [step for step in self._steps.decided if self._steps.verdict(step) is verdict]
        return _extreme(steps, least=(self._sense < 0) != first)

    def _nearest_not(self, verdict: Verdict, beyond: int | None) -> int | None:
        """The first decided step beyond one that has another verdict."""
        if beyond is None:
            return None
        steps = [
            s for s in self._steps.decided if (s - beyond) * self._sense > 0 and self._steps.verdict(s) is not verdict
        ]
        return _extreme(steps, least=self._sense > 0)
