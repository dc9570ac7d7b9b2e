"""What meshes are measured by: shape of elements, first moments of their volume."""

import numpy as np

from alula.geometry.meshing.element_geometry import TETRA_EDGES


def shape_quality(points, cells):
    """Return 12 (3V)^(2/3) / Σl² of each element's corners, (m,): 1 for the regular tetrahedron, 0 for a flat one.

    Knupp, SIAM J. Sci. Comput. 23 (2001) 193-218 (inverse mean ratio of a tetrahedron).
    """
    x = points[cells[:, :4]]
    volume = np.linalg.det(x[:, 1:] - x[:, :1]) / 6.0
    i, j = TETRA_EDGES.T
    return 12.0 * np.cbrt(3.0 * volume) ** 2 * np.sign(volume) / ((x[:, i] - x[:, j]) ** 2).sum(axis=(1, 2))


def volumes_and_moments(points, cells):
    """Return each element's volume (m,) and first moment ∫x dV (m, 3) by Gauss' rule of the collapsed cube."""
    s, w = np.polynomial.legendre.leggauss(5)
    u, v, t = (a.ravel() for a in np.meshgrid(*[(s + 1.0) / 2.0] * 3, indexing="ij"))
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel() / 8.0 * (1.0 - u) ** 2 * (1.0 - v)
    at = np.stack([u, v * (1.0 - u), t * (1.0 - u) * (1.0 - v)], axis=1)
    bary, slope = np.hstack([1.0 - at.sum(axis=1, keepdims=True), at]), np.vstack([-np.ones(3), np.eye(3)])
    shapes, gradients = bary, np.repeat(slope[None], len(at), axis=0)
    if cells.shape[1] == 10:
        i, j = TETRA_EDGES.T
        shapes = np.hstack([bary * (2.0 * bary - 1.0), 4.0 * bary[:, i] * bary[:, j]])
        edges = 4.0 * (bary[:, i, None] * slope[j] + bary[:, j, None] * slope[i])
        gradients = np.concatenate([(4.0 * bary[:, :, None] - 1.0) * slope, edges], axis=1)
    x = points[cells]
    volume, moment = np.zeros(len(cells)), np.zeros((len(cells), 3))
    for shape, gradient, weight in zip(shapes, gradients, weights, strict=True):
        determinant = weight * np.linalg.det(x.transpose(0, 2, 1) @ gradient)
        volume += determinant
        moment += determinant[:, None] * np.einsum("enx,n->ex", x, shape)
    return volume, moment
