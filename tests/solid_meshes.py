"""Simple tagged meshes for the tests of the solid: a box, a plane bar with two holes, a thick-walled cylinder."""

import dataclasses

import numpy as np
from skfem import MeshTet1, MeshTet2

from alula.geometry.meshing.tagged_mesh import TaggedMesh


def _quadratic(points, cells, holes):
    """Add mid-nodes; those of edges on a hole's or cylinder's wall (x, y, radius) are moved onto it."""
    mesh = MeshTet2.from_mesh(MeshTet1(points.T.copy(), np.ascontiguousarray(cells.T)))
    nodes, connected = mesh.doflocs.T.copy(), mesh.dofs.element_dofs.T.astype(np.int64)
    for x, y, radius in holes:
        wall = np.abs(np.hypot(points[:, 0] - x, points[:, 1] - y) - radius) < 1e-9 * radius
        edges = mesh.edges.T
        chosen = wall[edges[:, 0]] & wall[edges[:, 1]]
        number = np.arange(len(points), len(nodes))[chosen]
        arm = nodes[number, :2] - (x, y)
        nodes[number, :2] = (x, y) + arm * (radius / np.hypot(arm[:, 0], arm[:, 1]))[:, None]
    return nodes, connected


def _tagged(points, cells, curved, holes, pick):
    """Build the mesh; ``pick`` maps corner points (k, 3, 3) of boundary triangles to names -> mask."""
    mesh = MeshTet1(points.T.copy(), np.ascontiguousarray(cells.T))
    triangles = mesh.facets[:, mesh.boundary_facets()].T.astype(np.int64)
    named = {name: triangles[mask] for name, mask in pick(points[triangles]).items()}
    if curved:
        points, cells = _quadratic(points, cells, holes)
    return TaggedMesh(
        points=points,
        cells=np.asarray(cells, dtype=np.int64),
        surfaces=named,
        areas=dict.fromkeys(named, 0.0),
        volume=0.0,
        centroid=np.zeros(3),
    )


def distorted(points, lower, upper, amount):
    """Move points inside the box (and tangentially on its faces) by a smooth field; the box keeps its shape."""
    relative = (points - lower) / (upper - lower)
    bubble = np.prod(4.0 * relative * (1.0 - relative), axis=1)[:, None]
    inner = amount * bubble * np.sin(7.0 * points[:, [1, 2, 0]] + 3.0 * points)
    slide = amount * np.sin(np.pi * relative) * np.cos(5.0 * points[:, [2, 0, 1]])
    return points + inner + slide


def box(lower=(0.0, 0.0, 0.0), upper=(3.0, 1.1, 0.9), counts=(4, 2, 2), amount=0.0, curved=False):
    """Box with surfaces ``end:0`` and ``end:1`` at its ends along x and ``sides``; mid-nodes are distorted too."""
    lower, upper = np.array(lower, float), np.array(upper, float)
    mesh = MeshTet1.init_tensor(*(np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, counts, strict=True)))
    points, cells = mesh.p.T.copy(), mesh.t.T.astype(np.int64)

    def pick(corners):
        x = corners[:, :, 0]
        first, last = (np.abs(x - lower[0]) < 1e-9).all(axis=1), (np.abs(x - upper[0]) < 1e-9).all(axis=1)
        return {"end:0": first, "end:1": last, "sides": ~(first | last)}

    tagged = _tagged(points, cells, curved, (), pick)
    moved = distorted(tagged.points, lower, upper, amount)
    return TaggedMesh(
        points=moved,
        cells=tagged.cells,
        surfaces=tagged.surfaces,
        areas=tagged.areas,
        volume=float(np.prod(upper - lower)),
        centroid=(lower + upper) / 2.0,
    )


def _extruded(plane, triangles, heights):
    """Tetrahedra of a triangle mesh (p, 2), (k, 3) extruded to layers at the heights."""
    layers, count = len(heights), len(plane)
    points = np.vstack([np.column_stack([plane, np.full(count, z)]) for z in heights])
    a, b, c = np.sort(triangles, axis=1).T
    prism = np.vstack(
        [
            np.column_stack(t)
            for t in ((a, b, c, c + count), (a, b, b + count, c + count), (a, a + count, b + count, c + count))
        ]
    )
    return points, np.vstack([prism + count * i for i in range(layers - 1)])


def _grid(first, second):
    """Triangles of a structured grid numbered [i, j] -> i * second + j."""
    i, j = np.meshgrid(np.arange(first - 1), np.arange(second - 1), indexing="ij")
    a = (i * second + j).ravel()
    return np.vstack([np.column_stack([a, a + second, a + second + 1]), np.column_stack([a, a + second + 1, a + 1])])


def _merged(parts):
    points = np.vstack([p for p, _ in parts])
    offsets = np.cumsum([0] + [len(p) for p, _ in parts[:-1]])
    triangles = np.vstack([t + o for (_, t), o in zip(parts, offsets, strict=True)])
    _, first, number = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    merged = number.reshape(-1)[triangles]
    return points[first], merged[[len(set(t)) == 3 for t in merged.tolist()]]


