"""What a part covers as it is seen along its pins, in pieces: each between two heights z."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from alula.geometry.base.outline import Outline
from alula.geometry.bodies.features import Pin, Ring
from alula.geometry.bodies.kernel import Border

Place = tuple[float, float]

_STEP = math.radians(2.0)
"""Longest stretch of an arc for which a chord stands: it lies off the arc by 1.5e-4 of the radius."""


@dataclass(frozen=True, kw_only=True)
class Footprint:
    """All that lies within a distance of a point, a line or a polygon, between two heights.

    Attributes
    ----------
    corners : tuple of (float, float)
        (x, y) in the link's frame: one of a point, two of a line, more of a polygon [mm].
    low, high : float
        z between which its material lies, from the mid-plane of the part [mm].
    radius : float
        The distance [mm]; 0 for the polygon alone.
    holes : tuple of tuple of (float, float)
        Corners of what is cut out of a polygon [mm].
    error : float
        How far its border may lie off that of the part, where chords stand for arcs [mm].
    """

    corners: tuple[Place, ...]
    low: float
    high: float
    radius: float = 0.0
    holes: tuple[tuple[Place, ...], ...] = ()
    error: float = 0.0


def strip(start: Place, angle: float, length: float, width: float, height: float) -> Footprint:
    """Return a straight piece of even width.

    Parameters
    ----------
    start : tuple of float
        Where its axis begins [mm].
    angle : float
        Direction of its axis [rad].
    length, width, height : float
        Sizes; half of the height lies on either side of the mid-plane [mm].

    Returns
    -------
    Footprint
        A rectangle.
    """
    c, s, half = math.cos(angle), math.sin(angle), width / 2.0
    at = [(0.0, -half), (length, -half), (length, half), (0.0, half)]
    corners = tuple((start[0] + c * x - s * y, start[1] + s * x + c * y) for x, y in at)
    return Footprint(corners=corners, low=-height / 2.0, high=height / 2.0)


def eye(pin: Pin, ring: Ring, diameter: float) -> tuple[Footprint, ...]:
    """Return the round of material about a hole, or the long one about a slot.

    Parameters
    ----------
    pin : Pin
        The hole.
    ring : Ring
        What tells between which heights it lies.
    diameter : float
        Of the round [mm].

    Returns
    -------
    tuple of Footprint
        One for each of the ring's walls.
    """
    corners = tuple((x, pin.y) for x in dict.fromkeys(pin.span))
    return tuple(Footprint(corners=corners, radius=diameter / 2.0, low=low, high=high) for low, high in ring.walls)


def arc(centre: Place, radius: float, start: float, sweep: float) -> list[Place]:
    """Return points on an arc, both ends included.

    Parameters
    ----------
    centre : tuple of float
        [mm]
    radius : float
        [mm]
    start, sweep : float
        Direction of its first point from the centre, and the angle to its last one [rad].

    Returns
    -------
    list of (float, float)
        [mm]
    """
    count = max(math.ceil(abs(sweep) / _STEP), 1)
    turns = [start + sweep * k / count for k in range(count + 1)]
    return [(centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn)) for turn in turns]


def _off(radius: float) -> float:
    """How far a chord lies off an arc."""
    return abs(radius) * (1.0 - math.cos(_STEP / 2.0))


def of_outlines(around: Outline, holes: Sequence[Outline], height: float) -> Footprint:
    """Return a flat piece with a smooth outline.

    Parameters
    ----------
    around : Outline
        Of the piece.
    holes : sequence of Outline
        What is cut out of it.
    height : float
        Half of it lies on either side of the mid-plane [mm].

    Returns
    -------
    Footprint
        A polygon.
    """

    def points(of: Outline) -> tuple[Place, ...]:
        return tuple(p for a in of.arcs for p in arc((a.x, a.y), a.radius, a.start, a.end - a.start))

    radii = [a.radius for one in (around, *holes) for a in one.arcs]
    cut, half = tuple(map(points, holes)), height / 2.0
    return Footprint(corners=points(around), holes=cut, low=-half, high=half, error=max(map(_off, radii)))


def of_border(border: Border, height: float) -> Footprint:
    """Return a flat piece with a border of lines and arcs.

    Parameters
    ----------
    border : Border
        Where each piece of it starts, and the middle of an arc.
    height : float
        Half of it lies on either side of the mid-plane [mm].

    Returns
    -------
    Footprint
        A polygon.
    """
    corners: list[Place] = []
    largest = 0.0
    for (start, middle), (end, _) in zip(border, [*border[1:], border[0]], strict=True):
        corners.append(start)
        if middle is None:
            continue
        # The circle through three points: its centre is equally far from all of them.
        (bx, by), (cx, cy) = ((p[0] - start[0], p[1] - start[1]) for p in (middle, end))
        twice = 2.0 * (bx * cy - by * cx)
        b, c = bx * bx + by * by, cx * cx + cy * cy
        x, y = start[0] + (cy * b - by * c) / twice, start[1] + (bx * c - cx * b) / twice
        first, last = (math.atan2(p[1] - y, p[0] - x) for p in (start, end))
        sweep = (last - first) % (2.0 * math.pi) - (0.0 if twice > 0.0 else 2.0 * math.pi)
        corners += arc((x, y), math.dist((x, y), start), first, sweep)[1:-1]
        largest = max(largest, math.dist((x, y), start))
    return Footprint(corners=tuple(corners), low=-height / 2.0, high=height / 2.0, error=_off(largest))
