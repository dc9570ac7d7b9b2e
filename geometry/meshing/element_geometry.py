"""Volumes, areas and validity of straight and curved simplices, from their node coordinates alone.

Nodes stand in VTK's order: corners, then the mid-nodes of the edges 01, 12, 02 of a triangle and
01, 12, 02, 03, 13, 23 of a tetrahedron.
"""

import itertools
import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

TETRA_EDGES = np.array([[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]])
TRIANGLE_EDGES = np.array([[0, 1], [1, 2], [0, 2]])

_Array = NDArray[np.float64]
_Ints = NDArray[np.int64]


def shape_gradients(edges: _Ints, at: _Array) -> _Array:
    """Return the gradients of the quadratic functions of a simplex.

    Parameters
    ----------
    edges : ndarray
        Corners of the edges that carry mid-nodes.
    at : ndarray
        Points (q, d) of the unit simplex.

    Returns
    -------
    ndarray
        (q, nodes, d).
    """
    d = at.shape[1]
    bary = np.hstack([1.0 - at.sum(axis=1, keepdims=True), at])
    slope = np.vstack([-np.ones(d), np.eye(d)])
    corners = (4.0 * bary[:, :, None] - 1.0) * slope[None, :, :]
    i, j = edges.T
    mids = 4.0 * (bary[:, i, None] * slope[j] + bary[:, j, None] * slope[i])
    return np.concatenate([corners, mids], axis=1)


@cache
def _cubic_lattice() -> tuple[_Array, _Array]:
    """Return 20 lattice points (20, 3) and the matrix from values there to cubic Bernstein coefficients."""
    powers = np.array([p for p in itertools.product(range(4), repeat=4) if sum(p) == 3])
    bary = powers / 3.0
    weight = [6.0 / math.prod(math.factorial(int(k)) for k in p) for p in powers]
    values = np.stack([w * np.prod(bary**p, axis=1) for p, w in zip(powers, weight, strict=True)], axis=1)
    return bary[:, 1:], np.linalg.inv(values)


def jacobian_coefficients(points: _Array, cells: _Ints) -> _Array:
    """Return the Bernstein coefficients of each element's Jacobian determinant.

    Their least and greatest value bound the determinant everywhere in the element; their mean is six times its volume.

    Parameters
    ----------
    points : ndarray
        Nodes (n, 3).
    cells : ndarray
        Elements (m, 4) or (m, 10), node numbers.

    Returns
    -------
    ndarray
        Coefficients (m, 1) of straight elements, (m, 20) of curved ones.

    References
    ----------
    Johnen, Remacle, Geuzaine, J. Comput. Phys. 233 (2013) 359-372, section 3.
    """
    x = points[cells]
    if cells.shape[1] == 4:
        return np.asarray(np.linalg.det(x[:, 1:] - x[:, :1]))[:, None]
    lattice, to_bernstein = _cubic_lattice()
    gradients = shape_gradients(TETRA_EDGES, lattice)
    determinants = np.empty((len(cells), len(lattice)))
    for q, gradient in enumerate(gradients):
        determinants[:, q] = _determinants(x.transpose(0, 2, 1) @ gradient)
    return determinants @ to_bernstein.T


def _determinants(matrices: _Array) -> _Array:
    """Return the determinants (m,) of (m, 3, 3) written out: ten times as fast as by factorisation."""
    a, b, c = matrices[:, 0], matrices[:, 1], matrices[:, 2]
    return np.asarray(
        a[:, 0] * (b[:, 1] * c[:, 2] - b[:, 2] * c[:, 1])
        - a[:, 1] * (b[:, 0] * c[:, 2] - b[:, 2] * c[:, 0])
        + a[:, 2] * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    )


def scaled_jacobians(points: _Array, cells: _Ints) -> _Array:
    """Return each element's least over greatest Jacobian determinant: 1 straight, not positive if invalid.

    A guaranteed lower bound while positive, since it is taken from Bernstein coefficients.

    Parameters
    ----------
    points : ndarray
        Nodes (n, 3).
    cells : ndarray
        Elements (m, 4) or (m, 10), node numbers.

    Returns
    -------
    ndarray
        Ratios (m,).
    """
    coefficients = jacobian_coefficients(points, cells)
    greatest = np.abs(coefficients).max(axis=1)
    return np.asarray(coefficients.min(axis=1) / np.where(greatest > 0.0, greatest, 1.0))


def triangle_areas(points: _Array, triangles: _Ints) -> _Array:
    """Return the area of each triangle, of a curved one to a relative 1e-6 while its curvature is mild.

    Parameters
    ----------
    points : ndarray
        Nodes (n, 3).
    triangles : ndarray
        Triangles (k, 3) or (k, 6), node numbers.

    Returns
    -------
    ndarray
        Areas (k,).
    """
    x = points[triangles]
    if triangles.shape[1] == 3:
        return np.asarray(np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2.0)
    at, weights = triangle_rule()
    area = np.zeros(len(triangles))
    for gradient, weight in zip(shape_gradients(TRIANGLE_EDGES, at), weights, strict=True):
        tangents = np.einsum("enx,nd->edx", x, gradient)
        area += weight * np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1)
    return area


@cache
def triangle_rule() -> tuple[_Array, _Array]:
    """Return the Gauss rule of the square, collapsed onto the triangle: exact to degree 8.

    Returns
    -------
    at : ndarray
        Points (25, 2) of the unit triangle.
    weights : ndarray
        (25,), of sum 1/2.
    """
    at, weights = np.polynomial.legendre.leggauss(5)
    s, w = (at + 1.0) / 2.0, weights / 2.0
    u, v = (a.ravel() for a in np.meshgrid(s, s, indexing="ij"))
    return np.stack([u, v * (1.0 - u)], axis=1), np.outer(w, w).ravel() * (1.0 - u)


def flatten(points: _Array, cells: _Ints, least: float) -> tuple[_Array, int]:
    """Flatten curved elements that are nearly invalid.

    The mid-nodes of such an element move a quarter of the way to the middle of their edges, and all the
    way from the eighth time on. Moving a mid-node bends the neighbours too, so this repeats until every
    element is valid; it ends, since elements with straight edges have scaled Jacobians of one.

    Parameters
    ----------
    points : ndarray
        Nodes (n, 3).
    cells : ndarray
        Elements (m, 10), node numbers.
    least : float
        Scaled Jacobian below which an element is flattened.

    Returns
    -------
    points : ndarray
        The nodes (n, 3) in their new places.
    flattened : int
        Number of elements that were flattened.
    """
    points = points.copy()
    times = np.zeros(len(cells), dtype=int)
    scaled = scaled_jacobians(points, cells)
    while (bad := np.flatnonzero((scaled < least) & (times < 8))).size:
        times[bad] += 1
        for share, chosen in ((0.25, bad[times[bad] < 8]), (1.0, bad[times[bad] == 8])):
            # A mid-node that several bad elements share moves once.
            nodes, first = np.unique(cells[chosen, 4:], return_index=True)
            middles = points[cells[chosen, :4]][:, TETRA_EDGES].mean(axis=2).reshape(-1, 3)[first]
            points[nodes] = (1.0 - share) * points[nodes] + share * middles
        beside = np.flatnonzero(np.isin(cells[:, 4:], cells[bad, 4:]).any(axis=1))
        scaled[beside] = scaled_jacobians(points, cells[beside])
    return points, int((times > 0).sum())
