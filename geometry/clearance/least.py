"""The least gap between two outlines over a motion, and where they touch first.

The gap changes by no more than one outline moves against the other. So between two poses it is at least the mean of the
gaps at both less half of that way; poses are put in between until this bound is close to the least gap that was found,
or above 0 everywhere before the first contact.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.ties import first_largest, first_least
from alula.geometry.clearance.shape import Core, Shape, error_of, gaps, meeting, nearest, overlap
from alula.geometry.linkage.placement import Placement

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

POSES = 20_000
"""At most, at which the gap of two outlines is found; what then remains open is in the band."""
_ROUNDS = 60
_DEEPEST = 60
"""Poses, about, at which it is found how far two outlines lie in each other."""


@dataclass(frozen=True, kw_only=True)
class Spot:
    """Where an outline stands: in the frame of a link, about one of its points, or about its origin.

    Attributes
    ----------
    link : str
        The link.
    point : str, optional
        Its point at which a pin stands; None for the link itself.
    """

    link: str
    point: str | None = None

    def _arm(self, place: Placement) -> Complex | float:
        return 0.0 if self.point is None else place.arm(self.link, self.point)

    def origin(self, place: Placement) -> Complex:
        """Return where the outline's origin is.

        Parameters
        ----------
        place : Placement
            At n poses.

        Returns
        -------
        complex array (n,)
            [mm]
        """
        return np.asarray(place.origin(self.link) + self._arm(place))

    def velocity(self, place: Placement, centre: complex) -> Complex:
        """Return how fast a point of the outline moves by the coordinate.

        Parameters
        ----------
        place : Placement
            At n poses, with rates by the coordinate.
        centre : complex
            The point, from the outline's origin in the link's axes [mm].

        Returns
        -------
        complex array (n,)
            [mm per rad or mm]
        """
        arm = self._arm(place) + place.direction(self.link) * centre
        return np.asarray(place.velocity(self.link) + 1j * place.spin(self.link) * arm)

    def acceleration(self, place: Placement, centre: complex) -> Complex:
        """Return how fast that changes by the coordinate.

        Parameters
        ----------
        place : Placement
            At n poses, with rates by the coordinate.
        centre : complex
            The point, from the outline's origin in the link's axes [mm].

        Returns
        -------
        complex array (n,)
            [mm per rad² or mm²]
        """
        arm = self._arm(place) + place.direction(self.link) * centre
        turn = 1j * place.spin_rate(self.link) - place.spin(self.link) ** 2
        return np.asarray(place.acceleration(self.link) + turn * arm)


@dataclass(frozen=True, kw_only=True)
class Gap:
    """The least gap of two outlines over all poses.

    Attributes
    ----------
    names : tuple of str
        ``link AE`` or ``pin B``, twice.
    value : float
        [mm]; negative where they lie in each other: less the diameter of the largest circle that lies in both.
    low, high : float
        What it may be between the poses that were looked at, and with arcs in place of chords [mm].
    at : float or None
        Coordinate of the motion there: of the first contact where there is one, else of the least gap, the first
        of those that rounding alone tells apart [rad, mm]; None for a single pose.
    place : tuple of float
        (x, y) between the two there, in global axes [mm].
    """

    names: tuple[str, str]
    value: float
    low: float
    high: float
    at: float | None
    place: tuple[float, float]

    @property
    def touches(self) -> bool:
        """Whether the two touch at some pose."""
        return self.value <= 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """Two outlines of which pieces lie at one height.

    Attributes
    ----------
    one, other : Shape
        The outlines; the other one is the smaller.
    at : tuple of Spot
        Where they stand.
    cores : tuple of (Core, Core)
        Their pieces that may meet.
    """

    one: Shape
    other: Shape
    at: tuple[Spot, Spot]
    cores: tuple[tuple[Core, Core], ...]

    @classmethod
    def of(cls, one: tuple[Shape, Spot], other: tuple[Shape, Spot]) -> "Pair | None":
        """Return the pair of two outlines.

        Parameters
        ----------
        one, other : tuple of Shape and Spot
            Outline, and where it stands.

        Returns
        -------
        Pair or None
            None where they pass over each other.
        """
        entries = one, other
        larger = first_largest([entry[0].circle[1] for entry in entries])
        first, second = entries[larger], entries[1 - larger]
        cores = meeting(first[0], second[0])
        return cls(one=first[0], other=second[0], at=(first[1], second[1]), cores=tuple(cores)) if cores else None

    @property
    def names(self) -> tuple[str, str]:
        """What they are."""
        return self.one.name, self.other.name

    def relative(self, place: Placement) -> tuple[Complex, Complex]:
        """Return how the second outline stands in the frame of the first.

        Parameters
        ----------
        place : Placement
            At n poses.

        Returns
        -------
        tuple of 2 complex array (n,)
            turn and shift: its point p lies at turn p + shift [mm].
        """
        first, second = self.at
        back = np.conj(place.direction(first.link))
        return back * place.direction(second.link), back * (second.origin(place) - first.origin(place))

    def circles(self, place: Placement) -> Real:
        """Return the gap of the circles about both outlines, which is no more than theirs.

        Parameters
        ----------
        place : Placement
            At n poses.

        Returns
        -------
        array (n,)
            [mm]
        """
        (centre, reach), (other, small) = self.one.circle, self.other.circle
        turn, shift = self.relative(place)
        return np.asarray(np.abs(turn * other + shift - centre) - reach - small)

    def speeds(self, place: Placement) -> tuple[Real, Real]:
        """Return how fast any point of the second outline moves against the first, at most, and how fast that changes.

        Parameters
        ----------
        place : Placement
            At n poses, with rates by the coordinate.

        Returns
        -------
        tuple of 2 array (n,)
            First and second derivative by the coordinate [mm per rad or mm].
        """
        first, second = self.at
        centre, reach = self.other.circle
        spins = [(place.spin(spot.link), place.spin_rate(spot.link)) for spot in self.at]
        (w, dw), (u, du) = spins
        away = second.origin(place) + place.direction(second.link) * centre - first.origin(place)
        rate = second.velocity(place, centre) - first.velocity(place, 0j)
        bend = second.acceleration(place, centre) - first.acceleration(place, 0j)
        seen = rate - 1j * w * away
        bent = bend - 2j * w * rate - (1j * dw + w**2) * away
        reach = reach if second.point is None else 0.0  # a pin that turns looks the same
        return np.abs(seen) + np.abs(u - w) * reach, np.abs(bent) + (np.abs(du - dw) + (u - w) ** 2) * reach


def width_at(pair: Pair, place: Placement) -> float:
    """Return the gap of two outlines at a single pose, without its place.

    Parameters
    ----------
    pair, place
        As of ``gap_at``.

    Returns
    -------
    float
        [mm]; below zero where they lie in each other.
    """
    turn, shift = pair.relative(place)
    value = float(gaps(pair.cores, turn, shift)[0])
    return value if value > 0.0 else -overlap(pair.cores, turn[0], shift[0])[0]


def gap_at(pair: Pair, place: Placement) -> Gap:
    """Return the gap of two outlines at a single pose.

    Parameters
    ----------
    pair : Pair
        The outlines.
    place : Placement
        The pose, as one of one.

    Returns
    -------
    Gap
        In a band of the chords' error.
    """
    value, error = width_at(pair, place), error_of(pair.cores)
    spot = _place(pair, place)
    return Gap(names=pair.names, value=value, low=value - error, high=value + error, at=None, place=spot)


def _place(pair: Pair, place: Placement) -> tuple[float, float]:
    """Return the place between two outlines at a single pose, in global axes."""
    turn, shift = pair.relative(place)
    local = nearest(pair.cores, turn[0], shift[0])
    found = pair.at[0].origin(place)[0] + place.direction(pair.at[0].link)[0] * local
    return float(found.real), float(found.imag)


def least_gap(
    pair: Pair,
    at: Callable[[Real], Placement],
    start: tuple[Real, Placement],
    *,
    near: float,
    step: float,
    enough: float = np.inf,
) -> Gap | None:
    """Return the least gap of two outlines over a motion, and the first contact where they touch.

    Parameters
    ----------
    pair : Pair
        The outlines.
    at : callable
        Takes values (n,) of the coordinate to the poses there, with rates by the coordinate.
    start : tuple of (array, Placement)
        Values of the coordinate to begin with, from the first pose to the last, and the poses there [rad, mm].
    near : float
        How close the bound must come to the least gap [mm].
    step : float
        Difference of the coordinate to which the first contact is found [rad, mm].
    enough : float, optional
        A gap above it is of no interest [mm].

    Returns
    -------
    Gap or None
        None where the gap is more than that all along.
    """
    s, place = start
    if float(_bounds(s, pair.circles(place), *pair.speeds(place)).min()) > enough:
        return None
    known = _Known.of(pair, s, place)
    for _ in range(_ROUNDS):
        lower, touching = known.lower, known.first_contact
        if touching is None:
            open_yet = lower < known.gap.min() - near
        else:
            open_yet = (lower <= 0.0) & (np.arange(len(lower)) < touching) & (np.abs(np.diff(known.s)) > step)
        widest = np.argsort(lower)[: max((POSES - len(known.s)), 0)]
        chosen = np.zeros(len(lower), dtype=np.bool_)
        chosen[widest] = True
        if not (open_yet & chosen).any():
            break
        known = known.refined(pair, at, open_yet & chosen)
    error = error_of(pair.cores)
    touching = known.first_contact
    if touching is None:
        value, low = float(known.gap.min()), float(min(known.gap.min(), known.lower.min()))
        k = first_least(known.gap, pair.one.circle[1])
        spot = _place(pair, at(known.s[k : k + 1]))
        return Gap(names=pair.names, value=value, low=low - error, high=value + error, at=float(known.s[k]), place=spot)
    first = _contact(pair, at, known, touching, step)
    depth, slack = _deepest(pair, at, known)
    spot = _place(pair, at(np.array([first])))
    return Gap(names=pair.names, value=-depth, low=-depth - slack - error, high=-depth + error, at=first, place=spot)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Known:
    """Gaps at values of the coordinate, and how fast the outlines move there; where they touch the gap is 0."""

    s: Real
    gap: Real
    speed: Real
    bend: Real

    @classmethod
    def of(cls, pair: Pair, s: Real, place: Placement) -> "_Known":
        speed, bend = pair.speeds(place)
        gap = np.maximum(gaps(pair.cores, *pair.relative(place)), 0.0)
        return cls(s=s, gap=gap, speed=speed, bend=bend)

    @property
    def lower(self) -> Real:
        """The least that the gap can be between each two values."""
        return _bounds(self.s, self.gap, self.speed, self.bend)

    @property
    def first_contact(self) -> int | None:
        """The first value at which the outlines touch."""
        found = np.flatnonzero(self.gap <= 0.0)
        return int(found[0]) if found.size else None

    def refined(self, pair: Pair, at: Callable[[Real], Placement], where: NDArray[np.bool_]) -> "_Known":
        """Return the same with a further value in the middle of some intervals."""
        k = np.flatnonzero(where)
        more = _Known.of(pair, middles := (self.s[k] + self.s[k + 1]) / 2.0, at(middles))
        columns = zip((self.s, self.gap, self.speed, self.bend), (more.s, more.gap, more.speed, more.bend), strict=True)
        s, gap, speed, bend = (np.insert(old, k + 1, new) for old, new in columns)
        return _Known(s=s, gap=gap, speed=speed, bend=bend)


def _bounds(s: Real, gap: Real, speed: Real, bend: Real) -> Real:
    """Return the least that a gap can be between each two of the poses.

    The speed in between is at most that at either end and half the way to it at the rate by which it changes.
    """
    h = np.abs(np.diff(s))
    way = h * (np.maximum(speed[1:], speed[:-1]) + h / 2.0 * np.maximum(bend[1:], bend[:-1]))
    return np.asarray((gap[1:] + gap[:-1] - way) / 2.0)


def _contact(pair: Pair, at: Callable[[Real], Placement], known: _Known, k: int, step: float) -> float:
    """Return the coordinate of the first contact, by bisection between the poses before and after it."""
    if k == 0:
        return float(known.s[0])
    free, met = float(known.s[k - 1]), float(known.s[k])
    while abs(met - free) > step / 100.0:
        middle = (free + met) / 2.0
        touches = gaps(pair.cores, *pair.relative(at(np.array([middle]))))[0] <= 0.0
        free, met = (free, middle) if touches else (middle, met)
    return met


def _deepest(pair: Pair, at: Callable[[Real], Placement], known: _Known) -> tuple[float, float]:
    """Return how far two outlines lie in each other over the poses, and by how much that may be more in between."""
    inside = np.flatnonzero(known.gap <= 0.0)
    chosen = inside[:: max(len(inside) // _DEEPEST, 1)]
    turn, shift = pair.relative(at(known.s[chosen]))
    depths: Sequence[float] = [overlap(pair.cores, t, d)[0] for t, d in zip(turn, shift, strict=True)]
    apart = float(np.abs(np.diff(known.s)).max()) * max(len(inside) // _DEEPEST, 1)
    return max(depths), apart * float(known.speed.max())
