"""The side of a flat bar whose width varies: straight stretches and steps, with fillets in the re-entrant corners.

The bar is symmetric about its axis, so that its upper side stands for both.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.eyes import ROUNDING
from alula.geometry.bodies.kernel import Border

Place = tuple[float, float]

SMOOTH = 1e-6
"""Angle between two stretches below which they are one line [rad]."""


@dataclass(frozen=True, kw_only=True)
class Edge:
    """A piece of the side: a straight line, or the arc of a fillet.

    Attributes
    ----------
    start, end : tuple of float
        (x, y) of its ends [mm].
    middle : tuple of float, optional
        (x, y) of the middle of an arc [mm]; None of a line.
    centre : tuple of float, optional
        (x, y) of the centre of an arc, outside of the bar [mm]; None of a line.
    """

    start: Place
    end: Place
    middle: Place | None = None
    centre: Place | None = None

    @property
    def radius(self) -> float:
        """Radius of an arc [mm]."""
        assert self.centre is not None
        return math.dist(self.centre, self.start)

    def at(self, x: float) -> float:
        """Return its y at a station within it; of an upright line the greater one.

        Parameters
        ----------
        x : float
            Station [mm].

        Returns
        -------
        float
            y [mm].
        """
        (x0, y0), (x1, y1) = self.start, self.end
        if self.centre is not None:
            return self.centre[1] - math.sqrt(max(self.radius**2 - (x - self.centre[0]) ** 2, 0.0))
        return max(y0, y1) if x1 == x0 else y0 + (y1 - y0) * (x - x0) / (x1 - x0)

    def distance(self, p: Place) -> float:
        """Return how far a place is from it.

        Parameters
        ----------
        p : tuple of float
            (x, y) [mm].

        Returns
        -------
        float
            Distance [mm].
        """
        if self.centre is not None:
            angles = [math.atan2(x - self.centre[0], self.centre[1] - y) for x, y in (self.start, p, self.end)]
            if angles[0] <= angles[1] <= angles[2]:
                return abs(math.dist(p, self.centre) - self.radius)
            return min(math.dist(p, self.start), math.dist(p, self.end))
        (x0, y0), (x1, y1) = self.start, self.end
        share = ((p[0] - x0) * (x1 - x0) + (p[1] - y0) * (y1 - y0)) / math.dist(self.start, self.end) ** 2
        share = min(max(share, 0.0), 1.0)
        return math.dist(p, (x0 + share * (x1 - x0), y0 + share * (y1 - y0)))


@dataclass(frozen=True, kw_only=True)
class Profile:
    """The upper side of a bar from one of its ends to the other.

    Attributes
    ----------
    corners : tuple of tuple of float
        (x, y) where straight stretches meet, by rising x, with both ends [mm].
    radius : float
        Of the fillets in its re-entrant corners [mm]; 0 leaves them sharp.
    """

    corners: tuple[Place, ...]
    radius: float

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Angle by which the side turns outwards at each corner [rad]; 0 at both ends."""
        found = []
        for a, b, c in zip(self.corners, self.corners[1:], self.corners[2:], strict=False):
            ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]
            found.append(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))
        return (0.0, *found, 0.0)

    @property
    def sharp(self) -> bool:
        """Whether it has a re-entrant corner without a fillet."""
        return self.radius == 0.0 and any(turn > SMOOTH for turn in self.turns)

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """Its lines and arcs, by rising x."""
        found: list[Edge] = []
        starts = [self.corners[0]]
        for before, corner, after, turn in zip(
            self.corners, self.corners[1:], self.corners[2:], self.turns[1:], strict=False
        ):
            if self.radius == 0.0 or turn <= SMOOTH:
                found += _line(starts[-1], corner)
                starts.append(corner)
                continue
            reach = self.radius * math.tan(turn / 2.0)
            p, q = _towards(corner, before, reach), _towards(corner, after, reach)
            length = math.dist(corner, p)
            ux, uy = (corner[0] - p[0]) / length, (corner[1] - p[1]) / length
            centre = p[0] - self.radius * uy, p[1] + self.radius * ux
            found += _line(starts[-1], p)
            found.append(Edge(start=p, end=q, middle=_towards(centre, corner, self.radius), centre=centre))
            starts.append(q)
        return (*found, *_line(starts[-1], self.corners[-1]))

    @property
    def balls(self) -> tuple[tuple[Place, float], ...]:
        """Centre and radius of every fillet; re-entrant corners that are sharp, with radius 0 [mm]."""
        if self.radius == 0.0:
            return tuple((c, 0.0) for c, turn in zip(self.corners, self.turns, strict=True) if turn > SMOOTH)
        return tuple((edge.centre, self.radius) for edge in self.edges if edge.centre is not None)

    @property
    def border(self) -> Border:
        """The whole outline of the bar, for ``Kernel.extruded``: the lower side, and the upper side backwards."""
        lower = [(_mirrored(edge.start), edge.middle and _mirrored(edge.middle)) for edge in self.edges]
        lower.append((_mirrored(self.edges[-1].end), None))
        upper = [(edge.end, edge.middle) for edge in reversed(self.edges)]
        return [*lower, *upper, (self.edges[0].start, None)]

    def half(self, x: float) -> float:
        """Return half the width.

        Parameters
        ----------
        x : float
            Station [mm]; beyond an end that of the end counts.

        Returns
        -------
        float
            y of the side [mm]; the greater one at a step.
        """
        x = min(max(x, self.corners[0][0]), self.corners[-1][0])
        slack = ROUNDING * (self.corners[-1][0] - self.corners[0][0])
        inside = [edge for edge in self.edges if edge.start[0] - slack <= x <= edge.end[0] + slack]
        return max(edge.at(min(max(x, edge.start[0]), edge.end[0])) for edge in inside)

    def distance(self, p: Place) -> float:
        """Return how far a place is from the side.

        Parameters
        ----------
        p : tuple of float
            (x, y) [mm].

        Returns
        -------
        float
            Distance [mm].
        """
        return min(edge.distance(p) for edge in self.edges)

    def even(self, low: float, high: float) -> bool:
        """Return whether the side is one straight line between two stations.

        Parameters
        ----------
        low, high : float
            Stations [mm].

        Returns
        -------
        bool
            Whether it has neither corner nor arc there.
        """
        slack = ROUNDING * (self.corners[-1][0] - self.corners[0][0])
        return any(
            edge.centre is None and edge.start[0] - slack <= low and high <= edge.end[0] + slack for edge in self.edges
        )

    def fillets(self, x: float, radius: float, ball: float, way: int) -> list[tuple[Place, Place]]:
        """Return where a fillet between an eye and the side lies, on one side of the eye.

        A ball touches the eye's circle and a straight stretch from outside, and nothing else.

        Parameters
        ----------
        x : float
            Centre of the eye, on the axis [mm].
        radius : float
            Of the eye [mm].
        ball : float
            Radius of the fillet; 0 for the corner without one [mm].
        way : int
            1 towards greater x, -1 towards smaller ones.

        Returns
        -------
        list of pairs of (float, float)
            Centre of the ball, and where it touches the side [mm].
        """
        found = []
        for edge in self.edges:
            if edge.centre is not None:
                continue
            length = math.dist(edge.start, edge.end)
            ux, uy = (edge.end[0] - edge.start[0]) / length, (edge.end[1] - edge.start[1]) / length
            px, py = edge.start[0] - ball * uy - x, edge.start[1] + ball * ux
            along, square = px * ux + py * uy, px**2 + py**2 - (radius + ball) ** 2
            if along**2 <= square:
                continue
            root = math.sqrt(along**2 - square)
            for s in (-along - root, -along + root):
                centre = x + px + s * ux, py + s * uy
                clear = ball == 0.0 or self.distance(centre) >= (1.0 - 1e-6) * ball
                if 0.0 <= s <= length and way * (centre[0] - x) > 0.0 and clear:
                    found.append((centre, (edge.start[0] + s * ux, edge.start[1] + s * uy)))
        return found

    def check(self, entry: str) -> None:
        """Refuse fillets that do not fit between the corners.

        Parameters
        ----------
        entry : str
            Of the radius, for the message.

        Raises
        ------
        CaseError
            With the largest radius that fits.
        """
        for i, (a, b) in enumerate(itertools.pairwise(self.corners)):
            room = sum(math.tan(turn / 2.0) for turn in self.turns[i : i + 2] if turn > SMOOTH)
            length = math.dist(a, b)
            if self.radius * room > (1.0 + ROUNDING) * length:
                what = "step" if a[0] == b[0] else f"stretch from x = {a[0]:.4g} to {b[0]:.4g} mm"
                where = f" at x = {a[0]:.4g} mm" if a[0] == b[0] else ""
                raise CaseError(
                    f"{entry} {self.radius:.4g} mm does not fit the {what}{where} of widths, which is {length:.4g} mm "
                    f"long: set it to at most {length / room:.6g} mm, or move the stations"
                )


