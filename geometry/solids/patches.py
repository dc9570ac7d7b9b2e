"""Loaded patches on parts of any shape: where a load that is no pin's enters an imported part or a plate.

It enters the face that is nearest to its point, of a plate its top and bottom: a flat one within a circle about the
nearest place, a round one whole. Where faces are equally near, as top and bottom of a flat part, all of them carry the
load. Runs in a child process only (see ``geometry.meshing.mesh``).
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CaseError
from geometry.bodies.features import PlainEnd
from geometry.bodies.kernel import ON_SURFACE, Entity

AS_NEAR = 1e-3
"""Share by which the distances of two faces from a point may differ where both count."""


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
