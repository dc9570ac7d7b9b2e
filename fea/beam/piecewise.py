"""Functions along a beam that are polynomials between stations, and their largest values."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.ties import TIE, first_largest_of_each

Floats = NDArray[np.float64]
Side = Literal["before", "after"]
SAMPLES = 33
_FINER, _ROUNDS = 17, 12
"""Samples between the neighbours of the best one, and how often: each time the stretch has an eighth of its length."""
Measure = Callable[[Floats], Floats]


def integral(c: Floats, constant: Floats) -> Floats:
    """Integrate polynomials.

    Parameters
    ----------
    c : ndarray, shape (..., k)
        Coefficients, lowest power first.
    constant : ndarray, shape (...)
        Values at 0.

    Returns
    -------
    ndarray, shape (..., k + 1)
        Coefficients of the integrals.
    """
    powers = np.arange(1, c.shape[-1] + 1)
    return np.concatenate([constant[..., None], c / powers], axis=-1)


def values(c: Floats, s: float | Floats) -> Floats:
    """Evaluate polynomials.

    Parameters
    ----------
    c : ndarray, shape (..., k)
        Coefficients, lowest power first.
    s : float or ndarray
        Where.

    Returns
    -------
    ndarray, shape (...)
        Values.
    """
    value = np.zeros(c.shape[:-1])
    for power in range(c.shape[-1] - 1, -1, -1):
        value = value * s + c[..., power]
    return value


@dataclass(frozen=True, kw_only=True, eq=False)
class LargestAlong:
    """The largest measure of functions in each of n states.

    Attributes
    ----------
    x : ndarray, shape (n,)
        Stations [mm].
    before : ndarray of bool, shape (n,)
        True where it is the value before a station where the functions jump.
    value : ndarray, shape (n,)
    """

    x: Floats
    before: NDArray[np.bool_]
    value: Floats

    def side(self, i: int = 0) -> Side:
        """Return on which side of its station the largest of a state is.

        Parameters
        ----------
        i : int, optional
            Number of the state.

        Returns
        -------
        Side
        """
        return "before" if self.before[i] else "after"


@dataclass(frozen=True, kw_only=True, eq=False)
class Piecewise:
    """Some functions of x in one state or in n, each a polynomial between neighbouring stations.

    Attributes
    ----------
    breaks : ndarray, shape (k + 1,)
        Stations, rising [mm].
    coefficients : ndarray, shape (k, m, p) or (n, k, m, p)
        Of m functions in powers 0 to p - 1 of the distance from the interval's first station.
    """

    breaks: Floats
    coefficients: Floats

    def at(self, x: float, side: Side = "after") -> Floats:
        """Return the functions at x.

        At the first station "before" and at the last "after" lie outside the beam: there the one-sided value inside is
        returned.

        Parameters
        ----------
        x : float
            Station [mm].
        side : Side, optional
            Which value, where the functions jump at x.

        Returns
        -------
        ndarray, shape (m,) or (n, m)
            Values.

        Raises
        ------
        CannotRunError
            For x off the beam.
        """
        first, last = self.breaks[0], self.breaks[-1]
        slack = 1e-9 * (last - first)
        if not first - slack <= x <= last + slack:
            raise CannotRunError(f"station x = {x:g} mm lies off the beam, which runs from {first:g} to {last:g} mm")
        interval = int(np.searchsorted(self.breaks, x, side="right" if side == "after" else "left")) - 1
        interval = min(max(interval, 0), self.coefficients.shape[-3] - 1)
        return values(self.coefficients[..., interval, :, :], x - self.breaks[interval])

    def along(self, stations: Floats) -> Floats:
        r"""Return the functions at many stations; where they jump, those after.

        Parameters
        ----------
        stations : ndarray, shape s
            On the beam [mm].

        Returns
        -------
        ndarray, shape (\*s, m) or (n, \*s, m)
        """
        interval = np.searchsorted(self.breaks, stations, side="right") - 1
        interval = np.clip(interval, 0, self.coefficients.shape[-3] - 1)
        return values(self.coefficients[..., interval, :, :], (stations - self.breaks[interval])[..., None])

    def state(self, i: int | None) -> "Piecewise":
        """Return the functions of one of n states.

        Parameters
        ----------
        i : int or None
            Its number. None gives functions in a single state an axis.

        Returns
        -------
        Piecewise
        """
        return Piecewise(breaks=self.breaks, coefficients=self.coefficients[i])

    @cached_property
    def samples(self) -> tuple[Floats, Floats]:
        """Stations (s,) [mm], and the functions (s, m) or (n, s, m): both ends of an interval, more where they bend."""
        grids, each = self._grids, np.moveaxis(self.coefficients, -3, 0)
        x = np.concatenate([x0 + s for x0, s in zip(self.breaks[:-1], grids, strict=True)])
        return x, np.concatenate([_along(c, s) for c, s in zip(each, grids, strict=True)], axis=-2)

    @cached_property
    def _grids(self) -> list[Floats]:
        """Distances of the samples from each interval's first station."""
        bent = np.any(np.moveaxis(self.coefficients[..., 2:], -3, 0).reshape(len(self.breaks) - 1, -1), axis=1)
        lengths = np.diff(self.breaks)
        fine = np.linspace(0.0, lengths, SAMPLES, axis=-1)
        return [grid if curved else grid[[0, -1]] for grid, curved in zip(fine, bent, strict=True)]

    def largest(self, measure: Measure, bound: Measure | None = None) -> tuple[float, Side, float]:
        """Find the largest measure of the functions of one state over the beam.

        Parameters
        ----------
        measure, bound
            As of ``peaks``.

        Returns
        -------
        tuple of float, Side and float
            Station [mm], side and value.
        """
        found = self.peaks(measure, bound)
        return float(found.x[0]), found.side(), float(found.value[0])

    def peaks(self, measure: Measure, bound: Measure | None = None) -> LargestAlong:
        """Find the largest measure of the functions over the beam in each state.

        Both ends of every interval are tried, and inside it samples, about the best of which finer and finer ones
        follow; a measure that is convex where the functions are linear (any norm) has its maximum found exactly there.

        Parameters
        ----------
        measure : callable
            Of values (r, m) of the functions at r stations, to numbers (r,).
        bound : callable, optional
            Of sizes (r, m) of the functions, to numbers (r,) that no measure of functions of these sizes exceeds. With
            it the measure is taken only where it can be the largest; the answer is the same.

        Returns
        -------
        LargestAlong
            Of one state as well as of n.
        """
        each = self.coefficients.reshape(-1, *self.coefficients.shape[-3:])
        sizes, counts = self._sizes(measure, bound)
        found = np.full(counts.shape, -np.inf)
        x, before = np.zeros(counts.shape), np.zeros(counts.shape, dtype=bool)
        inside = list[tuple[NDArray[np.int64], int, Floats, Floats]]()
        for k, (grid, own) in enumerate(zip(self._grids, sizes, strict=True)):
            i = first_largest_of_each(own)
            before[:, k] = i == len(grid) - 1
            found[:, k], x[:, k] = own[np.arange(len(own)), i], grid[i]
            [within] = np.nonzero(counts[:, k] & (i > 0) & ~before[:, k])
            inside.append((within, k, grid[i[within] - 1], grid[i[within] + 1]))
        state = np.concatenate([within for within, *_ in inside])
        interval = np.concatenate([np.full(len(within), k) for within, k, *_ in inside])
        if len(state):
            low, high = (np.concatenate([one[end] for one in inside]) for end in (2, 3))
            start = x[state, interval], found[state, interval]
            x[state, interval], found[state, interval] = _refined(each[state, interval], measure, low, high, *start)
        states, best = np.arange(len(found)), first_largest_of_each(found)
        ended = before[states, best]
        place = np.where(ended, self.breaks[best + 1], self.breaks[best] + x[states, best])
        return LargestAlong(x=place, before=ended, value=found[states, best])

    def _sizes(self, measure: Measure, bound: Measure | None) -> tuple[list[Floats], NDArray[np.bool_]]:
        """Measures (n, s) of each interval's samples, and in which of the intervals (n, k) it may be the largest.

        Those that are not the largest of their interval, by the caps beside them, are -inf.
        """
        ends = np.cumsum([len(grid) for grid in self._grids])
        rows = self.samples[1].reshape(-1, ends[-1], self.coefficients.shape[-2])
        if bound is None:
            every = measure(rows.reshape(-1, rows.shape[-1])).reshape(rows.shape[:2])
            return np.split(every, ends[:-1], axis=1), np.ones((len(rows), len(ends)), dtype=bool)
        caps = self._caps(bound, rows)
        most = [np.hstack([one[:, :1], np.minimum(one[:, :-1], one[:, 1:]), one[:, -1:]]) for one in caps]
        tops = np.stack([one.max(axis=1) for one in caps], axis=1)
        best = np.stack([one.argmax(axis=1) for one in most], axis=1) + np.append(0, ends[:-1])
        # First where the cap is highest, then in those intervals alone whose caps reach what was found there.
        least, counts = np.full(tops.shape, -np.inf), np.zeros(tops.shape, dtype=bool)
        state, interval = np.arange(len(rows)), tops.argmax(axis=1)
        while len(state):
            least[state, interval] = measure(rows[state, best[state, interval]]) * (1.0 - 2.0 * TIE)
            counts = np.asarray(tops >= least.max(axis=1, keepdims=True))
            state, interval = np.nonzero(counts & np.isneginf(least))
        wanted = [
            one >= np.where(own, low, np.inf)[:, None] for one, own, low in zip(most, counts.T, least.T, strict=True)
        ]
        where = np.concatenate(wanted, axis=1)
        found = np.full(where.shape, -np.inf)
        found[where] = measure(rows[where])
        return np.split(found, ends[:-1], axis=1), counts

    def _caps(self, bound: Measure, rows: Floats) -> list[Floats]:
        """What a measure does not exceed between neighbouring samples (n, s - 1) of each interval."""
        grids, powers = self._grids, np.arange(2, self.coefficients.shape[-1])
        each = np.moveaxis(self.coefficients.reshape(-1, *self.coefficients.shape[-3:]), 1, 0)
        ends = np.cumsum([len(grid) for grid in grids])[:-1]
        sizes = []
        for c, grid, own in zip(each, grids, np.split(np.abs(rows), ends, axis=1), strict=True):
            # Between two samples a function lies within h²/8 times its second derivative of their chord.
            curved = (grid[1:, None] ** (powers - 2) * powers * (powers - 1)) @ np.abs(c[..., 2:]).swapaxes(-1, -2)
            sizes.append(np.maximum(own[:, :-1], own[:, 1:]) + (np.diff(grid) ** 2 / 8.0)[:, None] * curved)
        together = np.concatenate(sizes, axis=1)
        caps = bound(together.reshape(-1, together.shape[-1])).reshape(together.shape[:2])
        return np.split(caps, ends - np.arange(1, len(grids)), axis=1)


