"""The outline of a link or a pin in the plane, in pieces between two heights, and the gap between two of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.ties import first_least
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.footprint import Footprint

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

TOUCHING = 1e-9
"""Share of two heights' range by which slabs that lie on each other may overlap by rounding."""
_ROUNDING = 1e-9
"""Share of its size by which a circle about a piece is wider than needed, for what rounding makes of distances."""
_SEGMENTS = 32
"""Chords of a quarter turn where a circle must be a polygon."""
_CHORD = 1.0 - np.cos(np.pi / (4.0 * _SEGMENTS))
"""How far these lie off the circle, over its radius."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Core:
    """All that lies within a radius of a geometry, between two heights.

    Attributes
    ----------
    geometry : shapely geometry
        Point, line or polygon in the frame of its link [mm].
    radius : float
        [mm]
    low, high : float
        z of the assembly between which it lies [mm].
    error : float
        How far its border may lie off that of the part [mm].
    """

    geometry: Any
    radius: float
    low: float
    high: float
    error: float

    @property
    def polygon(self) -> Any:
        """The whole as a polygon."""
        return self.geometry.buffer(self.radius, quad_segs=_SEGMENTS) if self.radius else self.geometry

    @cached_property
    def corners(self) -> Complex:
        """Corners (n,) of the geometry's convex hull, which reach furthest to any side [mm]."""
        import shapely

        at = shapely.get_coordinates(self.geometry.convex_hull)
        return np.asarray(at[:, 0] + 1j * at[:, 1])

    @cached_property
    def circle(self) -> tuple[complex, float]:
        """Centre and radius of a circle about all of it, a little wider than it is [mm]."""
        at = self.corners
        centre = complex((at.real.min() + at.real.max()) / 2.0, (at.imag.min() + at.imag.max()) / 2.0)
        return centre, (1.0 + _ROUNDING) * (float(np.abs(at - centre).max()) + self.radius + abs(centre)) - abs(centre)


@dataclass(frozen=True, kw_only=True, eq=False)
class Shape:
    """The outline of a link or a pin.

    Attributes
    ----------
    name : str
        ``link AE`` or ``pin B``.
    cores : tuple of Core
        Its pieces.
    """

    name: str
    cores: tuple[Core, ...]

    @cached_property
    def circle(self) -> tuple[complex, float]:
        """Centre and radius of a circle about all of it [mm]."""
        import shapely

        corners = [(shapely.get_coordinates(core.geometry), core.radius) for core in self.cores]
        low = np.min([at.min(axis=0) - radius for at, radius in corners], axis=0)
        high = np.max([at.max(axis=0) + radius for at, radius in corners], axis=0)
        middle = (low + high) / 2.0
        reach = max(float(np.hypot(*(at - middle).T).max()) + radius for at, radius in corners)
        return complex(*middle), reach

    @property
    def low(self) -> float:
        """Its least z [mm]."""
        return min(core.low for core in self.cores)

    @property
    def high(self) -> float:
        """Its greatest z [mm]."""
        return max(core.high for core in self.cores)

    @cached_property
    def polygon(self) -> Any:
        """All of it as seen along the pins."""
        import shapely

        return shapely.union_all([core.polygon for core in self.cores])


def link_shape(name: str, body: Body, planes: Sequence[float], *, without: int = 0) -> Shape:
    """Return the outline of a link.

    Parameters
    ----------
    name : str
        ``link AE``.
    body : Body
        Its body.
    planes : sequence of float
        z of its mid-plane; of both, where it is doubled [mm].
    without : int, optional
        How many of its first footprints are left out, and with any of them the fillets at them.

    Returns
    -------
    Shape
        In the frame of the link.
    """
    solid = [_core(piece) for piece in body.part.footprints(body)[without:]]
    if body.part.is_beam and body.part.fillet_radius > 0.0 and not without:
        solid += _fillets(solid, body.part.fillet_radius)
    forked = [core for piece in solid for core in _forked(piece, body)]
    cores = [replace(core, low=plane + core.low, high=plane + core.high) for plane in planes for core in forked]
    return Shape(name=name, cores=tuple(cores))


def pin_shape(name: str, diameter: float, low: float, high: float) -> Shape:
    """Return the outline of a pin, whose centre is the origin of its frame.

    Parameters
    ----------
    name : str
        ``pin B``.
    diameter : float
        [mm]
    low, high : float
        z of its ends [mm].

    Returns
    -------
    Shape
        A circle.
    """
    import shapely

    core = Core(geometry=shapely.Point(0.0, 0.0), radius=diameter / 2.0, low=low, high=high, error=0.0)
    return Shape(name=name, cores=(core,))


