"""Cylindrical walls of a mesh: triangles of its surface whose nodes lie on one cylinder; and its sharp inner edges.

Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

from collections import defaultdict
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.walls import Line, Wall, fitted_circle, joined_walls, united, upwards
from alula.geometry.meshing.element_geometry import TRIANGLE_EDGES, shape_gradients
from alula.geometry.solids.reentrant import ReentrantEdge

Real = NDArray[np.float64]
Ints = NDArray[np.int64]

ON_WALL = 3e-4
"""Share of the radius by which nodes may lie off a wall: files state places to six digits or so."""
_BENT = 1e-5
"""Share of an edge's length by which its mid-node lies off the middle where the edge is curved."""
_SMOOTH = float(np.cos(np.radians(10.0)))
"""Cosine of the angle between normals on both sides of an edge up to which a surface runs on smoothly."""
INNER = float(np.radians(15.0))
"""Angle above which a surface that turns inwards is sharp: of a round one with an edge per quarter it is 11 degrees."""
_NODES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])
_STEPS = 8
"""Of Gauss and Newton at most."""


def bent_edges(points: Real, triangles: Ints) -> NDArray[np.bool_]:
    """Return whether each edge of curved triangles is curved.

    Parameters
    ----------
    points : array
        Nodes (n, 3).
    triangles : int array
        (k, 6).

    Returns
    -------
    bool array
        (k, 3).
    """
    ends = points[triangles[:, TRIANGLE_EDGES]]
    off = np.linalg.norm(points[triangles[:, 3:]] - ends.mean(axis=2), axis=2)
    return np.asarray(off > _BENT * np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2), dtype=np.bool_)


def cylinder_walls(points: Real, triangles: Ints) -> list[Wall]:
    """Return the cylindrical walls of a surface.

    From each curved triangle with its smooth neighbours a cylinder is fitted to their nodes. It grows to all triangles
    that are joined to them and whose nodes lie on it, and is then fitted once more.

    Parameters
    ----------
    points : array
        Nodes (n, 3) [mm].
    triangles : int array
        (k, 6), counter-clockwise as seen from outside.

    Returns
    -------
    list of Wall
    """
    x = points[triangles]
    normals = _normals(x)
    neighbours = _neighbours(triangles, normals)
    curved = np.asarray(bent_edges(points, triangles).any(axis=1))
    free = curved.copy()
    faces = []
    for seed in np.flatnonzero(curved):
        if not free[seed]:
            continue
        patch = np.array([seed, *(k for k in neighbours[seed] if k >= 0 and free[k])])
        found = _grown(x, normals, neighbours, free, patch)
        if found is not None:
            wall, chosen = found
            free[chosen] = False
            faces.append(wall)
    return joined_walls(faces)


def on_cylinder(points: Real, line: Line, radius: float) -> NDArray[np.bool_]:
    """Return whether points lie on a cylinder.

    Parameters
    ----------
    points : array
        (..., 3) [mm].
    line : Line
        The axis.
    radius : float
        [mm].

    Returns
    -------
    bool array
        (...).
    """
    return np.asarray(np.abs(np.linalg.norm(_arms(points, line), axis=-1) - radius) <= ON_WALL * radius)


def _arms(points: Real, line: Line) -> Real:
    """Return the vectors from an axis straight to points."""
    arms = points - line.point
    return np.asarray(arms - (arms @ line.axis)[..., None] * line.axis)


def _normals(x: Real) -> Real:
    """Return unit normals (k, 6, 3) at the nodes of triangles (k, 6, 3)."""
    tangents = np.einsum("knx,qnd->kqdx", x, shape_gradients(TRIANGLE_EDGES, _NODES))
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-300))