def _along(c: Floats, s: Floats) -> Floats:
    """Values (..., r, m) of polynomials (..., m, k) at r places."""
    return np.asarray(np.vander(s, c.shape[-1], increasing=True) @ c.swapaxes(-1, -2))


def divided(functions: Piecewise, stations: Sequence[float]) -> Piecewise:
    """Return the same functions with further breaks.

    Parameters
    ----------
    functions : Piecewise
        The functions.
    stations : sequence of float
        Where; those outside are left out [mm].

    Returns
    -------
    Piecewise
        Equal everywhere.
    """
    first, last = functions.breaks[0], functions.breaks[-1]
    breaks = np.unique([*functions.breaks, *(x for x in stations if first < x < last)])
    if len(breaks) == len(functions.breaks):
        return functions
    rows = []
    for x in breaks[:-1]:
        i = min(int(np.searchsorted(functions.breaks, x, side="right")) - 1, functions.coefficients.shape[-3] - 1)
        c, s = functions.coefficients[..., i, :, :], float(x - functions.breaks[i])
        taylor, factorial = [], 1.0
        for k in range(c.shape[-1]):
            taylor.append(values(c, s) / factorial)
            c = c[..., 1:] * np.arange(1, c.shape[-1])
            factorial *= k + 1
        rows.append(np.stack(taylor, axis=-1))
    return Piecewise(breaks=breaks, coefficients=np.stack(rows, axis=-3))


