"""Largest stress of a link under each of many loads, found among all nodes from the stresses of a few modes.

The von Mises stress is the length of five numbers that are linear in the stress, the largest principal stress at most
the mean stress plus 2/3 of it. Both are convex and grow in proportion to the load, hence f(A + B) ≤ f(A) + f(B). Loads
of a motion change little from pose to pose. So they are taken in short runs: each load of a run is a mean of the loads
at its ends plus a rest, and its stress at most the larger of theirs plus that of the rest, which is at most the sum of
the modes' own stresses times their coefficients. Only nodes that by this bound may bear the peak are looked at under
every load of a run.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.solid.layers import Layers
from alula.fea.solid.stress import principal, von_mises

Real = NDArray[np.float64]

_BLOCK = 1_000_000
"""Numbers in a block of products: 8 MB."""
_RUN = 8
"""Loads from one end of a run to the other. Measured on a bar of 9,400 nodes over a crank's turn in 361 poses: with 4,
8 and 16 loads 38, 112 and 329 nodes are left for a run, and the ends take 0.67, 0.26 and 0.06 s."""
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Peaks:
    """Largest stress of all nodes under each of N loads.

    Attributes
    ----------
    value : ndarray, shape (N,)
        [MPa]
    node : ndarray of int, shape (N,)
        Where it is.
    """

    value: Real
    node: NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Runs:
    """Loads in runs.

    Attributes
    ----------
    ends : ndarray of int, shape (runs + 1,)
        Loads at which runs begin and end.
    rest : ndarray, shape (m, runs)
        Largest coefficients, by size, of what a run's loads differ by from means of its ends.
    """

    ends: NDArray[np.int64]
    rest: Real

    @classmethod
    def of(cls, combination: Real) -> "_Runs":
        """Part the loads of a combination (m, N)."""
        last = combination.shape[1] - 1
        ends = np.append(np.arange(0, max(last, 1), _RUN), last)
        load = np.arange(last + 1)
        run = np.minimum(load // _RUN, len(ends) - 2)
        first, second = ends[run], ends[run + 1]
        share = (load - first) / np.maximum(second - first, 1)
        rest = np.abs(combination - (1.0 - share) * combination[:, first] - share * combination[:, second])
        return cls(ends=ends, rest=np.maximum.reduceat(rest, ends[:-1], axis=1))

    def loads(self, run: int) -> slice:
        """Numbers of a run's loads, both ends included."""
        return slice(int(self.ends[run]), int(self.ends[run + 1]) + 1)

    def bounds(self, at_ends: Real, own: Real) -> Real:
        """Upper bounds (nodes, runs) from the values at the ends (nodes, runs + 1) and those of modes (nodes, m)."""
        return np.maximum(at_ends[:, :-1], at_ends[:, 1:]) + own @ self.rest


