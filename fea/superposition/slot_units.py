"""Unit loads of a pin that travels along a slot: its push at a row of places, from which any place follows.

The push on a flank at the place x is Σ L_k(x) q_k with the pushes q_k of a unit force at places x_k and the cubic
Lagrange polynomials L_k of the four nearest. These reproduce 1 and x, so force and moment are exact at every place.

References
----------
Hildebrand, Introduction to Numerical Analysis, 2nd ed., section 3.2.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.fea.tractions.slot_traction import slot_traction
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Pin
from alula.loads.records.bearing import PressureLaw, Span

Real = NDArray[np.float64]

PER_PATCH = 8
"""Places per length of the pressure. Measured on a lever whose pin travels by a third of its diameter, as the largest
difference of nodal stress near the slot from direct solutions at eight poses, of the largest there: with 2 places
2.6 %, with 4 0.6 %, with 8 0.21 %."""
MOST_PLACES = 800
_STENCIL = 4


@dataclass(frozen=True, kw_only=True, eq=False)
class SlotUnits:
    """Where the unit loads of one slot stand.

    Attributes
    ----------
    pin : Pin
    pushes : dict of (Span, float) to slice
        Span of the law and side of the flank -> numbers of the pushes at the law's places, without their resultants.
    places : dict of Span to ndarray, shape (k,)
        Span of the law -> x, evenly spaced [mm].
    rigid : slice
        Numbers of the tractions that deliver a unit force along y, a unit moment about the middle and a unit force
        along x.
    rubs : dict of (Span, float) to slice
        As ``pushes``, of a unit of friction along the flank; empty where nothing rubs.
    """

    pin: Pin
    pushes: dict[tuple[Span, float], slice]
    places: dict[Span, Real]
    rigid: slice
    rubs: dict[tuple[Span, float], slice] = field(default_factory=dict)

    def coefficients(self, load: PinLoad, law: PressureLaw) -> Iterator[tuple[slice, Real]]:
        """Yield the coefficients of the pushes, of friction and of the tractions.

        Parameters
        ----------
        load : PinLoad
            Of the pin at n poses.
        law : PressureLaw

        Yields
        ------
        tuple of (slice, ndarray, shape (k, n))
            Numbers of unit loads, and their coefficients [N, N mm].
        """
        force, place, friction = load.wrench[:, 1], load.centre[:, 0], np.broadcast_to(load.friction, len(load.wrench))
        weights = lagrange_weights(self.places[law.span], place)
        for units, sizes in ((self.pushes, np.abs(force)), (self.rubs, friction)):
            for (span, side), numbers in units.items():
                if span == law.span:
                    yield numbers, weights * np.where(np.sign(force) == side, sizes, 0.0)
        yield self.rigid, np.array([force, force * (place - self.pin.x) + load.rubbed, friction])


def places_for(pin: Pin, law: PressureLaw, low: float, high: float) -> Real:
    """Return the places of a law's pushes for a pin that travels along its slot.

    Parameters
    ----------
    pin : Pin
    law : PressureLaw
    low, high : float
        Ends of its travel, x [mm].

    Returns
    -------
    ndarray, shape (k,)
        x, evenly spaced [mm].

    Raises
    ------
    CannotRunError
        For a travel that would need too many places.
    """
    step = law.patch(pin.pin_diameter) / PER_PATCH
    count = max(_STENCIL, int(np.ceil((high - low) / step)) + 1)
    if count > MOST_PLACES:
        raise CannotRunError(
            f"the pin at {pin.name} travels {high - low:.4g} mm in its slot, {(high - low) / pin.pin_diameter:.3g} of "
            f"its diameters, for which an envelope would need {count} unit loads, more than {MOST_PLACES}; shorten the "
            "motion, or check single poses with alula check"
        )
    if high == low:
        low, high = low - step / 2.0, high + step / 2.0
    return np.linspace(low, high, count)


def lagrange_weights(places: Real, x: Real) -> Real:
    """Return the weights of evenly spaced places for values between them, cubic on the four nearest.

    Parameters
    ----------
    places : ndarray, shape (k,)
        Evenly spaced [mm].
    x : ndarray, shape (n,)
        Where values are wanted [mm].

    Returns
    -------
    ndarray, shape (k, n)
    """
    step = (places[-1] - places[0]) / (len(places) - 1)
    first = np.clip(np.floor((x - places[0]) / step).astype(int) - 1, 0, len(places) - _STENCIL)
    t = (x - places[0]) / step - first
    found = np.zeros((len(places), len(x)))
    for i in range(_STENCIL):
        others = [j for j in range(_STENCIL) if j != i]
        found[first + i, np.arange(len(x))] = np.prod([(t - j) / (i - j) for j in others], axis=0)
    return found


def unit_pushes(
    wall: SurfaceQuadrature, pin: Pin, law: PressureLaw, side: float, places: Real, friction: float = 0.0
) -> list[Real]:
    """Return the tractions of a unit force of a pin on one flank of its slot, with the pin at each place.

    Parameters
    ----------
    wall : SurfaceQuadrature
        Of the slot.
    pin : Pin
    law : PressureLaw
    side : {1, -1}
        1 for the flank at y > 0, -1 for that at y < 0.
    places : ndarray, shape (k,)
        x of the pin [mm].
    friction : float, optional
        Along the flank, besides [N].

    Returns
    -------
    list of ndarray, shape (cells, points, 3)
        [MPa/N], one for each place.
    """
    wrench = np.array([friction, side, 0.0, 0.0, 0.0, -side * friction * pin.pin_diameter / 2.0])
    return [
        slot_traction(
            wall,
            PinLoad(
                name=pin.name,
                centre=np.array([x, pin.y, 0.0]),
                diameter=pin.pin_diameter,
                wrench=wrench,
                slotted=True,
                friction=friction,
            ),
            law,
        )
        for x in places
    ]