def only(functions: Piecewise, stretches: Sequence[tuple[float, float]]) -> Piecewise:
    """Return the same functions on some stretches, and zero elsewhere.

    Parameters
    ----------
    functions : Piecewise
    stretches : sequence of tuple of 2 float
        First and last station of each; what lies off the beam is left out [mm].

    Returns
    -------
    Piecewise
    """
    parts = divided(functions, [x for stretch in stretches for x in stretch])
    first, last = parts.breaks[:-1, None], parts.breaks[1:, None]
    low, high = np.reshape(stretches, (-1, 2)).T
    within = np.asarray(((first >= low) & (last <= high)).any(axis=1))
    return Piecewise(breaks=parts.breaks, coefficients=np.where(within[:, None, None], parts.coefficients, 0.0))


def _refined(c: Floats, measure: Measure, low: Floats, high: Floats, s: Floats, peak: Floats) -> tuple[Floats, Floats]:
    """Search for maxima of q intervals, each between two places; a start (s, peak) stays if nothing better turns up."""
    powers, each = np.arange(c.shape[-1]), np.arange(len(c))
    for _ in range(_ROUNDS):
        grid = np.linspace(low, high, _FINER, axis=-1)
        rows = grid[..., None] ** powers @ c.swapaxes(-1, -2)
        sizes = measure(rows.reshape(-1, rows.shape[-1])).reshape(grid.shape)
        i = sizes.argmax(axis=1)
        low, high = grid[each, np.maximum(i - 1, 0)], grid[each, np.minimum(i + 1, _FINER - 1)]
        better = sizes[each, i] > peak
        s, peak = np.where(better, grid[each, i], s), np.where(better, sizes[each, i], peak)
    return s, peak
