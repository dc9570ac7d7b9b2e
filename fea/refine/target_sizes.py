"""Element sizes of the next mesh from the estimated error of the last one.

Strategy of Zienkiewicz and Zhu 1987 (see ``alula.fea.refine.error_estimate``): every element may hold the same share of
the error allowed, ē = η √((‖u_h‖² + ‖e‖²)/m) over m elements, and the one with ‖e‖ = ξ ē gets the size
h/ξ^(1/p), p the order of the elements, or h/ξ^(1/λ) at a re-entrant edge of exponent λ.

To that comes a goal of its own, the peak of the von Mises stress: near every element that may hold the peak,
sizes fall so far that the estimate there becomes a stated share of it, and in any case enough for the
next mesh to count in a series for the observed order.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.space import EDGES, DisplacementSpace
from alula.fea.refine.convergence import FORMAL_ORDER, SERIES, GridConvergence

SERIES_RATIO = 1.5
"""Least size of the last mesh over that of the next one at a peak; at least 1.3 (Celik et al. 2008)."""
MOST_RATIO, MOST_RATIO_ELSEWHERE = 2.0, 1.5
NEAR = 2.5
"""Radius, in element sizes, about a peak in which the mesh becomes finer for the series' sake."""
HOT = 0.9
"""Share of the peak above which an element may hold it."""
GROWTH = 0.6
"""Largest growth of sizes per distance."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LocalGoal:
    """A peak that is to converge.

    Attributes
    ----------
    location : ndarray
        Of the peak (3,) [mm].
    value : float
        Of the peak [MPa].
    stress : ndarray, shape (m,)
        Largest nodal stress in each element [MPa].
    estimate : ndarray, shape (m,)
        Of the stress error in each element [MPa].
    allowed : float
        Estimate over peak that is aimed at.
    ratio : float
        Of the sizes near the peak, last mesh over next one.
    radius : float
        About the peak [mm], at least ``NEAR`` elements, in which sizes fall by that ratio: where a series measures its
        sizes, since a smaller region lets them fall by less.
    """

    location: NDArray[np.float64]
    value: float
    stress: NDArray[np.float64]
    estimate: NDArray[np.float64]
    allowed: float
    ratio: float = SERIES_RATIO
    radius: float = 0.0


def element_sizes(space: DisplacementSpace) -> NDArray[np.float64]:
    """Return the mean length of the edges of each element, taken straight.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.

    Returns
    -------
    ndarray, shape (m,)
        Sizes [mm].
    """
    corners = space.nodes[space.cells[:, :4]]
    return np.asarray(np.mean([np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in EDGES], axis=0))


def reduction(
    energy: NDArray[np.float64], energy_norm: float, allowed: float, exponent: NDArray[np.float64] | float
) -> NDArray[np.float64]:
    """Return the factors by which element sizes fall for an allowed error in the energy norm.

    Parameters
    ----------
    energy : ndarray, shape (m,)
        Energy norm of the error in each element [√(N mm)].
    energy_norm : float
        Of the solution [√(N mm)].
    allowed : float
        Relative error in the energy norm that is aimed at.
    exponent : ndarray or float
        p of the elements, or λ where a singularity rules.

    Returns
    -------
    ndarray, shape (m,)
        Factors ≥ 1.
    """
    whole = np.sqrt((energy_norm**2 + (energy**2).sum()) / len(energy))
    if whole == 0.0:
        return np.ones_like(energy)
    return np.asarray(np.clip((energy / (allowed * whole)) ** (1.0 / exponent), 1.0, MOST_RATIO_ELSEWHERE))


def next_sizes(
    space: DisplacementSpace, factors: Sequence[NDArray[np.float64]], goals: Sequence[LocalGoal]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the points and element sizes of the next mesh, at the corner nodes.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    factors : sequence of ndarray
        By which sizes fall, each (m,): the largest counts (``reduction``).
    goals : sequence of LocalGoal
        Peaks that are to converge.

    Returns
    -------
    tuple of 2 ndarray
        Points (n, 3) and sizes (n,) [mm].
    """
    sizes = element_sizes(space)
    centres = space.nodes[space.cells[:, :4]].mean(axis=1)
    factor = np.max([np.ones(len(sizes)), *factors], axis=0)
    for goal in goals:
        wanted = np.clip(np.sqrt(goal.estimate / (goal.allowed * goal.value)), 1.0, MOST_RATIO)
        hot = goal.stress + goal.estimate >= HOT * goal.value
        factor = np.where(hot, np.maximum(factor, wanted), factor)
        distance = np.linalg.norm(centres - goal.location, axis=1)
        here = float(sizes[np.argsort(distance)[:8]].mean())
        factor = np.where(distance <= max(NEAR * here, goal.radius), np.maximum(factor, goal.ratio), factor)
    corners = space.cells[:, :4]
    # The mean over a node's elements: their least would make the whole mesh finer, by half in number.
    mean = np.bincount(corners.ravel(), np.repeat(sizes, 4)) / np.bincount(corners.ravel())
    finer = np.ones(space.corners)
    np.maximum.at(finer, corners.ravel(), np.repeat(factor, 4))
    finest = mean / finer
    if space.mirror is not None:  # what one half asks for, both get: the mesh is made of a half and its image
        finest = np.minimum(finest, finest[space.mirror[: space.corners]])
    return space.nodes[: space.corners], _rounded(_graded(space, finest))


def _rounded(sizes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round sizes to four digits: else rounding of the loads, 1e-16, gives another mesh and moves a peak by 1 %."""
    unit = 10.0 ** (np.floor(np.log10(sizes)) - 3.0)
    return np.asarray(np.round(sizes / unit) * unit)


def _graded(space: DisplacementSpace, sizes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Limit the growth of nodal sizes along the edges of the mesh."""
    pairs = np.unique(np.sort(np.concatenate([space.cells[:, list(edge)] for edge in EDGES]), axis=1), axis=0)
    length = GROWTH * np.linalg.norm(space.nodes[pairs[:, 0]] - space.nodes[pairs[:, 1]], axis=1)
    while True:
        before = sizes.copy()
        np.minimum.at(sizes, pairs[:, 0], before[pairs[:, 1]] + length)
        np.minimum.at(sizes, pairs[:, 1], before[pairs[:, 0]] + length)
        if (before - sizes <= 1e-9 * before).all():
            return sizes


def series_ratio(series: GridConvergence, accuracy: float) -> float:
    """Return the ratio of the sizes at a peak, last mesh over next one, so that the next mesh narrows its band.

    The first steps are the largest, since no verdict but a far one stands before ``SERIES`` meshes.

    Parameters
    ----------
    series : GridConvergence
        Of the peak on the meshes so far.
    accuracy : float
        Width of the band over the peak that is aimed at.

    Returns
    -------
    float
        From ``SERIES_RATIO`` to ``MOST_RATIO``.
    """
    if not len(series.values) >= SERIES or not math.isfinite(series.index):
        return MOST_RATIO
    order = min(max(series.order or 1.0, 1.0), FORMAL_ORDER)
    return min(max(math.pow(series.index / accuracy, 1.0 / order), SERIES_RATIO), MOST_RATIO)
