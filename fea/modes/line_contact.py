"""Hertz's pressure of a pin on the flat flank of its slot, along a line, and the stress below it.

``docs/theory/connections.md`` derives the field of stress under that pressure and the friction of a pin that slides.
"""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band

Real = NDArray[np.float64]
REACH, STEPS = 1.5, 301
"""How far the largest stress is sought beside the middle and below the surface, in half widths, and at how many places:
to 0.1 % of it (``tests/unit/fea/test_line_contact.py``)."""


@dataclass(frozen=True, kw_only=True)
class LineContact:
    """Contact of a joint's pin in its slot.

    Attributes
    ----------
    line_load : float
        Force over length, where it is largest [N/mm].
    pressure, half_width : float
        Largest pressure [MPa], and half the width of contact [mm].
    factors : dict of str to Band
        Safety factor of ``pin`` and ``flank``, or of both together as ``pressure`` where a limit on it is stated.
    """

    line_load: float
    pressure: float
    half_width: float
    factors: dict[str, Band]


def hertz_pressure(load: float, radius: float, pin: tuple[float, float], flank: tuple[float, float]) -> float:
    """Return the largest pressure of a cylinder on a flat.

    Parameters
    ----------
    load : float
        Over length [N/mm].
    radius : float
        Of the cylinder [mm].
    pin, flank : tuple of 2 float
        Young's modulus [MPa] and Poisson's ratio.

    Returns
    -------
    float
        [MPa]

    References
    ----------
    Hertz, p0 = sqrt(P E*/(π R)) with 1/E* = (1 - ν1²)/E1 + (1 - ν2²)/E2.
    """
    soft = sum((1.0 - ratio**2) / young for young, ratio in (pin, flank))
    return math.sqrt(load / (math.pi * radius * soft))


def stress_below(x: Real, z: Real, friction: float) -> tuple[Real, Real, Real]:
    """Return the stress in a half-plane under Hertz's pressure sqrt(1 - x²) and its friction along +x.

    With ζ = x + i z and G = ζ - sqrt(ζ² - 1), the Cauchy integral of the pressure, the pressure alone makes
    σx + σz = 2 Im G, σz - σx = -2 z Re G' and τ = -z Im G'. Friction makes, each times its coefficient,
    σx + σz = -2 Re G, σz - σx = 2 Re G - 2 z Im G' and τ = Im G + z Re G'.

    Parameters
    ----------
    x, z : ndarray
        Place along the surface and below it, in half widths.
    friction : float
        Its coefficient; it pushes the half-plane along +x.

    Returns
    -------
    tuple of 3 ndarray
        σx, σz and τxz over the largest pressure.
    """
    place = x + 1j * z
    root = np.sqrt(place - 1.0) * np.sqrt(place + 1.0)
    potential, slope = place - root, 1.0 - place / root
    total = 2.0 * potential.imag - 2.0 * friction * potential.real
    apart_ = -2.0 * z * slope.real + friction * (2.0 * potential.real - 2.0 * z * slope.imag)
    shear = -z * slope.imag + friction * (potential.imag + z * slope.real)
    return (total - apart_) / 2.0, (total + apart_) / 2.0, shear


@cache
def most_equivalent(poisson: float, friction: float = 0.0) -> float:
    """Return the largest von Mises stress below a line of contact over its largest pressure, in plane strain.

    Parameters
    ----------
    poisson : float
        Poisson's ratio.
    friction : float, optional
        Coefficient of friction.

    Returns
    -------
    float
        0.558 at 0.3 without friction, so that yield begins at a pressure of 1.79 times the yield strength.
    """
    place = np.linspace(-REACH, REACH, STEPS), np.linspace(0.0, REACH, STEPS) + 1e-9
    along, below, shear = stress_below(*np.meshgrid(*place), friction)
    out = poisson * (along + below)
    square = ((along - below) ** 2 + (below - out) ** 2 + (out - along) ** 2) / 2.0 + 3.0 * shear**2
    return float(np.sqrt(square.max()))
