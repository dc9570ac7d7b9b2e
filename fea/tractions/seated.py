"""Under what angle a pin presses whose clearance is known: that of contact, in place of two spans.

Where a case states the clearance of a hole, both laws of pressure (``WIDE`` and ``NARROW``) become those of contact, at
the ends of what contact may be: the wide one at the least clearance and under the largest force per length, ``WIDER``
than the calibrated law says, the narrow one at the other ends, ``NARROWER``. So a check solves two pressures as ever,
and its band is as much narrower as the stress under both is alike. It holds for eyes that end a bar or tube, within
what was tried: ``THINNEST`` and ``ASKEW``. Elsewhere, and where nothing is stated, spans of 180 and 90 degrees hold.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.seat import Seat
from alula.loads.records.bearing import WIDE, PressureLaw
from alula.loads.records.contact import eye_half_angle, pressure

Real = NDArray[np.float64]

WIDER, NARROWER = math.radians(25.0), math.radians(12.0)
"""By which the half angle of contact may be larger or smaller than the law says; where a pin pulls at an angle, contact
ends at two angles."""
NARROWEST = math.radians(36.0)
"""Half angle below which the pressure is taken no narrower. There the narrow law and contact load the sides of an eye
alike; what a loose pin presses beyond that is local, and told by the check of bearing."""
THINNEST, ASKEW = 2.4, math.radians(20.0)
"""Least outer diameter of an eye over its bore, and largest angle of the force to the link, for which it was tried."""


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """Pressure of contact over a half angle, as ``PressureLaw``.

    Attributes
    ----------
    half_angle : float
        [rad]
    """

    half_angle: float

    def shape(self, theta: Real) -> Real:
        """Return p(θ) over that of ``peak``.

        Parameters
        ----------
        theta : ndarray
            Angles from the direction of the force [rad].

        Returns
        -------
        ndarray
        """
        return pressure(theta, self.half_angle)

    def peak(self, *, force: float, diameter: float, thickness: float) -> float:
        """Return the nominal bearing stress, of which ``shape`` is a multiple.

        Parameters
        ----------
        force : float
            [N]
        diameter, thickness : float
            Of the hole [mm].

        Returns
        -------
        float
            [MPa]
        """
        return force / (diameter * thickness)


def half_angles(seat: Seat | None, law: PressureLaw, push: Real) -> Real:
    """Return the half angle of contact at which a law of pressure stands for a pin of known clearance.

    Parameters
    ----------
    seat : Seat or None
        How the pin sits.
    law : PressureLaw
        Of the two that bracket contact.
    push : ndarray, shape (n, 6)
        What the pressure delivers about the middle of the wall [N, N mm].

    Returns
    -------
    ndarray, shape (n,)
        [rad]; NaN where the law is to be taken as it is.
    """
    none = np.full(len(push), math.nan)
    if seat is None or seat.clearance is None or seat.away == 0 or seat.eye < THINNEST * seat.diameter:
        return none
    force, couple = np.hypot(push[:, 0], push[:, 1]), np.hypot(push[:, 3], push[:, 4])
    pulled = seat.away * push[:, 0] > math.cos(ASKEW) * force
    wide = law.span == WIDE.span
    clearance, side, spread = (seat.clearance[0], 1.0, WIDER) if wide else (seat.clearance[1], -1.0, -NARROWER)
    largest = np.maximum(force + side * 6.0 * couple / seat.length, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        tightness = np.nan_to_num(seat.young * clearance * seat.length / largest, nan=0.0, posinf=LOOSE)
    stiffer = 2.0 * seat.pin_young / (seat.young + seat.pin_young)
    found = eye_half_angle(np.minimum(tightness, LOOSE), stiffer=stiffer, ratio=seat.eye / seat.diameter)
    return np.where(pulled, np.maximum(found + spread, NARROWEST), none)


LOOSE = 1e6
"""E c t/F beyond which all pins touch alike."""


def pressing_law(seat: Seat | None, law: PressureLaw, push: Real) -> "PressureLaw | ContactLaw":
    """Return the law by which a pin presses in one state.

    Parameters
    ----------
    seat, law
        As of ``half_angles``.
    push : ndarray, shape (6,)
        What the pressure delivers.

    Returns
    -------
    PressureLaw or ContactLaw
    """
    [found] = half_angles(seat, law, push[None])
    return law if math.isnan(found) else ContactLaw(half_angle=float(found))


def contact_coefficients(half_angle: Real, highest: int) -> Real:
    """Return the Fourier coefficients of the pressure of contact, by Gauss's rule in the angle of its root.

    Parameters
    ----------
    half_angle : ndarray, shape (n,)
        [rad]
    highest : int
        Order at which the series ends.

    Returns
    -------
    ndarray, shape (highest + 1, n)
        Of cos kθ in p d t/F.
    """
    theta = half_angle * np.sin(0.5 * math.pi * _NODES)[:, None]
    weight = half_angle * (0.5 * math.pi * np.cos(0.5 * math.pi * _NODES) * _WEIGHTS)[:, None]
    p = weight * pressure(theta, half_angle)
    found = np.array([(p * np.cos(k * theta)).sum(axis=0) for k in range(highest + 1)]) / math.pi
    found[0] *= 0.5
    return found


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