def profile(stations: Sequence[Place], radius: float, first: float, last: float) -> Profile:
    """Return the upper side of a bar.

    Parameters
    ----------
    stations : sequence of (float, float)
        x and width there, by rising x: linear in between, a step where two x are equal, and constant beyond [mm].
    radius : float
        Of the fillets in its re-entrant corners [mm].
    first, last : float
        x of the bar's ends [mm].

    Returns
    -------
    Profile
        The side.
    """
    inner = [(x, w / 2.0) for x, w in stations if first < x < last]
    ends = (first, _widths_at(stations, first)[1] / 2.0), (last, _widths_at(stations, last)[0] / 2.0)
    corners = [ends[0]]
    for place in (*inner, ends[1]):
        if place != corners[-1]:
            corners.append(place)
    return Profile(corners=tuple(corners), radius=radius)


def width_at(stations: Sequence[Place], x: float) -> float:
    """Return the width of a bar without its fillets.

    Parameters
    ----------
    stations : sequence of (float, float)
        As of ``profile``.
    x : float
        Place [mm].

    Returns
    -------
    float
        Width [mm]; the greater one at a step.
    """
    return max(_widths_at(stations, x))


def _widths_at(stations: Sequence[Place], x: float) -> tuple[float, float]:
    """Return the widths just before and just after a place."""
    before = [station for station in stations if station[0] < x]
    after = [station for station in stations if station[0] > x]
    here = [width for place, width in stations if place == x]
    if here:
        return here[0], here[-1]
    if not before or not after:
        width = (before[-1:] or after[:1])[0][1]
        return width, width
    (x0, w0), (x1, w1) = before[-1], after[0]
    width = w0 + (w1 - w0) * (x - x0) / (x1 - x0)
    return width, width


def _line(start: Place, end: Place) -> list[Edge]:
    """Return the line between two places; none where they are one."""
    size = max(map(abs, (*start, *end)))
    return [Edge(start=start, end=end)] if math.dist(start, end) > ROUNDING * size else []


def _towards(start: Place, end: Place, length: float) -> Place:
    """Return the place at a distance from one towards another."""
    share = length / math.dist(start, end)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


def _mirrored(place: Place) -> Place:
    return place[0], -place[1]
