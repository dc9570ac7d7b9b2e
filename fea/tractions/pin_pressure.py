"""The pressure of a pin in its hole: itself under single forces, and fields of which it is a sum under any.

The pressure p(θ − α) of a pin is not linear in its force, but its Fourier series is a sum of fixed fields:

    p(θ − α) = Σ a_n (cos nα cos nθ + sin nα sin nθ)

The fields cos nθ and sin nθ on the hole, with the coefficients of either span, give it in every direction α. Where a
pin tilts, α turns along it (``alula.fea.tractions.bore_wall.BoreWall``): the fields are then cos nθ and sin nθ times a
hat about each of several heights, between which the pressure is linear. A traction of the rigid-body fields on the same
hole takes the resultant off each field. Further such tractions deliver the wrench. So the sum carries exactly the
wrench that statics asks for, on the hole as it is meshed.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.tractions.bore_wall import HEIGHTS, BoreWall
from alula.fea.tractions.seated import contact_coefficients, half_angles
from alula.fea.tractions.surface_load import SurfaceLoad, pins_over
from alula.fea.tractions.surfaces import Surfaces
from alula.fea.tractions.traction import Transfer, pin_traction, wrench_density
from alula.loads.records.applied import chosen
from alula.loads.records.bearing import PressureLaw

Real = NDArray[np.float64]

HIGHEST_ORDER = 16
"""Of the pressure's Fourier series. Measured on a bar with 24 quadratic elements round its holes under a force that
turns fully, as the largest difference of the peak stress from the pressure's own, over 180° and over 90°: 0.17 and
0.63 % with orders to 8, 0.20 and 1.13 % to 10, 0.12 and 0.36 % to 12, 0.05 and 0.09 % to 16. They took 38, 45, 48 and
50 solutions, since only the span of the motion's loads is solved for."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PinPressure(SurfaceLoad):
    """The pressure of one pin in its hole; its force along z is a ``Thrust``, its moment about z a ``Torque``.

    Attributes
    ----------
    wall : BoreWall
        Of its hole.
    tilts : bool
        True where the pressure varies along the pin in some state.
    order : int
        Highest of the series.
    """

    wall: BoreWall
    tilts: bool
    order: int

    @classmethod
    def found(cls, surfaces: Surfaces, histories: Sequence[LinkLoads]) -> Iterator["PinPressure"]:
        """As ``SurfaceLoad.found``: the pins that press on holes."""
        for pin in pins_over(histories, slotted=False):
            if np.any(pin.wrench[:, [0, 1, 3, 4]]):
                wall = BoreWall.of(surfaces.wall(pin), chosen(pin, 0))
                tilts = bool(np.any(wall.tilts(wall.pushes(pin.wrench))))
                yield cls(surfaces=surfaces, wall=wall, tilts=tilts, order=HIGHEST_ORDER)

    @property
    def name(self) -> str:
        """Of the pin."""
        return self.wall.pin.name

    @cached_property
    def _heights(self) -> Real:
        """Heights (h,) of the fields [mm]."""
        return np.linspace(self.wall.height.min(), self.wall.height.max(), HEIGHTS) if self.tilts else np.zeros(1)

    def _densities(self) -> Iterator[Real]:
        """The fields with their resultants: of each height cos nθ for n = 0, 1, ..., then sin nθ for n = 1, 2, ..."""
        angle, orders = self.wall.angle, range(1, self.order + 1)
        waves = [np.ones_like(angle), *(np.cos(n * angle) for n in orders), *(np.sin(n * angle) for n in orders)]
        for hat in hats(self._heights, self.wall.height):
            for wave in waves:
                yield -(hat * wave)[..., None] * self.wall.bore.normals

    @cached_property
    def _resultants(self) -> Real:
        """Wrenches (6, fields) of the fields about the middle of the wall."""
        return np.array([self.wall.bore.wrench(density, self.wall.middle) for density in self._densities()]).T

    @property
    def local(self) -> int:
        """Number of the pressure fields."""
        return len(self._heights) * (2 * self.order + 1)

    @property
    def _carried(self) -> list[int]:
        """The components of the wrench that the pressure delivers."""
        return [0, 1, 3, 4] if self.tilts else [0, 1]

    def vectors(self) -> Iterator[Real]:
        """Yield the pressure fields without their resultants, then tractions of unit components of the wrench."""
        bore, units = self.wall.bore, np.eye(6)

        def rigid(point: Real, unit: Real) -> Real:
            return self.surfaces.vector(bore, wrench_density(bore, point, unit))

        freed_by = np.array([rigid(self.wall.middle, unit) for unit in units]).T
        for density, resultant in zip(self._densities(), self._resultants.T, strict=True):
            yield self.surfaces.vector(bore, density) - freed_by @ resultant
        for unit in units[self._carried]:
            yield rigid(self.wall.pin.centre, unit)

    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """As ``SurfaceLoad.coefficients``: those of the pressure fields [MPa], then of the tractions [N, N mm]."""
        wrench = self.wrench(loads)
        return np.vstack([self.pressure(wrench, law), self.tractions(wrench)])

    def wrench(self, loads: LinkLoads) -> Real:
        """Return the wrench of the pin; zero where the loads have none.

        Parameters
        ----------
        loads : LinkLoads
            At n states.

        Returns
        -------
        ndarray, shape (n, 6)
            [N, N mm]
        """
        own = (pin.wrench for pin in loads.pins if pin.name == self.name and not pin.slotted)
        return sum(own, np.zeros((loads.poses, 6)))

    def tractions(self, wrench: Real) -> Real:
        """Return the coefficients of the tractions alone: those of a pin that moves with the mean of its bore.

        Parameters
        ----------
        wrench : ndarray, shape (n, 6)
            Of the pin [N, N mm].

        Returns
        -------
        ndarray, shape (2 or 4, n)
            [N, N mm]
        """
        return np.asarray(wrench[:, self._carried].T)

    def pressure(self, wrench: Real, law: PressureLaw) -> Real:
        """Return the coefficients of the pressure fields.

        Parameters
        ----------
        wrench : ndarray, shape (n, 6)
            Of the pin [N, N mm].
        law : PressureLaw

        Returns
        -------
        ndarray, shape (fields, n)
            [MPa]

        Raises
        ------
        CannotRunError
            For a hole meshed too coarsely, or open where the pin pushes.
        """
        diameter, angles = self.wall.pin.diameter, half_angles(self.wall.pin.seat, law, self.wall.pushes(wrench))
        by_span = fourier_coefficients(law, self.order) * law.peak(force=1.0, diameter=diameter, thickness=1.0)
        a, known = np.tile(by_span[:, None], len(wrench)), np.isfinite(angles)
        a[:, known] = contact_coefficients(angles[known], self.order) / diameter
        order = np.arange(self.order + 1)[:, None]

        def series(push: Real, slope: Real) -> Real:
            along = self.wall.along(push, slope, self._heights[:, None])
            size, turned = np.hypot(along[..., 0], along[..., 1]), np.arctan2(along[..., 1], along[..., 0])
            rows = [
                one * np.vstack([a * np.cos(order * way), (a * np.sin(order * way))[1:]])
                for one, way in zip(size, turned, strict=True)
            ]
            return np.vstack(rows)

        return series(*self.wall.per_length(wrench, lambda *along: (self._resultants @ series(*along)).T))

    def exact(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """As ``SurfaceLoad.exact``: the pressure itself."""
        own, bore = [replace(self.wall.pin, wrench=wrench) for wrench in self.wrench(loads)], self.wall.bore
        return np.array([self.surfaces.vector(bore, pin_traction(bore, pin, law)) for pin in own]).T


def fourier_coefficients(law: PressureLaw, highest: int = HIGHEST_ORDER) -> Real:
    """Return the coefficients a_n of cos nθ in p(θ)/p0, which is cos kθ for |θ| < β = π/(2k) and zero elsewhere.

    a_0 = 1/(πk), a_n = (1/π) (sin((k−n)β)/(k−n) + sin((k+n)β)/(k+n)), and a_k = 1/(2k).

    Parameters
    ----------
    law : PressureLaw
        With the wave number k.
    highest : int, optional
        Order n at which the series ends.

    Returns
    -------
    ndarray, shape (highest + 1,)
    """
    k, n = law.wave, np.arange(highest + 1)
    beta = math.pi / (2.0 * k)
    found = beta / math.pi * (np.sinc((k - n) * beta / math.pi) + np.sinc((k + n) * beta / math.pi))
    found[0] *= 0.5
    return np.asarray(found)


def hats(heights: Real, z: Real) -> list[Real]:
    """Return the linear interpolation weights of each height.

    Parameters
    ----------
    heights : ndarray, shape (h,)
        Evenly spaced, rising [mm].
    z : ndarray
        Where they are wanted [mm].

    Returns
    -------
    list of ndarray
        One for each height, of the shape of ``z``; beyond the ends they go on linearly. A single height counts for all.
    """
    if len(heights) == 1:
        return [np.ones_like(z)]
    step = heights[1] - heights[0]
    place = (z - heights[0]) / step
    first = np.clip(np.floor(place).astype(int), 0, len(heights) - 2)
    share = place - first
    return [np.where(first == k, 1.0 - share, 0.0) + np.where(first == k - 1, share, 0.0) for k in range(len(heights))]
