"""Which of several values counts as largest or least where rounding alone tells them apart."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

TIE = 1e-9
"""Values that differ by no more than this share of their size are equal."""


def first_largest(values: ArrayLike, size: float = 0.0) -> int:
    """Return the number of the first of the largest values: both ends of a turn are one pose, whatever rounding says.

    Parameters
    ----------
    values : array, shape (P,)
        Infinite ones may be among them, and NaN, which is passed over.
    size : float, optional
        As of ``first_least``.

    Returns
    -------
    int
    """
    return first_least(-np.asarray(values, dtype=float), size)


def first_least(values: ArrayLike, size: float = 0.0) -> int:
    """Return the number of the first of the least values, as ``first_largest`` does.

    Parameters
    ----------
    values : array, shape (P,)
        Infinite ones may be among them, and NaN, which is passed over.
    size : float, optional
        Size of what the values are differences of, such as the length of which gaps are; where it is left out or less
        than the least value, that of the least value.

    Returns
    -------
    int
    """
    return int(_first(np.asarray(values, dtype=float), size))


def first_largest_of_each(values: ArrayLike) -> NDArray[np.int64]:
    """Return the number of the first of the largest values in each row, as ``first_largest`` does.

    Parameters
    ----------
    values : array, shape (n, P)

    Returns
    -------
    ndarray of int, shape (n,)
    """
    return np.asarray(_first(-np.asarray(values, dtype=float), 0.0))


def _first(given: NDArray[np.float64], size: float) -> NDArray[np.int64]:
    """Numbers of the first of the least values along the last axis."""
    least = np.nanmin(given, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):  # of an infinite one there is no share
        most = np.where(np.isfinite(least), least + TIE * np.maximum(np.abs(least), size), least)
    return np.asarray(np.argmax(given <= most, axis=-1))


def ranked(values: ArrayLike, size: float) -> list[int]:
    """Return the numbers of values in rising order; those that rounding alone tells apart stay in their own order.

    Parameters
    ----------
    values : array, shape (P,)
        Finite.
    size : float
        As of ``first_least``.

    Returns
    -------
    list of int
    """
    given = np.asarray(values, dtype=float)
    order = np.argsort(given, kind="stable")
    group = np.cumsum(np.diff(given[order], prepend=given[order[:1]]) > TIE * size)
    return [int(order[i]) for i in np.lexsort((order, group))]
