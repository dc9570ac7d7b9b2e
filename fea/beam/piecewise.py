"""Functions along a beam that are polynomials between stations, and their largest values."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.ties import TIE, first_largest

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
class Piecewise:
    """Some functions of x, each a polynomial between neighbouring stations.

    Attributes
    ----------
    breaks : ndarray, shape (k + 1,)
        Stations, rising [mm].
    coefficients : ndarray, shape (k, m, p)
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
        ndarray, shape (m,)
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
        interval = min(max(interval, 0), len(self.coefficients) - 1)
        return values(self.coefficients[interval], x - self.breaks[interval])

    def along(self, stations: Floats) -> Floats:
        """Return the functions at many stations; where they jump, those after.

        Parameters
        ----------
        stations : ndarray, shape (...)
            On the beam [mm].

        Returns
        -------
        ndarray, shape (..., m)
        """
        interval = np.searchsorted(self.breaks, stations, side="right") - 1
        interval = np.clip(interval, 0, len(self.coefficients) - 1)
        return values(self.coefficients[interval], (stations - self.breaks[interval])[..., None])

    @cached_property
    def samples(self) -> tuple[Floats, Floats]:
        """Stations (n,) [mm], and the functions (n, m) there: both ends of every interval, and more where they bend."""
        grids = self._grids
        x = np.concatenate([x0 + s for x0, s in zip(self.breaks[:-1], grids, strict=True)])
        return x, np.concatenate([_along(c, s) for c, s in zip(self.coefficients, grids, strict=True)])

    @cached_property
    def _grids(self) -> list[Floats]:
        """Distances of the samples from each interval's first station."""
        bent = np.any(self.coefficients[:, :, 2:], axis=(1, 2))
        lengths = np.diff(self.breaks)
        fine = np.linspace(0.0, lengths, SAMPLES, axis=-1)
        return [grid if curved else grid[[0, -1]] for grid, curved in zip(fine, bent, strict=True)]

    def largest(self, measure: Measure, bound: Measure | None = None) -> tuple[float, Side, float]:
        """Find the largest measure of the functions over the beam.

        Both ends of every interval are tried, and inside it samples, about the best of which finer and finer ones
        follow; a measure that is convex where the functions are linear (any norm) has its maximum found exactly there.

        Parameters
        ----------
        measure : callable
            Of values (n, m) of the functions at n stations, to numbers (n,).
        bound : callable, optional
            Of sizes (n, m) of the functions, to numbers (n,) that no measure of functions of these sizes exceeds. With
            it the measure is taken only where it can be the largest; the answer is the same.

        Returns
        -------
        tuple of float, Side and float
            Station [mm], side and value.
        """
        ends = np.cumsum([len(grid) for grid in self._grids])[:-1]
        rows = np.split(self.samples[1], ends)
        caps = self._caps(bound)
        found, most = [-np.inf] * len(rows), -np.inf
        places: list[tuple[float, Side]] = [(float(x), "after") for x in self.breaks[:-1]]
        for k in sorted(range(len(rows)), key=lambda k: -caps[k].max()):
            if caps[k].max() < most * (1.0 - 2.0 * TIE):
                break
            grid, sizes = self._grids[k], _where_it_counts(measure, rows[k], caps[k])
            i = first_largest(sizes)
            s, found[k] = float(grid[i]), float(sizes[i])
            if 0 < i < len(grid) - 1:
                between = float(grid[i - 1]), float(grid[i + 1])
                s, found[k] = _refined(self.coefficients[k], measure, between, s, found[k])
            last = i == len(grid) - 1
            places[k] = (float(self.breaks[k + 1]), "before") if last else (float(self.breaks[k]) + s, "after")
            most = max(most, found[k])
        k = first_largest(found)
        return *places[k], found[k]

    def _caps(self, bound: Measure | None) -> list[Floats]:
        """What a measure does not exceed between neighbouring samples of each interval."""
        grids = self._grids
        if bound is None:
            return [np.full(len(grid) - 1, np.inf) for grid in grids]
        powers = np.arange(2, self.coefficients.shape[-1])
        ends = np.cumsum([len(grid) for grid in grids])[:-1]
        sizes = []
        for c, grid, rows in zip(self.coefficients, grids, np.split(np.abs(self.samples[1]), ends), strict=True):
            # Between two samples a function lies within h²/8 times its second derivative of their chord.
            curved = (grid[1:, None] ** (powers - 2) * powers * (powers - 1)) @ np.abs(c[:, 2:]).T
            sizes.append(np.maximum(rows[:-1], rows[1:]) + (np.diff(grid) ** 2 / 8.0)[:, None] * curved)
        return np.split(bound(np.concatenate(sizes)), ends - np.arange(1, len(grids)))


def _where_it_counts(measure: Measure, rows: Floats, caps: Floats) -> Floats:
    """Measures (n,) of an interval's samples; -inf of those that are not its largest, by the caps beside them."""
    if not np.isfinite(caps).all():
        return measure(rows)
    most = np.minimum(np.append(caps, np.inf), np.append(np.inf, caps))
    found = np.full(len(rows), -np.inf)
    best = int(np.argmax(most))
    least = float(measure(rows[best : best + 1])[0])
    counts = most >= least * (1.0 - 2.0 * TIE)
    found[counts] = measure(rows[counts])
    return found


def _along(c: Floats, s: Floats) -> Floats:
    """Values (n, m) of polynomials (m, k) at n places."""
    return np.asarray(np.vander(s, c.shape[-1], increasing=True) @ c.T)


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
        i = min(int(np.searchsorted(functions.breaks, x, side="right")) - 1, len(functions.coefficients) - 1)
        c, s = functions.coefficients[i], float(x - functions.breaks[i])
        taylor, factorial = [], 1.0
        for k in range(c.shape[-1]):
            taylor.append(values(c, s) / factorial)
            c, factorial = np.polynomial.polynomial.polyder(c, axis=-1), factorial * (k + 1)
        rows.append(np.stack(taylor, axis=-1))
    return Piecewise(breaks=breaks, coefficients=np.array(rows))


def _refined(c: Floats, measure: Measure, between: tuple[float, float], s: float, peak: float) -> tuple[float, float]:
    """Search for a maximum between two places of an interval; the start (s, peak) stays if nothing better turns up."""
    for _ in range(_ROUNDS):
        grid = np.linspace(*between, _FINER)
        sizes = measure(_along(c, grid))
        i = int(np.argmax(sizes))
        between = float(grid[max(i - 1, 0)]), float(grid[min(i + 1, _FINER - 1)])
        if sizes[i] > peak:
            s, peak = float(grid[i]), float(sizes[i])
    return s, peak
