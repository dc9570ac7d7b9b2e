"""What the air does to wings that flap: a force normal to each strip, against its motion, and its added mass.

A strip at station x of a wing moves with v(x) across its face, along the link's y axis. In the link's axes the force
per length on it is

    f = -½ ρ C_N c |v| v - ρ π c² / 4 dv/dt

along y. The first part is that of blade elements whose chords stand across their motion: an angle of attack of 90°,
at which lift has no part (Ellington, Phil. Trans. R. Soc. Lond. B 305, 1984, 1-15 and 79-113; Sane and Dickinson, J.
Exp. Biol. 205, 2002, 1087-1096; Whitney and Wood, J. Fluid Mech. 660, 2010, 197-220). The second is the added mass of
a thin plate in potential flow, which DeLaurier (Aeronautical Journal 97, 1993, 125-130) has for strips in the same
form. dv/dt is the rate of the normal component as the plate has it: a·n - ω v·e, where n and e are the link's y and x
axes. Where a wing turns about a point on its axis, v·e is zero and the rate is a·n. Elsewhere a·n would count as
inertia of air what is the turning of the normal alone; with dv/dt the added mass does the work -d/dt ∫ ρ π c² v² / 8 dx
and none over a cycle, as inertia must.

Both parts act on the link's axis, whatever lies chordwise. Left out are the stream of flight, tip vortices and the flow
along the span, the wing's own bending and twist, its wake that it meets again, other wings, and the ground.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting
from alula.loads.case.case import Case
from alula.loads.records.applied import LineLoad, Load, PointLoad
from alula.loads.records.flapping import VISCOSITY, Flapping, Wing
from alula.loads.records.load_case import LoadCase

Real = NDArray[np.float64]

PIECES = 4
"""Linear pieces by which the force along a wing is represented; each has its exact force and first moment. With force
as x² the bending moment between their ends is off by at most 1/48 of PIECES to the power -4, 8e-5 of that at the root
(``tests/unit/loads/test_flapping.py``)."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Exact to degree 5: c v² and c² dv/dt are cubics in x, and their first moments of degree 4."""


def wing_span(wing: Wing, case: Case) -> tuple[float, float, tuple[float, float]]:
    """Return where a wing begins and ends along its link, and its chord there.

    Parameters
    ----------
    wing : Wing
    case : Case

    Returns
    -------
    tuple of (float, float, tuple)
        Stations in rising order, and the chords at them [mm].
    """
    points = case.links[wing.link].points
    if wing.span is not None:
        first, last = wing.span
    else:
        assert wing.start is not None
        assert wing.end is not None
        first, last = points[wing.start][0], points[wing.end][0]
    return (first, last, wing.chord) if first < last else (last, first, wing.chord[::-1])


