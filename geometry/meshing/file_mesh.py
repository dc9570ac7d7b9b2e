"""A volume mesh from a file: read, checked, what is found in it, and the mesh of a body that is made of it.

Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.imported.bores import find_bores
from alula.geometry.imported.facts import MESH_FORMATS, PartFacts, PartSurface, Vector
from alula.geometry.meshing.element_geometry import (
    TETRA_EDGES,
    TRIANGLE_EDGES,
    jacobian_coefficients,
    shape_gradients,
    triangle_areas,
    triangle_rule,
)
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.meshing.mesh_walls import ON_WALL, bent_edges, cylinder_walls, inner_edges
from alula.geometry.meshing.surface_section import section_of_surface
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.mesh_part import MeshedPart
from alula.geometry.solids.reentrant import ReentrantEdge

Real = NDArray[np.float64]
Ints = NDArray[np.int64]

_FACES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
"""Nodes of the faces of a tetrahedron, counter-clockwise as seen from outside."""
_PARTS = 4
"""Into which the edges of a curved triangle are divided for flat ones."""
NOTE = (
    "the mesh is that of the part's file; it is not refined, so that the band of its stress is four times the "
    "estimated error"
)
_TURNED = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]
"""The nodes of an element whose second and third corner change places."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FileMesh:
    """Tetrahedra of ten nodes, one body.

    Attributes
    ----------
    points : array
        Nodes (n, 3) [mm], each of them of an element.
    cells : int array
        (m, 10), in VTK's order.
    boundary : int array
        Triangles (k, 6) of its surface, counter-clockwise as seen from outside.
    """

    points: Real
    cells: Ints
    boundary: Ints


@lru_cache(maxsize=2)
def read_mesh(path: str, digest: str, unit: float) -> FileMesh:
    """Read a file and check what it holds.

    Parameters
    ----------
    path : str
        The file.
    digest : str
        SHA-256 of its content.
    unit : float
        Its unit of length [mm].

    Returns
    -------
    FileMesh
        In mm, in the frame of the file.

    Raises
    ------
    CaseError
        Where it cannot be read, or holds anything but one body of valid quadratic tetrahedra.
    CannotRunError
        Where it has changed.
    """
    name = Path(path).name
    content = Path(path).read_bytes()
    if hashlib.sha256(content).hexdigest() != digest:
        raise CannotRunError(f"the file '{name}' changed while it was used; run once more")
    if path.lower().endswith(".inp") and b"*include" in content.lower():
        raise CaseError(f"'{name}' includes other files (*INCLUDE), which is not supported; export one file")
    del content
    points, cells = _tetrahedra(path)
    if not np.isfinite(points).all():
        raise CaseError(f"'{name}' has nodes whose coordinates are no finite numbers; export the mesh anew")
    used, cells = np.unique(cells, return_inverse=True)
    points, cells = points[used] * unit, cells.reshape(-1, 10)
    x = points[cells[:, :4]]
    if (np.linalg.det(x[:, 1:] - x[:, :1]) < 0.0).all():  # Netgen numbers corners the other way round
        cells = cells[:, _TURNED]
    if (worst := int((jacobian_coefficients(points, cells).min(axis=1) <= 0.0).sum())) > 0:
        raise CaseError(
            f"{worst} of {len(cells)} elements of '{name}' are inverted (their Jacobian determinant is not positive "
            "everywhere); mesh the part anew"
        )
    boundary = _boundary(name, cells)
    if not bent_edges(points, boundary).any():
        raise CaseError(
            f"the quadratic elements of '{name}' are straight, so that round holes are polygons with false peaks of "
            "stress; have the mesher move the mid-nodes to the geometry and export once more"
        )
    return FileMesh(points=points, cells=cells, boundary=boundary)


def _tetrahedra(path: str) -> tuple[Real, Ints]:
    """Return nodes (n, 3) and tetrahedra (m, 10) as the file has them."""
    import meshio

    name = Path(path).name
    try:
        mesh = meshio.read(path, file_format=MESH_FORMATS[Path(path).suffix.lower()])
        points = np.asarray(mesh.points, dtype=np.float64)
        blocks = [(block.type, block.dim, np.asarray(block.data, dtype=np.int64)) for block in mesh.cells]
    except MemoryError:
        raise
    except (Exception, SystemExit):  # meshio raises whatever a malformed file leads it to, and exits
        raise CaseError(f"'{name}' cannot be read as a mesh (.msh, .inp or .vtu); export it anew") from None
    solids = [(kind, data) for kind, dim, data in blocks if dim == 3 and len(data)]
    if not solids:
        found = sorted({kind for kind, _, _ in blocks}) or ["nothing"]
        raise CaseError(f"'{name}' holds no volume elements ({', '.join(found)}); export a mesh of tetrahedra")
    others = sorted({kind for kind, _ in solids} - {"tetra", "tetra10"})
    if others:
        raise CaseError(
            f"'{name}' has elements of other kinds ({', '.join(others)}) than tetrahedra; mesh with tetrahedra"
        )
    if any(kind == "tetra" for kind, _ in solids):
        raise CaseError(
            f"'{name}' has linear tetrahedra (4 nodes), whose round holes are polygons with false peaks of stress; "
            "export quadratic elements (10 nodes)"
        )
    cells = np.concatenate([data for _, data in solids])
    if points.ndim != 2 or points.shape[1] != 3 or cells.min() < 0 or cells.max() >= len(points):
        raise CaseError(f"'{name}' has elements with nodes that it does not state; export the mesh anew")
    return points, cells


