"""A solid as it is seen along its pins: the triangles in view, and its edges."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Int = NDArray[np.int64]

_SEEN, _BENDS = 0.35, 0.8
"""Least cosine of a face's normal to the view where it is seen, since triangles of coarse bores stand askew; and the
cosine between two faces below which their edge is drawn: 37 degrees, more than triangles of a round surface enclose."""


_SIDES = np.array([[0, 1], [1, 2], [2, 0]])
_PARTS = 6
"""Chords of a curved edge."""


def silhouette(nodes: Real, triangles: Int) -> tuple[Int, Int]:
    """Return what is seen of a closed surface from far along z.

    Parameters
    ----------
    nodes : array
        (n, 3).
    triangles : int array
        Corners (k, 3), counter-clockwise as seen from outside; of curved ones (k, 6), with the nodes in the middles of
        the edges from the first corner to the second, from there to the third and from that to the first.

    Returns
    -------
    seen : int array
        Triangles (m, 3 or 6) that face the viewer; nearer ones may hide others.
    edges : int array
        Ends (e, 2), and middles (e, 3) where these are there, of the edges where the surface bends or turns away.
    """
    a, b, c = np.moveaxis(nodes[triangles[:, :3]], 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facing = normals[:, 2] > _SEEN
    ends = np.sort(triangles[:, _SIDES].reshape(-1, 2), axis=1)
    order = np.lexsort(ends.T)
    pairs = order.reshape(-1, 2) // 3  # on a closed surface each edge has two triangles
    bend = np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]])
    drawn = facing[pairs].any(axis=1) & ((bend < _BENDS) | ~facing[pairs].all(axis=1))
    whole = np.hstack([ends, triangles[:, 3:].reshape(-1, 1)]) if triangles.shape[1] == 6 else ends
    return triangles[facing], whole[order][::2][drawn]


def curves(places: Real) -> Real:
    """Return points on edges.

    Parameters
    ----------
    places : array
        Their ends (e, 2, d), or ends and middles (e, 3, d).

    Returns
    -------
    array
        (e, p, d): the ends alone, or points on the parabola through all three nodes.
    """
    if places.shape[1] == 2:
        return places
    t = np.linspace(0.0, 1.0, _PARTS + 1)
    shape = np.array([(1.0 - t) * (1.0 - 2.0 * t), t * (2.0 * t - 1.0), 4.0 * t * (1.0 - t)])
    return np.asarray(np.einsum("ip,eid->epd", shape, places))


def outlines(places: Real) -> Real:
    """Return triangles as polygons.

    Parameters
    ----------
    places : array
        Their corners (k, 3, d), or corners and middles of edges (k, 6, d).

    Returns
    -------
    array
        (k, p, d): points all round.
    """
    if places.shape[1] == 3:
        return places
    sides = [curves(places[:, [*ends, 3 + k]])[:, :-1] for k, ends in enumerate(_SIDES)]
    return np.concatenate(sides, axis=1)
