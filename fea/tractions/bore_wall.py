"""The wall of a pin's hole on the mesh: where it is, how pressure is spread along it, and where it is open."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.features import OFF_PLANE
from alula.loads.records.applied import shifted
from alula.loads.statics.foundation import Foundation

Density = NDArray[np.float64]
Delivered = Callable[[Density, Density], Density]

LARGEST_CORRECTION = 0.1
"""A meshed surface may miss the wrench by this part of the load before its mesh is refused."""
_NOTHING, _CORRECTIONS = 1e-13, 60
"""Share of a wrench that counts for nothing, and the most corrections to reach it."""
_BY_PRESSURE, _BY_FORCE = np.array([1.0, 1.0, 0.0, 1.0, 1.0, 0.0]), np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
"""Components of the wrench that a pressure delivers, and one that is even along the pin."""
HEIGHTS = 7
"""Evenly spaced along a bore, at which its pressure is looked at. One that turns over within the bore has a kink there,
which 7 meet within 1/12 of it."""
_FAINT = 1e-6
"""Share of the largest pressure along a pin below which it may push into an opening."""
OPENING = math.radians(15.0)
"""Angle on both sides of a pressure's peak within which a hole must have some wall: half of what the key of a bore of
5 to 50 mm takes of its circle at most (DIN 6885: its width is a third of the diameter or less, mostly a quarter)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreWall:
    """The wall of a pin's hole on the mesh, and the pressure's resultant per length that delivers a wrench there.

    Force and moment are one pressure p0(z) law(θ − α(z)) n, whose resultant per length varies linearly along the pin,

        q(z) = F/L + D z/I,    D = ∫ z q dz = (My, −Mx),

    with the wall's length L and its second moment I about its middle. So it stands on one side of the hole while a
    moment in the plane of the force is at most F L/6, and beyond that on both. q is corrected until the meshed
    hole, whose facets turn and shorten the resultant, and whose wall may be longer on one side, has the wrench.
    A pin that bends in the hole (``alula.loads.statics.foundation``) presses otherwise along it, with the same
    resultants.
    In a hole whose middle lies off the link's plane of forces, heights count from its middle, and the force's moment
    about that middle is added to the pin's.

    Attributes
    ----------
    bore : SurfaceQuadrature
        The hole on the mesh.
    pin : PinLoad
        Its name, diameter and centre; not its wrench.
    middle : ndarray, shape (3,)
        Of the wall on the hole's axis [mm].
    radius : float
        As meshed [mm].
    """

    bore: SurfaceQuadrature
    pin: PinLoad
    middle: NDArray[np.float64]
    radius: float

    @classmethod
    def of(cls, bore: SurfaceQuadrature, pin: PinLoad) -> "BoreWall":
        """Return the wall of a pin's hole.

        Parameters
        ----------
        bore : SurfaceQuadrature
            The hole on the mesh.
        pin : PinLoad

        Returns
        -------
        BoreWall

        Raises
        ------
        CannotRunError
            If the surface is not that hole.
        """
        middle = bore_middle(bore, pin.centre)
        arm = bore.x - middle
        radius = float((bore.w * np.hypot(arm[..., 0], arm[..., 1])).sum() / bore.w.sum())
        if not 0.9 < 2.0 * radius / pin.diameter < 1.1:
            raise CannotRunError(
                f"the hole at pin {pin.name} measures {2.0 * radius:.4g} mm on the mesh, not {pin.diameter:.4g} mm"
            )
        return cls(bore=bore, pin=pin, middle=middle, radius=radius)

    @cached_property
    def angle(self) -> NDArray[np.float64]:
        """Angles (k, q) of the points about the axis [rad]."""
        arm = self.bore.x - self.middle
        return np.asarray(np.arctan2(arm[..., 1], arm[..., 0]))

    @cached_property
    def height(self) -> NDArray[np.float64]:
        """Heights (k, q) of the points above the middle [mm]."""
        return np.asarray(self.bore.x[..., 2] - self.middle[2])

    @cached_property
    def foundation(self) -> Foundation | None:
        """Of a pin that bends in the hole; None for a stiff one."""
        return Foundation.of(self.pin.seat)

    def along(self, push: Density, slope: Density, height: Density) -> Density:
        """Return the resultant per length at heights.

        Parameters
        ----------
        push, slope : ndarray, shape (..., 2)
            Of a stiff pin, at the middle [N/mm], and its slope [N/mm²].
        height : ndarray, broadcasts with (...)
            Above the middle [mm].

        Returns
        -------
        ndarray, shape (..., 2)
            [N/mm]
        """
        z = np.asarray(height)[..., None]
        if self.foundation is None:
            return np.asarray(push + z * slope)
        length = self.foundation.length
        even, turning = self.foundation.shapes(z)
        return np.asarray(length * even * push + length**3 / 12.0 * turning * slope)

    def pushes(self, wrench: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what the pressure has to deliver about the middle, of wrenches of the pin.

        Parameters
        ----------
        wrench : ndarray, shape (n, 6)
            About the pin's centre [N, N mm].

        Returns
        -------
        ndarray, shape (n, 6)
            Fx, Fy, Mx and My.
        """
        return shifted(wrench * _BY_PRESSURE, self.pin.centre - self.middle)

    def tilts(self, target: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return in which states (n,) the resultant per length varies along the pin.

        Parameters
        ----------
        target : ndarray, shape (n, 6)
            Of ``pushes``.

        Returns
        -------
        ndarray of bool, shape (n,)
        """
        size = _gap(target, self.pin.diameter)
        if self.foundation is not None:
            return size > 0.0
        return np.asarray(np.hypot(target[:, 3], target[:, 4]) > _NOTHING * size * self.pin.diameter)

    def per_length(self, wrench: NDArray[np.float64], delivered: Delivered) -> tuple[Density, Density]:
        """Return the resultant per length that makes a pressure deliver wrenches on the meshed hole.

        Parameters
        ----------
        wrench : ndarray, shape (n, 6)
            Of the pin [N, N mm].
        delivered : callable
            From the resultant per length at the middle (n, 2) [N/mm] and its slope (n, 2) [N/mm²], to the wrenches
            (n, 6) about the middle that the pressure has on the mesh.

        Returns
        -------
        tuple of (ndarray, ndarray), shape (n, 2)
            At the middle [N/mm], and its slope [N/mm²], as of a stiff pin (``along``).

        Raises
        ------
        CannotRunError
            For a hole meshed too coarsely, or open where the pin pushes.
        """
        target, diameter = self.pushes(wrench), self.pin.diameter
        size, tilts = _gap(target, diameter), self.tilts(target)[:, None]
        around = 2.0 * math.pi * self.radius
        length = float(self.bore.w.sum()) / around
        second = float((self.bore.w * self.height**2).sum()) / around
        push, slope, missing = np.zeros((len(target), 2)), np.zeros((len(target), 2)), target
        last = np.full(len(target), np.inf)
        for _ in range(_CORRECTIONS):
            push = push + missing[:, :2] / length
            slope = slope + tilts * missing[:, [4, 3]] * [1.0, -1.0] / second
            missing = target - delivered(push, slope)
            left = _gap(missing * np.where(tilts, _BY_PRESSURE, _BY_FORCE), diameter)
            if np.all((left <= _NOTHING * size) | (left >= last)):
                break
            last = left
        along = self.along(push, slope, np.linspace(-0.5, 0.5, HEIGHTS)[:, None] * float(np.ptp(self.height)))
        strength = np.hypot(along[..., 0], along[..., 1])
        pressed = along[strength > _FAINT * strength.max(axis=0)]
        bare = first_opening(self.angle, np.arctan2(pressed[:, 1], pressed[:, 0]))
        if bare is not None:
            raise CannotRunError(into_opening(self.pin.name, bare))
        gap = _gap(missing, diameter)
        if np.any(gap > LARGEST_CORRECTION * size):
            raise CannotRunError(
                f"the hole at pin {self.pin.name} is meshed too unevenly: its pressure misses the load by "
                f"{np.max(gap[size > 0.0] / size[size > 0.0]):.1%}; refine it"
            )
        return push, slope


def bore_middle(bore: SurfaceQuadrature, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point of a hole's axis at the middle of its wall.

    Parameters
    ----------
    bore : SurfaceQuadrature
        The hole on the mesh.
    centre : ndarray, shape (3,)
        Of the pin, in the plane of the link's forces [mm].

    Returns
    -------
    ndarray, shape (3,)
        The middle; ``centre`` itself where it differs by rounding or by uneven elements alone [mm].
    """
    height, reach = float(bore.centroid[2] - centre[2]), float(np.ptp(bore.x[..., 2]))
    return np.asarray(centre + np.array([0.0, 0.0, height if abs(height) > OFF_PLANE * reach else 0.0]))


def first_opening(wall: NDArray[np.float64], directions: NDArray[np.float64]) -> float | None:
    """Return the first direction within ``OPENING`` of which a hole has no wall.

    Parameters
    ----------
    wall : ndarray
        Angles at which there is some [rad].
    directions : ndarray, shape (n,)
        Angles [rad].

    Returns
    -------
    float or None
        None where all have a wall.
    """
    known, wanted = np.sort(np.ravel(wall) % (2.0 * math.pi)), directions % (2.0 * math.pi)
    around = np.concatenate([known[-1:] - 2.0 * math.pi, known, known[:1] + 2.0 * math.pi])
    after = np.searchsorted(around, wanted).clip(1, len(around) - 1)
    nearest = np.minimum(wanted - around[after - 1], around[after] - wanted)
    bare = np.flatnonzero(nearest > OPENING)
    return float(directions[bare[0]]) if bare.size else None


def into_opening(pin: str, direction: float) -> str:
    """Say that a pin pushes into the opening of its bore.

    Parameters
    ----------
    pin : str
        Its name.
    direction : float
        Angle of the pressure's peak in the link's frame [rad].

    Returns
    -------
    str
        For a message.
    """
    at = round(math.degrees(direction)) % 360
    return (
        f"the pin at {pin} pushes at {at} degrees into the opening of its bore, where "
        "no wall bears it; turn the part in its link, or close the bore in the CAD program"
    )


def _gap(wrench: NDArray[np.float64], diameter: float) -> NDArray[np.float64]:
    """Sizes (n,) of wrenches (n, 6) as forces [N]."""
    return np.asarray(np.linalg.norm(wrench[:, :3], axis=1) + np.linalg.norm(wrench[:, 3:], axis=1) / diameter)
