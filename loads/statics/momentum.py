"""Momentum, energy and shaking of a moving linkage: what its links carry along, and what that does to the ground."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Complex, Placement, vector
from alula.loads.records.applied import FrictionLoad, Load, PartMass, shifted

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkMomentum:
    """What a link carries along, at one pose or at n; vectors of the plane are complex, x + iy.

    Attributes
    ----------
    mass : float
        [tonne]
    linear : complex array (...)
        Linear momentum m v of its centroid [N s].
    angular : array (...)
        Angular momentum I ω about its centroid [N mm s].
    kinetic : array (...)
        Kinetic energy ½ m v² + ½ I ω² [N mm].
    """

    mass: float
    linear: Complex
    angular: Real
    kinetic: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageMomentum:
    """What all links together carry along, and what they do to the ground by their inertia alone.

    Attributes
    ----------
    links : mapping of str to LinkMomentum
        Of the links with mass.
    about : complex
        The fixed point about which moments are taken [mm].
    linear : complex array (...)
        Linear momentum [N s].
    angular : array (...)
        Angular momentum about that point [N mm s].
    kinetic : array (...)
        Kinetic energy [N mm].
    shaking_force : complex array (...)
        On the ground [N]: -d/dt of the linear momentum.
    shaking_moment : array (...)
        On the ground about that point [N mm]: -d/dt of the angular momentum.
    """

    links: Mapping[str, LinkMomentum]
    about: complex
    linear: Complex
    angular: Real
    kinetic: Real
    shaking_force: Complex
    shaking_moment: Real


def centroid_motion(place: Placement, link: str, own: PartMass) -> tuple[Complex, Complex, Complex]:
    """Return position, velocity and acceleration of the centroid of a link's mass.

    Parameters
    ----------
    place : Placement
        Where the links stand, with rates.
    link : str
    own : PartMass
        Its mass.

    Returns
    -------
    tuple of 3 complex array (...)
        x + iy [mm, mm/s, mm/s²].
    """
    arm, spin = place.direction(link) * complex(*own.centroid), place.spin(link)
    turned = (1j * place.spin_rate(link) - spin**2) * arm
    return place.origin(link) + arm, place.velocity(link) + 1j * spin * arm, place.acceleration(link) + turned


def linkage_momentum(place: Placement, masses: Mapping[str, PartMass], about: complex) -> LinkageMomentum:
    """Return momentum and kinetic energy of a moving linkage, with the force and moment by which it shakes the ground.

    Parameters
    ----------
    place : Placement
        Where the links stand, with rates.
    masses : mapping of str to PartMass
        Of the links, with what they carry.
    about : complex
        A fixed point, x + iy [mm].

    Returns
    -------
    LinkageMomentum

    References
    ----------
    Norton, Design of Machinery, 5th ed., chapters 11 and 12: shaking force and moment are the sum of the inertia forces
    and their moment. With P = Σ m v and H = Σ (r × m v + I ω), r from the fixed point to each centroid, they are
    -dP/dt = -Σ m a and -dH/dt = -Σ (r × m a + I α).
    """
    linear, force = np.zeros(place.shape, dtype=complex), np.zeros(place.shape, dtype=complex)
    angular, moment, kinetic = (np.zeros(place.shape) for _ in range(3))
    links = {}
    for link, own in masses.items():
        position, velocity, acceleration = centroid_motion(place, link, own)
        spin, arm = place.spin(link), np.conj(position - about)
        links[link] = LinkMomentum(
            mass=own.mass,
            linear=own.mass * velocity,
            angular=own.inertia * spin,
            kinetic=0.5 * own.mass * np.abs(velocity) ** 2 + 0.5 * own.inertia * spin**2,
        )
        linear += own.mass * velocity
        angular += own.mass * (arm * velocity).imag + own.inertia * spin
        kinetic += links[link].kinetic
        force -= own.mass * acceleration
        moment -= own.mass * (arm * acceleration).imag + own.inertia * place.spin_rate(link)
    return LinkageMomentum(
        links=links,
        about=about,
        linear=linear,
        angular=angular,
        kinetic=kinetic,
        shaking_force=force,
        shaking_moment=moment,
    )


def on_ground(loads: Sequence[Load], place: Placement, about: complex) -> tuple[Complex, Real]:
    """Return what the ground must be held against: the sum of all loads on the links, inertia included.

    Joint forces, drive, friction and springs between links cancel in it, so that it serves redundant linkages too.
    Where no load acts on the ground itself, it is what joints, drive and springs do to the ground.

    Parameters
    ----------
    loads : sequence of Load
        All that acts on the links.
    place : Placement
        Where they stand.
    about : complex
        A fixed point, x + iy [mm].

    Returns
    -------
    tuple of complex array (...) and array (...)
        Force in the plane, x + iy [N], and moment about z and that point [N mm].
    """
    total = np.zeros((*place.shape, 6))
    for load in loads:
        if not isinstance(load, FrictionLoad):
            total += shifted(load.resultant(place), vector(place.origin(load.link) - about))
    return total[..., 0] + 1j * total[..., 1], total[..., 5]