def ring(inner, outer, height, *, around=8, radial=3, layers=2, curved=True, grading=1.0):
    """Thick-walled cylinder about z with surfaces ``bore:A``, ``outside``, ``top:A``, ``bottom:A``."""
    radii = inner + (outer - inner) * np.linspace(0.0, 1.0, radial + 1) ** grading
    theta = np.linspace(0.0, 2.0 * np.pi, around + 1)
    plane = np.column_stack([np.outer(radii, np.cos(theta)).ravel(), np.outer(radii, np.sin(theta)).ravel()])
    plane, triangles = _merged([(plane, _grid(radial + 1, around + 1))])
    points, cells = _extruded(plane, triangles, np.linspace(-height / 2.0, height / 2.0, layers + 1))

    def pick(corners):
        radius, z = np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]
        return {
            "bore:A": (np.abs(radius - inner) < 1e-8).all(axis=1),
            "outside": (np.abs(radius - outer) < 1e-8).all(axis=1),
            "top:A": (np.abs(z - height / 2.0) < 1e-9).all(axis=1),
            "bottom:A": (np.abs(z + height / 2.0) < 1e-9).all(axis=1),
        }

    return _tagged(points, cells, curved, [(0.0, 0.0, r) for r in (inner, outer)], pick)


def bar(
    length=20.0,
    half_width=2.5,
    height=3.0,
    hole=0.75,
    *,
    around=16,
    radial=3,
    along=6,
    layers=2,
    curved=True,
    grading=1.5,
    tail=0.0,
):
    """Flat bar with holes of that radius at A (0, 0) and B (length, 0) in square eyes, and a tail beyond B.

    Surfaces: ``bore:A``, ``bore:B``, ``top:``/``bottom:`` of each eye (the square around it), ``sides``
    and ``end:T``, the end face of the tail (or of the eye at B).
    """
    theta = np.linspace(-np.pi / 4.0, 7.0 * np.pi / 4.0, around + 1)
    direction = np.column_stack([np.cos(theta), np.sin(theta)])
    square = direction * (half_width / np.abs(direction).max(axis=1))[:, None]
    share = np.linspace(0.0, 1.0, radial + 1) ** grading
    eye = ((1.0 - share)[:, None, None] * hole * direction + share[:, None, None] * square).reshape(-1, 2)
    across = half_width * np.tan(theta[: around // 4 + 1])

    def block(start, stop, count):
        x = np.linspace(start, stop, count + 1)
        return np.column_stack([np.repeat(x, len(across)), np.tile(across, count + 1)]), _grid(count + 1, len(across))

    triangles = _grid(radial + 1, around + 1)
    parts = [
        (eye, triangles),
        block(half_width, length - half_width, along),
        (eye + np.array([length, 0.0]), triangles),
    ]
    if tail > 0.0:
        parts.append(block(length + half_width, length + half_width + tail, max(1, round(along * tail / length))))
    plane, triangles = _merged(parts)
    points, cells = _extruded(plane, triangles, np.linspace(-height / 2.0, height / 2.0, layers + 1))

    def pick(corners):
        z, named = corners[..., 2], {}
        for name, centre in (("A", 0.0), ("B", length)):
            x = corners[..., 0] - centre
            named[f"bore:{name}"] = (np.abs(np.hypot(x, corners[..., 1]) - hole) < 1e-8).all(axis=1)
            inside = (np.abs(x) < half_width + 1e-8).all(axis=1)
            named[f"top:{name}"] = (z > height / 2.0 - 1e-9).all(axis=1) & inside
            named[f"bottom:{name}"] = (z < 1e-9 - height / 2.0).all(axis=1) & inside
        named["end:T"] = (corners[..., 0] > length + half_width + tail - 1e-8).all(axis=1)
        named["sides"] = (np.abs(np.abs(corners[..., 1]) - half_width) < 1e-8).all(axis=1)
        return named

    return _tagged(points, cells, curved, [(0.0, 0.0, hole), (length, 0.0, hole)], pick)


def raised(mesh, *, wobble=0.0):
    """Stand a mesh on z = 0, up to ``wobble``, as an upper half for ``mirrored``: its foot bears no name then."""
    up = np.array([0.0, 0.0, 1.0])
    height = np.ptp(mesh.points[:, 2])
    foot = np.abs(mesh.points[:, 2] - mesh.points[:, 2].min()) < 1e-12
    surfaces = {name: t for name, t in mesh.surfaces.items() if not name.startswith("bottom")}
    return dataclasses.replace(
        mesh,
        points=mesh.points + height / 2.0 * up + wobble * foot[:, None] * up,
        surfaces=surfaces,
        areas=dict.fromkeys(surfaces, 2.0),
        volume=3.0,
        centroid=np.array([10.0, 0.0, 0.75]),
    )


def half_bar(*, wobble=0.0, **sizes):
    """Upper half of the bar, for ``mirrored``."""
    return raised(bar(height=1.5, **sizes), wobble=wobble)


def scikit_fem_mesh(space):
    """The mesh of a displacement space as scikit-fem's ``MeshTet1`` or ``MeshTet2``."""
    kind = MeshTet1 if space.order == 1 else MeshTet2
    return kind(np.ascontiguousarray(space.nodes.T), np.ascontiguousarray(space.cells[:, :4].T))
