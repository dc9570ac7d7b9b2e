"""The least mass, or another objective, of several entries' values, subject to all checks over their whole bands.

Hand calculation explores: all combinations where they are few, else by scipy's differential evolution. The model that
decides solves the best one that is then expected to pass; what it says corrects hand calculation, and so on, until no
combination is expected to be better than the best that passes. Then it solves what differs from that one by a single
step and would be better.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import Verdict
from alula.fea.sizing.candidates import Candidates, Objective, Place
from alula.fea.sizing.search import Search
from alula.fea.study.margin import counterpart, margin, nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import Axis
from alula.loads.text.caveat import Caveat

ENUMERATED = 200
"""Combinations up to which all are calculated by hand."""
BY_HAND = 600
"""Combinations at most that are calculated by hand otherwise, give or take the last batch."""
SOLVED = 24
"""Combinations at most that the model that decides solves unless stated otherwise."""
GENERATIONS, MEMBERS = 12, 10
"""Of differential evolution, in each round; members for each entry."""


@dataclass(frozen=True, kw_only=True)
class Gain:
    """What another value of one entry does to what limits the answer.

    Attributes
    ----------
    path : str
    value : object
    share : float
        By which the margin of the check grows.
    cost : float
        Share by which the objective grows.
    by_hand : bool
        True by hand calculation, False from the model that decides.
    """

    path: str
    value: object
    share: float
    cost: float
    by_hand: bool


@dataclass(frozen=True, kw_only=True)
class Lightest:
    """What a search over several entries found.

    Attributes
    ----------
    axes : tuple of Axis
    objective : Objective
    best : Place or None
        The best combination that passes over its whole band; None where none that was solved does.
    solved : mapping of Place to VariantResult
        By the model that decides.
    by_hand : int
        How many combinations were calculated by hand.
    complete : bool
        False where the solver's turns ran out before the search ended.
    limit : VariantNumber or None
        The check of the best one that is nearest to its limit.
    gains : tuple of Gain
        Of the best one, for each entry, the larger first.
    caveats : tuple of Caveat
        What a verdict of the case stands on that no check judges.
    """

    axes: tuple[Axis, ...]
    objective: Objective
    best: Place | None
    solved: Mapping[Place, VariantResult]
    by_hand: int
    complete: bool
    limit: VariantNumber | None
    gains: tuple[Gain, ...]
    caveats: tuple[Caveat, ...]

    def point(self, place: Place) -> dict[str, object]:
        """Return a combination.

        Parameters
        ----------
        place : Place

        Returns
        -------
        dict of str to object
            Entry -> value.
        """
        return {axis.path: axis.values[step] for axis, step in zip(self.axes, place, strict=True)}


def lightest(
    search: Search,
    axes: Sequence[Axis],
    objective: Objective,
    *,
    most: int = SOLVED,
    seed: int = 0,
    caveats: tuple[Caveat, ...] = (),
) -> Lightest:
    """Find the best combination that passes over its whole band.

    Parameters
    ----------
    search : Search
        That varies these entries.
    axes : sequence of Axis
        With their values.
    objective : Objective
    most : int
        Combinations that the model that decides may solve.
    seed : int
        Of differential evolution.
    caveats : tuple of Caveat, optional
        Of the case; handed on.

    Returns
    -------
    Lightest

    Raises
    ------
    CaseError
        Where the case's own rules refuse every combination, or none has the objective's number.
    """
    candidates = Candidates(search, axes, objective)
    hunt = _Hunt(candidates, seed)
    hunt.explore()
    _require(candidates)
    complete = True
    while (wanted := hunt.next()) is not None:
        if len(candidates.solved) >= most:
            complete = False
            break
        candidates.solve([wanted])
        hunt.explore()
    best = hunt.best
    limit = None if best is None else nearest(candidates.solved[best])
    return Lightest(
        axes=tuple(axes),
        objective=objective,
        best=best,
        solved=candidates.solved,
        by_hand=len(candidates.by_hand),
        complete=complete,
        limit=limit,
        gains=() if best is None or limit is None else _gains(candidates, best, limit),
        caveats=caveats,
    )


def _require(candidates: Candidates) -> None:
    """Refuse where nothing can be chosen."""
    results = candidates.by_hand.values()
    if not (done := [result for result in results if result.state == "done"]):
        raise CaseError(f"size: no combination of these values makes a case; the first: {next(iter(results)).sentence}")
    if not any(math.isfinite(candidates.objective.cost(result)) for result in done):
        known = ", ".join(sorted({number.quantity for result in done for number in result.numbers}))
        raise CaseError(f"size: no variant has the number '{candidates.objective.quantity}'; choose among {known}")


class _Hunt:
    """Chooses what is calculated by hand, and what is solved next."""

    def __init__(self, candidates: Candidates, seed: int) -> None:
        self._candidates, self._seed = candidates, seed
        self._sizes = [len(axis.values) for axis in candidates.axes]

    @property
    def best(self) -> Place | None:
        """The best that was solved and passes."""
        passing = [place for place in self._candidates.solved if self._candidates.passes(place)]
        return min(passing, key=self._candidates.cost, default=None)

    def expected(self) -> Place | None:
        """The best of those that pass or are expected to pass."""
        found = self._candidates
        inside = [place for place in found.by_hand if found.margin(place) >= 0.0 and math.isfinite(found.cost(place))]
        return min(inside, key=lambda place: (found.cost(place), place), default=None)

    def next(self) -> Place | None:
        """Return what the model that decides solves next; None where nothing better is to be expected."""
        found, best, expected = self._candidates, self.best, self.expected()
        if expected is not None and expected not in found.solved:
            return expected
        if best is None:  # nothing is expected to pass: what is nearest to it
            nearest_to = max(found.by_hand, key=found.margin)
            done = nearest_to in found.solved or found.by_hand[nearest_to].state != "done"
            return None if done else nearest_to
        beside = self._around(best, 1)
        found.calculate(beside)
        better = [place for place in beside if found.cost(place) < found.cost(best)]
        likeliest = [
            max((place for place in better if place[k] != best[k]), key=found.margin, default=best)
            for k in range(len(best))
        ]
        return next((place for place in likeliest if place not in found.solved), None)

    def explore(self) -> None:
        """Calculate by hand where the best is to be expected."""
        found = self._candidates
        if math.prod(self._sizes) <= ENUMERATED:
            found.calculate(list(product(*map(range, self._sizes))))
            return
        if len(found.by_hand) < BY_HAND:
            self._evolve()
        while len(found.by_hand) < BY_HAND and (place := self.expected()) is not None:
            found.calculate(self._around(place, 2))
            if self.expected() == place:
                break

    def _around(self, place: Place, most: int) -> list[Place]:
        """Return what differs by a step in at most so many entries; of a list, any value is a step away."""
        choices = [
            [step for step in (here - 1, here, here + 1) if 0 <= step < size] if axis.is_range else range(size)
            for axis, here, size in zip(self._candidates.axes, place, self._sizes, strict=True)
        ]
        return [other for other in product(*choices) if 0 < sum(map(int.__ne__, other, place)) <= most]

    def _evolve(self) -> None:
        """Explore by differential evolution over whole steps, one generation a batch."""
        from scipy.optimize import NonlinearConstraint, differential_evolution

        found, start = self._candidates, self.expected()

        def places(members: NDArray[np.float64]) -> list[Place]:
            these = [tuple(int(step) for step in np.rint(member)) for member in np.atleast_2d(members.T)]
            found.calculate(these)
            return these

        def costs(members: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.array([found.cost(place) for place in places(members)])

        def margins(members: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.array([[found.margin(place) for place in places(members)]])

        options: dict[str, Any] = {} if start is None else {"x0": np.array(start, dtype=float)}
        differential_evolution(
            costs,
            [(0, size - 1) for size in self._sizes],
            integrality=[True] * len(self._sizes),
            constraints=NonlinearConstraint(margins, 0.0, np.inf),
            vectorized=True,
            updating="deferred",
            polish=False,
            rng=self._seed + len(found.solved),
            popsize=MEMBERS,
            maxiter=GENERATIONS,
            tol=0.0,
            callback=lambda intermediate_result: len(found.by_hand) >= BY_HAND,
            **options,
        )


def _gains(candidates: Candidates, best: Place, limit: VariantNumber) -> tuple[Gain, ...]:
    """Return for each entry the step from the best one that raises most what limits it."""
    beside = {}
    for number, axis in enumerate(candidates.axes):
        steps = [best[number] - 1, best[number] + 1] if axis.is_range else range(len(axis.values))
        inside = [step for step in steps if 0 <= step < len(axis.values) and step != best[number]]
        beside[axis.path] = [(*best[:number], step, *best[number + 1 :]) for step in inside]
    candidates.calculate([best, *(place for places in beside.values() for place in places)])
    gains = []
    for number, axis in enumerate(candidates.axes):
        found = [gain for place in beside[axis.path] if (gain := _gain(candidates, best, place, number, limit))]
        gains += [max(found, key=lambda gain: gain.share)] if found else []
    return tuple(sorted(gains, key=lambda gain: -gain.share))


def _gain(candidates: Candidates, best: Place, place: Place, number: int, limit: VariantNumber) -> Gain | None:
    results = candidates.solved if place in candidates.solved else candidates.by_hand
    here, there = (counterpart(results[one], limit) for one in (best, place))
    if here is None or there is None:
        return None
    before, after = margin(here, worst=False), margin(there, worst=False)
    costs = [candidates.objective.cost(results[one]) for one in (best, place)]
    if not (0.0 < before < math.inf and 0.0 < after < math.inf and all(map(math.isfinite, costs)) and costs[0]):
        return None
    return Gain(
        path=candidates.axes[number].path,
        value=candidates.axes[number].values[place[number]],
        share=after / before - 1.0,
        cost=(costs[1] - costs[0]) / abs(costs[0]) * (-1.0 if candidates.objective.largest else 1.0),
        by_hand=results is candidates.by_hand,
    )


def none_passes(found: Lightest) -> bool:
    """Return whether all that was solved fails, which then was what is nearest to passing.

    Parameters
    ----------
    found : Lightest

    Returns
    -------
    bool
    """
    verdicts = {result.verdict for result in found.solved.values() if result.state == "done"}
    return verdicts == {Verdict.FAIL} and found.complete
