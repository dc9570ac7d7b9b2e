"""The surface of a solid, cut along its sharp edges, so that a light shows them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from alula.reports.figures.figures_worker import SMOOTH_BELOW

Real = NDArray[np.float64]
Int = NDArray[np.int64]

_EDGES = np.array([[0, 1, 3], [1, 2, 4], [0, 2, 5]])
"""Corners and middle node of the edges of a face."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CutSurface:
    """Faces whose vertices belong to one side of every sharp edge.

    Attributes
    ----------
    nodes : int array
        (v,), the node of the mesh at every vertex.
    faces : int array
        (b, 3) or (b, 6) vertices, as in the mesh.
    edges : int array
        (e, 2) vertices along the sharp edges.
    """

    nodes: Int
    faces: Int
    edges: Int


def cut_surface(points: Real, faces: Int) -> CutSurface:
    """Cut a surface along its sharp edges: where the faces on both sides are at more than ``SMOOTH_BELOW`` degrees.

    Directions are those of the curved faces in the middle of the edge: a coarse mesh of a round eye has corners in its
    plane triangles, but hardly any in its quadratic ones.

    Parameters
    ----------
    points : array
        Nodes (n, 3) [mm].
    faces : int array
        Linear (b, 3) or quadratic (b, 6) faces.

    Returns
    -------
    CutSurface
    """
    count, width = faces.shape
    sides = _EDGES[:, : 3 if width == 6 else 2]
    ends = faces[:, _EDGES[:, :2]].reshape(-1, 2)
    _, edge, times = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge, kind="stable")
    paired = order[times[edge[order]] == 2].reshape(-1, 2)
    directions = _directions(points[faces])
    smooth = np.einsum("ij,ij->i", *directions[paired.T]) > np.cos(np.deg2rad(SMOOTH_BELOW))
    slots = (np.arange(count)[:, None, None] * width + sides).reshape(-1, sides.shape[1])
    one, other = slots[paired[smooth, 0]], slots[paired[smooth, 1]].copy()
    turned = ends[paired[smooth, 0], 0] != ends[paired[smooth, 1], 0]
    other[turned, :2] = other[turned, 1::-1]
    joined = coo_array((np.ones(one.size, dtype=bool), (one.ravel(), other.ravel())), shape=(faces.size, faces.size))
    number, vertex = connected_components(joined, directed=False)
    nodes = np.empty(number, dtype=np.int64)
    nodes[vertex] = faces.ravel()
    sharp = np.ones(len(slots), dtype=bool)
    sharp[paired[smooth]] = False
    sharp[paired[~smooth, 1]] = False
    lines = vertex[slots[sharp]]
    lines = lines if lines.shape[1] == 2 else lines[:, [0, 2, 2, 1]].reshape(-1, 2)
    return CutSurface(nodes=nodes, faces=vertex.reshape(faces.shape).astype(np.int64), edges=lines.astype(np.int64))


def _directions(at: Real) -> Real:
    """Unit normals (3 b, 3) of faces (b, 3 or 6, 3) in the middle of their edges 01, 12 and 02."""
    if at.shape[1] == 3:
        normal = np.repeat(np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])[:, None], 3, axis=1)
    else:
        middles = ((0.5, 0.0), (0.5, 0.5), (0.0, 0.5))
        normal = np.stack([np.cross(*_tangents(at, xi, eta)) for xi, eta in middles], axis=1)
    normal = normal.reshape(-1, 3)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(normal / np.where(size > 0.0, size, 1.0))


def _tangents(at: Real, xi: float, eta: float) -> tuple[Real, Real]:
    """Derivatives (b, 3) of quadratic faces along ξ, from corner 0 to 1, and along η, from corner 0 to 2.

    References
    ----------
    Zienkiewicz, Taylor & Zhu, The Finite Element Method, 6th ed., vol. 1, section 4.7: shape functions of triangles.
    """
    first = 4.0 * (xi + eta) - 3.0
    along_xi = np.array([first, 4.0 * xi - 1.0, 0.0, 4.0 * (1.0 - 2.0 * xi - eta), 4.0 * eta, -4.0 * eta])
    along_eta = np.array([first, 0.0, 4.0 * eta - 1.0, -4.0 * xi, 4.0 * xi, 4.0 * (1.0 - xi - 2.0 * eta)])
    return np.einsum("k,bkj->bj", along_xi, at), np.einsum("k,bkj->bj", along_eta, at)
