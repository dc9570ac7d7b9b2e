"""A cause whose answers are alternatives: one of them holds, nobody knows which, and the worst of all counts.

The range of a coefficient, friction, and the places that play lets a linkage take are such causes. Each is solved anew
at some of its values (``alula.fea.doubts``), and what these make of a number is read here, for every number by the same
rule (``docs/theory/bands.md``).
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Generic, TypeVar

from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, eq=False)
class Alternatives(Generic[T]):
    """Answers that a cause may put in the place of the stated one.

    Attributes
    ----------
    source : Source
        The cause.
    others : tuple
        The answers besides the stated one, at the ends of what may be and perhaps between them.
    coefficients : tuple of float
        Where numbers are convex in a coefficient: the stated one, then those of ``others``; else empty.
    endless : bool
        True where one of the answers has no end, such as that of a linkage that locks itself.
    """

    source: Source
    others: tuple[T, ...]
    coefficients: tuple[float, ...] = ()
    endless: bool = False

    def scatter(self, stated: T, number: Callable[[T], float]) -> Scatter:
        """Return what the cause makes of a number.

        Parameters
        ----------
        stated : T
            The stated answer.
        number : callable
            Returns the number of an answer; not negative.

        Returns
        -------
        Scatter
        """
        return self.of(number(stated), [number(one) for one in self.others])

    def of(self, value: float, others: Sequence[float]) -> Scatter:
        """Return what the cause makes of a number from what it is in every answer.

        The largest is one of them. So is the least, unless the number is convex in a coefficient and may be less
        between two of them: then a bound below all stands in its place (``least_of_convex``).

        Parameters
        ----------
        value : float
            In the stated answer; not negative.
        others : sequence of float
            In ``others``.

        Returns
        -------
        Scatter
            On ``value``; without upper end where that is zero, and others are not.
        """
        every = (value, *others)
        most, least = max(every), min(every)
        if self.coefficients:
            least = max(least_of_convex(zip(self.coefficients, every, strict=True)), 0.0)
        if not most > 0.0:
            return Scatter()
        if not value > 0.0:
            return Scatter.from_zero(others, (self.source,))
        high = math.inf if self.endless else max(most / value, 1.0)
        return Scatter(low=min(least / value, 1.0), high=high, sources=(self.source,))

    def told_by(self, other: Callable[[T], Any]) -> "Alternatives[Any]":
        """Return the same with something else of every answer.

        Parameters
        ----------
        other : callable
            Returns it.

        Returns
        -------
        Alternatives
        """
        return replace(self, others=tuple(map(other, self.others)))


def least_of_convex(found: Iterable[tuple[float, float]]) -> float:
    """Return a lower bound of a convex function between the first and the last of some places.

    Beyond a piece between two places, a convex function lies above the line through its ends. So between two
    neighbours it lies above the lines of the pieces before and after.

    Parameters
    ----------
    found : iterable of tuple of (float, float)
        Places, in any order, with the values there; at least three for a bound, of two the least is returned.

    Returns
    -------
    float
        At most the least of the values.
    """
    known = sorted(dict(found).items())
    least = min(value for _, value in known)
    lines = [((b - a) / (x1 - x0), x0, a) for (x0, a), (x1, b) in pairwise(known)]
    for i, (start, end) in enumerate(pairwise(known)):
        before = lines[i - 1] if i > 0 else None
        after = lines[i + 1] if i + 1 < len(lines) else None
        if before and after:
            steeper = after[0] - before[0]
            if steeper > 0.0:
                x = (_at(before, 0.0) - _at(after, 0.0)) / steeper
                if start[0] < x < end[0]:
                    least = min(least, _at(before, x))
        elif before:
            least = min(least, _at(before, end[0]))
        elif after:
            least = min(least, _at(after, start[0]))
    return least


def _at(line: tuple[float, float, float], x: float) -> float:
    slope, x0, y0 = line
    return y0 + slope * (x - x0)
