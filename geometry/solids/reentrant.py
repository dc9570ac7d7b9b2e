"""Re-entrant edges of a solid: where linear elasticity has infinite stress, whatever the mesh.

At an edge whose material spans an angle β > π, stress grows as r^(λ-1) with λ < 1 (Williams, J. Appl.
Mech. 19 (1952) 526-528; Barber, Elasticity, 3rd ed., section 11.2).
"""

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from geometry.solids.solid_model import Solid

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

    The faces' tangent planes cut the plane normal to the edge into four sectors, of which one is material
    at a convex edge and all but one at a re-entrant edge.
    """
    place = np.asarray(gmsh.model.getValue(1, curve, [at]))
    axis = np.asarray(gmsh.model.getDerivative(1, curve, [at]))
    axis /= np.linalg.norm(axis)
    rays = []
    for face in faces:
        uv = gmsh.model.getParametrization(2, face, place)
        ray = np.cross(axis, np.asarray(gmsh.model.getNormal(face, uv)))
        rays += [ray / np.linalg.norm(ray), -ray / np.linalg.norm(ray)]
    if np.linalg.norm(np.cross(rays[0], rays[2])) < math.sin(SHARP):
        return math.pi  # the faces run into each other smoothly
    across = rays[0]
    other = np.cross(axis, across)
    turns = sorted(math.atan2(ray @ other, ray @ across) % (2.0 * math.pi) for ray in rays)
    sectors = list(itertools.pairwise([*turns, turns[0] + 2.0 * math.pi]))

    def material(sector: tuple[float, float]) -> bool:
        middle = (sector[0] + sector[1]) / 2.0
        point = place + _RADIUS * (math.cos(middle) * across + math.sin(middle) * other)
        return bool(gmsh.model.isInside(3, volume, point))

    found = [material(sectors[0]), material(sectors[2])]
    if found[0] == found[1]:
        # Opposite sectors: the lone material (or lone void) is one of the other two.
        lone = sectors[1] if material(sectors[1]) != found[0] else sectors[3]
        reentrant = found[0]
    else:
        reentrant = material(sectors[1])
        lone = sectors[0] if found[0] != reentrant else sectors[2]
    span = lone[1] - lone[0]
    return 2.0 * math.pi - span if reentrant else span
