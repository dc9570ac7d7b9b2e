"""What a solid of any shape covers as seen along z, from the triangles of its surface, layer by layer."""

import itertools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.footprint import Footprint

Real = NDArray[np.float64]
Int = NDArray[np.int64]

_LAYERS = 16
"""At most; of more flat faces the largest divide the solid."""
_LEVEL, _NEAR = 1e-6, 1e-4
"""Share of the solid's size by which a flat face may slope, and of a layer's height at which it is cut open."""
_SLIVER = 1e-3
"""Share of the solid's size: smaller pieces and holes are left by rounding."""
_ROUND = 0.35
"""Angle between two edges of a border below which they are chords of one arc: triangles turn by 0.2 [rad]."""


def shadows(points: Real, triangles: Int) -> tuple[Footprint, ...]:
    """Return what a solid covers, in layers between its flat faces across z.

    Of each layer it is the shadow: all that lies above or below anything of it.

    Parameters
    ----------
    points : array
        Corners (n, 3) [mm].
    triangles : int array
        Of the closed surface (k, 3), counter-clockwise as seen from outside.

    Returns
    -------
    tuple of Footprint
        Polygons.
    """
    corners = points[triangles]
    heights, size = corners[..., 2], float(np.ptp(points, axis=0).max())
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2.0
    flat = np.ptp(heights, axis=1) <= _LEVEL * size
    levels: dict[float, float] = {}
    for z, area in zip(heights[flat].mean(axis=1), areas[flat], strict=True):
        near = next((level for level in levels if abs(level - z) <= _NEAR * size), float(z))
        levels[near] = levels.get(near, 0.0) + float(area)
    low, high = float(heights.min()), float(heights.max())
    inner = [z for z in levels if low + _NEAR * size < z < high - _NEAR * size]
    inner = sorted(inner, key=lambda z: -levels[z])[: _LAYERS - 1]
    ends = [low, *sorted(inner), high]
    up = corners[normals[:, 2] > _LEVEL * areas]
    return tuple(piece for a, b in itertools.pairwise(ends) for piece in _layer(corners, up, a, b, _LEVEL * size))


def _layer(corners: Real, up: Real, low: float, high: float, grid: float) -> list[Footprint]:
    """Return the shadow of what lies between two heights: its upper faces, and the cut just below its top."""
    import shapely

    margin = _NEAR * (high - low)
    low_in, high_in = low + margin, high - margin
    below, above = up[..., 2].min(axis=1), up[..., 2].max(axis=1)
    inside = up[(below >= low_in) & (above <= high_in)]
    crossing = up[(below < high_in) & (above > low_in) & ~((below >= low_in) & (above <= high_in))]
    pieces = list(shapely.polygons(inside[..., :2]))
    pieces += [shapely.Polygon(p[:, :2]) for p in (_clipped(t, low_in, high_in) for t in crossing) if len(p) > 2]
    pieces.append(_cut(corners, high_in, grid))
    union = shapely.union_all([piece for piece in pieces if not piece.is_empty], grid_size=grid)
    least = (_SLIVER / _LEVEL * grid) ** 2
    parts = [part for part in shapely.get_parts(shapely.simplify(union, grid)) if part.area > least]
    return [
        Footprint(
            corners=_ring(part.exterior),
            holes=tuple(_ring(hole) for hole in part.interiors if shapely.Polygon(hole).area > least),
            low=low,
            high=high,
            error=2.0 * max(_chords(ring) for ring in (part.exterior, *part.interiors)),
        )
        for part in parts
    ]


def _ring(ring: Any) -> tuple[tuple[float, float], ...]:
    return tuple((float(x), float(y)) for x, y in ring.coords[:-1])


def _chords(ring: Any) -> float:
    """Return how far the chords of a border lie off its arcs: L/2 tan(δ/4) of a chord L on an arc of δ [mm]."""
    at = np.asarray(ring.coords)[:-1]
    edges = np.roll(at, -1, axis=0) - at
    lengths, ways = np.hypot(*edges.T), np.arctan2(edges[:, 1], edges[:, 0])
    turns = np.abs((ways - np.roll(ways, 1) + math.pi) % (2.0 * math.pi) - math.pi)
    longer = np.maximum(lengths, np.roll(lengths, 1))
    # A chord beside a straight edge is no longer than its neighbour on the arc, so the shorter of the two counts there.
    longer = np.minimum(longer, 2.0 * np.minimum(lengths, np.roll(lengths, 1)))
    return float(np.max(np.where(turns < _ROUND, longer / 2.0 * np.tan(turns / 4.0), 0.0), initial=0.0))


def _clipped(triangle: Real, low: float, high: float) -> Real:
    """Return the part (m, 3) of a triangle between two heights."""
    found = triangle
    for sign, limit in ((1.0, low), (-1.0, -high)):
        kept = []
        for p, q in zip(found, np.roll(found, -1, axis=0), strict=True):
            u, v = sign * p[2] - limit, sign * q[2] - limit
            if u >= 0.0:
                kept.append(p)
            if u * v < 0.0:
                kept.append(p + (q - p) * u / (u - v))
        found = np.array(kept).reshape(-1, 3)
    return found


def _cut(corners: Real, height: float, grid: float) -> Any:
    """Return the section of a closed surface across z as polygons."""
    import shapely

    above = corners[..., 2] > height
    across = corners[above.any(axis=1) & ~above.all(axis=1)]
    if not len(across):
        return shapely.Polygon()
    start, end = across, np.roll(across, -1, axis=1)
    met = (start[..., 2] > height) != (end[..., 2] > height)  # two of the three edges of each triangle
    p, q = start[met], end[met]
    share = (height - p[:, 2]) / (q[:, 2] - p[:, 2])
    ends = (p + share[:, None] * (q - p))[:, :2]
    lines = _joined(ends, grid).reshape(-1, 2, 2)
    lines = lines[np.abs(lines[:, 1] - lines[:, 0]).max(axis=1) > 0.0]
    return shapely.build_area(shapely.union_all(shapely.linestrings(np.concatenate([lines, _missing(lines)]))))


def _missing(lines: Real) -> Real:
    """Return lines between loose ends, each to the nearest: of two faces the chords along a curve may differ."""
    places, times = np.unique(lines.reshape(-1, 2), axis=0, return_counts=True)
    loose = list(places[times % 2 == 1])
    found = []
    while len(loose) > 1:
        end = loose.pop()
        nearest = int(np.argmin([float(np.hypot(*(other - end))) for other in loose]))
        found.append((end, loose.pop(nearest)))
    return np.array(found).reshape(-1, 2, 2)


def _joined(places: Real, near: float) -> Real:
    """Return places with those that are one but for rounding made equal: triangles of two faces share no corners."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(places).query_pairs(near, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(places),) * 2)
    groups = connected_components(links, directed=False)[1]
    return np.asarray(places[np.unique(groups, return_index=True)[1]][groups])
