"""Ascents of many smooth functions of shares from 0 to 1, side by side.

Each follows its own function by a quasi-Newton method (BFGS: Nocedal & Wright, Numerical Optimization, 2006, section
6.1), with the shares held that its slope presses on an end of their range (section 16.7). The first step goes to the
ends to which the slope points.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Index = NDArray[np.int64]
Evaluate = Callable[[Real, Index], tuple[Real, Real]]
"""Values (m,) and slopes (m, k) at shares (m, k), of those functions whose numbers (m,) are given."""

FLAT = 1e-6
"""Slope, over the steepest, that tells nothing."""
SHORTER = 0.25
"""Share of a step that is tried after one that led down."""
STEPS = 12
"""At most, of each."""
GRID = 1e-4
"""To which shares are rounded, so that rounding in slopes, which every step would carry on, does not move them."""
LEAST = 1e-3
"""Share of a step below which an ascent ends."""


def ascend(start: Real, evaluate: Evaluate, near: Real) -> Real:
    """Follow functions upwards.

    Parameters
    ----------
    start : ndarray, shape (n, k)
        Shares, for each of the n functions.
    evaluate : callable
        Sees all shares that are tried.
    near : ndarray, shape (n,)
        Gain to first order below which an ascent ends.

    Returns
    -------
    ndarray, shape (n, k)
        Shares at which they end.
    """
    x, going = start.copy(), np.arange(len(start))
    value, slope = evaluate(x, going)
    part, inverse = np.ones(len(x)), np.zeros((len(x), x.shape[1], x.shape[1]))
    for _ in range(STEPS):
        at, rise = x[going], slope[going]
        rise = np.where(((at <= 0.0) & (rise <= 0.0)) | ((at >= 1.0) & (rise >= 0.0)), 0.0, rise)
        way = np.where(rise != 0.0, np.einsum("nij,nj->ni", inverse[going], rise), 0.0)
        first = np.einsum("ni,ni->n", way, rise) <= 0.0
        flat = np.abs(rise) <= FLAT * np.abs(rise).max(axis=1, keepdims=True)
        way = np.where(first[:, None], np.where(flat, 0.0, (rise > 0.0) - at), way)
        tried = np.round(np.clip(at + part[going, None] * way, 0.0, 1.0) / GRID) * GRID
        gains = np.einsum("ni,ni->n", rise, tried - at) > near[going]
        going, tried = going[gains], tried[gains]
        if not len(going):
            break
        now, then = evaluate(tried, going)
        better = now > value[going]
        own = going[better]
        _learn(inverse, own, tried[better] - x[own], slope[own] - then[better])
        x[own], value[own], slope[own], part[own] = tried[better], now[better], then[better], 1.0
        part[going[~better]] *= SHORTER
        going = going[part[going] > LEAST]
    return x


def _learn(inverse: Real, own: Index, step: Real, change: Real) -> None:
    """Update the inverse curvatures (n, k, k) of those ascents that went by a step with a change of slope downwards."""
    along, size = np.einsum("ni,ni->n", step, change), np.einsum("ni,ni->n", change, change)
    bent = along > 1e-10 * np.sqrt(np.einsum("ni,ni->n", step, step) * size)
    own, step, change, along, size = own[bent], step[bent], change[bent], along[bent], size[bent]
    eye = np.eye(step.shape[1])
    new = ~np.any(inverse[own], axis=(1, 2), keepdims=True)
    known = np.where(new, (along / size)[:, None, None] * eye, inverse[own])
    left = eye - step[:, :, None] * change[:, None, :] / along[:, None, None]
    inverse[own] = left @ known @ left.swapaxes(1, 2) + step[:, :, None] * step[:, None, :] / along[:, None, None]
