"""Extremes of smooth periodic functions from even samples."""

import numpy as np

from alula.geometry.mechanisms.dyad import FloatArray


def periodic_maximum(values: FloatArray) -> float:
    """Return the maximum of a smooth periodic function.

    The greatest sample is refined by the parabola through it and its neighbours: the error falls with the
    fourth power of the spacing, that of the sample itself with the second.

    Parameters
    ----------
    values : ndarray
        Even samples (n,) of one period.

    Returns
    -------
    float
        The maximum.
    """
    at = int(np.argmax(values))
    before, top, after = values[at - 1], values[at], values[(at + 1) % values.size]
    curvature = before - 2 * top + after
    return float(top if curvature >= 0 else top - (after - before) ** 2 / (8 * curvature))


def periodic_minimum(values: FloatArray) -> float:
    """Return the minimum, as ``periodic_maximum`` returns the maximum.

    Parameters
    ----------
    values : ndarray
        Even samples (n,) of one period.

    Returns
    -------
    float
        The minimum.
    """
    return -periodic_maximum(-values)
