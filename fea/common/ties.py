"""Which of several values counts as the largest where rounding alone tells them apart."""

from math import isfinite

from numpy import argmax, asarray
from numpy.typing import ArrayLike


def first_largest(values: ArrayLike) -> int:
    """Return the number of the first of the largest values: both ends of a turn are one pose, whatever rounding says.

    Parameters
    ----------
    values : array, shape (P,)
        Infinite ones may be among them.

    Returns
    -------
    int
    """
    sizes = asarray(values)
    top = float(sizes.max())
    return int(argmax(sizes >= (top - 1e-9 * abs(top) if isfinite(top) else top)))
