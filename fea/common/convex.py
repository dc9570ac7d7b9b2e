"""Ends of convex functions: the least of one from its values at a few places, the largest at outermost points."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

FLAT = 1e-4
"""Extent of points in a direction, over their largest, below which they have none."""
MOST_DIRECTIONS = 6
"""Beyond so many nearly all points are corners of their convex hull, and finding it takes long."""


def outermost(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the corners of the convex hull of points: at one of them a convex function is largest.

    Parameters
    ----------
    points : ndarray, shape (n, d)

    Returns
    -------
    ndarray of int
        Their numbers, rising; of points in more than ``MOST_DIRECTIONS`` directions, and where no hull is found, all.
    """
    place, extent, _ = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    place = place[:, extent > FLAT * extent[0]]  # the hull has the same corners however it is stretched
    count, directions = place.shape
    if directions == 0:
        return np.array([0])
    if directions == 1:
        return np.unique([place.argmin(), place.argmax()])
    if directions > MOST_DIRECTIONS or count <= directions + 1:
        return np.arange(count)
    from scipy.spatial import ConvexHull, QhullError

    try:
        return np.sort(ConvexHull(place).vertices).astype(np.int64)
    except QhullError:  # points that are corners but for rounding
        return np.arange(count)


def least_of_convex(found: Iterable[tuple[float, float]]) -> float:
    """Return a lower bound of a convex function between the first and the last of some places.

    Beyond a piece between two places, a convex function lies above the line through its ends. So between two
    neighbours it lies above the lines of the pieces before and after.

    Parameters
    ----------
    found : iterable of tuple of (float, float)
        Places, in any order, with the values there; at least three for a bound, of two the least is returned.

    Returns
    -------
    float
        At most the least of the values.
    """
    known = sorted(dict(found).items())
    least = min(value for _, value in known)
    lines = [((b - a) / (x1 - x0), x0, a) for (x0, a), (x1, b) in pairwise(known)]
    for i, (start, end) in enumerate(pairwise(known)):
        before = lines[i - 1] if i > 0 else None
        after = lines[i + 1] if i + 1 < len(lines) else None
        if before and after:
            steeper = after[0] - before[0]
            if steeper > 0.0:
                x = (_at(before, 0.0) - _at(after, 0.0)) / steeper
                if start[0] < x < end[0]:
                    least = min(least, _at(before, x))
        elif before:
            least = min(least, _at(before, end[0]))
        elif after:
            least = min(least, _at(after, start[0]))
    return least


def _at(line: tuple[float, float, float], x: float) -> float:
    slope, x0, y0 = line
    return y0 + slope * (x - x0)