def inner_edges(points: Real, triangles: Ints) -> list[ReentrantEdge]:
    """Return the edges at which the material's angle exceeds π by more than ``INNER``.

    Parameters
    ----------
    points : array
        Nodes (n, 3) [mm].
    triangles : int array
        (k, 6), counter-clockwise as seen from outside.

    Returns
    -------
    list of ReentrantEdge
        One for each chain of edges.
    """
    own = _normals(points[triangles])[:, 3:].reshape(-1, 3)
    one, other = _pairs(triangles)
    angle = np.arctan2(np.linalg.norm(np.cross(own[one], own[other]), axis=1), (own[one] * own[other]).sum(axis=1))
    first, last = triangles[one // 3, TRIANGLE_EDGES[one % 3].T]
    middle = triangles[one // 3, 3 + one % 3]
    opposite = triangles[other // 3, np.array([2, 0, 1])[other % 3]]
    inwards = np.cross(
        own[other], points[last] - points[first]
    )  # along the second triangle, away from the edge or to it
    inwards *= np.sign((inwards * (points[opposite] - points[middle])).sum(axis=1))[:, None]
    rising = (inwards * own[one]).sum(axis=1) > 0.0
    found = np.flatnonzero(rising & (angle > INNER))
    return [
        ReentrantEdge(points=points[chain], angle=np.pi + turn)
        for chain, turn in _chains(list(zip(*(a[found].tolist() for a in (first, middle, last, angle)), strict=True)))
    ]


def _chains(edges: list[tuple[int, int, int, float]]) -> list[tuple[list[int], float]]:
    """Return edges (first, middle and last node, angle) as chains of nodes, with the greatest angle of each."""
    at: dict[int, set[int]] = defaultdict(set)
    for number, (first, _, last, _) in enumerate(edges):
        at[first].add(number)
        at[last].add(number)
    chains = []
    for node in sorted(at, key=lambda node: len(at[node]) == 2):  # ends and branches first, then closed chains
        while at[node]:
            chain, turn = [node], 0.0
            while at[chain[-1]]:
                number = min(at[chain[-1]])
                first, middle, last, angle = edges[number]
                at[first].discard(number)
                at[last].discard(number)
                chain += [middle, last if chain[-1] == first else first]
                turn = max(turn, angle)
            chains.append((chain, turn))
    return chains


def _pairs(triangles: Ints) -> tuple[Ints, Ints]:
    """Return numbers of edges (three times that of the triangle, plus the edge's own) that are one and the same."""
    middles = triangles[:, 3:].ravel()
    order = np.argsort(middles, kind="stable")
    ordered = middles[order]
    starts = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    counts = np.diff(np.append(starts, len(ordered)))
    pairs = starts[counts == 2]
    return order[pairs], order[pairs + 1]


def _neighbours(triangles: Ints, normals: Real) -> Ints:
    """Return the triangle (k, 3) beyond each edge where the surface runs on smoothly; -1 elsewhere."""
    one, other = _pairs(triangles)
    own = normals[:, 3:].reshape(-1, 3)
    smooth = (own[one] * own[other]).sum(axis=1) > _SMOOTH
    found = np.full(triangles[:, 3:].size, -1, dtype=np.int64)
    found[one[smooth]], found[other[smooth]] = other[smooth] // 3, one[smooth] // 3
    return found.reshape(-1, 3)


def _grown(x: Real, normals: Real, neighbours: Ints, free: NDArray[np.bool_], patch: Ints) -> tuple[Wall, Ints] | None:
    """Return the wall that grows from triangles, and its triangles; None where they lie on no cylinder."""
    start = _start(x[patch].reshape(-1, 3), normals[patch].reshape(-1, 3))
    if start is None:
        return None
    line, radius = start
    chosen = patch
    for _ in range(2):
        fitted = _fitted(x[chosen].reshape(-1, 3), line, radius)
        if fitted is None or not on_cylinder(x[chosen], *fitted).all():
            return None
        line, radius = fitted
        chosen = _spread(x, normals, neighbours, free, chosen, line, radius)
    return _wall(x[chosen], normals[chosen], line, radius), chosen


def _start(points: Real, normals: Real) -> tuple[Line, float] | None:
    """Return a first cylinder: the axis across all normals, then a circle about it; None where nothing is round."""
    _, sizes, directions = np.linalg.svd(normals, full_matrices=False)
    if not sizes[2] < 0.2 * sizes[1]:
        return None
    middle = points.mean(axis=0)
    line = Line(point=middle, axis=upwards(directions[2]))
    first, second = line.across
    arms = points - middle
    a, b, radius = fitted_circle(np.column_stack([arms @ first, arms @ second]))
    line = Line(point=middle + a * first + b * second, axis=line.axis)
    away = np.linalg.norm(_arms(points, line), axis=1)
    return (line, radius) if np.abs(away - radius).max() < 0.05 * radius else None


def _fitted(points: Real, line: Line, radius: float) -> tuple[Line, float] | None:
    """Return the cylinder whose distances from points have the least sum of squares, by Gauss and Newton's method.

    A point at the distance d from the axis and at the place t along it has the residual d - r. With the unit vector u
    from the axis to it, a shift s of the axis changes d by -u·s, and a tilt w by -t u·w.
    """
    for _ in range(_STEPS):
        arms, places = _arms(points, line), line.along(points)
        away = np.linalg.norm(arms, axis=1)
        if not away.min() > 0.0:
            return None
        unit = arms / away[:, None]
        across = np.stack(line.across, axis=1)
        slopes = -unit @ across
        reach = max(float(np.ptp(places)), radius)
        matrix = np.column_stack([slopes, slopes * (places / reach)[:, None], -np.ones(len(points))])
        step, *_ = np.linalg.lstsq(matrix, -(away - radius), rcond=1e-12)
        radius += float(step[4])
        if not 0.0 < radius < 1e6 * reach:
            return None
        line = Line(point=line.point + across @ step[:2], axis=upwards(line.axis + across @ step[2:4] / reach))
        if np.abs(step).max() < 1e-12 * radius:
            break
    return line, radius


def _spread(
    x: Real, normals: Real, neighbours: Ints, free: NDArray[np.bool_], chosen: Ints, line: Line, radius: float
) -> Ints:
    """Return triangles and all that are joined to them, lie on a cylinder and are upright on it."""
    taken = np.zeros(len(x), dtype=bool)
    taken[chosen] = True
    front = chosen
    while front.size:
        beyond = np.unique(neighbours[front])
        beyond = beyond[beyond >= 0]
        beyond = beyond[free[beyond] & ~taken[beyond]]
        arms = _arms(x[beyond], line)
        radial = np.abs((arms * normals[beyond]).sum(axis=2)) > _SMOOTH * np.linalg.norm(arms, axis=2)
        front = beyond[radial.all(axis=1) & on_cylinder(x[beyond], line, radius).all(axis=1)]
        taken[front] = True
    return np.flatnonzero(taken)


def _wall(x: Real, normals: Real, line: Line, radius: float) -> Wall:
    arms, places = _arms(x, line), line.along(x)
    first, second = line.across
    angles = np.arctan2(arms @ second, arms @ first)
    turned = (angles - angles[:, :1] + np.pi) % (2.0 * np.pi) - np.pi
    starts = (angles[:, 0] + turned.min(axis=1)) % (2.0 * np.pi)
    arcs: Iterable[tuple[float, float]] = zip(starts.tolist(), np.ptp(turned, axis=1).tolist(), strict=True)
    return Wall(
        line=line,
        radius=radius,
        hollow=bool((arms * normals).sum() < 0.0),
        span=(float(places.min()), float(places.max())),
        arcs=united(arcs),
    )