def _boundary(name: str, cells: Ints) -> Ints:
    """Return the triangles (k, 6) of the surface; refuse what is not one body whose elements are joined."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    edges = np.sort(cells[:, TETRA_EDGES], axis=2).reshape(-1, 2)
    middles = cells[:, 4:].reshape(-1, 1)
    joined = np.unique(np.hstack([edges, middles]), axis=0)
    if not len(joined) == len(np.unique(joined[:, :2], axis=0)) == len(np.unique(joined[:, 2])):
        raise CaseError(
            f"neighbours in '{name}' have different mid-nodes on the edge that they share; mesh the part anew"
        )
    faces = cells[:, _FACES].reshape(-1, 6)
    _, number, counts = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_inverse=True, return_counts=True)
    number = number.ravel()
    if counts.max() > 2:
        raise CaseError(f"'{name}' has faces that belong to more than two elements; mesh the part anew")
    order = np.argsort(number, kind="stable")
    inner = order[counts[number[order]] == 2].reshape(-1, 2) // 4
    graph = coo_array((np.ones(len(inner)), (inner[:, 0], inner[:, 1])), shape=(len(cells), len(cells)))
    bodies = connected_components(graph, directed=False, return_labels=False)
    if bodies > 1:
        raise CaseError(
            f"'{name}' holds {bodies} bodies whose elements share no face, and a part is one; export each to a file of "
            "its own, or merge coincident nodes"
        )
    return np.asarray(faces[counts[number] == 1])


def facts_of_mesh(gmsh: Any, path: str, digest: str, unit: float) -> PartFacts:
    """Return what is found in a mesh file.

    Parameters
    ----------
    gmsh : module
        Not needed here.
    path : str
        The file.
    digest : str
        SHA-256 of its content.
    unit : float
        Its unit of length [mm].

    Returns
    -------
    PartFacts
        In mm, in the frame of the file; volume integrals are those of the curved elements.

    Raises
    ------
    CaseError, CannotRunError
        As ``read_mesh``.
    """
    mesh = read_mesh(path, digest, unit)
    volume, centroid, inertia = _integrals(mesh.points, mesh.boundary)
    surface = _flat(mesh)
    box = np.array([surface.points.min(axis=0), surface.points.max(axis=0)])
    return PartFacts(
        volume=volume,
        surface=float(triangle_areas(mesh.points, mesh.boundary).sum()),
        centroid=_vector(centroid),
        inertia=(_vector(inertia[0]), _vector(inertia[1]), _vector(inertia[2])),
        low=_vector(box[0]),
        high=_vector(box[1]),
        bores=find_bores(cylinder_walls(mesh.points, mesh.boundary), surface, box),
        digest=digest,
    )


def surface_of_mesh(gmsh: Any, path: str, digest: str, unit: float) -> PartSurface:
    """Return triangles of the surface of a mesh; parameters and errors are those of ``facts_of_mesh``.

    Parameters
    ----------
    gmsh, path, digest, unit : object
        As for ``facts_of_mesh``.

    Returns
    -------
    PartSurface
        Flat triangles, 16 for each curved one.
    """
    return _flat(read_mesh(path, digest, unit))


def _flat(mesh: FileMesh) -> PartSurface:
    lattice = [(i, j) for j in range(_PARTS + 1) for i in range(_PARTS + 1 - j)]
    number = {place: k for k, place in enumerate(lattice)}
    small = [((i, j), (i + 1, j), (i, j + 1)) for i, j in lattice if i + j < _PARTS]
    small += [((i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in lattice if i + j < _PARTS - 1]
    shape = _functions(np.array(lattice) / _PARTS)
    points = np.einsum("qn,knx->kqx", shape, mesh.points[mesh.boundary]).reshape(-1, 3)
    corners = np.array([[number[place] for place in one] for one in small])
    starts = len(lattice) * np.arange(len(mesh.boundary))
    triangles = (starts[:, None, None] + corners).reshape(-1, 3)
    faces = np.repeat(np.arange(len(mesh.boundary)), len(small))
    return PartSurface(points=points, triangles=triangles, faces=faces)


def _functions(at: Real) -> Real:
    """Return the six quadratic functions of a triangle at points (q, 2) of the unit triangle."""
    u, v = at.T
    w = 1.0 - u - v
    return np.stack([w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * w * u, 4 * u * v, 4 * w * v], axis=1)


def _integrals(points: Real, boundary: Ints) -> tuple[float, Real, Real]:
    """Return volume, centroid (3,) and inertia (3, 3) about it for unit density, by Gauss' theorem.

    div(f p) = (3 + n) f for a homogeneous f of degree n in p, so that ∫ f dV = 1/(3 + n) ∮ f p·dA. On curved triangles
    that is a polynomial of degree 8 at most, for which the rule is exact.
    """
    middle = points.mean(axis=0)  # near the centroid: no differences of large numbers
    x = points[boundary] - middle
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    at, weights = triangle_rule()
    for shape, gradient, weight in zip(_functions(at), shape_gradients(TRIANGLE_EDGES, at), weights, strict=True):
        place = np.einsum("n,knx->kx", shape, x)
        tangents = np.einsum("knx,nd->dkx", x, gradient)
        through = weight * (place * np.cross(tangents[0], tangents[1])).sum(axis=1)
        volume += float(through.sum()) / 3.0
        first += through @ place / 4.0
        second += (place * through[:, None]).T @ place / 5.0
    centroid = first / volume
    second -= volume * np.outer(centroid, centroid)
    return volume, middle + centroid, np.trace(second) * np.eye(3) - second


def mesh_of_body(body: Body, settings: MeshSettings) -> TaggedMesh:
    """Return the mesh of a body that is made of a mesh file, in its link's frame.

    Parameters
    ----------
    body : Body
        The body.
    settings : MeshSettings
        Of which ``max_elements`` alone counts.

    Returns
    -------
    TaggedMesh
        The file's elements, with the walls of its pins' holes as surfaces.

    Raises
    ------
    CaseError, CannotRunError
        As ``read_mesh``, and where the mesh is too large.
    """
    mesh = _placed(body)
    if len(mesh.cells) > settings.max_elements:
        raise CannotRunError(
            f"the mesh of the file has {len(mesh.cells):,} tetrahedra, more than max_elements "
            f"{settings.max_elements:,}; mesh the part coarser"
        )
    surfaces: dict[str, Ints] = {}
    areas: dict[str, float] = {}
    corners = mesh.points[mesh.boundary]
    for pin in body.pins:
        ring, radius = body.ring(pin), pin.diameter / 2.0
        near = 1e-3 * radius
        within = (corners[..., 2] >= ring.low - near) & (corners[..., 2] <= ring.high + near)
        off = np.abs(pin.distance(corners[..., 0], corners[..., 1]) - radius)
        wall = mesh.boundary[((off <= ON_WALL * radius) & within).all(axis=1)]
        surfaces[f"bore:{pin.name}"] = np.ascontiguousarray(wall[:, :3])
        areas[f"bore:{pin.name}"] = float(triangle_areas(mesh.points, wall).sum())
    volume, centroid, _ = _integrals(mesh.points, mesh.boundary)
    return TaggedMesh(
        points=mesh.points,
        cells=mesh.cells,
        surfaces=surfaces,
        areas=areas,
        volume=volume,
        centroid=centroid,
        notes=(NOTE,),
    )


def _placed(body: Body) -> FileMesh:
    """Return the mesh of a body's file in the frame of its link."""
    part = body.part
    assert isinstance(part, MeshedPart)
    mesh = read_mesh(part.file, part.digest, part.file_unit)
    return FileMesh(points=mesh.points @ np.array(part.turn).T + part.shift, cells=mesh.cells, boundary=mesh.boundary)


def _mass(body: Body) -> tuple[float, Real, Real]:
    mesh = _placed(body)
    return _integrals(mesh.points, mesh.boundary)


def _sections(body: Body, stations: tuple[float, ...]) -> tuple[list[CutSection], list[float]]:
    """Return sections of the surface's flat triangles, and that no hole has a flat ring."""
    surface = _flat(_placed(body))
    found = (section_of_surface(surface.points[surface.triangles], x) for x in stations)
    return [section for section in found if section is not None], [0.0] * len(body.pins)


def _reentrant(body: Body) -> list[ReentrantEdge]:
    mesh = _placed(body)
    return inner_edges(mesh.points, mesh.boundary)


def _refused(body: Body, path: str) -> None:
    raise CaseError("the part is a mesh, which has no faces or edges for a STEP file; export the program's own solid")


MESH_TASKS: dict[str, Callable[..., object]] = {
    "mesh": mesh_of_body,
    "mass": _mass,
    "step": _refused,
    "reentrant": _reentrant,
    "sections": _sections,
}
"""What the worker does with a body that is made of a mesh file, and further arguments."""


def _vector(values: Real) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
