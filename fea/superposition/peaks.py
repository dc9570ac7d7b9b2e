"""Largest number of a link under each of many loads, found among all nodes from those of a few modes.

The von Mises stress is the length of five numbers that are linear in the stress, a displacement of three, the stress on
layers at most the length of three, the largest principal stress at most the mean stress plus 2/3 of the von Mises
stress. All are convex and grow in proportion to the load, hence f(A + B) ≤ f(A) + f(B). Loads of a motion change little
from pose to pose. So they are taken in short runs: each load of a run is a mean of the loads at its ends plus a rest,
and its number at most the larger of theirs plus that of the rest, which is at most the sum of the modes' own numbers
times their coefficients. Only nodes that by this bound may bear the peak are looked at under every load of a run.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from alula.fea.solid.layers import Layers
from alula.fea.solid.stress import extreme_principal, principal

Real = NDArray[np.float64]
Nodes = NDArray[np.int64]

_BLOCK = 1_000_000
"""Numbers in a block of products: 8 MB."""
_RUN = 8
"""Loads from one end of a run to the other. Measured on a bar of 9,400 nodes over a crank's turn in 361 poses: with 4,
8 and 16 loads 38, 112 and 329 nodes are left for a run, and the ends take 0.67, 0.26 and 0.06 s."""
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Peaks:
    """The largest number of all nodes under each of N loads.

    Attributes
    ----------
    value : ndarray, shape (N,)
        [MPa or mm]
    node : ndarray of int, shape (N,)
        Where it is.
    """

    value: Real
    node: Nodes


@dataclass(frozen=True, kw_only=True, eq=False)
class ModeMeasures:
    """A number of every node under sums of m modes: the length of a few numbers that are linear in them.

    Such are the displacement, and the von Mises stress (``deviator``).

    Attributes
    ----------
    parts : ndarray, shape (nodes, k, m)
        The numbers whose length it is [MPa or mm].
    """

    parts: Real

    @cached_property
    def sizes(self) -> Real:
        """What neither a mode by itself nor its opposite exceeds (nodes, m)."""
        return np.asarray(np.sqrt(np.einsum("kim,kim->km", self.parts, self.parts)))

    def bounds(self, nodes: Nodes, combination: Real) -> Real:
        """Return what the numbers of some nodes do not exceed.

        Parameters
        ----------
        nodes : ndarray of int, shape (k,)
        combination : ndarray, shape (m, n)
            Of the modes under n loads.

        Returns
        -------
        ndarray, shape (k, n)
        """
        products = _products(self.parts[nodes], combination)
        return np.asarray(np.sqrt(np.einsum("kin,kin->kn", products, products)))

    def at(self, nodes: Nodes, combination: Real) -> Real:
        """Return the numbers of some nodes.

        Parameters
        ----------
        nodes, combination
            As of ``bounds``.

        Returns
        -------
        ndarray, shape (k, n)
        """
        return self.bounds(nodes, combination)

    def largest(self, nodes: Nodes, combination: Real) -> Peaks:
        """Return the largest of some nodes under a few loads.

        Parameters
        ----------
        nodes, combination
            As of ``bounds``.

        Returns
        -------
        Peaks
        """
        found = self.at(nodes, combination)
        best = np.argmax(found, axis=0)
        return Peaks(value=np.take_along_axis(found, best[None], axis=0)[0], node=nodes[best])

    def most(self, combination: Real) -> Real:
        """Return the largest number of all nodes, which are few, under any number of loads.

        Parameters
        ----------
        combination : ndarray, shape (m, n)
            Of the modes under n loads.

        Returns
        -------
        ndarray, shape (n,)
        """
        nodes, count = np.arange(len(self.parts)), combination.shape[1]
        step = max(1, 2 * _BLOCK // (self.parts.shape[1] * len(nodes)))
        blocks = [combination[:, first : first + step] for first in range(0, count, step)]
        return np.concatenate([self.at(nodes, block).max(axis=0) for block in blocks])

    def near(self, combination: Real, share: float) -> Self:
        """Return the numbers of the nodes alone that come near to the peak under one of the loads.

        Parameters
        ----------
        combination : ndarray, shape (m, n)
            Of the modes under n loads.
        share : float
            Of the peak by which they may lie below it.

        Returns
        -------
        ModeMeasures
        """
        nodes = np.arange(len(self.parts))
        blocks = _blocks(nodes, self.parts.shape[1] * combination.shape[1])
        values = np.concatenate([self.at(block, combination) for block in blocks])
        hot = (values >= (1.0 - share) * values.max(axis=0)).any(axis=1)
        return replace(self, **{name: part[hot] for name, part in vars(self).items() if name in ("parts", "stress")})


@dataclass(frozen=True, kw_only=True, eq=False)
class TensionMeasures(ModeMeasures):
    """The largest principal stress; the parts are those of the von Mises stress.

    Attributes
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].
    """

    stress: Real

    @cached_property
    def mean(self) -> Real:
        """Mean of the direct stresses (nodes, m) [MPa]."""
        return np.asarray(self.stress[:, :3].mean(axis=1))

    @cached_property
    def sizes(self) -> Real:
        """What neither a mode by itself nor its opposite exceeds (nodes, m)."""
        return np.asarray(np.abs(self.mean) + 2.0 / 3.0 * ModeMeasures(parts=self.parts).sizes)

    def bounds(self, nodes: Nodes, combination: Real) -> Real:
        """Return the mean stress plus 2/3 of the von Mises stress.

        Parameters
        ----------
        nodes, combination
            As of ``ModeMeasures``.

        Returns
        -------
        ndarray
        """
        return np.asarray(self.mean[nodes] @ combination + 2.0 / 3.0 * super().bounds(nodes, combination))

    def at(self, nodes: Nodes, combination: Real) -> Real:
        """Return the largest principal stress, to about 1e-8.

        Parameters
        ----------
        nodes, combination
            As of ``ModeMeasures``.

        Returns
        -------
        ndarray
        """
        return extreme_principal(_products(self.stress[nodes], combination).swapaxes(1, 2))[0]

    def largest(self, nodes: Nodes, combination: Real) -> Peaks:
        """Return the largest of some nodes, exact where it is.

        Parameters
        ----------
        nodes, combination
            As of ``ModeMeasures``.

        Returns
        -------
        Peaks
        """
        node = super().largest(nodes, combination).node
        return Peaks(value=principal(np.einsum("nim,mn->ni", self.stress[node], combination))[:, 0], node=node)


class LayerMeasures(ModeMeasures):
    """The stress on layers: the length of shear along them and of tension across them; compression counts as none."""

    def at(self, nodes: Nodes, combination: Real) -> Real:
        """Return the stress on the layers.

        Parameters
        ----------
        nodes, combination
            As of ``ModeMeasures``.

        Returns
        -------
        ndarray
        """
        tension, *shear = np.moveaxis(_products(self.parts[nodes], combination), 1, 0)
        return np.asarray(np.sqrt(np.maximum(tension, 0.0) ** 2 + sum(part**2 for part in shear)))


def of_stress(stress: Real, *, brittle: bool, layers: Layers | None = None) -> ModeMeasures:
    """Return the numbers of the stress of modes.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].
    brittle : bool
        True for the largest principal stress, False for the von Mises stress.
    layers : Layers, optional
        For the stress on them in place of either.

    Returns
    -------
    ModeMeasures
    """
    if layers is not None:
        return LayerMeasures(parts=layers.parts(stress))
    parts = deviator(stress)
    return TensionMeasures(parts=parts, stress=stress) if brittle else ModeMeasures(parts=parts)


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

    ends: Nodes
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


def largest(modes: ModeMeasures, combination: Real) -> Peaks:
    """Return the largest number of all nodes under each load.

    Parameters
    ----------
    modes : ModeMeasures
    combination : ndarray, shape (m, N)
        Of the modes under N loads.

    Returns
    -------
    Peaks
    """
    runs, count = _Runs.of(combination), combination.shape[1]
    ends, least = combination[:, runs.ends], None
    value, node = np.full(count, -np.inf), np.zeros(count, dtype=np.int64)

    def look(nodes: Nodes, loads: slice) -> None:
        found = modes.largest(nodes, combination[:, loads])
        better = found.value > value[loads]
        value[loads][better], node[loads][better] = found.value[better], found.node[better]

    order = np.argsort(-(modes.sizes @ np.abs(combination).max(axis=1)))
    left: list[list[Nodes]] = [[] for _ in runs.ends[1:]]
    for block in _blocks(order, modes.parts.shape[1] * len(runs.ends)):
        at_ends = modes.bounds(block, ends)
        if least is None:  # the nodes that are hottest at the ends of each run
            hottest = block[np.argmax(at_ends, axis=0)]
            for run in range(len(left)):
                look(np.unique(hottest[run : run + 2]), runs.loads(run))
            least = np.array([value[runs.loads(run)].min() for run in range(len(left))])
            least -= _ROUNDING * np.abs(least)
        may = runs.bounds(at_ends, modes.sizes[block]) >= least
        for run in np.flatnonzero(may.any(axis=0)).tolist():
            left[run].append(block[may[:, run]])
    for run, nodes in enumerate(left):
        look(np.concatenate([order[:1], *nodes]), runs.loads(run))
    return Peaks(value=value, node=node)


def _blocks(numbers: Nodes, width: int) -> Iterator[Nodes]:
    """Parts of nodes or loads whose products, of some numbers for each, are not too large."""
    step = max(1, _BLOCK // width)
    for start in range(0, len(numbers), step):
        yield numbers[start : start + step]


def _products(linear: Real, combination: Real) -> Real:
    """Sums (nodes, k, n) of what is linear in modes (nodes, k, m)."""
    nodes, k, m = linear.shape
    return np.asarray((linear.reshape(nodes * k, m) @ combination).reshape(nodes, k, -1))


def signed_bounds(modes: ModeMeasures, combination: Real) -> tuple[Real, Real]:
    """Return bounds between which the signed stress of each node stays under all loads.

    It is at most the largest principal stress and at least the smallest one, for ductile materials of the size of the
    von Mises stress.

    Parameters
    ----------
    modes : ModeMeasures
        Of the largest principal or the von Mises stress.
    combination : ndarray, shape (m, N)
        Of the modes under N loads.

    Returns
    -------
    tuple of 2 ndarray, shape (nodes,)
        The lower and the upper bound [MPa].
    """
    runs, count = _Runs.of(combination), len(modes.parts)
    ends = combination[:, runs.ends]
    low, high = np.empty((2, count))
    for block in _blocks(np.arange(count), modes.parts.shape[1] * len(runs.ends)):
        own = modes.sizes[block]
        high[block] = runs.bounds(modes.bounds(block, ends), own).max(axis=1)
        signed = isinstance(modes, TensionMeasures)
        low[block] = -(runs.bounds(modes.bounds(block, -ends), own).max(axis=1) if signed else high[block])
    return low, high
