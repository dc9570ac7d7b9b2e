"""What presses on the wall of a hole that bears a force and a couple of its pin: the integral of pressure along it.

The pressure's resultant per length varies linearly along the hole, q(z) = F/L + D (z - m)/I, with the length L of the
walls, their middle m and their second moment I. F is the force, and D its first moment about m, which is M x e for a
couple M about axes in the plane and the direction e of the pin. Friction about the pin is mu r times the integral of
|q|. That is |F| where the couple is small and presses both rims on the same side, and more beyond: of a single wall
with F along D, from |D| = |F| L/6 on, |F| (a/4 + 1/a) with a = 12 |D|/(|F| L).
A pin that bends in its hole presses otherwise (``alula.loads.statics.foundation``).
"""

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.features import Ring
from alula.loads.statics.foundation import Foundation

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
PIECES = 16
"""Of the wall, in the integral of a pin that bends."""
FAR = 2.0
"""Distance of the least pressure from the middle of a wall, over half its length, beyond which the rule is exact."""


def pressing(force: Complex, moment: Complex, ring: Ring, foundation: Foundation | None = None) -> Real:
    """Return what presses on the wall of a hole.

    Parameters
    ----------
    force : complex array (...)
        Fx + i Fy that the hole bears [N].
    moment : complex array (...)
        Mx + i My about where z is 0 [N mm].
    ring : Ring
        The hole.
    foundation : Foundation, optional
        Of a pin that bends in the hole; it is loaded from the same side in all of these.

    Returns
    -------
    array (...)
        Integral of the size of the pressure's resultant per length [N], at least |force|.
    """
    first = -1j * moment - ring.middle * force
    if foundation is not None:
        return np.asarray(np.maximum(_size_of_bent(force, first, foundation), np.abs(force)))
    slope, total = first / ring.second, np.zeros(np.shape(first))
    for low, high in ring.walls:
        at_middle = force / ring.thickness + slope * (0.5 * (low + high) - ring.middle)
        total += _size_along(at_middle, slope, 0.5 * (high - low))
    return np.asarray(np.maximum(total, np.abs(force)))


def _size_of_bent(force: Complex, first: Complex, foundation: Foundation) -> Real:
    """Return the integral of |q| of a pin that bends, by Gauss's rule on pieces: where q turns over, |q| has a kink."""
    edges = np.linspace(-0.5, 0.5, PIECES + 1) * foundation.length
    half = 0.5 * (edges[1] - edges[0])
    z = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * _NODES
    even, turning = foundation.shapes(z)
    each = np.abs(np.asarray(force)[..., None, None] * even + np.asarray(first)[..., None, None] * turning)
    return np.asarray(half * (each @ _WEIGHTS).sum(axis=-1))


def _size_along(middle: Complex, slope: Complex, half: float) -> Real:
    """Return the integral of |middle + slope s| for s from -half to half.

    The size is |slope| sqrt(u^2 + h^2), with u = s - s0 from where it is least and h its least over |slope|. Where s0
    is far off, small differences of large numbers would be left, and Gauss's rule is exact.
    """
    steep = np.abs(slope)
    with np.errstate(divide="ignore", invalid="ignore"):
        least = np.where(steep > 0.0, -middle / np.where(steep > 0.0, slope, 1.0), np.inf)
    near = np.isfinite(least) & (np.abs(least) < FAR * half)
    place = np.where(near, least, 0.0)
    h = np.abs(place.imag)
    ends = [_antiderivative(sign * half - place.real, h) for sign in (1.0, -1.0)]
    closed = steep * (ends[0] - ends[1])
    s = half * _NODES
    far = half * np.abs(np.asarray(middle)[..., None] + np.asarray(slope)[..., None] * s) @ _WEIGHTS
    return np.asarray(np.where(near, closed, far))


def _antiderivative(u: Real, h: Real) -> Real:
    """Return that of sqrt(u^2 + h^2) by u."""
    over = np.arcsinh(np.divide(u, h, out=np.zeros_like(u), where=h > 0.0))
    return np.asarray(0.5 * (u * np.hypot(u, h) + h**2 * over))
