"""Unit loads of a pin that bears a couple beside its force, as between layers: pressure fields at several heights.

Force and couple are one pressure (``alula.fea.tractions.traction.pin_traction``), p0(z) law(θ − α(z)), whose resultant
per length q(z) varies linearly along the pin, so that its direction may turn over. At a height it is a Fourier series
as in ``pin_units``; between heights it is interpolated linearly. The fields are cos nθ and sin nθ times a hat about
each height, without their resultants; six tractions of the rigid-body fields deliver the wrench, exactly.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.superposition.pin_units import HIGHEST_ORDER, fourier_coefficients
from alula.fea.tractions.traction import first_opening, into_opening
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Pin
from alula.loads.records.bearing import PressureLaw

Real = NDArray[np.float64]

HEIGHTS = 7
"""Evenly spaced along a bore. A pressure that turns over within it has a kink there, which 7 meet within 1/12 of it."""
_FAINT = 1e-6
"""Share of the largest pressure along a pin below which it may push into an opening."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CoupleUnits:
    """Where the unit loads of one pin stand.

    Attributes
    ----------
    pin : Pin
    heights : ndarray, shape (h,)
        Of the fields, from the middle of the hole's wall [mm].
    length, second : float
        Of the wall along the pin: its length [mm], and its second moment about the middle [mm³].
    lift : float
        Height of the middle above the plane of the link's forces [mm].
    fields : slice
        Numbers of the fields: of each height cos nθ for n = 0, 1, ..., then sin nθ for n = 1, 2, ...
    wrench : slice
        Numbers of the tractions that deliver unit components of the wrench.
    wall : ndarray
        Angles at which there is some wall [rad].
    """

    pin: Pin
    heights: Real
    length: float
    second: float
    lift: float
    fields: slice
    wrench: slice
    wall: Real

    def coefficients(self, wrench: Real, law: PressureLaw) -> Real:
        """Return the coefficients of the fields.

        Parameters
        ----------
        wrench : ndarray, shape (n, 6)
            Of the pin on the link about its point, at n poses [N, N mm].
        law : PressureLaw

        Returns
        -------
        ndarray, shape (fields, n)
            [MPa]

        Raises
        ------
        CannotRunError
            Where the pin pushes into an opening of its hole.
        """
        force = wrench[:, :2]
        about_middle = np.column_stack([wrench[:, 4], -wrench[:, 3]]) - self.lift * force
        along = force / self.length + self.heights[:, None, None] * about_middle / self.second
        size, direction = np.hypot(along[..., 0], along[..., 1]), np.arctan2(along[..., 1], along[..., 0])
        bare = first_opening(self.wall, direction[size > _FAINT * size.max(initial=0.0)])
        if bare is not None:
            raise CannotRunError(into_opening(self.pin.name, bare))
        a = fourier_coefficients(law, HIGHEST_ORDER)[:, None]
        order = np.arange(HIGHEST_ORDER + 1)[:, None]
        peak = law.peak(force=1.0, diameter=self.pin.diameter, thickness=1.0) * size
        found = [
            p * np.vstack([a * np.cos(order * turned), (a * np.sin(order * turned))[1:]])
            for p, turned in zip(peak, direction, strict=True)
        ]
        return np.vstack(found)


def hats(heights: Real, z: Real) -> list[Real]:
    """Return the linear interpolation weights of each height.

    Parameters
    ----------
    heights : ndarray, shape (h,)
        Rising [mm].
    z : ndarray
        Where they are wanted [mm].

    Returns
    -------
    list of ndarray
        One for each height, of the shape of ``z``; beyond the ends they go on linearly.
    """
    step = heights[1] - heights[0]
    place = (z - heights[0]) / step
    first = np.clip(np.floor(place).astype(int), 0, len(heights) - 2)
    share = place - first
    return [np.where(first == k, 1.0 - share, 0.0) + np.where(first == k - 1, share, 0.0) for k in range(len(heights))]
