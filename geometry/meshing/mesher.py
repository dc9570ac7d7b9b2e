"""Tetrahedra for a solid of the kernel or its upper half: sizes, extraction, and the checks that let a mesh pass.

Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError, CoarseMeshError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.forks import fork_places
from alula.geometry.meshing.element_count import SAFETY, Sizes, estimated_elements
from alula.geometry.meshing.element_geometry import flatten, jacobian_coefficients, scaled_jacobians, triangle_areas
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.meshing.mesh_target import MeshTarget
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.solids.solid_model import SECTION_UNITS, present

SLOT_ELEMENTS = 1.5
"""Element edges along a slot to those round a hole of its width: a pin pushes on a shorter stretch of a flank."""
LEAST_JACOBIAN = 0.1
"""Least over greatest Jacobian determinant below which a curved element is flattened.

gmsh's high-order optimiser is not used: on two owl links it mended 2 of 5 and 2 of 8 such elements, but
it can take half a minute, aborts the process where it fails, and its result varies from run to run.
"""

EDGE_PRECISION = 1e-4
"""Error of the number of elements along a stretch of an edge, at most a 64th of it, as the mesher adds up 1/size.

Each place costs the curvatures of the faces beside it. The mesher's own 1e-9 takes ten times as long (0.8 s in place of
0.05 s on link AE of the owl wing).
"""
_OPTIONS = {
    "Algorithm": 6,
    "Algorithm3D": 1,
    "Optimize": 1,
    "ElementOrder": 1,
    "LcIntegrationPrecision": EDGE_PRECISION,
    "MeshSizeExtendFromBoundary": 0,
    "MeshSizeFromPoints": 0,
}

FINER, ATTEMPTS = 0.7, 3
"""Factor on all sizes from one attempt at a mesh to the next, and how many there are."""

# The mesher places some nodes from either end of an edge, as memory addresses fall: they differ by
# 4e-16 from run to run. Rounding makes runs agree to the last bit.
_DECIMALS = 10

# gmsh's tetrahedron of ten nodes ends with the edges 23, 13; VTK's with 13, 23.
_FROM_GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
_GMSH_TETRA = {1: 4, 2: 11}
_GMSH_TRIANGLE = {1: 2, 2: 9}


def mesh_solid(gmsh: Any, target: MeshTarget, settings: MeshSettings) -> TaggedMesh:
    """Mesh a solid and check the mesh against the kernel's areas and volume; where half of it is meshed, mirror that.

    A mesh that fails these checks is made anew, finer, up to ``ATTEMPTS`` times in all, and the mesh's notes say so.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    target : MeshTarget
        What is to be meshed of the solid.
    settings : MeshSettings
        How fine, and what it may cost.

    Returns
    -------
    TaggedMesh
        The mesh of the whole solid, in mm.

    Raises
    ------
    CannotRunError
        If the mesher fails, if the mesh will exceed or exceeds ``max_elements``, if an element stays invalid, or if an
        area or the volume is off by more than the elements' chord error.
    """
    present(gmsh, target.tag)
    first: CoarseMeshError | None = None
    allowed = settings.chord_error  # error allowed for the requested size, and for finer ones
    for attempt in range(ATTEMPTS):
        try:
            mesh = _mesh(gmsh, target, settings, allowed)
        except CoarseMeshError as error:
            first, settings = first or error, settings.scaled(FINER)
        except CannotRunError:  # too many elements
            if first is None:
                raise
            break
        else:
            note = f"meshed with {FINER**attempt:.2g} times the requested size, because with that {first}"
            return mesh if first is None else replace(mesh, notes=(*mesh.notes, note))
    raise CannotRunError(f"{first}, and finer sizes fail as well; change the part's dimensions a little")


def _mesh(gmsh: Any, target: MeshTarget, settings: MeshSettings, allowed: float) -> TaggedMesh:
    """Return the mesh of one attempt; raises ``CoarseMeshError`` where a finer one may do."""
    gmsh.model.mesh.clear()
    order, images = 2 if settings.curved else 1, 2 if target.half else 1
    estimate = estimated_elements(gmsh, target, _sizes_at(target, settings), settings.turn_elements)
    if estimate > SAFETY * settings.max_elements:
        raise CannotRunError(
            f"the mesh would have about {estimate:,.2g} tetrahedra, more than max_elements {settings.max_elements:,} "
            f"even if that is {SAFETY:g} times too many; increase solid.mesh_size or check with --fidelity beam"
        )
    _set_sizes(gmsh, target, settings)
    for option, value in _OPTIONS.items():
        gmsh.option.setNumber(f"Mesh.{option}", value)
    try:
        gmsh.model.mesh.generate(3)
    except Exception as error:
        raise CoarseMeshError(f"the mesher failed ({error})") from None
    count = images * len(gmsh.model.mesh.getElementsByType(_GMSH_TETRA[1])[0])
    if count == 0:
        raise CoarseMeshError("the mesher filled no volume")
    if count > settings.max_elements:
        raise CannotRunError(
            f"the mesh has {count:,} tetrahedra, more than max_elements {settings.max_elements:,}; "
            "increase solid.mesh_size or check with --fidelity beam"
        )
    if order == 2:
        gmsh.model.mesh.setOrder(2)
    points, cells, numbers = _read(gmsh, order, target.cut)
    notes: tuple[str, ...] = ()
    if order == 2:
        curved = points
        points, flattened = flatten(curved, cells, LEAST_JACOBIAN)
        if flattened:
            moved = np.linalg.norm(points - curved, axis=1).max() * target.solid.unit
            of = f"{images * flattened} of {images * len(cells)}"
            notes = (f"{of} curved elements were flattened, by up to {moved:.2g} mm",)
    mesh = _checked(gmsh, target, settings, points, cells, numbers, notes, allowed)
    if not target.half:
        return mesh
    try:
        return mirrored(mesh)
    except CannotRunError as error:
        raise CoarseMeshError(str(error)) from None


def _read(gmsh: Any, order: int, cut: list[int]) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Return points and cells numbered from 0, positively oriented, and the map from gmsh's node tags.

    Points of the faces of a cut get z = 0: where it meets a fillet, the kernel has it to 1e-6.
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, flat = gmsh.model.mesh.getElementsByType(_GMSH_TETRA[order])
    cells = np.asarray(flat, dtype=np.int64).reshape(-1, 4 if order == 1 else 10)
    if order == 2:
        cells = cells[:, _FROM_GMSH]
    used = np.unique(cells)
    numbers = np.full(int(max(tags)) + 1, -1, dtype=np.int64)
    numbers[used] = np.arange(len(used))
    place = np.empty((len(numbers), 3))
    place[np.asarray(tags, dtype=np.int64)] = np.asarray(coordinates).reshape(-1, 3)
    for face in cut:
        place[np.asarray(gmsh.model.mesh.getNodes(2, face, includeBoundary=True)[0], dtype=np.int64), 2] = 0.0
    return np.round(place[used], _DECIMALS), numbers[cells], numbers


def _checked(
    gmsh: Any,
    target: MeshTarget,
    settings: MeshSettings,
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
    numbers: NDArray[np.int64],
    notes: tuple[str, ...],
    allowed: float,
) -> TaggedMesh:
    coefficients = jacobian_coefficients(points, cells)
    if coefficients.min() <= 0.0:
        least = scaled_jacobians(points, cells).min()
        raise CoarseMeshError(f"the mesh holds an inverted element (scaled Jacobian {least:.3g})")
    surfaces: dict[str, NDArray[np.int64]] = {}
    areas: dict[str, float] = {}
    order, unit = 2 if settings.curved else 1, target.solid.unit
    for name, faces in target.surfaces.items():
        flat = np.concatenate([gmsh.model.mesh.getElementsByType(_GMSH_TRIANGLE[order], tag)[1] for tag in faces])
        triangles = numbers[np.asarray(flat, dtype=np.int64).reshape(-1, 3 if order == 1 else 6)]
        area = sum(target.areas[tag] for tag in faces)
        meshed = triangle_areas(points, triangles).sum()
        if abs(meshed - area) > allowed * area:
            raise CoarseMeshError(
                f"surface '{name}' has {meshed * unit**2:.6g} mm² in the mesh, but "
                f"{area * unit**2:.6g} mm² in the geometry"
            )
        surfaces[name] = np.ascontiguousarray(triangles[:, :3])
        areas[name] = area * unit**2
    volume = target.volume
    meshed = coefficients.mean(axis=1).sum() / 6.0
    if abs(meshed - volume) > allowed * volume:
        raise CoarseMeshError(f"the mesh has {meshed * unit**3:.6g} mm³, but the geometry {volume * unit**3:.6g} mm³")
    return TaggedMesh(
        points=points * unit,
        cells=cells,
        surfaces=surfaces,
        areas=areas,
        volume=volume * unit**3,
        centroid=target.centroid * unit,
        notes=notes,
    )


def _set_sizes(gmsh: Any, target: MeshTarget, settings: MeshSettings) -> None:
    for field in gmsh.model.mesh.field.list():
        gmsh.model.mesh.field.remove(field)
    for view in gmsh.view.getTags():
        gmsh.view.remove(view)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", settings.turn_elements)
    if settings.size_points is None or settings.size_values is None:
        fields = [_formula(gmsh, text) for text in size_formulas(target.solid.body, settings)]
    else:
        fields = [_background(gmsh, *_cloud(target, settings))]
    smallest = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(smallest, "FieldsList", fields)
    gmsh.model.mesh.field.setAsBackgroundMesh(smallest)


def _cloud(target: MeshTarget, settings: MeshSettings) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return points and sizes in scaled units; of a half, each with the least of the sizes there and at its image."""
    assert settings.size_points is not None
    assert settings.size_values is not None
    points, values = settings.size_points / target.solid.unit, settings.size_values / target.solid.unit
    if not target.half:
        return points, values
    folded = np.round(np.column_stack([points[:, :2], np.abs(points[:, 2])]), _DECIMALS)
    folded, place = np.unique(folded, axis=0, return_inverse=True)
    least = np.full(len(folded), np.inf)
    np.minimum.at(least, place.ravel(), values)
    if folded[:, 2].min() > 0.0:  # a mesh has points on the plane; others would leave out what is below theirs
        folded, least = np.concatenate([folded, folded * (1.0, 1.0, -1.0)]), np.concatenate([least, least])
    return folded, least


