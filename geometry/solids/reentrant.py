"""Re-entrant edges of a solid: where linear elasticity has infinite stress, whatever the mesh.

At an edge whose material spans an angle β > π, stress grows as r^(λ-1) with λ < 1 (Williams, J. Appl.
Mech. 19 (1952) 526-528; Barber, Elasticity, 3rd ed., section 11.2).
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from alula.geometry.solids.solid_model import Solid

SHARP = math.radians(5.0)
"""Angles up to this far above 180° count as smooth: the exponent λ is then above 0.99."""

# In the solid's scaled unit, in which sections are ten across.
_RADIUS = 1e-3
_STATIONS = (0.07, 0.5, 0.81)
_POINTS = 25


@dataclass(frozen=True, kw_only=True)
class ReentrantEdge:
    """A re-entrant edge.

    Attributes
    ----------
    points : ndarray
        Polyline (n, 3) along it [mm].
    angle : float
        Greatest angle that the material spans [rad].
    """

    points: NDArray[np.float64]
    angle: float


def find_reentrant_edges(gmsh: Any, solid: "Solid") -> list[ReentrantEdge]:
    """Return the edges whose material angle exceeds π by more than ``SHARP`` at one of three stations.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid as its model.
    solid : Solid
        The solid.

    Returns
    -------
    list of ReentrantEdge
        The edges.
    """
    edges = []
    for _, tag in gmsh.model.getEntities(1):
        faces = gmsh.model.getAdjacencies(1, tag)[0]
        if len(faces) != 2:
            continue  # the seam of a round face
        low, high = (bound[0] for bound in gmsh.model.getParametrizationBounds(1, tag))
        angle = 0.0
        for at in _STATIONS:
            here = _material_angle(gmsh, solid.tag, tag, faces, low + (high - low) * at)
            angle = max(angle, here)
            if here < math.pi:
                break  # convex here, so all along: asking the kernel is slow where a part has many faces
        if angle > math.pi + SHARP:
            along = np.asarray(gmsh.model.getValue(1, tag, np.linspace(low, high, _POINTS))).reshape(-1, 3)
            edges.append(ReentrantEdge(points=along * solid.unit, angle=angle))
    return edges


def _material_angle(gmsh: Any, volume: int, curve: int, faces: NDArray[np.int32], at: float) -> float:
    """Return the angle [rad] that the solid spans at a point of an edge between two faces.

    Behind one face and in front of the other there is material at a re-entrant edge alone, whichever of the two it is.
    Where one of both places has material and the other none, the normal of a face points inwards, as that of one which
    was imprinted may.
    """
    place = np.asarray(gmsh.model.getValue(1, curve, [at]))
    normals = [gmsh.model.getNormal(face, gmsh.model.getParametrization(2, face, place)) for face in faces]
    one, other = (np.asarray(normal) / np.linalg.norm(normal) for normal in normals)
    sine = float(np.linalg.norm(np.cross(one, other)))
    if sine < math.sin(SHARP):
        return math.pi  # the faces run into each other smoothly

    def material(direction: NDArray[np.float64]) -> bool:
        point = place + _RADIUS * direction / np.linalg.norm(direction)
        return bool(gmsh.model.isInside(3, volume, point))

    reentrant = material(one - other)
    if material(other - one) != reentrant:
        other = -other
        reentrant = material(one - other)
    turn = math.atan2(sine, float(one @ other))
    return math.pi + (turn if reentrant else -turn)
