"""Functions along a beam that are polynomials between stations, and their largest values."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fea.common.ties import first_largest
from geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]
Side = Literal["before", "after"]
SAMPLES = 33
_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0


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

    def largest(self, measure: Callable[[Floats], float]) -> tuple[float, Side, float]:
        """Find the largest measure of the functions over the beam.

        Both ends of every interval are tried, and inside it samples, the best of them refined by golden section; a
        measure that is convex where the functions are linear (any norm) has its maximum found exactly there.

        Parameters
        ----------
        measure : callable
            Of the values (m,) of the functions.

        Returns
        -------
        tuple of float, Side and float
            Station [mm], side and value.
        """
        peaks: list[tuple[float, Side, float]] = []
        for c, x0, x1 in zip(self.coefficients, self.breaks[:-1], self.breaks[1:], strict=True):
            h = float(x1 - x0)

            def value(s: float, c: Floats = c) -> float:
                return measure(values(c, s))

            grid = np.linspace(0.0, h, SAMPLES if np.any(c[:, 2:]) else 2)
            found = [value(s) for s in grid]
            i = first_largest(found)
            s, peak = float(grid[i]), found[i]
            if 0 < i < len(grid) - 1:
                s, peak = _golden(value, float(grid[i - 1]), float(grid[i + 1]), s, peak)
            peaks.append((float(x1), "before", peak) if i == len(grid) - 1 else (float(x0) + s, "after", peak))
        return peaks[first_largest([peak for _, _, peak in peaks])]


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


def _golden(value: Callable[[float], float], low: float, high: float, s: float, peak: float) -> tuple[float, float]:
    """Golden-section search for a maximum; the start (s, peak) is kept if nothing better turns up."""
    for _ in range(60):
        a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        fa, fb = value(a), value(b)
        low, high = (low, b) if fa > fb else (a, high)
        if max(fa, fb) > peak:
            s, peak = (a, fa) if fa > fb else (b, fb)
    return s, peak
