"""Sections of a solid across the x axis of its link, and the flat rings about its holes, by the geometry kernel.

Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.body import FLAT_WALL, apart
from alula.geometry.bodies.cut_section import CutSection, convex, joined
from alula.geometry.bodies.kernel import ON_SURFACE
from alula.geometry.solids.solid_model import Solid

WIDEST = 4.0
"""Diameter of the ring about a hole on a larger face, over that of the hole, at most."""
_POINTS = 129
"""Along a curve: a circle's chords lie within 3e-4 of its radius."""
Real = NDArray[np.float64]


def cut_sections(gmsh: Any, solid: Solid, stations: tuple[float, ...]) -> list[CutSection]:
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
    list of CutSection
        The sections that have an area.
    """
    low, high = np.reshape(gmsh.model.getBoundingBox(3, solid.tag), (2, 3))
    margin = 0.1 * (high - low).max()
    faces = [_cut(gmsh, solid.tag, x / solid.unit, low - margin, high + margin) for x in stations]
    gmsh.model.occ.synchronize()
    found = [[_section(gmsh, face, x, solid.unit) for face in own] for x, own in zip(stations, faces, strict=True)]
    gmsh.model.occ.remove([(2, face) for own in faces for face in own], recursive=True)
    gmsh.model.occ.synchronize()
    return [joined(own) for own in found if own]


def _cut(gmsh: Any, tag: int, x: float, low: Real, high: Real) -> list[int]:
    """Return the tags of the faces of a section, not yet synchronised."""
    occ = gmsh.model.occ
    plane = occ.addRectangle(0.0, 0.0, 0.0, high[2] - low[2], high[1] - low[1])
    occ.rotate([(2, plane)], 0, 0, 0, 0, 1, 0, -math.pi / 2.0)  # the first side now along z
    occ.translate([(2, plane)], x, low[1], low[2])
    try:
        pieces, _ = occ.intersect([(2, plane)], [(3, tag)], removeTool=False)
    except Exception:  # the kernel's own, where nothing is cut
        return []
    return [face for dim, face in pieces if dim == 2 and occ.getMass(2, face) > 0.0]


def _section(gmsh: Any, face: int, x: float, unit: float) -> CutSection:
    """Return one face of a section; the face is as large as ``unit`` says of its kernel."""
    occ = gmsh.model.occ
    inertia = np.reshape(occ.getMatrixOfInertia(2, face), (3, 3)) * unit**4
    second = np.trace(inertia) / 2.0 * np.eye(3) - inertia
    _, y, z = occ.getCenterOfMass(2, face)
    outline = []
    for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
        first, last = (bound[0] for bound in gmsh.model.getParametrizationBounds(1, curve))
        count = 2 if gmsh.model.getType(1, curve) == "Line" else _POINTS
        outline.append(
            np.reshape(gmsh.model.getValue(1, curve, np.linspace(first, last, count)), (-1, 3))[:, 1:] * unit
        )
    return CutSection(
        x=x,
        area=float(occ.getMass(2, face)) * unit**2,
        centre=(float(y) * unit, float(z) * unit),
        i_y=float(second[2, 2]),
        i_z=float(second[1, 1]),
        i_yz=float(second[1, 2]),
        hull=convex(map(tuple, np.concatenate(outline).tolist())),
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
