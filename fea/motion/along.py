"""The largest stress along a link at poses of its motion, for pictures that show where it is."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.motion.envelope_result import StressAlong, VariantCurve
from alula.fea.superposition.link_measure import LinkMeasure
from alula.geometry.base.ties import first_largest

Real = NDArray[np.float64]

STATIONS = 32
"""Stretches of equal length into which a link is parted along its x axis."""
POSES = 120
"""At most about so many poses of a motion, evenly spread."""


def spread_poses(count: int) -> NDArray[np.int64]:
    """Return the numbers of evenly spread poses of a motion.

    Parameters
    ----------
    count : int
        Poses of the motion.

    Returns
    -------
    ndarray of int
    """
    return np.unique(np.linspace(0, count - 1, min(count, POSES)).round().astype(np.int64))


def stress_along(measure: LinkMeasure, curve: VariantCurve, evaluated: NDArray[np.bool_]) -> StressAlong:
    """Return the stress along a link over a motion: at evenly spread poses, and at the worst.

    Parameters
    ----------
    measure : LinkMeasure
    curve : VariantCurve
        The variant that governs.
    evaluated : ndarray of bool, shape (n,)
        The poses that count; others are left out.

    Returns
    -------
    StressAlong
        Of fewer stretches where the mesh has some without a node.
    """
    poses = np.union1d(spread_poses(len(evaluated)), [first_largest(curve.stress)])
    poses = poses[evaluated[poses]]
    loads = curve.first + np.cumsum(evaluated)[poses] - 1
    solved = measure.solved
    x = solved.space.nodes[solved.nodes, 0]
    first, last = float(x.min()), float(x.max())
    stretches = STATIONS
    while True:
        stretch = np.minimum(((x - first) / max(last - first, 1e-12) * stretches).astype(int), stretches - 1)
        if stretches == 1 or len(np.unique(stretch)) == stretches:
            break
        stretches -= 1
    stress = np.empty((len(poses), stretches))
    for k in range(stretches):
        stress[:, k] = measure.decisive.at(np.flatnonzero(stretch == k), solved.combination[:, loads]).max(axis=0)
    return StressAlong(first=first, last=last, poses=poses, stress=stress)
