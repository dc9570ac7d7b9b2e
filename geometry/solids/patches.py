"""Loaded patches on parts of any shape: where a load that is no pin's enters an imported part or a plate.

It enters the face that is nearest to its point, of a plate its top and bottom: a flat one within a circle about the
nearest place, a round one whole. Where faces are equally near, as top and bottom of a flat part, all of them carry the
load. Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.features import FlatFace, PlainEnd
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel

AS_NEAR = 1e-3
"""Share by which the distances of two faces from a point may differ where both count."""


FACE = 1e-4
"""Share of a face's size by which its centre, its plane and its area may be off where it is found again."""


def patch_borders(gmsh: Any, solid: int, end: PlainEnd, height: float | None = None) -> list[Entity]:
    """Return the circles that bound a patch on flat faces, as disks.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : int
        Tag of the solid.
    end : PlainEnd
        The load point.
    height : float or None, optional
        Where stated, flat faces at this z and at its opposite alone count.

    Returns
    -------
    list of tuple
        Faces to be imprinted on the solid.

    Raises
    ------
    CaseError
        Where the point lies off the part.
    """
    if end.face is not None:
        return []
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, solid)], oriented=False)]
    disks, radius, nearest = [], end.patch / 2.0, _nearest(gmsh, _level(gmsh, faces, height), end)
    away = min(float(np.linalg.norm(at - (end.x, end.y, 0.0))) for at in nearest.values())
    if away > radius and not gmsh.model.isInside(3, solid, [end.x, end.y, 0.0]):
        raise CaseError(
            f"the load point {end.name} lies outside of the part, {away / radius:.3g} times half of end_patch from its "
            "surface; move it onto the part"
        )
    for face, at in nearest.items():
        if gmsh.model.getType(2, face) == "Plane":
            normal = gmsh.model.getNormal(face, gmsh.model.getParametrization(2, face, at))
            disks.append((2, gmsh.model.occ.addDisk(*at, radius, radius, zAxis=list(normal))))
    return disks


def patch_faces(gmsh: Any, faces: Iterable[int], end: PlainEnd, height: float | None = None) -> list[int]:
    """Return the faces that make up a patch, after its borders were imprinted.

    Parameters
    ----------
    gmsh : module
        gmsh, with what is meshed in its present model.
    faces : iterable of int
        Tags of its faces.
    end : PlainEnd
        The load point.
    height : float or None, optional
        Where stated, flat faces at this z and at its opposite alone count.

    Returns
    -------
    list of int
        Tags.
    """
    found, reach = [], end.patch / 2.0 + 10.0 * ON_SURFACE
    for face, at in _nearest(gmsh, _level(gmsh, faces, height), end).items():
        box = np.reshape(gmsh.model.getBoundingBox(2, face), (2, 3))
        if gmsh.model.getType(2, face) != "Plane" or np.abs(box - at).max() < reach:
            found.append(face)
    return found


def pieces_of_face(gmsh: Any, faces: Iterable[int], body: Body, wanted: FlatFace) -> list[int]:
    """Return the faces into which a named face of an imported part was split, as by the rings about its bores.

    Parameters
    ----------
    gmsh : module
        gmsh, with what is meshed in its present model.
    faces : iterable of int
        Tags of its faces.
    body : Body
        The body, in the unit in which it is built.
    wanted : FlatFace
        The face, in the same unit.

    Returns
    -------
    list of int
        Tags; empty where the part has no such face.
    """
    model, normal, centre = gmsh.model, np.array(wanted.normal), np.array(wanted.centre)
    reach = FACE * math.sqrt(wanted.area)

    def lies(face: int) -> bool:
        """Tell whether a face is on the plane of the wanted one."""
        if model.getType(2, face) != "Plane":
            return False
        corners = np.reshape([model.getValue(0, point, []) for _, point in _corners(gmsh, face)], (-1, 3))
        return bool(np.abs((corners - centre) @ normal).max() < reach)

    flat = [face for face in faces if lies(face)]
    whole = body.part.solid(Kernel(gmsh), body)  # once more, as it is without what was imprinted
    model.occ.synchronize()
    own = [
        face
        for _, face in model.getBoundary([whole], oriented=False)
        if np.linalg.norm(model.occ.getCenterOfMass(2, face) - centre) < reach
        and abs(model.occ.getMass(2, face) - wanted.area) < FACE * wanted.area
        and lies(face)
    ]
    found = [face for face in flat if own and _is_within(gmsh, face, own[0])]
    model.occ.remove([whole], recursive=True)
    model.occ.synchronize()
    return found


def _corners(gmsh: Any, face: int) -> Any:
    return gmsh.model.getBoundary([(2, face)], combined=False, oriented=False, recursive=True)


def _is_within(gmsh: Any, piece: int, face: int) -> bool:
    """Return whether a flat face lies within another one on its plane, told by places spread over it."""
    low, high = gmsh.model.getParametrizationBounds(2, piece)
    for count in (8, 32, 128):
        steps = (np.arange(count) + 0.5) / count
        grid = np.stack(np.meshgrid(*(a + steps * (b - a) for a, b in zip(low, high, strict=True))), axis=-1)
        own = [at for at in grid.reshape(-1, 2).tolist() if gmsh.model.isInside(2, piece, at, parametric=True)]
        if own:
            places = gmsh.model.getValue(2, piece, np.ravel(own))
            return bool(2 * gmsh.model.isInside(2, face, places) > len(own))
    return False


def _level(gmsh: Any, faces: Iterable[int], height: float | None) -> list[int]:
    """Return the faces of a body that are flat at a height or its opposite; all where none is stated."""

    def lies(face: int, level: float) -> bool:
        low, high = map(float, gmsh.model.getBoundingBox(2, face)[2::3])
        off = max(abs(low - level), abs(high - level))
        return bool(gmsh.model.getType(2, face) == "Plane") and off < 10.0 * ON_SURFACE

    if height is None:
        return list(faces)
    return [face for face in faces if lies(face, height) or lies(face, -height)]


def _nearest(gmsh: Any, faces: Iterable[int], end: PlainEnd) -> dict[int, NDArray[np.float64]]:
    """Return the faces nearest to a load point, each with its nearest place (3,)."""
    occ = gmsh.model.occ
    point = occ.addPoint(end.x, end.y, 0.0)
    told = {face: occ.getDistance(0, point, 2, face) for face in faces}
    occ.remove([(0, point)])
    least = min(distance for distance, *_ in told.values())
    near = least * (1.0 + AS_NEAR) + ON_SURFACE
    return {face: np.asarray(places[3:6]) for face, (distance, *places) in told.items() if distance <= near}
