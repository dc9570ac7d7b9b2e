"""Sections of a closed surface of flat triangles across x."""

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.cut_section import CutSection, convex

Real = NDArray[np.float64]
_ONE = 1e-9
"""Share of the surface's size within which ends of pieces of a border are one."""


def section_of_surface(corners: Real, x: float) -> CutSection | None:
    """Return what triangles enclose in a plane across x; None where they do not meet it.

    Each triangle that crosses the plane gives a straight piece of the border, with the material on its left as seen
    from +x; the moments of the triangles between the pieces and the origin add up to those of the section.

    Parameters
    ----------
    corners : array
        Of the triangles (k, 3, 3), counter-clockwise as seen from outside [mm].
    x : float
        The station [mm].

    Returns
    -------
    CutSection or None
        The section.
    """
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    above = corners[..., 0] > x
    corners, above = corners[(s := above.sum(axis=1) % 3 != 0)], above[s]
    if not len(corners):
        return None
    lone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)  # the corner on a side of its own
    rows = np.arange(len(corners))
    a, b, c = (corners[rows, (lone + k) % 3] for k in range(3))
    p, q = (a + ((x - a[:, 0]) / (other[:, 0] - a[:, 0]))[:, None] * (other - a) for other in (b, c))
    up = (a[:, 0] > x)[:, None]
    # With the lone corner above, the outside is to the right of the way from its second side to its first.
    start, end = np.where(up, p, q)[:, 1:], np.where(up, q, p)[:, 1:]
    middle = start.mean(axis=0)
    start, end = start - middle, end - middle
    cross = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
    area = float(cross.sum()) / 2.0
    if not area > 0.0:
        return None
    centre = (cross[:, None] * (start + end)).sum(axis=0) / (6.0 * area)
    both = start + end
    second = (start * cross[:, None]).T @ start + (end * cross[:, None]).T @ end + (both * cross[:, None]).T @ both
    second = second / 24.0 - area * np.outer(centre, centre)
    return CutSection(
        x=x,
        area=area,
        centre=(float(centre[0] + middle[0]), float(centre[1] + middle[1])),
        i_y=float(second[1, 1]),
        i_z=float(second[0, 0]),
        i_yz=float(second[0, 1]),
        hull=convex(map(tuple, (np.concatenate([start, end]) + middle).tolist())),
        pieces=_pieces(start, end, cross, _ONE * size),
    )


def _pieces(start: Real, end: Real, cross: Real, one: float) -> int:
    """Return how many closed borders run counter-clockwise: the others are those of holes."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    places = np.concatenate([start, end])
    near = cKDTree(places).query_pairs(one, output_type="ndarray")
    k = np.arange(len(start))
    joins = np.concatenate([near, np.column_stack([k, k + len(start)])])
    graph = coo_array((np.ones(len(joins)), joins.T), shape=(len(places), len(places)))
    _, border = connected_components(graph, directed=False)
    return max(int((np.bincount(border[k], weights=cross) > 0.0).sum()), 1)
