"""The convex hull of circles, as arcs joined by common tangents: outline, area, depth and chords in closed form."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

STANDS_OUT = 1e-3
"""Share of its radius by which a circle must stand out from the hull of the others to be part of the outline: less
would leave edges there that are far shorter than any element."""
_TURN, _ROUNDING = 2.0 * math.pi, 1e-12


@dataclass(frozen=True, kw_only=True)
class Arc:
    """An arc, run through counter-clockwise; a whole circle has end = start + 2π.

    Attributes
    ----------
    x, y : float
        Its centre [mm].
    radius : float
        Its radius [mm].
    start, end : float
        Directions of its outward normal at either end [rad].
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
        """Return how far the whole circle reaches in a direction.

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


@dataclass(frozen=True, kw_only=True)
class Hull:
    """The convex hull of circles.

    Attributes
    ----------
    arcs : tuple of Arc
        Of its outline, counter-clockwise; each ends in the direction in which the next one starts, and a straight
        line joins the two.
    """

    arcs: tuple[Arc, ...]

    @property
    def lines(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Both ends of the straight line after each arc; of a single circle none."""
        pairs = itertools.pairwise((*self.arcs, self.arcs[0])) if len(self.arcs) > 1 else ()
        return [(one.point(one.end), other.point(one.end)) for one, other in pairs]

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

        Of a convex set that is the least over all directions of its support less the place's. On an arc it is at one
        of its ends, or where the arc's normal runs through the place.

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
            towards = math.atan2(y - arc.y, x - arc.x)
            angles = [arc.start, arc.end]
            if (towards - arc.start) % _TURN < arc.end - arc.start:
                angles.append(towards)
            found += [arc.support(angle) - x * math.cos(angle) - y * math.sin(angle) for angle in angles]
        return min(found)

    def chord(self, x: float) -> tuple[float, float]:
        """Return where the outline meets a line across the x axis.

        Parameters
        ----------
        x : float
            Station, between the ends of the hull [mm].

        Returns
        -------
        low, high : float
            Least and greatest y there [mm].
        """
        found = []
        for arc in self.arcs:
            half = math.sqrt(max(arc.radius**2 - (x - arc.x) ** 2, 0.0))
            found += [
                arc.y + side * half
                for side in (-1.0, 1.0)
                if (math.atan2(side * half, x - arc.x) - arc.start) % _TURN <= arc.end - arc.start
                and abs(x - arc.x) <= arc.radius
            ]
        for (x0, y0), (x1, y1) in self.lines:
            if min(x0, x1) <= x <= max(x0, x1):
                found += [y0 + (y1 - y0) * (x - x0) / (x1 - x0)] if x0 != x1 else [y0, y1]
        return min(found), max(found)


def hull(circles: Sequence[tuple[float, float, float]]) -> Hull:
    """Return the convex hull of circles.

    Parameters
    ----------
    circles : sequence of (x, y, radius)
        At least one [mm].

    Returns
    -------
    Hull
        Without the circles that do not stand out (``STANDS_OUT``).
    """
    arcs = [Arc(x=x, y=y, radius=radius) for x, y, radius in dict.fromkeys(circles)]
    found = _wrapped(arcs)
    for arc in sorted(found, key=lambda arc: arc.end - arc.start):
        others = [one for one in arcs if (one.x, one.y, one.radius) != (arc.x, arc.y, arc.radius)]
        if others and arc.radius - Hull(arcs=_wrapped(others)).depth(arc.x, arc.y) < STANDS_OUT * arc.radius:
            arcs = others
    return Hull(arcs=_wrapped(arcs))


def _wrapped(circles: Sequence[Arc]) -> tuple[Arc, ...]:
    """Wrap a thread around circles, counter-clockwise from the direction x on.

    From circle i on, with d and φ the distance and direction to circle j, their common outer tangent has its normal at
    φ - acos((r_i - r_j)/d), where j begins to reach further. The next circle is the first to do so, of several the
    furthest.
    """
    start = max(circles, key=lambda arc: (arc.support(0.0), arc.y))
    found, angle, here = [], 0.0, start
    while True:
        ahead = []
        for other in circles:
            dx, dy = other.x - here.x, other.y - here.y
            distance = math.hypot(dx, dy)
            if other is not here and distance > abs(here.radius - other.radius):
                normal = math.atan2(dy, dx) - math.acos((here.radius - other.radius) / distance)
                ahead.append(((normal - angle) % _TURN, -distance, other))
        turn, _, then = min(_tied(ahead), key=lambda entry: entry[1], default=(_TURN, 0.0, here))
        if angle + turn > _TURN - _ROUNDING:
            break
        found.append(replace(here, start=angle, end=angle + turn))
        angle, here = angle + turn, then
    if found and here is start:  # the thread began in the middle of this arc
        found[0] = replace(start, start=angle - _TURN, end=found[0].end)
    else:
        found.append(replace(here, start=angle, end=_TURN))
    return tuple(found)


def _tied(ahead: list[tuple[float, float, Arc]]) -> list[tuple[float, float, Arc]]:
    """Return the tangents that come first; rounding puts one that is due at once at a whole turn."""
    turned = [(0.0 if _TURN - turn < _ROUNDING else turn, far, arc) for turn, far, arc in ahead]
    least = min((turn for turn, _, _ in turned), default=0.0)
    return [entry for entry in turned if entry[0] < least + _ROUNDING]
