"""Combinations of values that a search chooses among, and what is known or expected of each.

Where a combination is solved by the model that decides, every check's margin there, over its whole band, has a ratio to
that of hand calculation; so has the objective. Elsewhere hand calculation is taken times the ratios of the nearest
combination that is solved.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from alula.fea.common.verdict import Verdict
from alula.fea.sizing.search import Search
from alula.fea.study.margin import margin
from alula.fea.study.numbers import DRIVING, VariantNumber, VariantResult
from alula.loads.plans.axis import Axis

Place = tuple[int, ...]
"""Which value of each entry."""
BEYOND = math.log(1e9)
"""Logarithm of the largest margin that is told from another."""


@dataclass(frozen=True, kw_only=True)
class Objective:
    """The number of a variant that is to be small, or large.

    Attributes
    ----------
    quantity : str
        As a study calls it.
    largest : bool
        True where it is to be large.
    """

    quantity: str = "mass"
    largest: bool = False

    def numbers(self, result: VariantResult) -> list[VariantNumber]:
        """Return the numbers of that name, those of the whole linkage where it has some.

        Parameters
        ----------
        result : VariantResult

        Returns
        -------
        list of VariantNumber
        """
        found = [number for number in result.numbers if number.quantity == self.quantity]
        return [number for number in found if number.subject == "the linkage"] or found

    def number(self, result: VariantResult) -> VariantNumber | None:
        """Return the worst of these numbers.

        Parameters
        ----------
        result : VariantResult

        Returns
        -------
        VariantNumber or None
            None where none is known.
        """
        known = [number for number in self.numbers(result) if not math.isnan(number.value)]
        return (min if self.largest else max)(known, key=_size, default=None)

    def cost(self, result: VariantResult) -> float:
        """Return what is to be small.

        Parameters
        ----------
        result : VariantResult

        Returns
        -------
        float
            Infinite where the number is not known.
        """
        number = self.number(result)
        return math.inf if number is None else -_size(number) if self.largest else _size(number)


def _size(number: VariantNumber) -> float:
    return abs(number.value) if number.subject == DRIVING else number.value


@dataclass(frozen=True, kw_only=True)
class _Told:
    """What a model says of a combination: the logarithm of each check's margin, and what is to be small."""

    margins: Mapping[tuple[str, ...], float]
    cost: float


class Candidates:
    """All combinations of the values of some entries, those that were calculated by hand, and those that were solved.

    Parameters
    ----------
    search : Search
        That varies these entries.
    axes : sequence of Axis
        With their values.
    objective : Objective

    Attributes
    ----------
    by_hand, solved : dict of Place to VariantResult
    """

    def __init__(self, search: Search, axes: Sequence[Axis], objective: Objective) -> None:
        self._search, self.axes, self.objective = search, tuple(axes), objective
        self.by_hand: dict[Place, VariantResult] = {}
        self.solved: dict[Place, VariantResult] = {}
        self._hand: dict[Place, _Told] = {}
        self._true: dict[Place, _Told] = {}

    def point(self, place: Place) -> dict[str, object]:
        """Return a combination.

        Parameters
        ----------
        place : tuple of int

        Returns
        -------
        dict of str to object
            Entry -> value.
        """
        return {axis.path: axis.values[step] for axis, step in zip(self.axes, place, strict=True)}

    def calculate(self, places: Sequence[Place]) -> None:
        """Calculate combinations by hand.

        Parameters
        ----------
        places : sequence of Place
        """
        new = [place for place in dict.fromkeys(places) if place not in self.by_hand]
        results = self._search.at([self.point(place) for place in new], "beam", roughly=True)
        self.by_hand.update(zip(new, results, strict=True))
        self._hand.update((place, self._told(self.by_hand[place], worst=False)) for place in new)

    def solve(self, places: Sequence[Place]) -> None:
        """Let the model that decides solve combinations that were calculated by hand.

        Parameters
        ----------
        places : sequence of Place
        """
        results = self._search.at([self.point(place) for place in places])
        self.solved.update(zip(places, results, strict=True))
        self._true.update((place, self._told(self.solved[place], worst=True)) for place in places)

    def _told(self, result: VariantResult, *, worst: bool) -> "_Told":
        return _Told(margins=_margins(result, worst=worst), cost=self.objective.cost(result))

    def passes(self, place: Place) -> bool:
        """Return whether a combination was solved and passes over its whole band.

        Parameters
        ----------
        place : Place

        Returns
        -------
        bool
        """
        return place in self.solved and self.solved[place].verdict is Verdict.PASS

    def margin(self, place: Place) -> float:
        """Return how far a combination is within its limits, as far as is known.

        Parameters
        ----------
        place : Place
            That was calculated by hand.

        Returns
        -------
        float
            Logarithm of the least margin: from 0 on it passes.
        """
        if place in self.solved:
            least = min(self._true[place].margins.values(), default=-BEYOND)
            return max(least, 0.0) if self.passes(place) else min(least, -1e-12)
        found, near = self._hand[place].margins, self._nearest(place)
        if near is not None and found:
            there, hand = self._true[near].margins, self._hand[near].margins
            found = {name: true + found.get(name, 0.0) - hand.get(name, 0.0) for name, true in there.items()}
        return min(found.values(), default=-BEYOND)

    def cost(self, place: Place) -> float:
        """Return what is to be small, as far as is known.

        Parameters
        ----------
        place : Place
            That was calculated by hand.

        Returns
        -------
        float
            Infinite where it is not known.
        """
        if place in self.solved:
            return self._true[place].cost
        found, near = self._hand[place].cost, self._nearest(place)
        if near is None:
            return found
        there, hand = self._true[near].cost, self._hand[near].cost
        ratio = there / hand if hand else math.nan
        return found * ratio if 0.0 < ratio < math.inf else found

    def _nearest(self, place: Place) -> Place | None:
        """The nearest one that is solved, by the shares of the ranges."""
        done = [other for other, result in self.solved.items() if result.state == "done"]
        return min(done, key=lambda other: self._distance(place, other), default=None)

    def _distance(self, one: Place, other: Place) -> float:
        apart = 0.0
        for axis, here, there in zip(self.axes, one, other, strict=True):
            apart += abs(here - there) / (len(axis.values) - 1) if axis.is_range else float(here != there)
        return apart


def _margins(result: VariantResult, *, worst: bool) -> Mapping[tuple[str, ...], float]:
    """Return the logarithm of the margin of each check; nothing of a variant that is not done."""
    return {
        (n.check, n.subject, n.load_case, n.quantity): math.log(
            min(max(margin(n, worst=worst), math.exp(-BEYOND)), math.exp(BEYOND))
        )
        for n in result.numbers
        if n.check
    }