def point_shape(
    name: str, points: Sequence[tuple[float, float]], low: float, high: float, *, joined: bool = False
) -> Shape:
    """Return points as an outline, for a link of which no more is known.

    Parameters
    ----------
    name : str
        ``link AG``.
    points : sequence of (x, y)
        [mm]
    low, high : float
        z between which the link lies [mm].
    joined : bool, optional
        True for the line through the points.

    Returns
    -------
    Shape
        In the frame of the link.
    """
    import shapely

    geometry = shapely.LineString(points) if joined else shapely.MultiPoint(points)
    core = Core(geometry=geometry, radius=0.0, low=low, high=high, error=0.0)
    return Shape(name=name, cores=(core,))


def _core(piece: Footprint) -> Core:
    return Core(geometry=_geometry(piece), radius=piece.radius, low=piece.low, high=piece.high, error=piece.error)


def _forked(core: Core, body: Body) -> list[Core]:
    """Return a piece as the gaps of forks leave it; a gap ends where what rounds its root begins."""
    import shapely

    found = [core]
    for pin in body.pins:
        if pin.fork is None:
            continue
        half, cut = pin.fork.gap / 2.0, pin.fork.depth - pin.fork.radius
        room = shapely.Point(pin.x, pin.y).buffer(cut, quad_segs=_SEGMENTS)
        rest = []
        for piece in found:
            low, high = max(piece.low, -half), min(piece.high, half)
            if low >= high or not room.intersects(piece.polygon):
                rest.append(piece)
                continue
            ends = [(piece.low, low), (high, piece.high)]
            rest += [replace(piece, low=a, high=b) for a, b in ends if b - a > TOUCHING * (piece.high - piece.low)]
            left, error = piece.polygon.difference(room), piece.error + _CHORD * (piece.radius + cut)
            if not left.is_empty:
                rest.append(Core(geometry=left, radius=0.0, low=low, high=high, error=error))
        found = rest
    return found


def _geometry(piece: Footprint) -> Any:
    import shapely

    if len(piece.corners) == 1:
        return shapely.Point(piece.corners[0])
    if len(piece.corners) == 2:
        return shapely.LineString(piece.corners)
    found = shapely.Polygon(piece.corners, piece.holes)
    return found if found.is_valid else found.buffer(0.0)


def _fillets(pieces: Sequence[Core], radius: float) -> list[Core]:
    """Return what a ball in the plane does not reach in the corners between pieces: their closing, less themselves.

    It lies at the height of the first piece, the bar or tube.
    """
    import shapely

    plain = shapely.union_all([piece.polygon for piece in pieces])
    closed = plain.buffer(radius, quad_segs=_SEGMENTS).buffer(-radius, quad_segs=_SEGMENTS)
    low, high = pieces[0].low, pieces[0].high
    error = _CHORD * (radius + max(piece.radius for piece in pieces))
    return [
        Core(geometry=corner, radius=0.0, low=low, high=high, error=error)
        for corner in shapely.get_parts(closed.difference(plain))
        if corner.geom_type == "Polygon" and corner.area > 1e-3 * radius**2
    ]


def meeting(one: Shape, other: Shape) -> list[tuple[Core, Core]]:
    """Return the pieces of two outlines that lie at a height together.

    Parameters
    ----------
    one, other : Shape
        The outlines.

    Returns
    -------
    list of (Core, Core)
        Empty where the two pass over each other.
    """
    found = []
    for a in one.cores:
        for b in other.cores:
            common = min(a.high, b.high) - max(a.low, b.low)
            if common > TOUCHING * max(a.high - a.low, b.high - b.low):
                found.append((a, b))
    return found