def _sizes_at(target: MeshTarget, settings: MeshSettings) -> Sizes:
    """Return the same sizes as a function of points in scaled units."""
    if settings.size_points is not None and settings.size_values is not None:
        from scipy.spatial import cKDTree

        places, values = _cloud(target, settings)
        nearest = cKDTree(places)
        return lambda points: np.asarray(values[nearest.query(points)[1]])
    texts = [text.replace("^", "**") for text in size_formulas(target.solid.body, settings)]
    functions = {"Sqrt": np.sqrt, "Max": np.maximum, "Min": np.minimum, "Fabs": np.abs}

    def sizes(points: NDArray[np.float64]) -> NDArray[np.float64]:
        names = functions | dict(zip("xyz", points.T, strict=True))
        # Texts of our own, made of numbers: gmsh takes formulas as text alone.
        found = [np.broadcast_to(eval(text, {"__builtins__": {}}, names), len(points)) for text in texts]
        return np.asarray(np.min(found, axis=0))

    return sizes


def size_formulas(body: Body, settings: MeshSettings) -> list[str]:
    """Return formulas in x, y and z of which the least is the element size.

    The general size; round each hole its circumference over the number of elements, growing with the distance from its
    wall; at the places that the kind of part names, such as fillets, their own size, growing likewise.

    Parameters
    ----------
    body : Body
        The body in scaled units.
    settings : MeshSettings
        How fine.

    Returns
    -------
    list of str
        Formulas as gmsh reads them, in scaled units.
    """
    part, growth = body.part, settings.growth
    general = min(settings.size * SECTION_UNITS, part.largest_element())
    holes = [
        (pin.diameter, settings.bore_elements * (SLOT_ELEMENTS if pin.slot else 1.0), pin.distance_formula)
        for pin in body.pins
    ]
    for row in body.holes:
        across = "y" if row.along == "z" else "z"
        holes += [(row.diameter, settings.hole_elements, f"Sqrt((x-({x:.12g}))^2+{across}^2)") for x in row.positions]
    places = [
        (min(math.pi * diameter / elements, general), f"Max({distance}-{diameter / 2.0:.12g},0)")
        for diameter, elements, distance in holes
    ]
    places += part.fine_places(body, general, settings.fillet_size)
    places += fork_places(body, general, settings.fillet_size)
    return [f"{general:.12g}", *(f"{size:.12g}+{growth:g}*{distance}" for size, distance in places)]


def _formula(gmsh: Any, text: str) -> int:
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", text)
    return int(field)


def _background(gmsh: Any, points: NDArray[np.float64], values: NDArray[np.float64]) -> int:
    """Return a field that interpolates the sizes linearly on the points' Delaunay tetrahedra."""
    from scipy.spatial import Delaunay

    tetrahedra = Delaunay(points).simplices
    data = np.concatenate([points[tetrahedra].transpose(0, 2, 1).reshape(-1, 12), values[tetrahedra]], axis=1)
    view = gmsh.view.add("sizes")
    gmsh.view.addListData(view, "SS", len(tetrahedra), data.ravel())
    field = gmsh.model.mesh.field.add("PostView")
    gmsh.model.mesh.field.setNumber(field, "ViewTag", view)
    return int(field)
