"""A balanced set of loads on a straight beam, in its link's frame, in one state or in n along a leading axis."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import shifted

Floats = NDArray[np.float64]
RECENT = 16
"""Beams whose loads and internal forces are kept: growth of bending and hand calculation ask for those of one link."""


def _frozen(values: ArrayLike, name: str, *shapes: int) -> Floats:
    """Return a read-only copy of a vector or of n, refused unless finite and of one of the given lengths."""
    array = np.array(values, dtype=np.float64)
    if array.ndim not in (1, 2) or array.shape[-1] not in shapes or not np.isfinite(array).all():
        raise CannotRunError(f"{name} {array.tolist()} must be {' or '.join(map(str, shapes))} finite numbers")
    array.setflags(write=False)
    return array


@dataclass(frozen=True, kw_only=True, eq=False)
class PointLoad:
    """A wrench at a point of the link, in the link's frame.

    Attributes
    ----------
    point : ndarray, shape (3,)
        x, y, z [mm] (two numbers mean z = 0); off the axis it adds the moment of its force.
    wrench : ndarray, shape (..., 6)
        Fx, Fy, Fz [N], Mx, My, Mz [N·mm].
    """

    point: Floats
    wrench: Floats

    def __post_init__(self) -> None:
        """Copy, complete and check the arrays."""
        point = _frozen(self.point, "the point of a load", 2, 3)
        object.__setattr__(self, "point", _frozen([*point, 0.0][:3], "the point of a load", 3))
        object.__setattr__(self, "wrench", _frozen(self.wrench, "the wrench of a load", 6))

    @cached_property
    def on_axis(self) -> Floats:
        """The same wrench (..., 6), reduced to the point (x, 0, 0) of the axis."""
        return shifted(self.wrench, np.array([0.0, self.point[1], self.point[2]]))


@dataclass(frozen=True, kw_only=True, eq=False)
class LineLoad:
    """A force per length on the axis, varying linearly between two stations.

    Attributes
    ----------
    start : float
        x [mm].
    end : float
        x beyond ``start`` [mm].
    first : ndarray, shape (..., 3)
        Force per length at the start, in the link's frame [N/mm].
    last : ndarray, shape (3,)
        The same at the end.
    """

    start: float
    end: float
    first: Floats
    last: Floats

    def __post_init__(self) -> None:
        """Copy and check the arrays."""
        if not (np.isfinite([self.start, self.end]).all() and self.start < self.end):
            raise CannotRunError(f"a line load from x = {self.start:g} mm to {self.end:g} mm needs start < end")
        object.__setattr__(self, "first", _frozen(self.first, "a line load", 3))
        object.__setattr__(self, "last", _frozen(self.last, "a line load", 3))

    @property
    def resultant(self) -> tuple[float, Floats]:
        """Station of the mean force's moment and wrench (..., 6) about it: the load as one wrench at mid-length.

        Force (first + last) L/2 at the middle, with the couple e_x × (last - first) L²/12.
        """
        length = self.end - self.start
        slope = (self.last - self.first) * length**2 / 12.0
        couple = np.stack([np.zeros(slope.shape[:-1]), -slope[..., 2], slope[..., 1]], axis=-1)
        force = (self.first + self.last) * length / 2.0
        return (self.start + self.end) / 2.0, np.concatenate([force, couple], axis=-1)


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamLoads:
    """All that acts on one link, joint forces included: a balanced set.

    Attributes
    ----------
    points : tuple of PointLoad
        Wrenches at points.
    lines : tuple of LineLoad
        Spread loads.
    """

    points: tuple[PointLoad, ...]
    lines: tuple[LineLoad, ...] = ()

    @cached_property
    def states(self) -> tuple[int, ...]:
        """Shape of the states: () for one, (n,) for n."""
        vectors = [p.wrench for p in self.points] + [q.first for q in self.lines]
        return np.broadcast_shapes(*(vector.shape[:-1] for vector in vectors))

    @cached_property
    def span(self) -> tuple[float, float]:
        """The x of the first and of the last loaded station [mm]."""
        stations = [float(p.point[0]) for p in self.points] + [x for q in self.lines for x in (q.start, q.end)]
        if not stations or min(stations) == max(stations):
            raise CannotRunError("a beam needs loads at two stations or more; give the point loads of every joint")
        return min(stations), max(stations)

    @cached_property
    def size(self) -> float:
        """Length scale for moments: the largest extent of the loaded points along any axis [mm]."""
        x0, x1 = self.span
        return max(x1 - x0, *(abs(float(end)) for p in self.points for end in p.point[1:]), 0.0)

    @cached_property
    def scale(self) -> Floats:
        """Sum (...) of the magnitudes of all loads [N], moments divided by ``size``."""
        total = np.zeros(self.states)
        for p in self.points:
            total = total + _size(p.wrench[..., :3]) + _size(p.wrench[..., 3:]) / self.size
        for q in self.lines:
            total = total + (_size(q.first) + _size(q.last)) / 2.0 * (q.end - q.start)
        return total

    @cached_property
    def resultant(self) -> Floats:
        """The wrench (..., 6) of all loads about the middle of the span [N, N·mm]; zero where they balance."""
        middle = sum(self.span) / 2.0
        total = np.zeros((*self.states, 6))
        wrenches = [(float(p.point[0]), p.on_axis) for p in self.points] + [q.resultant for q in self.lines]
        for x, wrench in wrenches:
            total += wrench
            total[..., 4] -= (x - middle) * wrench[..., 2]
            total[..., 5] += (x - middle) * wrench[..., 1]
        return total

    @property
    def imbalance(self) -> Floats:
        """Resultant (...) over the sum of the loads' magnitudes (moments over ``size``)."""
        larger = np.maximum(_size(self.resultant[..., :3]), _size(self.resultant[..., 3:]) / self.size)
        return np.asarray(larger / np.where(self.scale > 0.0, self.scale, 1.0))


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