@dataclass(frozen=True)
class FlappingAir(Acting):
    """Air on the wings of a case, which follows from how they move.

    Attributes
    ----------
    case : Case
    load_case : LoadCase
        One of the case's.
    """

    case: Case
    load_case: LoadCase

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: what the air does to the wings; nothing at rest."""
        return flapping_loads(self.case, self.load_case, place)


def flapping_loads(case: Case, load_case: LoadCase, place: Placement) -> tuple[PointLoad | LineLoad, ...]:
    """Return what the air does to the wings of a case.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
        One of the case's.
    place : Placement
        Where the links stand and how they move, at one pose or at n.

    Returns
    -------
    tuple of PointLoad or LineLoad
        In the links' axes; none at rest, and in a load case without air.
    """
    air = load_case.flapping
    if air is None or place.qdot is None:
        return ()
    found: list[PointLoad | LineLoad] = []
    for wing in case.wings:
        first, last, _ = wing_span(wing, case)
        if wing.at is None:
            ends = np.linspace(first, last, PIECES + 1)
            found += [
                _line(wing.link, a, b, *_resultant(case, air, wing, place, a, b))
                for a, b in itertools.pairwise(map(float, ends))
            ]
        else:
            force, moment = _resultant(case, air, wing, place, first, last)
            wrench = np.zeros((*place.shape, 6))
            wrench[..., 1] = force
            wrench[..., 5] = moment - case.links[wing.link].points[wing.at][0] * force
            found.append(PointLoad(link=wing.link, point=wing.at, wrench=wrench, axes="link"))
    return tuple(found)


def normal_motion(wing: Wing, place: Placement) -> tuple[Real, Real, Real, Real]:
    """Return how a wing's link moves across its own axis: v(x) = v0 + ω x, and dv/dt = r0 + α x.

    Parameters
    ----------
    wing : Wing
    place : Placement
        With rates.

    Returns
    -------
    tuple of 4 arrays (...)
        v0 [mm/s], ω [rad/s], r0 [mm/s²] and α [rad/s²].
    """
    turn = np.conj(place.direction(wing.link))
    speed, rate = place.velocity(wing.link) * turn, place.acceleration(wing.link) * turn
    spin = place.spin(wing.link)
    return speed.imag, spin, rate.imag - spin * speed.real, place.spin_rate(wing.link)


def _resultant(case: Case, air: Flapping, wing: Wing, place: Placement, a: float, b: float) -> tuple[Real, Real]:
    """Return force [N] and first moment about the origin of the link's frame [N mm] on a wing from a to b.

    The stretch is parted where v changes its sign, so that the quadrature is exact.
    """
    first, last, chord = wing_span(wing, case)
    speed, spin, rate, spin_rate = normal_motion(wing, place)
    with np.errstate(divide="ignore", invalid="ignore"):
        still = np.clip(np.nan_to_num(-speed / spin, nan=b), a, b)
    force, moment = np.zeros(place.shape), np.zeros(place.shape)
    for low, high in ((np.full(place.shape, a), still), (still, np.full(place.shape, b))):
        for point, weight in zip(_POINTS, _WEIGHTS, strict=True):
            x = 0.5 * (low + high) + 0.5 * (high - low) * point
            c = chord[0] + (chord[1] - chord[0]) * (x - first) / (last - first)
            v = speed + spin * x
            f = -0.5 * air.density * air.normal_coefficient * c * np.abs(v) * v
            if air.added_mass:
                f = f - air.density * np.pi / 4.0 * c**2 * (rate + spin_rate * x)
            f = 0.5 * (high - low) * weight * f
            force, moment = force + f, moment + f * x
    return force, moment


def _line(link: str, a: float, b: float, force: Real, moment: Real) -> LineLoad:
    """Return the linear load with a force and a first moment."""
    mean, slope = force / (b - a), 6.0 * (moment - 0.5 * (a + b) * force) / (b - a) ** 2
    ends = np.zeros((2, *np.shape(force), 3))
    ends[0, ..., 1], ends[1, ..., 1] = mean - slope, mean + slope
    return LineLoad(link=link, start=a, end=b, at_start=ends[0], at_end=ends[1], axes="link")


def wing_reynolds(case: Case, air: Flapping, wing: Wing, place: Placement) -> float:
    """Return the Reynolds number of a wing: its largest normal speed and its mean chord.

    Parameters
    ----------
    case : Case
    air : Flapping
    wing : Wing
    place : Placement
        With rates.

    Returns
    -------
    float
    """
    first, last, chord = wing_span(wing, case)
    speed, spin, _, _ = normal_motion(wing, place)
    fastest = max(float(np.abs(speed + spin * x).max()) for x in (first, last))
    return air.density * fastest * 0.5 * sum(chord) / VISCOSITY


def in_air(case: Case, share: float | None) -> Case:
    """Return the load cases of a case that have air for wings, with another C_N or without air.

    Parameters
    ----------
    case : Case
    share : float or None
        The C_N, from the least of its range, at 0, to the largest, at 1; None for no air.

    Returns
    -------
    Case
        With these load cases alone, in which C_N has no range.
    """
    found = {}
    for name, load_case in case.load_cases.items():
        if (air := load_case.flapping) is not None:
            low, high = air.ends
            update = {"normal_coefficient": low + (share or 0.0) * (high - low), "normal_coefficient_range": None}
            found[name] = load_case.model_copy(
                update={"flapping": None if share is None else air.model_copy(update=update)}
            )
    return case.model_copy(update={"load_cases": found})
