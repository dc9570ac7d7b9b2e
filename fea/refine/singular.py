"""Peaks at sharp re-entrant edges, where elasticity has no finite stress whatever the mesh."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.fea.refine.convergence import williams_exponent
from alula.geometry.meshing.mesh import ReentrantEdge

ELEMENT_ORDER = 2.0
AT_EDGE = 1.0
"""Distance from an edge, in element sizes, up to which its singularity rules an element."""
ON_EDGE = 0.01
"""Distance from an edge, over the section's smaller dimension, up to which a node lies on it: edges are polylines."""
LOADED = 0.5
"""Stress on a sharp edge over the peak from which on the edge is refined to see whether it grows without limit."""
NEARLY = 0.25
"""Stress on a sharp edge over one coarse mesh's peak from which on finer meshes judge anew whether it is ``LOADED``."""
SCREENING = 0.2
"""Distance from the edge, over the section's smaller dimension, at which the screening stress is taken."""
SHARE_OF_WILLIAMS = 0.3
"""Observed growth over Williams's exponent 1 − λ from which a peak on an edge is singular."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SharpPeak:
    """A peak that grows without limit at a re-entrant edge.

    Attributes
    ----------
    place : ndarray, shape (3,)
        Of the peak [mm].
    angle : float
        Of the material there [rad].
    growth : float
        Observed exponent s of the peak ~ h^(−s).
    theory : float
        1 − λ after Williams.
    distance : float
        From every re-entrant edge, at which ``screening`` is taken [mm].
    screening : float
        Largest von Mises stress at that distance or more [MPa].
    resolved : bool
        True where elements at the edge are small enough for that distance to be the one aimed at.
    """

    place: NDArray[np.float64]
    angle: float
    growth: float
    theory: float
    distance: float
    screening: float
    resolved: bool

    @property
    def reason(self) -> Reason:
        """Why no number stands for it, and what does for screening."""
        return reason(
            "singular_edge",
            place=tuple(0.0 if abs(v) < 5e-4 else float(v) for v in self.place),
            degrees=float(np.degrees(self.angle)),
            power=-self.growth,
            theory=-self.theory,
            distance=self.distance,
            screening=self.screening,
        )


def edge_distance(edges: Sequence[ReentrantEdge], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the distance of points from each of k edges.

    Parameters
    ----------
    edges : sequence of ReentrantEdge
        Polylines.
    points : ndarray, shape (n, 3)
        Points [mm].

    Returns
    -------
    ndarray, shape (n, k)
        Distances [mm].
    """
    found = np.empty((len(points), len(edges)))
    for number, edge in enumerate(edges):
        start, along = edge.points[:-1], np.diff(edge.points, axis=0)
        square = np.maximum((along**2).sum(axis=1), 1e-300)
        nearest = np.full(len(points), np.inf)
        for a, d, s in zip(start, along, square, strict=True):
            share = np.clip((points - a) @ d / s, 0.0, 1.0)
            nearest = np.minimum(nearest, np.linalg.norm(points - a - share[:, None] * d, axis=1))
        found[:, number] = nearest
    return found


def loaded_edge(
    edges: Sequence[ReentrantEdge],
    nodes: NDArray[np.float64],
    von_mises: NDArray[np.float64],
    section: float,
    share: float = LOADED,
) -> tuple[ReentrantEdge, int] | None:
    """Return the edge whose nodes bear the largest stress, and that node; None where it is well below the peak.

    Parameters
    ----------
    edges : sequence of ReentrantEdge
        Re-entrant edges of the link.
    nodes : ndarray, shape (n, 3)
        Of the mesh [mm].
    von_mises : ndarray, shape (n,)
        Stress at the nodes [MPa].
    section : float
        Smaller dimension of the link's section [mm].
    share : float, optional
        Of the peak, below which the edge does not count.

    Returns
    -------
    tuple of ReentrantEdge and int or None
        The edge and the node.
    """
    if not edges:
        return None
    distance = edge_distance(edges, nodes)
    stress = np.where(distance.min(axis=1) <= ON_EDGE * section, von_mises, -1.0)
    node = int(np.argmax(stress))
    if stress[node] < share * von_mises.max():
        return None
    return edges[int(np.argmin(distance[node]))], node


def element_exponents(
    edges: Sequence[ReentrantEdge], centres: NDArray[np.float64], sizes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the exponents by which errors fall with size: the order of quadratic elements, or λ next to an edge.

    Parameters
    ----------
    edges : sequence of ReentrantEdge
        Re-entrant edges of the link.
    centres : ndarray, shape (m, 3)
        Of the elements [mm].
    sizes : ndarray, shape (m,)
        Of the elements [mm].

    Returns
    -------
    ndarray, shape (m,)
        Exponents.
    """
    exponents = np.full(len(sizes), ELEMENT_ORDER)
    if edges:
        distance = edge_distance(edges, centres)
        for number, edge in enumerate(edges):
            exponents[distance[:, number] <= AT_EDGE * sizes] = williams_exponent(edge.angle)
    return exponents


def sharp_peak(
    edge: ReentrantEdge,
    edges: Sequence[ReentrantEdge],
    *,
    place: NDArray[np.float64],
    sizes: Sequence[float],
    values: Sequence[float],
    nodes: NDArray[np.float64],
    von_mises: NDArray[np.float64],
    section: float,
) -> SharpPeak | None:
    """Return the singular peak at ``place`` on ``edge`` if its growth over the meshes is that of one, else None.

    Parameters
    ----------
    edge : ReentrantEdge
        The edge that bears the peak.
    edges : sequence of ReentrantEdge
        Re-entrant edges of the link.
    place : ndarray, shape (3,)
        Of the peak [mm].
    sizes : sequence of float
        Of the elements at the peak, mesh by mesh, coarse to fine [mm].
    values : sequence of float
        Of the peak, mesh by mesh [MPa].
    nodes : ndarray, shape (n, 3)
        Of the finest mesh [mm].
    von_mises : ndarray, shape (n,)
        Stress at these nodes [MPa].
    section : float
        Smaller dimension of the link's section [mm].

    Returns
    -------
    SharpPeak or None
        The singular peak.
    """
    if (
        len(values) < 3
        or not values[-1] > values[-2] > values[-3] >= values[0] > 0.0
        or not sizes[-1] < sizes[-2] < sizes[-3]
    ):
        return None
    growth = float(np.log(values[-1] / values[0]) / np.log(sizes[0] / sizes[-1]))
    last = float(np.log(values[-1] / values[-2]) / np.log(sizes[-2] / sizes[-1]))
    theory = 1.0 - williams_exponent(edge.angle)
    if min(growth, last) < SHARE_OF_WILLIAMS * theory:
        return None
    away = edge_distance(edges, nodes).min(axis=1)
    distance = max(SCREENING * section, 2.0 * sizes[-1])
    beyond = away >= distance
    return SharpPeak(
        place=place,
        angle=edge.angle,
        growth=growth,
        theory=theory,
        distance=distance,
        screening=float(von_mises[beyond].max()) if beyond.any() else 0.0,
        resolved=distance == SCREENING * section,
    )
