"""A solid as it is seen along its pins: the triangles in view, and its edges."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Int = NDArray[np.int64]

_SEEN, _BENDS = 0.35, 0.8
"""Least cosine of a face's normal to the view where it is seen, since triangles of coarse bores stand askew; and the
cosine between two faces below which their edge is drawn: 37 degrees, more than triangles of a round surface enclose."""


def silhouette(nodes: Real, triangles: Int) -> tuple[Int, Int]:
    """Return what is seen of a closed surface from far along z.

    Parameters
    ----------
    nodes : array
        (n, 3).
    triangles : int array
        Corners (k, 3), counter-clockwise as seen from outside.

    Returns
    -------
    seen : int array
        Triangles (m, 3) that face the viewer; nearer ones may hide others.
    edges : int array
        Ends (e, 2) of the edges of these: where the surface bends, or turns away.
    """
    a, b, c = np.moveaxis(nodes[triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facing = normals[:, 2] > _SEEN
    ends = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(ends.T)
    pairs = order.reshape(-1, 2) // 3  # on a closed surface each edge has two triangles
    bend = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    drawn = facing[pairs].any(axis=1) & ((bend < _BENDS) | ~facing[pairs].all(axis=1))
    return triangles[facing], ends[order][::2][drawn]
