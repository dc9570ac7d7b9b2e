"""Buckling factor of a straight column whose normal force varies along it, held in place at some stations.

The lowest factor λ at which E I ∫v''² dx = λ ∫P v'² dx for some shape v that the supports allow, P the compression
(Timoshenko & Gere, Theory of Elastic Stability, 2nd ed., section 2.8). Cubic elements, with ∫P v'² integrated exactly
for P of degree 2: the factor comes out from above, within 2e-4 where a half-wave spans six elements or more. Shear
is left out. A stretch may be softer than the column: one of another E I, or two flanks beside a slot, which bend by
themselves and resist with a pair of forces only that their ends turn against one another, E I ∫v''² + E S (Δv')²/L.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]

ELEMENTS = 12
"""Along the whole column, at least; two at least between neighbouring stations."""
MERGED = 1e-3
"""Share of the length below which two stations are one to the mesh; the force is integrated as it is."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)
GAUSS = (_POINTS + 1.0) / 2.0, _WEIGHTS / 2.0
"""Points and weights of Gauss on an element, as shares of it."""
NOTHING = 1e-12
"""Largest eigenvalue over the force, below which no factor makes the column buckle."""


@dataclass(frozen=True, kw_only=True, eq=False)
class AxialForce:
    """Compression along a column in each of P poses: a parabola between neighbouring stations.

    Attributes
    ----------
    breaks : ndarray, shape (k + 1,)
        Stations, rising [mm].
    values : ndarray, shape (k, 3, P)
        At the start, in the middle and at the end of each interval; tension negative [N].
    """

    breaks: Real
    values: Real

    def at(self, x: Real) -> Real:
        """Return the compression at stations inside intervals; none beyond the first and last break.

        Parameters
        ----------
        x : ndarray, shape (n,)
            Stations [mm].

        Returns
        -------
        ndarray, shape (n, P)
            Compression [N].
        """
        i = np.clip(np.searchsorted(self.breaks, x, side="right") - 1, 0, len(self.values) - 1)
        t = (x - self.breaks[i]) / (self.breaks[i + 1] - self.breaks[i])
        weights = np.stack([(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)], axis=1)
        weights[(t < 0.0) | (t > 1.0)] = 0.0
        return np.asarray(np.einsum("nj,njp->np", weights, self.values[i]))


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """A part of a column with a stiffness of its own.

    Attributes
    ----------
    first : float
        x of its start [mm].
    last : float
        x of its end [mm].
    bending : float
        Its E I over the column's.
    pair : float
        E S over the column's E I, of the flanks' pair of forces.
    """

    first: float
    last: float
    bending: float
    pair: float = 0.0


def column_factors(
    force: AxialForce,
    stiffness: float,
    *,
    held: Sequence[float] = (),
    built_in: Sequence[float] = (),
    stretches: Sequence[Stretch] = (),
) -> Real:
    """Return the factor on the force at which a column buckles; infinite where none does, NaN where it is unknown.

    Parameters
    ----------
    force : AxialForce
        Along the column in P poses.
    stiffness : float
        E I [N·mm²].
    held : sequence of float, optional
        x where the column is held in place, free to turn [mm].
    built_in : sequence of float, optional
        x where it is held in place and in its angle [mm].
    stretches : sequence of Stretch, optional
        Of another stiffness; they do not overlap.

    Returns
    -------
    ndarray, shape (P,)
        Factors.
    """
    supports = sorted({*held, *built_in})
    nodes = _nodes(force, supports, [x for stretch in stretches for x in (stretch.first, stretch.last)])
    start, length = nodes[0], nodes[-1] - nodes[0]
    sizes = np.diff(nodes) / length
    unknown = np.asarray(np.isnan(force.values).any(axis=(0, 1)))
    known = AxialForce(breaks=force.breaks, values=np.where(unknown, 0.0, force.values))
    stations = start + (nodes[:-1, None] - start) + (sizes[:, None] * GAUSS[0]) * length
    pressed = known.at(stations.ravel()).reshape(*stations.shape, -1)
    count = 2 * len(nodes)
    K, G = stiffness_matrices(nodes, pressed, stretches)
    fixed = [2 * int(np.argmin(np.abs(nodes - x))) for x in supports]
    fixed += [2 * int(np.argmin(np.abs(nodes - x))) + 1 for x in built_in]
    free = np.setdiff1d(np.arange(count), fixed)
    inverse = np.linalg.inv(np.linalg.cholesky(K[np.ix_(free, free)]))
    largest = np.linalg.eigvalsh(inverse @ G[:, free[:, None], free] @ inverse.T)[:, -1]
    size = np.abs(known.values).max(axis=(0, 1))
    buckles = largest > NOTHING * size
    factor = np.where(buckles, stiffness / (length**2 * np.where(buckles, largest, 1.0)), math.inf)
    return np.where(unknown, np.nan, factor)