def gaps(pairs: Sequence[tuple[Core, Core]], turn: Complex, shift: Complex) -> Real:
    """Return the gap between two outlines at n placements.

    Parameters
    ----------
    pairs : sequence of (Core, Core)
        Their pieces that may meet.
    turn, shift : complex arrays (n,)
        A point p of the second one's frame lies at turn p + shift in the first one's [mm].

    Returns
    -------
    array (n,)
        Least distance [mm]; negative where circles overlap, 0 where polygons do.
    """
    import shapely

    found = np.full(len(turn), np.inf)
    if not pairs:
        return found
    (a_at, a_reach), (b_at, b_reach) = (
        (np.array([one.circle[0] for one in each]), np.array([one.circle[1] for one in each]))
        for each in zip(*pairs, strict=True)
    )
    least = np.abs(turn * b_at[:, None] + shift - a_at[:, None]) - (a_reach + b_reach)[:, None]
    for k in np.argsort(least.min(axis=1), kind="stable"):
        (a, b), near = pairs[k], np.flatnonzero(least[k] < found)
        if near.size:
            apart = shapely.distance(a.geometry, _placed(b.geometry, turn[near], shift[near])) - a.radius - b.radius
            found[near] = np.minimum(found[near], apart)
    return found


def overlap(pairs: Sequence[tuple[Core, Core]], turn: complex, shift: complex) -> tuple[float, complex]:
    """Return how far two outlines lie in each other, and where.

    Parameters
    ----------
    pairs : sequence of (Core, Core)
        Their pieces that may meet.
    turn, shift : complex
        As of ``gaps``, at one placement.

    Returns
    -------
    tuple of float and complex
        Diameter of the largest circle that lies in both [mm], and its centre in the first one's frame; 0 where they are
        apart. They are apart only after one has moved by that much or more.
    """
    import shapely

    found = (0.0, 0j)
    for a, b in pairs:
        [moved] = _placed(b.geometry, np.array([turn]), np.array([shift]))
        common = a.polygon.intersection(moved.buffer(b.radius, quad_segs=_SEGMENTS) if b.radius else moved)
        common = shapely.union_all([part for part in shapely.get_parts(common) if part.geom_type == "Polygon"])
        if common.area > 0.0:
            line = shapely.maximum_inscribed_circle(common, tolerance=1e-3 * np.sqrt(common.area))
            found = max(found, (2.0 * line.length, complex(*line.coords[0])), key=lambda entry: entry[0])
    return found


def nearest(pairs: Sequence[tuple[Core, Core]], turn: complex, shift: complex) -> complex:
    """Return the place between two outlines where they are nearest, or touch.

    Outlines that lie apart are nearest at a corner of one of them. Where they are as near at several, as along sides
    that are parallel, the first corner counts, in the order of the pieces and of their corners.

    Parameters
    ----------
    pairs : sequence of (Core, Core)
        Their pieces that may meet.
    turn, shift : complex
        As of ``gaps``, at one placement.

    Returns
    -------
    complex
        Middle of the gap in the first one's frame [mm].
    """
    import shapely

    placed = [(a, b, _placed(b.geometry, np.array([turn]), np.array([shift]))[0]) for a, b in pairs]
    apart = [shapely.distance(a.geometry, moved) - a.radius - b.radius for a, b, moved in placed]
    a, b, moved = placed[first_least(apart, max(abs(a.corners).max() for a, _ in pairs))]
    if not shapely.distance(a.geometry, moved) > 0.0:
        return complex(*a.geometry.intersection(moved).centroid.coords[0])
    own, others = (shapely.points(shapely.get_coordinates(one)) for one in (a.geometry, moved))
    ways = np.concatenate([shapely.distance(own, moved), shapely.distance(others, a.geometry)])
    k = first_least(ways)
    ends = (own[k], moved) if k < len(own) else (a.geometry, others[k - len(own)])
    p, q = (complex(*end) for end in shapely.shortest_line(*ends).coords)
    return complex(p + (q - p) * (a.radius + ways[k] - b.radius) / (2.0 * ways[k]))


def _placed(geometry: Any, turn: Complex, shift: Complex) -> Any:
    """Return a geometry at n placements, as an array of geometries."""
    import shapely

    at = shapely.get_coordinates(geometry)
    places = turn[:, None] * (at[:, 0] + 1j * at[:, 1]) + shift[:, None]
    copies = np.full(len(turn), geometry, dtype=object)
    return shapely.set_coordinates(copies, np.column_stack([places.real.ravel(), places.imag.ravel()]))


def error_of(pairs: Sequence[tuple[Core, Core]]) -> float:
    """Return how far the gap between two outlines may be off, since chords stand for arcs.

    Parameters
    ----------
    pairs : sequence of (Core, Core)
        Their pieces that may meet.

    Returns
    -------
    float
        [mm]
    """
    return max((a.error + b.error for a, b in pairs), default=0.0)
