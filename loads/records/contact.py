"""Contact of a pin with its hole where the clearance is known: the closed form for similar materials, in the plane.

A pin of radius R - ΔR (ΔR = c/2, c the diametral clearance) is pushed by the force F into a hole of radius R through an
infinite plate of thickness t, without friction, in plane stress. With x = tan(θ/2), θ from the force's direction, the
half angle α of contact and

    b = tan(α/2),    s = √(1 + b²),    p1 = F/(π R t)

the pressure and the clearance are

    p = p1 [2 √(b² - x²)/(s (1 + x²)) + ln((s + √(b² - x²))/(s - √(b² - x²)))/(2 b² s²)],
    E c t/F = 2 (2 - 2 b⁴ - ln(1 + b²))/(π b² (1 + b²)).

Derivation. The pressure Σ p_n cos nθ, n ≥ 2, moves the wall of the hole and that of the disc by (Muskhelishvili's
potentials φ' = -z^-n/2 and -z^n/2; κ = (3 - ν)/(1 + ν))

    2μ u_n = R (κ/(2(n - 1)) + 1/(2(n + 1))) p_n    and    -R (κ/(2(n + 1)) + 1/(2(n - 1))) p_n.

Of similar materials both differ by w_n = (4R/E) n/(n² - 1) p_n, and w_0 = (2R/E) p_0. Where they touch,
ΔR + w(θ) = δ cos θ with the pin's shift δ, in which all of n = 1 is held. The operator d²/dθ² + 1 takes δ away:

    Σ n p_n cos nθ = p1 cos θ + C,    C = p_0/2 + E ΔR/(4R).

The left side is (1/2π) ∫ p'(φ) cot((θ - φ)/2) dφ, and in x

    (1/π) ∫ (dp/ds)/(x - s) ds = 2 p1 (1 - x²)/(1 + x²)² + 2C/(1 + x²).

The two terms of p above are its solutions for the two terms on the right, with s/(1 + x²)-transforms by residues. That
p1 is the first coefficient of p gives C = p1/(2 b² s²); that p_0 is its mean gives p_0 = p1 b²/s² + C ln(1 + b²), and
so the clearance. For b → 0 it is Hertz's line contact, and c = 0 at α = 84.8°. The result is Persson's; a Poisson's
ratio is not in it.

References
----------
Persson, On the Stress Distribution of Cylindrical Elastic Bodies in Contact, thesis, Chalmers, Gothenburg, 1964.
Ciavarella & Decuzzi, The state of stress induced by the plane frictionless cylindrical contact. I. The case of elastic
similarity, Int. J. Solids Struct. 38 (2001) 4507-4523.
Johnson, Contact Mechanics, Cambridge University Press 1985, chapter 5.3.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]

_HALVINGS = 60


def tightness(half_angle: ArrayLike) -> Real:
    """Return E c t/F of similar materials at which a pin touches its hole over a half angle; it falls with the angle.

    Parameters
    ----------
    half_angle : array_like
        α [rad], above 0 and below π.

    Returns
    -------
    array
        Below zero where the pin would have to be larger than its hole.
    """
    b2 = np.tan(0.5 * np.asarray(half_angle, dtype=np.float64)) ** 2
    return np.asarray(2.0 * (2.0 - 2.0 * b2**2 - np.log1p(b2)) / (math.pi * b2 * (1.0 + b2)))


def half_angle(clearance: ArrayLike) -> Real:
    """Return the half angle of contact of similar materials.

    Parameters
    ----------
    clearance : array_like
        E c t/F, from 0.

    Returns
    -------
    array
        α [rad].
    """
    wanted = np.asarray(clearance, dtype=np.float64)
    low, high = np.zeros(wanted.shape), np.full(wanted.shape, CONFORMAL)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        wider = tightness(middle) > wanted
        low, high = np.where(wider, middle, low), np.where(wider, high, middle)
    return np.asarray(0.5 * (low + high))


def pressure(theta: ArrayLike, half_angle: ArrayLike) -> Real:
    """Return the pressure over the nominal bearing stress F/(d t).

    Parameters
    ----------
    theta : array_like
        Angles from the direction of the force [rad], in any period.
    half_angle : array_like
        α [rad], above 0 and below π.

    Returns
    -------
    array
        p d t/F, zero where the pin does not touch; its resultant is the force.
    """
    angle = np.mod(np.asarray(theta, dtype=np.float64) + math.pi, 2.0 * math.pi) - math.pi
    alpha = np.asarray(half_angle, dtype=np.float64)
    angle = np.clip(angle, -alpha, alpha)
    b, x = np.tan(0.5 * alpha), np.tan(0.5 * angle)
    s, root = np.sqrt(1.0 + b**2), np.sqrt(np.maximum(b**2 - x**2, 0.0))
    logarithm = 2.0 * np.arctanh(root / s)
    return np.asarray(2.0 / math.pi * (2.0 * root / (s * (1.0 + x**2)) + logarithm / (2.0 * b**2 * s**2)))


CONFORMAL = 2.0 * math.atan(0.9135727915594122)
"""Half angle of a pin without clearance [rad], where 2 - 2 b⁴ = ln(1 + b²): 84.83°."""
PULLED = (1.452, 0.847, 1.533)
"""Of a finite eye that its pin pulls off the shank: S over (r/(r - 1))⁴ - 1 for r = D/d, angle [rad] and exponent.

Fitted by least squares to 70 contact solutions of ten eyes by ``benchmarks/contact_plane.py`` (D/d of 1.5 to 3.4,
shanks of 0.55 to 1 D, rigid pins, steel in plastic and one material, E c t/F of 0.03 to 200). They scatter by 3.6°
about it.
"""


def eye_half_angle(clearance: ArrayLike, *, stiffer: float, ratio: float) -> Real:
    """Return the half angle of contact in an eye that its pin pulls off its shank, by a calibrated law.

    A pin stiffer than the eye sinks in less: of E c t/F the part 2 E_p/(E + E_p) counts, as in Hertz's contact. A thin
    eye closes about its pin, which takes S h(α) off E c t/F, with S = s0 ((r/(r - 1))⁴ - 1) and h = exp(-(α/α0)^n).

    Parameters
    ----------
    clearance : array_like
        E c t/F, from 0, with the modulus of the eye.
    stiffer : float
        2 E_p/(E + E_p), with that of the pin: 1 of one material, 2 of a rigid pin.
    ratio : float
        D/d of the eye.

    Returns
    -------
    array
        α [rad].
    """
    wanted, (size, angle, power) = stiffer * np.asarray(clearance, dtype=np.float64), PULLED
    closing = stiffer * size * ((ratio / (ratio - 1.0)) ** 4 - 1.0)
    low, high = np.zeros(wanted.shape), np.full(wanted.shape, math.pi - 1e-6)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        wider = tightness(middle) + closing * np.exp(-((middle / angle) ** power)) > wanted
        low, high = np.where(wider, middle, low), np.where(wider, high, middle)
    return np.asarray(0.5 * (low + high))