def stiffness_matrices(nodes: Real, pressed: Real, stretches: Sequence[Stretch]) -> tuple[Real, Real]:
    """Return the bending stiffness and what compression takes of it, by deflections and slopes at the nodes.

    Lengths are counted in whole lengths L of the column.

    Parameters
    ----------
    nodes : ndarray, shape (n,)
        Of the mesh [mm].
    pressed : ndarray, shape (n - 1, 4, P)
        Compression at the elements' Gauss points [N].
    stretches : sequence of Stretch
        Of another stiffness.

    Returns
    -------
    tuple of 2 ndarray
        K (2n, 2n), in E I/L², and G (P, 2n, 2n) [N].
    """
    length = nodes[-1] - nodes[0]
    sizes, (points, weights) = np.diff(nodes) / length, GAUSS
    count = 2 * len(nodes)
    K, G = np.zeros((count, count)), np.zeros((pressed.shape[2], count, count))
    bent, slope = _bending(sizes), slopes(sizes[:, None], points)
    softened = np.einsum("egp,eg,egi,egj->epij", pressed, weights * sizes[:, None], slope, slope, optimize=True)
    for e in range(len(sizes)):
        own, middle = slice(2 * e, 2 * e + 4), (nodes[e] + nodes[e + 1]) / 2.0
        soft = next((stretch for stretch in stretches if stretch.first < middle < stretch.last), None)
        K[own, own] += (1.0 if soft is None else soft.bending) * bent[e]
        G[:, own, own] += softened[e]
    for stretch in stretches:
        ends = [2 * int(np.argmin(np.abs(nodes - x))) + 1 for x in (stretch.first, stretch.last)]
        pair = stretch.pair * length / (stretch.last - stretch.first)
        K[np.ix_(ends, ends)] += pair * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return K, G


def _nodes(force: AxialForce, supports: Sequence[float], others: Sequence[float]) -> Real:
    """Nodes of the mesh (n,): supports, ends, others and, unless too near, where the force is no one parabola."""
    first, last = min(force.breaks[0], *supports, *others), max(force.breaks[-1], *supports, *others)
    length = last - first
    marks = list(supports)
    for x in (first, last, *others, *force.breaks):
        if all(abs(x - mark) > MERGED * length for mark in marks):
            marks.append(float(x))
    found = [min(marks)]
    for a, b in itertools.pairwise(sorted(marks)):
        found += list(np.linspace(a, b, max(2, math.ceil(ELEMENTS * (b - a) / length)) + 1)[1:])
    return np.array(found)


def _bending(h: Real) -> Real:
    """∫v''² (n, 4, 4) of cubic elements of lengths h (n,), by deflection and slope at their ends."""
    one = np.ones_like(h)
    rows = [
        [12.0 * one, 6.0 * h, -12.0 * one, 6.0 * h],
        [6.0 * h, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
        [-12.0 * one, -6.0 * h, 12.0 * one, -6.0 * h],
        [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
    ]
    return np.asarray(np.moveaxis(np.array(rows), -1, 0) / h[:, None, None] ** 3)


def slopes(h: ArrayLike, t: Real) -> Real:
    """Return the slopes of the shape functions of a cubic element, by deflection and slope at its ends.

    Parameters
    ----------
    h : array
        Length of the element.
    t : ndarray
        Shares of it; both broadcast.

    Returns
    -------
    ndarray, shape (..., 4)
        Slopes.
    """
    across = 6.0 * t * (1.0 - t) / np.asarray(h)
    first, last = (np.broadcast_to(one, across.shape) for one in (1.0 - 4.0 * t + 3.0 * t**2, 3.0 * t**2 - 2.0 * t))
    return np.stack([-across, first, across, last], axis=-1)
