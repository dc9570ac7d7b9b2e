"""How far outlines reach along the global axes over a motion.

Between two poses a point of an outline reaches beyond its places at both by no more than an eighth of its largest
acceleration by the coordinate, times the distance of the poses squared. Poses are put in between until that bound is
close to what was found.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.ties import first_largest
from alula.geometry.clearance.least import POSES, Spot
from alula.geometry.clearance.shape import Shape
from alula.geometry.linkage.placement import Placement

Real = NDArray[np.float64]
Standing = tuple[Shape, Spot]
"""An outline, and where it stands."""


@dataclass(frozen=True, kw_only=True)
class Outermost:
    """How far outlines reach to one side.

    Attributes
    ----------
    value : float
        Coordinate of the outermost place along the axis [mm].
    less, more : float
        How much less, and how much further out they may reach: between poses, and where chords stand for arcs [mm].
    name : str
        The outline that reaches there, such as ``link AE``.
    at : float or None
        Coordinate of the motion there [rad, mm]; None for a single pose, and along z, where nothing moves.
    """

    value: float
    less: float
    more: float
    name: str
    at: float | None


_ROUNDS = 60
Sides = tuple[tuple[Outermost, Outermost], ...]
"""To the side of small values and to that of large ones, along x, y and z."""


def reaches_at(outlines: Sequence[Standing], place: Placement) -> Sides:
    """Return how far outlines reach at a single pose.

    Parameters
    ----------
    outlines : sequence of (Shape, Spot)
        At least one.
    place : Placement
        The pose, as one of one.

    Returns
    -------
    tuple of (Outermost, Outermost)
        Along x, y and z: to the side of small values, and to that of large ones.
    """
    found = _far(outlines, place)
    return _told(outlines, found, None, found[2].max(axis=(0, 2)))


def reaches(outlines: Sequence[Standing], at: Callable[[Real], Placement], start: Real, *, near: float) -> Sides:
    """Return how far outlines reach over a motion.

    Parameters
    ----------
    outlines : sequence of (Shape, Spot)
        At least one.
    at : callable
        Takes values (n,) of the coordinate to the poses there, with rates by the coordinate.
    start : array
        Values of the coordinate to begin with, from the first pose to the last [rad, mm].
    near : float
        How close the bound must come to what is found [mm].

    Returns
    -------
    tuple of (Outermost, Outermost)
        As of ``reaches_at``.
    """
    s, place = start, at(start)
    found, bends = _far(outlines, place), _bends(outlines, place)
    for _ in range(_ROUNDS):
        open_yet = _between(s, found[2], bends) - found[2].max(axis=(0, 2))[:, None] > near
        k = np.flatnonzero(open_yet.any(axis=0))[: POSES - len(s)]
        if not k.size:
            break
        middles = (s[k] + s[k + 1]) / 2.0
        place, s = at(middles), np.insert(s, k + 1, middles)
        found = np.insert(found, k + 1, _far(outlines, place), axis=-1)
        bends = np.insert(bends, k + 1, _bends(outlines, place), axis=-1)
    return _told(outlines, found, s, _between(s, found[2], bends).max(axis=1))


def _far(outlines: Sequence[Standing], place: Placement) -> Real:
    """Return how far each outline reaches along -x, +x, -y and +y: at least, by its chords, and at most.

    Its shape is (3, outlines, 4, poses) [mm].
    """
    found = np.full((3, len(outlines), 4, len(place.q)), -np.inf)
    for i, (shape, spot) in enumerate(outlines):
        turn, origin = place.direction(spot.link)[:, None], spot.origin(place)[:, None]
        for core in shape.cores:
            places = turn * core.corners + origin
            for k, along in enumerate((-places.real, places.real, -places.imag, places.imag)):
                reach = along.max(axis=1) + core.radius
                for which, error in enumerate((-core.error, 0.0, core.error)):
                    found[which, i, k] = np.maximum(found[which, i, k], reach + error)
    return found


def _bends(outlines: Sequence[Standing], place: Placement) -> Real:
    """Return the largest acceleration of any point of each outline by the coordinate, (outlines, poses)."""
    found = []
    for shape, spot in outlines:
        centre, reach = shape.circle
        turning = np.abs(place.spin_rate(spot.link)) + place.spin(spot.link) ** 2
        around = reach if spot.point is None else 0.0  # a pin that turns looks the same
        found.append(np.abs(spot.acceleration(place, centre)) + turning * around)
    return np.array(found)


def _between(s: Real, outer: Real, bends: Real) -> Real:
    """Return how far the outlines reach at most between each two poses, (4, n - 1)."""
    rise = np.maximum(bends[:, 1:], bends[:, :-1]) * np.diff(s) ** 2 / 8.0
    return np.asarray((np.maximum(outer[..., 1:], outer[..., :-1]) + rise[:, None]).max(axis=0))


def _told(outlines: Sequence[Standing], found: Real, s: Real | None, most: Real) -> Sides:
    sides = []
    for k in range(4):
        own = found[1, :, k]
        i, pose = np.unravel_index(first_largest(np.ravel(own)), own.shape)
        value, least = float(own.max()), float(found[0, :, k].max())
        name, at = outlines[int(i)][0].name, None if s is None else float(s[pose])
        coordinate = value if k % 2 else -value
        sides.append(Outermost(value=coordinate, less=value - least, more=float(most[k]) - value, name=name, at=at))
    shapes = [shape for shape, _ in outlines]
    lowest, highest = min(shapes, key=lambda shape: shape.low), max(shapes, key=lambda shape: shape.high)
    for value, name in ((lowest.low, lowest.name), (highest.high, highest.name)):
        sides.append(Outermost(value=value, less=0.0, more=0.0, name=name, at=None))
    return tuple((sides[k], sides[k + 1]) for k in (0, 2, 4))
