"""Laws of the pressure between a pin and its hole, as functions of the angle from the direction of the force."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.base.errors import CaseError

Span = Literal[180, 90]


@dataclass(frozen=True, kw_only=True)
class PressureLaw:
    """Frictionless pin pressure p(θ) = p0 cos(kθ) for |θ| < span/2, zero elsewhere.

    The cosine over 180° is the usual law for a pin that fits; the narrower one stands for clearance. Against contact on
    a plane eye a cosine over 180° reads 13 to 26 % low in peak stress, one over 90° 2 to 6 % low: both are run, the
    larger stress is reported, and its band reaches on by ``CONTACT_SHORTFALL``.

    Attributes
    ----------
    span : {180, 90}
        Loaded angle of the hole [degrees]: 180 (k = 1) or 90 (k = 2). Both end at zero pressure; a cosine cut off at
        ±45° would leave a jump.
    """

    span: Span

    def patch(self, pin_diameter: float) -> float:
        """Return the length of a slot's flank on which a pin pushes: half the diameter, or a quarter of it.

        A pin on a flat flank touches it along a line (Hertz's half width is some hundredths of the pin's radius), which
        no mesh of a whole link resolves. The wide law takes half, the narrow one a quarter.

        Parameters
        ----------
        pin_diameter : float
            Diameter [mm].

        Returns
        -------
        float
            Length [mm].
        """
        return pin_diameter * self.span / 360.0

    @property
    def wave(self) -> int:
        """The factor k of the angle in p0 cos(kθ)."""
        return 180 // self.span

    def shape(self, theta: ArrayLike) -> NDArray[np.float64]:
        """Return p(θ)/p0.

        Parameters
        ----------
        theta : array_like
            Angles from the direction of the force [rad], in any period.

        Returns
        -------
        array
            Of the same shape.
        """
        angle = np.mod(np.asarray(theta, dtype=np.float64) + math.pi, 2.0 * math.pi) - math.pi
        return np.where(np.abs(angle) < math.radians(self.span) / 2.0, np.cos(self.wave * angle), 0.0)

    def peak(self, *, force: float, diameter: float, thickness: float) -> float:
        """Return the peak pressure p0 of a force on a hole.

        Equilibrium F = p0 t (d/2) ∫ cos(kθ) cos θ dθ gives p0 = 4F/(π d t) for 180° and 3F/(√2 d t) for 90°.

        Parameters
        ----------
        force : float
            Force F [N].
        diameter, thickness : float
            Diameter d and length t of the hole [mm].

        Returns
        -------
        float
            Peak pressure [MPa].
        """
        factor = 4.0 / math.pi if self.span == 180 else 3.0 / math.sqrt(2.0)
        return factor * bearing_stress(force=force, diameter=diameter, thickness=thickness)


WIDE = PressureLaw(span=180)
NARROW = PressureLaw(span=90)
CONTACT_SHORTFALL = 0.06
"""Share of the stress of contact by which the narrow law may fall short of it in an eye: the most that was measured."""


def bearing_stress(*, force: float, diameter: float, thickness: float) -> float:
    """Return the nominal bearing stress F/(d t) of a pin on an eye.

    Parameters
    ----------
    force : float
        Across the pin [N].
    diameter : float
        Of the pin [mm].
    thickness : float
        Of the eye [mm].

    Returns
    -------
    float
        [MPa]

    Raises
    ------
    CaseError
        For a pin or an eye without size.

    References
    ----------
    Budynas & Nisbett, Shigley's Mechanical Engineering Design, 10th ed., chapter 8.
    """
    if not (diameter > 0.0 and thickness > 0.0):
        raise CaseError(
            f"bearing needs a pin and an eye above zero, not {diameter:g} mm by {thickness:g} mm; state both"
        )
    return force / (diameter * thickness)
