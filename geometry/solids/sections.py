"""Sections of a solid across the x axis of its link, and the flat rings about its holes, by the geometry kernel.

Runs in a child process only (see ``geometry.meshing.mesh``).
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.bodies.body import FLAT_WALL, apart
from geometry.bodies.kernel import ON_SURFACE
from geometry.solids.solid_model import Solid

WIDEST = 4.0
"""Diameter of the ring about a hole on a larger face, over that of the hole, at most."""
_POINTS = 65


@dataclass(frozen=True, kw_only=True)
class StationSection:
    """A section of a solid normal to x.

    Attributes
    ----------
    x : float
        Where it is cut [mm].
    area : float
        Its area [mm²].
    centre : tuple of float
        (y, z) of its centroid [mm].
    i_y, i_z, i_yz : float
        ∫z² dA, ∫y² dA and ∫yz dA about axes through the centroid [mm⁴].
    low, high : tuple of float
        Least and greatest y and z [mm].
    """

    x: float
    area: float
    centre: tuple[float, float]
    i_y: float
    i_z: float
    i_yz: float
    low: tuple[float, float]
    high: tuple[float, float]

    @property
    def principal(self) -> tuple[float, float]:
        """Least and greatest second moment of area about axes through the centroid [mm⁴].

        (I_y + I_z)/2 ± √(((I_y - I_z)/2)² + I_yz²) (Timoshenko, Strength of Materials I, appendix A).
        """
        mean, half = (self.i_y + self.i_z) / 2.0, math.hypot((self.i_y - self.i_z) / 2.0, self.i_yz)
        return mean - half, mean + half


def cut_sections(gmsh: Any, solid: Solid, stations: tuple[float, ...]) -> list[StationSection]:
    """Cut a solid at stations; one that lies outside of it yields nothing.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : Solid
        The solid.
    stations : tuple of float
        The x at which it is cut [mm].

    Returns
    -------
    list of StationSection
        The sections that have an area.
    """
    low, high = np.reshape(gmsh.model.getBoundingBox(3, solid.tag), (2, 3))
    margin = 0.1 * (high - low).max()
    found = []
    for x in stations:
        faces = _faces(gmsh, solid.tag, x / solid.unit, low - margin, high + margin)
        if faces:
            found.append(_joined(x, faces, solid.unit))
    return found


def _faces(
    gmsh: Any, tag: int, x: float, low: NDArray[np.float64], high: NDArray[np.float64]
) -> list[tuple[float, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]]:
    """Return area, centroid (3,), second moments (3, 3) about it and bounds (2, 3) of each face of a section."""
    occ = gmsh.model.occ
    plane = occ.addRectangle(0.0, 0.0, 0.0, high[2] - low[2], high[1] - low[1])
    occ.rotate([(2, plane)], 0, 0, 0, 0, 1, 0, -math.pi / 2.0)  # the first side now along z
    occ.translate([(2, plane)], x, low[1], low[2])
    try:
        pieces, _ = occ.intersect([(2, plane)], [(3, tag)], removeTool=False)
    except Exception:  # the kernel's own, where nothing is cut
        return []
    faces = []
    for dim, face in pieces:
        if dim == 2 and (area := occ.getMass(2, face)) > 0.0:
            inertia = np.reshape(occ.getMatrixOfInertia(2, face), (3, 3))
            second = np.trace(inertia) / 2.0 * np.eye(3) - inertia
            bounds = np.reshape(occ.getBoundingBox(2, face), (2, 3))
            faces.append((area, np.asarray(occ.getCenterOfMass(2, face)), second, bounds))
    occ.remove(pieces, recursive=True)
    return faces


def _joined(
    x: float, faces: list[tuple[float, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]], unit: float
) -> StationSection:
    """Return faces of one plane as one section, by the parallel-axis theorem."""
    area = sum(face[0] for face in faces)
    centre = np.sum([face[0] * face[1] for face in faces], axis=0) / area
    second = np.sum([f[2] + f[0] * np.outer(f[1] - centre, f[1] - centre) for f in faces], axis=0)
    low = np.min([face[3][0] for face in faces], axis=0) * unit
    high = np.max([face[3][1] for face in faces], axis=0) * unit
    return StationSection(
        x=x,
        area=float(area) * unit**2,
        centre=(float(centre[1]) * unit, float(centre[2]) * unit),
        i_y=float(second[2, 2]) * unit**4,
        i_z=float(second[1, 1]) * unit**4,
        i_yz=float(second[1, 2]) * unit**4,
        low=(float(low[1]), float(low[2])),
        high=(float(high[1]), float(high[2])),
    )


def ring_diameters(gmsh: Any, solid: Solid) -> list[float]:
    """Return the outer diameter of the flat ring about each hole, on which a torque or a thrust enters.

    A face that is itself a ring, such as that of an eye or a boss, counts whole. Of a larger one the ring takes three
    quarters of the wall between the hole and the nearest border (between two pins, of half of it), and is at most
    ``WIDEST`` times as wide as the hole.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : Solid
        The solid.

    Returns
    -------
    list of float
        In the order of the body's pins [mm]; 0 where the rims of a hole do not both lie in flat faces.
    """
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, solid.tag)], oriented=False)]
    planes = [tag for tag in faces if gmsh.model.getType(2, tag) == "Plane"]
    found = []
    for pin in solid.body.pins:
        ring = solid.body.ring(pin)
        others = [other for other in solid.body.pins if other is not pin]
        walls = [apart(pin, other) - (pin.diameter + other.diameter) / 2.0 for other in others]
        widest = min([WIDEST * pin.diameter, *(pin.diameter + wall for wall in walls)])
        sides = [
            max((_ring_on(gmsh, face, (pin.x, pin.y, z), pin.diameter, widest) for face in planes), default=0.0)
            for z in (ring.low, ring.high)
        ]
        found.append(0.0 if pin.slot > 0.0 else min(sides) * solid.unit)
    return found


def _ring_on(gmsh: Any, face: int, centre: tuple[float, float, float], diameter: float, widest: float) -> float:
    """Return the outer diameter of the ring about a hole on a flat face; 0 where the hole's rim is no border of it."""
    rim, border = False, []
    for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
        low, high = (bound[0] for bound in gmsh.model.getParametrizationBounds(1, curve))
        points = np.reshape(gmsh.model.getValue(1, curve, np.linspace(low, high, _POINTS)), (-1, 3))
        if np.abs(points[:, 2] - centre[2]).max() > ON_SURFACE:
            return 0.0
        away = 2.0 * np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1])
        if np.abs(away - diameter).max() < 2.0 * ON_SURFACE:
            rim = True
        else:
            border.append(away)
    if not rim or not border:
        return 0.0
    every = np.concatenate(border)
    nearest = float(every.min())
    if nearest < diameter + 2.0 * ON_SURFACE:  # the hole is open at a side, or has a keyway
        return 0.0
    if np.ptp(every) < 2.0 * ON_SURFACE:
        return nearest
    return diameter + FLAT_WALL * (min(nearest, widest) - diameter)