def deviator(stress: Real) -> Real:
    """Return five numbers, linear in the stress, whose length is the von Mises stress.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].

    Returns
    -------
    ndarray, shape (nodes, 5, m)
        [MPa]
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(stress, 1, 0)
    root = np.sqrt(3.0)
    return np.stack([root / 2.0 * (xx - yy), (xx + yy) / 2.0 - zz, root * xy, root * yz, root * xz], axis=1)


def largest_stress(modes: "ModeMeasures", combination: Real, *, brittle: bool, layers: Layers | None = None) -> Peaks:
    """Return the largest stress of all nodes under each load.

    Parameters
    ----------
    modes : ModeMeasures
    combination : ndarray, shape (m, N)
        Of the modes under N loads.
    brittle : bool
        True for the largest principal stress, False for the von Mises stress.
    layers : Layers, optional
        For the stress on them in place of either; the modes' parts are theirs then.

    Returns
    -------
    Peaks
    """
    runs, search = _Runs.of(combination), _Search(modes.stress, combination, brittle=brittle, layers=layers)
    length = 2.0 / 3.0 if brittle else 1.0
    own = (np.abs(modes.mean) if brittle else 0.0) + length * modes.sizes
    ends, least = combination[:, runs.ends], None
    order = np.argsort(-(own @ np.abs(combination).max(axis=1)))
    left: list[list[NDArray[np.int64]]] = [[] for _ in runs.ends[1:]]
    for block in _blocks(order, 5 * len(runs.ends)):
        at_ends = length * np.sqrt(_squares(modes.parts[block], ends))
        if brittle:
            at_ends += modes.mean[block] @ ends
        if least is None:
            search.begin(runs, block[np.argmax(at_ends, axis=0)])
            least = np.array([search.value[runs.loads(run)].min() for run in range(len(left))])
            least -= _ROUNDING * np.abs(least)
        may = runs.bounds(at_ends, own[block]) >= least
        for run in np.flatnonzero(may.any(axis=0)).tolist():
            left[run].append(block[may[:, run]])
    for run, nodes in enumerate(left):
        search.look(np.concatenate([order[:1], *nodes]), runs.loads(run))
    return Peaks(value=search.value, node=search.node)


class _Search:
    """The largest stress found so far under each load."""

    def __init__(self, stress: Real, combination: Real, *, brittle: bool, layers: Layers | None) -> None:
        self._stress, self._combination, self._brittle, self._layers = stress, combination, brittle, layers
        count = combination.shape[1]
        self.value, self.node = np.full(count, -np.inf), np.zeros(count, dtype=np.int64)

    def begin(self, runs: _Runs, hottest: NDArray[np.int64]) -> None:
        """Look at the nodes that are hottest at the ends of each run."""
        for run in range(len(runs.ends) - 1):
            self.look(np.unique(hottest[run : run + 2]), runs.loads(run))

    def look(self, nodes: NDArray[np.int64], loads: slice) -> None:
        """Evaluate the stress of nodes (k,) under some loads."""
        k, m = len(nodes), self._stress.shape[2]
        sigma = (self._stress[nodes].reshape(6 * k, m) @ self._combination[:, loads]).reshape(k, 6, -1).swapaxes(1, 2)
        found = von_mises(sigma) if self._layers is None else self._layers.stress(sigma)
        if self._brittle:
            bound = sigma[..., :3].mean(axis=-1) + 2.0 / 3.0 * found
            near = bound + _ROUNDING * np.abs(bound) >= self.value[loads]
            found = np.full(near.shape, -np.inf)
            found[near] = principal(sigma[near])[:, 0]
        best = np.argmax(found, axis=0)
        largest = np.take_along_axis(found, best[None], axis=0)[0]
        better = largest > self.value[loads]
        self.value[loads][better], self.node[loads][better] = largest[better], nodes[best[better]]


def _blocks(nodes: NDArray[np.int64], width: int) -> Iterator[NDArray[np.int64]]:
    """Parts of the nodes whose products, of some numbers for each, are not too large."""
    step = max(1, _BLOCK // width)
    for start in range(0, len(nodes), step):
        yield nodes[start : start + step]


def _squares(parts: Real, combination: Real) -> Real:
    """Squared von Mises stresses (nodes, N) from the deviators (nodes, 5, m) of modes."""
    nodes, count, m = parts.shape
    products = (parts.reshape(nodes * count, m) @ combination).reshape(nodes, count, -1)
    return np.asarray(np.einsum("kin,kin->kn", products, products))


def mode_sizes(parts: Real) -> Real:
    """Return the von Mises stress of each mode by itself.

    Parameters
    ----------
    parts : ndarray, shape (nodes, 5, m)
        From ``deviator`` [MPa].

    Returns
    -------
    ndarray, shape (nodes, m)
        [MPa]
    """
    return np.asarray(np.sqrt(np.einsum("kim,kim->km", parts, parts)))


@dataclass(frozen=True, kw_only=True, eq=False)
class ModeMeasures:
    """Numbers of m modes from which bounds on their sums' stresses follow.

    Attributes
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].
    parts : ndarray, shape (nodes, 5, m)
        From ``deviator`` [MPa].
    sizes : ndarray, shape (nodes, m)
        Von Mises stress of each mode by itself [MPa].
    mean : ndarray, shape (nodes, m)
        Mean of the direct stresses [MPa].
    """

    stress: Real
    parts: Real
    sizes: Real
    mean: Real

    @classmethod
    def of(cls, stress: Real, layers: Layers | None = None) -> "ModeMeasures":
        """Return the numbers of modes.

        Parameters
        ----------
        stress : ndarray, shape (nodes, 6, m)
            Components [MPa].
        layers : Layers, optional
            For the stress on them in place of the von Mises stress.

        Returns
        -------
        ModeMeasures
        """
        parts = deviator(stress) if layers is None else layers.parts(stress)
        return cls(stress=stress, parts=parts, sizes=mode_sizes(parts), mean=stress[:, :3].mean(axis=1))


def signed_bounds(modes: ModeMeasures, combination: Real, *, brittle: bool) -> tuple[Real, Real]:
    """Return bounds between which the signed stress of each node stays under all loads.

    It is at most the largest principal stress and at least the smallest one, for ductile materials of the size of the
    von Mises stress.

    Parameters
    ----------
    modes : ModeMeasures
    combination : ndarray, shape (m, N)
        Of the modes under N loads.
    brittle : bool
        As for ``alula.fea.motion.fatigue.signed_stress``.

    Returns
    -------
    tuple of 2 ndarray, shape (nodes,)
        The lower and the upper bound [MPa].
    """
    runs = _Runs.of(combination)
    ends = combination[:, runs.ends]
    low, high = np.empty((2, len(modes.parts)))
    for block in _blocks(np.arange(len(low)), 5 * len(runs.ends)):
        size, own = np.sqrt(_squares(modes.parts[block], ends)), modes.sizes[block]
        if brittle:
            mean, own = modes.mean[block] @ ends, np.abs(modes.mean[block]) + 2.0 / 3.0 * own
            low[block], high[block] = (
                sign * runs.bounds(sign * mean + 2.0 / 3.0 * size, own).max(axis=1) for sign in (-1.0, 1.0)
            )
        else:
            high[block] = runs.bounds(size, own).max(axis=1)
            low[block] = -high[block]
    return low, high
