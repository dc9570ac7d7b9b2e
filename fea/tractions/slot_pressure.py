"""The push of a pin that travels along a slot: itself at single places, and fields of which it is a sum at any place.

The push on a flank at the place x is Σ L_k(x) q_k with the pushes q_k of a unit force at places x_k and the cubic
Lagrange polynomials L_k of the four nearest. These reproduce 1 and x, so force and moment are exact at every place.
Where the pin tilts, its pressure varies along it: each push is split by hats about several heights. Two heights are
exact as long as it pushes on one flank; where it pushes on both, the pressure has a kink, and there are ``HEIGHTS``.

References
----------
Hildebrand, Introduction to Numerical Analysis, 2nd ed., section 3.2.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.fea.tractions.bore_wall import HEIGHTS, bore_middle
from alula.fea.tractions.pin_pressure import hats
from alula.fea.tractions.slot_traction import about_middle, along_pin, refuse_what_slides, slot_traction
from alula.fea.tractions.surface_load import SurfaceLoad, pins_over
from alula.fea.tractions.surfaces import Surfaces
from alula.fea.tractions.traction import Transfer, wrench_density
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import chosen, shifted
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw

Real = NDArray[np.float64]

PER_PATCH = 8
"""Places per length of the pressure. Measured on a lever whose pin travels by a third of its diameter, as the largest
difference of nodal stress near the slot from direct solutions at eight poses, of the largest there: with 2 places
2.6 %, with 4 0.6 %, with 8 0.21 %."""
MOST_PLACES = 800
_STENCIL = 4


_CARRIED = [0, 1, 3, 4, 5]
"""Components of the wrench that enter through the wall: all but the force along z, a ``Thrust``."""
_ROUNDING = 1e-12
"""Share of a force that counts for nothing."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SlotPressure(SurfaceLoad):
    """The push of one pin on the flanks of its slot, with its friction along them.

    Attributes
    ----------
    pin : PinLoad
        Its name, its diameter, and a place of it.
    wall : SurfaceQuadrature
        Of the slot.
    places : dict of PressureLaw to ndarray, shape (k,)
        x, evenly spaced [mm].
    sides : tuple of float
        Flanks that it pushes on: 1 for that at y > 0, -1 for that at y < 0.
    heights : ndarray, shape (h,)
        Of the fields, from the middle of the wall, over half of its height.
    rubs : bool
        Whether there is any friction.
    """

    pin: PinLoad
    wall: SurfaceQuadrature
    places: dict[PressureLaw, Real]
    sides: tuple[float, ...]
    heights: Real
    rubs: bool

    @classmethod
    def found(cls, surfaces: Surfaces, histories: Sequence[LinkLoads]) -> Iterator["SlotPressure"]:
        """As ``SurfaceLoad.found``: the pins that push on slots."""
        for every in pins_over(histories, slotted=True):
            acts = np.any(every.wrench[:, _CARRIED], axis=1)
            if not acts.any():
                continue
            wall = surfaces.wall(every)
            ends = along_pin(wall, about_middle(wall, every), np.array([[-1.0], [1.0]]))
            ends[np.abs(ends) <= _ROUNDING * np.abs(ends).max()] = 0.0
            tilts = np.any(np.ptp(ends, axis=0) > _ROUNDING * np.abs(ends).max(axis=0))
            turns_over = np.any(ends[0] * ends[1] < 0.0)
            low, high = (float(end(every.centre[acts, 0])) for end in (np.min, np.max))
            yield cls(
                surfaces=surfaces,
                pin=chosen(every, 0),
                wall=wall,
                places={law: places_for(every, law, low, high) for law in (WIDE, NARROW)},
                sides=tuple(float(side) for side in np.unique(np.sign(ends[ends != 0.0]))),
                heights=np.linspace(-1.0, 1.0, HEIGHTS if turns_over else 2) if tilts else np.zeros(1),
                rubs=bool(np.any(every.friction)),
            )

    def _unit(self, place: float, law: PressureLaw, side: float, friction: float) -> Real:
        """Traction of a unit force on a flank, even along the pin, and of friction, with the pin at a place."""
        turned = -side * friction * self.pin.diameter / 2.0
        wrench, centre = np.array([friction, side, 0.0, 0.0, 0.0, turned]), self.pin.centre.copy()
        centre[0] = place
        wrench = shifted(wrench, bore_middle(self.wall, centre) - centre)
        return slot_traction(self.wall, replace(self.pin, centre=centre, wrench=wrench, friction=friction), law)

    @property
    def _blocks(self) -> list[tuple[PressureLaw, float]]:
        return [(law, side) for law in self.places for side in self.sides]

    @property
    def local(self) -> int:
        """Number of the fields of pushes and of friction."""
        each = len(self.heights) + self.rubs
        return sum(len(self.places[law]) * each for law, _ in self._blocks)

    def vectors(self) -> Iterator[Real]:
        """Yield pushes of all places and heights, then friction, by law and flank; then tractions of unit wrenches."""
        origin, units = self.pin.centre, np.eye(6)[_CARRIED]
        rigid = np.array([self.surfaces.vector(self.wall, wrench_density(self.wall, origin, one)) for one in units]).T

        def freed(density: Real) -> Real:
            return self.surfaces.vector(self.wall, density) - rigid @ self.wall.wrench(density, origin)[_CARRIED]

        z = self.wall.x[..., 2] - bore_middle(self.wall, origin)[2]
        shares = hats(self.heights, z / np.abs(z).max())
        for law, side in self._blocks:
            plain = [self._unit(place, law, side, 0.0) for place in self.places[law]]
            yield from (freed(push * share[..., None]) for push in plain for share in shares)
            if self.rubs:
                for place, push in zip(self.places[law], plain, strict=True):
                    yield freed(self._unit(place, law, side, 1.0) - push)
        yield from rigid.T

    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """As ``SurfaceLoad.coefficients``: those of pushes and friction [N], then of the tractions [N, N mm]."""
        pin, found = self._of(loads), []
        place, friction = pin.centre[:, 0], np.broadcast_to(pin.friction, loads.poses)
        pushed, rubbed = about_middle(self.wall, pin), np.zeros((loads.poses, 6))
        rubbed[:, 0], rubbed[:, 5] = friction, pin.rubbed
        refuse_what_slides(pin, pushed - rubbed)
        along = along_pin(self.wall, pushed, self.heights[:, None])
        for own, side in self._blocks:
            weights = lagrange_weights(self.places[own], place) * (own == law)
            found.append((weights[:, None] * np.maximum(side * along, 0.0)).reshape(-1, loads.poses))
            if self.rubs:
                found.append(weights * np.where(np.sign(pin.wrench[:, 1]) == side, friction, 0.0))
        taken = shifted(pin.wrench * [1.0, 1.0, 0.0, 1.0, 1.0, 1.0], pin.centre - self.pin.centre)
        return np.vstack([*found, taken[:, _CARRIED].T])

    def exact(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """As ``SurfaceLoad.exact``: the pushes themselves."""
        states = [chosen(self._of(loads), number) for number in range(loads.poses)]
        return np.array([self.surfaces.vector(self.wall, slot_traction(self.wall, pin, law)) for pin in states]).T

    def _of(self, loads: LinkLoads) -> PinLoad:
        """Return the pin of some loads; where they have none, without a wrench."""
        own = [pin for pin in loads.pins if pin.name == self.pin.name and pin.slotted]
        nothing = np.zeros((loads.poses, 6))
        return own[0] if own else replace(self.pin, centre=nothing[:, :3] + self.pin.centre, wrench=nothing)


def places_for(pin: PinLoad, law: PressureLaw, low: float, high: float) -> Real:
    """Return the places of a law's pushes for a pin that travels along its slot.

    Parameters
    ----------
    pin : PinLoad
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
    step = law.patch(pin.diameter) / PER_PATCH
    count = max(_STENCIL, int(np.ceil((high - low) / step)) + 1)
    if count > MOST_PLACES:
        raise CannotRunError(
            f"the pin at {pin.name} travels {high - low:.4g} mm in its slot, {(high - low) / pin.diameter:.3g} of "
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
