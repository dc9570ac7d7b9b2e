"""The outline about circles: what a ball that rolls around them does not reach. Of a straight edge it is their hull.

Arcs, convex on the circles and concave on the ball, and common tangents give length, area and depth in closed form.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

STANDS_OUT = 1e-3
"""Share of its radius by which a circle must stand out from the outline of the others to be part of it: less
would leave edges there that are far shorter than any element."""
STRAIGHT = math.inf
"""Radius of a ball whose outline is the convex hull."""
_TURN, _ROUNDING, _MEET = 2.0 * math.pi, 1e-12, 1e-9


class BallError(Exception):
    """The ball falls through between the circles, or leaves no material between them."""


@dataclass(frozen=True, kw_only=True)
class Arc:
    """An arc, run through with the material to its left; a whole circle has end = start + 2π.

    Attributes
    ----------
    x, y : float
        Its centre [mm].
    radius : float
        Its radius, negative of a concave arc, whose centre lies outside of the material [mm].
    start, end : float
        Directions of its outward normal at either end [rad]; the normal of a concave arc turns clockwise.
    """

    x: float
    y: float
    radius: float
    start: float = 0.0
    end: float = _TURN

    def point(self, angle: float) -> tuple[float, float]:
        """Return the point where the outward normal has a direction.

        Parameters
        ----------
        angle : float
            The direction [rad].

        Returns
        -------
        tuple of float
            (x, y) [mm].
        """
        return self.x + self.radius * math.cos(angle), self.y + self.radius * math.sin(angle)

    def support(self, angle: float) -> float:
        """Return how far the whole circle of a convex arc reaches in a direction.

        Parameters
        ----------
        angle : float
            The direction [rad].

        Returns
        -------
        float
            Distance of its tangent from the origin [mm].
        """
        return self.x * math.cos(angle) + self.y * math.sin(angle) + self.radius

    def has(self, angle: float) -> bool:
        """Return whether the outward normal has a direction somewhere on the arc.

        Parameters
        ----------
        angle : float
            The direction [rad].

        Returns
        -------
        bool
            Ends included, and a little beyond, so that no direction is lost between two arcs that meet.
        """
        return (angle - min(self.start, self.end) + _MEET) % _TURN <= abs(self.end - self.start) + 2.0 * _MEET

    def nearest(self, x: float, y: float) -> list[float]:
        """Return where on the arc a place may be nearest: the ends' normals, and that which runs through the place.

        Parameters
        ----------
        x, y : float
            The place [mm].

        Returns
        -------
        list of float
            Directions of the outward normal [rad].
        """
        side = math.copysign(1.0, self.radius)
        towards = math.atan2(side * (y - self.y), side * (x - self.x))
        return [self.start, self.end, *([towards] if self.has(towards) else [])]


@dataclass(frozen=True, kw_only=True)
class Outline:
    """A smooth closed line of arcs and the straight lines between them.

    Attributes
    ----------
    arcs : tuple of Arc
        Counter-clockwise about the material; each ends in the direction in which the next one starts, and a straight
        line joins the two where they do not meet.
    """

    arcs: tuple[Arc, ...]

    @property
    def straight(self) -> list[bool]:
        """Whether a straight line follows each arc."""
        scale = max(abs(arc.x) + abs(arc.y) + abs(arc.radius) for arc in self.arcs)
        return [math.dist(*ends) > _MEET * scale for ends in self._joints]

    @property
    def lines(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Both ends of every straight line; of a single circle none."""
        return [ends for ends, line in zip(self._joints, self.straight, strict=True) if line]

    @property
    def _joints(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """The end of each arc, and the start of the next."""
        pairs = zip(self.arcs, self.arcs[1:] + self.arcs[:1], strict=True)
        return [(one.point(one.end), other.point(other.start)) for one, other in pairs]

    @property
    def area(self) -> float:
        """Enclosed area, by Green's theorem: ½ ∮ (x dy - y dx) [mm²]."""
        double = sum(a[0] * b[1] - b[0] * a[1] for a, b in self.lines)
        for arc in self.arcs:
            sines = math.sin(arc.end) - math.sin(arc.start)
            cosines = math.cos(arc.end) - math.cos(arc.start)
            double += arc.radius * (arc.radius * (arc.end - arc.start) + arc.x * sines - arc.y * cosines)
        return double / 2.0

    def depth(self, x: float, y: float) -> float:
        """Return how far a place lies within the outline.

        The line is smooth, so that the way from its nearest point to the place is along the normal there, whose sense
        tells inside from outside.

        Parameters
        ----------
        x, y : float
            The place [mm].

        Returns
        -------
        float
            Its distance from the outline, negative outside [mm].
        """
        found = []
        for arc in self.arcs:
            for angle in arc.nearest(x, y):
                px, py = arc.point(angle)
                inwards = (px - x) * math.cos(angle) + (py - y) * math.sin(angle)
                found.append((math.hypot(px - x, py - y), inwards))
        for (px, py), (qx, qy) in self.lines:
            length = math.hypot(qx - px, qy - py)
            tx, ty = (qx - px) / length, (qy - py) / length
            if 0.0 < (x - px) * tx + (y - py) * ty < length:
                inwards = (y - py) * tx - (x - px) * ty
                found.append((abs(inwards), inwards))
        distance, inwards = min(found)
        return math.copysign(distance, inwards)

    def across(self, x: float) -> float:
        """Return the length of a line across the x axis that lies within the outline.

        Parameters
        ----------
        x : float
            Station [mm].

        Returns
        -------
        float
            Length [mm].
        """
        found = []
        for arc in self.arcs:
            if abs(x - arc.x) <= abs(arc.radius):
                angle = math.acos((x - arc.x) / arc.radius)
                found += [arc.point(turn)[1] for turn in (angle, -angle) if arc.has(turn)]
        for (x0, y0), (x1, y1) in self.lines:
            if min(x0, x1) <= x <= max(x0, x1):
                found += [y0 + (y1 - y0) * (x - x0) / (x1 - x0)] if x0 != x1 else [y0, y1]
        pairs = itertools.pairwise(sorted(found))
        return sum(high - low for low, high in pairs if high > low and self.depth(x, (low + high) / 2.0) > 0.0)

    @property
    def webs(self) -> Iterator[tuple[float, Arc, Arc]]:
        """The necks: least width between two concave arcs that face each other, negative where they cross [mm]."""
        for one, other in itertools.combinations([arc for arc in self.arcs if arc.radius < 0.0], 2):
            towards = math.atan2(other.y - one.y, other.x - one.x)
            if one.has(towards + math.pi) and other.has(towards):
                yield math.hypot(other.x - one.x, other.y - one.y) + one.radius + other.radius, one, other


def outline(circles: Sequence[tuple[float, float, float]], ball: float = STRAIGHT) -> Outline:
    """Return the outline about circles.

    Parameters
    ----------
    circles : sequence of (x, y, radius)
        At least one [mm].
    ball : float, optional
        Radius of the ball that rolls around them [mm]; without it the outline is the convex hull.

    Returns
    -------
    Outline
        Without the circles that do not stand out (``STANDS_OUT``).

    Raises
    ------
    BallError
        Where the ball falls through between the circles, or touches another one across the material.
    """
    arcs = [Arc(x=x, y=y, radius=radius) for x, y, radius in dict.fromkeys(circles)]
    found = _closed(arcs, ball)
    for arc in sorted((arc for arc in found.arcs if arc.radius > 0.0), key=lambda arc: arc.end - arc.start):
        others = [one for one in arcs if (one.x, one.y, one.radius) != (arc.x, arc.y, arc.radius)]
        try:
            without = _closed(others, ball) if others else None
        except BallError:
            continue  # it holds others together
        if without is not None and arc.radius - without.depth(arc.x, arc.y) < STANDS_OUT * arc.radius:
            arcs, found = others, without
    return found


def _closed(circles: Sequence[Arc], ball: float) -> Outline:
    """Return the outline about all of some circles, which is in one piece.

    Where the ball falls through, some lie outside of it; where it touches another across the material, a neck is
    negative.
    """
    around = Outline(arcs=_rolled(circles, ball))
    if any(width <= 0.0 for width, *_ in around.webs) or any(around.depth(arc.x, arc.y) < 0.0 for arc in circles):
        raise BallError
    return around


def gap(one: Outline, other: Outline) -> float:
    """Return the distance of two convex outlines.

    They are circles rolled along polygons, whose distance is the largest, over all directions, by which they lie
    apart in it: that of a side's normal, or of a line between two corners.

    Parameters
    ----------
    one, other : Outline
        Convex outlines.

    Returns
    -------
    float
        Distance, negative where they overlap [mm].
    """
    normals = [arc.start for arc in one.arcs] + [arc.start + math.pi for arc in other.arcs]
    normals += [math.atan2(b.y - a.y, b.x - a.x) for a, b in itertools.product(one.arcs, other.arcs)]
    return max(-_support(one, angle) - _support(other, angle + math.pi) for angle in normals)


def _support(convex: Outline, angle: float) -> float:
    return max(arc.support(angle) for arc in convex.arcs)


def _rolled(circles: Sequence[Arc], ball: float) -> tuple[Arc, ...]:
    """Roll a ball around circles, counter-clockwise from the direction x on.

    On circle i it rolls until it touches circle j as well. Its centre is then r_i + R from one centre and r_j + R from
    the other, d and φ the distance and direction between them, so that its normal on i is at φ - acos of
    ((r_i + R)² + d² - (r_j + R)²) / (2 (r_i + R) d). Of a straight edge that is (r_i - r_j)/d: the common outer
    tangent. The next circle is the first to be touched, of several the furthest.
    """
    start = max(circles, key=lambda arc: (arc.support(0.0), arc.y))
    found: list[Arc] = []
    angle, here = 0.0, start
    while True:
        ahead = []
        for other in circles:
            dx, dy = other.x - here.x, other.y - here.y
            distance = math.hypot(dx, dy)
            apart = (1.0 - _MEET) * (here.radius + other.radius + 2.0 * ball)
            if other is not here and abs(here.radius - other.radius) < distance < apart:
                cosine = _contact(here.radius, other.radius, distance, ball)
                ahead.append(((math.atan2(dy, dx) - math.acos(cosine) - angle) % _TURN, -distance, other))
        turn, _, then = min(_tied(ahead), key=lambda entry: entry[1], default=(_TURN, 0.0, here))
        if angle + turn > _TURN - _ROUNDING and (here is start or ball == STRAIGHT):
            break
        found.append(replace(here, start=angle, end=angle + turn))
        angle += turn
        if ball < STRAIGHT:
            x, y = replace(here, radius=here.radius + ball).point(angle)
            sweep = (angle - math.atan2(y - then.y, x - then.x)) % _TURN
            found.append(Arc(x=x, y=y, radius=-ball, start=angle, end=angle - sweep))
            angle -= sweep
        here = then
    if found and here is start:  # the ball began in the middle of this arc
        found[0] = replace(start, start=angle - _TURN, end=found[0].end)
    else:
        found.append(replace(here, start=angle, end=_TURN))
    return tuple(found)


def _contact(one: float, other: float, distance: float, ball: float) -> float:
    """Return the cosine between a ball's direction from one circle's centre and that to a second one's it touches."""
    if ball == STRAIGHT:
        return (one - other) / distance
    # The same quotient with the squares' difference split up, which is exact of large balls.
    apart = (one - other) * (one + other + 2.0 * ball) + distance**2
    return min(max(apart / (2.0 * (one + ball) * distance), -1.0), 1.0)


def _tied(ahead: list[tuple[float, float, Arc]]) -> list[tuple[float, float, Arc]]:
    """Return the contacts that come first; rounding puts one that is due at once at a whole turn."""
    turned = [(0.0 if _TURN - turn < _ROUNDING else turn, far, arc) for turn, far, arc in ahead]
    least = min((turn for turn, _, _ in turned), default=0.0)
    return [entry for entry in turned if entry[0] < least + _ROUNDING]
