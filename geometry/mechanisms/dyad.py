"""The two-bar dyad: the intersection of two circles, the step that closes every four-bar."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

CLOSURE_TOLERANCE = 1e-12
"""Relative to the dyad's length: rounding at a dead point may leave the loop open by this much."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Dyad:
    """Directions of the two bars; angles in rad, all arrays of one shape.

    Attributes
    ----------
    first : ndarray
        Direction of the first bar, from its outer pin to the common pin, in (-π, π].
    second : ndarray
        Direction of the second bar, from its outer pin to the common pin, in (-π, π].
    between : ndarray
        Angle between the bars at the common pin, in [0, π].
    gap : ndarray
        Distance by which the bars fail to meet; 0 where they meet.
    closes : BoolArray
        Where the bars meet in a definite direction; elsewhere the angles are those of the nearest pose.
    """

    first: FloatArray
    second: FloatArray
    between: FloatArray
    gap: FloatArray
    closes: BoolArray


def wrap(angle: ArrayLike) -> FloatArray:
    """Bring angles in rad into (-π, π].

    Parameters
    ----------
    angle : array_like
        Angle of any turn [rad].

    Returns
    -------
    ndarray
        Angles [rad].
    """
    angle = np.asarray(angle, dtype=float)
    return np.asarray(angle - 2 * np.pi * np.ceil((angle - np.pi) / (2 * np.pi)))


def triangle_angle(p: ArrayLike, q: ArrayLike, opposite: ArrayLike) -> FloatArray:
    """Return the angle in rad between the sides p and q of a triangle.

    The half-angle form tan²(γ/2) = (r² - (p - q)²) / ((p + q)² - r²), with its differences of squares
    factored, loses no digits in needle-shaped triangles, where arccos of the law of cosines loses half
    (W. Kahan, Miscalculating Area and Angles of a Needle-like Triangle, 2014). Sides that do
    not form a triangle give the nearest flat one, 0 or π.

    Parameters
    ----------
    p : array_like
        A side.
    q : array_like
        The other side of the angle.
    opposite : array_like
        The third side, opposite of the angle.

    Returns
    -------
    ndarray
        Angles [rad].
    """
    p, q, r = (np.asarray(side, dtype=float) for side in (p, q, opposite))
    numerator = (r - np.abs(p - q)) * (r + np.abs(p - q))
    denominator = (p + q - r) * (p + q + r)
    return np.asarray(2 * np.arctan2(np.sqrt(np.maximum(numerator, 0)), np.sqrt(np.maximum(denominator, 0))))


def close_dyad(dx: ArrayLike, dy: ArrayLike, first: float, second: float, side: int) -> Dyad:
    """Close a dyad over the vector (dx, dy) from the first bar's outer pin to the second's.

    ``side`` is +1 when the common pin lies to the left of that vector and -1 when it lies to the right.
    Equivalent to R. L. Norton, Design of Machinery, 5th ed., chapter 4, without their
    quotient by 2A, which vanishes in regular poses. Shapes of ``dx`` and ``dy`` broadcast.

    Parameters
    ----------
    dx : array_like
        Vector over which the dyad closes, along x.
    dy : array_like
        The same along y.
    first : float
        Length of the first bar.
    second : float
        Length of the second bar.
    side : int
        1 where the common pin lies to the left of that vector, -1 where it lies to the right.

    Returns
    -------
    Dyad
        The closed dyad.
    """
    dx, dy = np.asarray(dx, dtype=float), np.asarray(dy, dtype=float)
    reach = np.hypot(dx, dy)
    gap = np.maximum(np.maximum(reach - (first + second), abs(first - second) - reach), 0.0)
    tolerance = CLOSURE_TOLERANCE * (first + second)
    line = np.arctan2(dy, dx)
    return Dyad(
        first=wrap(line + side * triangle_angle(first, reach, second)),
        second=wrap(line + np.pi - side * triangle_angle(second, reach, first)),
        between=triangle_angle(first, second, reach),
        gap=np.asarray(gap),
        # Equal bars whose outer pins coincide are free to spin: the pose is not definite.
        closes=np.asarray((gap <= tolerance) & (reach > tolerance)),
    )
