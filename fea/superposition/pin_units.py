"""Unit loads of a pin in a hole: pressure fields from which its pressure follows in every direction.

The pressure p(θ − α) of a pin is not linear in its force, but its Fourier series is a sum of fixed fields:

    p(θ − α) = Σ a_n (cos nα cos nθ + sin nα sin nθ)

The fields cos nθ and sin nθ on the hole, with the coefficients of either span, give it in every direction α. A traction
of the rigid-body fields on the same hole takes the resultant off each field. Two such tractions deliver the force. So
the sum carries exactly the force that statics asks for, on the hole as it is meshed.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.tractions.traction import LARGEST_CORRECTION, first_opening, into_opening
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Pin
from alula.loads.records.bearing import PressureLaw

Real = NDArray[np.float64]

HIGHEST_ORDER = 16
"""Of the pressure's Fourier series. Measured on a bar with 24 quadratic elements round its holes under a force that
turns fully, as the largest difference of the peak stress from the pressure's own, over 180° and over 90°: 0.17 and
0.63 % with orders to 8, 0.20 and 1.13 % to 10, 0.12 and 0.36 % to 12, 0.05 and 0.09 % to 16. They took 38, 45, 48 and
50 solutions, since only the span of the motion's loads is solved for."""


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


@dataclass(frozen=True, kw_only=True, eq=False)
class PinUnits:
    """Where the unit loads of one pin stand, and what its pressure fields deliver on the mesh.

    Attributes
    ----------
    pin : Pin
    cosine, sine : slice
        Numbers of the fields cos nθ, n = 0, 1, ..., and sin nθ, n = 1, 2, ...
    force : slice
        Numbers of the tractions that deliver a unit force along x and y.
    wrench : ndarray, shape (6, 2 orders − 1)
        Resultants of the pressure fields about the pin, before these were taken off [N, N mm].
    wall : ndarray, shape (k,)
        Angles at which there is some wall [rad].
    """

    pin: Pin
    cosine: slice
    sine: slice
    force: slice
    wrench: Real
    wall: Real

    def coefficients(self, force: Real, law: PressureLaw) -> tuple[Real, Real]:
        """Return the coefficients of the pressure fields and of the tractions.

        The pressure is turned and scaled until it delivers the force on the meshed hole, as
        ``alula.fea.tractions.traction.pin_traction`` does.

        Parameters
        ----------
        force : ndarray, shape (n, 2)
            Of the pin on the link, at n poses [N].
        law : PressureLaw

        Returns
        -------
        tuple of (ndarray, shape (2 orders − 1, n), ndarray, shape (2, n))
            Those of the fields [MPa], and those of the tractions [N].

        Raises
        ------
        CannotRunError
            For a hole meshed too coarsely, or open where the pin pushes.
        """
        size = np.hypot(force[:, 0], force[:, 1])
        loaded = size > 0.0
        wanted = np.arctan2(force[loaded, 1], force[loaded, 0])
        a = fourier_coefficients(law, self.cosine.stop - self.cosine.start - 1)[:, None]
        order = np.arange(len(a))[:, None]
        direction = wanted.copy()
        for _ in range(100):
            series = np.vstack([a * np.cos(order * direction), (a * np.sin(order * direction))[1:]])
            got = self.wrench @ series
            error = np.remainder(wanted - np.arctan2(got[1], got[0]) + math.pi, 2.0 * math.pi) - math.pi
            if np.all(np.abs(error) < 1e-13):
                break
            direction += error
        else:
            raise CannotRunError(
                f"the hole at pin {self.pin.name} is meshed too coarsely to carry the pin's pressure; refine it"
            )
        bare = first_opening(self.wall, direction)
        if bare is not None:
            raise CannotRunError(into_opening(self.pin.name, bare))
        got *= size[loaded] / np.hypot(got[0], got[1])
        missing = np.vstack([got[:2] - force[loaded].T, got[2:]])
        gap = np.linalg.norm(missing[:3], axis=0) + np.linalg.norm(missing[3:], axis=0) / self.pin.diameter
        if np.any(gap > LARGEST_CORRECTION * size[loaded]):
            raise CannotRunError(
                f"the hole at pin {self.pin.name} is meshed too unevenly: its pressure misses the load by "
                f"{float(np.max(gap / size[loaded])):.1%}; refine it"
            )
        pressure = np.zeros((len(series), len(force)))
        pressure[:, loaded] = series * (size[loaded] / np.hypot(*(self.wrench @ series)[:2]))
        return pressure, force.T
