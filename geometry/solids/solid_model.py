"""Links as solids of gmsh's OpenCASCADE kernel.

Runs in a child process only (see ``alula.geometry.meshing.mesh``), since the kernel can crash or loop for ever.
OpenCASCADE works to 1e-7 in whatever unit, so a body is built in a unit of its own: a tenth of its
section's smaller size. What this module is given and returns is in mm.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.bodies.body import Body, patch_span
from alula.geometry.bodies.eyes import flush
from alula.geometry.bodies.features import HoleRow, Pin
from alula.geometry.bodies.kernel import Entity, FilletError, Kernel
from alula.geometry.solids.patches import patch_borders

SECTION_UNITS = 10.0
"""Smaller size of a section, in the unit in which it is built."""


@dataclass(frozen=True, kw_only=True)
class Solid:
    """A solid in the kernel.

    Attributes
    ----------
    tag : int
        Its tag.
    unit : float
        Size of the unit in which it is built [mm].
    body : Body
        The body, in that unit.
    """

    tag: int
    unit: float
    body: Body


def initialised() -> Any:
    """Return gmsh, silent, on one thread and with fixed random numbers."""
    import gmsh

    gmsh.initialize(argv=[""], readConfigFiles=False, interruptible=False)
    for option, value in {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.RandomSeed": 1,
        "Geometry.OCCUnionUnify": 0,
        "Geometry.OCCBoundsUseStl": 0,
        "Geometry.OCCParallel": 0,
    }.items():
        gmsh.option.setNumber(option, value)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    return gmsh


def scaled(body: Body, unit: float) -> Body:
    """Return a body with lengths in another unit, rounded so that its real size leaves no trace.

    Parameters
    ----------
    body : Body
        The body, in mm.
    unit : float
        The unit [mm].

    Returns
    -------
    Body
        The same body, in that unit.
    """

    def s(length: float) -> float:
        return round(length / unit, 9)

    return Body(
        part=body.part.scaled(s),
        pins=tuple(
            replace(
                p,
                x=s(p.x),
                y=s(p.y),
                diameter=s(p.diameter),
                slot=s(p.slot),
                clearance=s(p.clearance),
                foot=None if p.foot is None else (s(p.foot[0]), s(p.foot[1])),
                ring=None if p.ring is None else p.ring.scaled(s),
                fork=None if p.fork is None else p.fork.scaled(s),
            )
            for p in body.pins
        ),
        ends=tuple(
            replace(
                e,
                x=s(e.x),
                patch=s(e.patch),
                y=s(e.y),
                face=None if e.face is None else e.face.scaled(s),
            )
            for e in body.ends
        ),
        holes=tuple(
            HoleRow.model_construct(
                count=r.count, diameter=s(r.diameter), first=s(r.first), last=s(r.last), along=r.along
            )
            for r in body.holes
        ),
    )


def build(gmsh: Any, body: Body) -> Solid:
    """Build a body in the present model of the kernel, which is empty.

    Parameters
    ----------
    gmsh : module
        gmsh, as ``initialised`` returns it.
    body : Body
        The body, in mm.

    Returns
    -------
    Solid
        The solid.

    Raises
    ------
    CaseError
        Where the fillets do not fit.
    CannotRunError
        Where the kernel fails otherwise.
    """
    part, kernel = body.part, Kernel(gmsh)
    unit = part.size / SECTION_UNITS
    small = scaled(body, unit)
    try:
        solid = small.part.solid(kernel, small)
        tools = small.part.cavities(kernel, small)
    except FilletError:
        arms = ", or turn an arm further from what is beside it" if any(pin.foot for pin in body.pins) else ""
        rings = [ring for ring in map(body.ring, body.pins) if ring.diameter > 0.0]
        if not rings:
            raise CaseError(
                f"fillet_radius {part.fillet_radius:g} mm does not fit inside the {part.shape}; reduce it"
            ) from None
        eyes = " and ".join(dict.fromkeys(f"{ring.diameter:g} mm by {ring.height:g} mm" for ring in rings))
        raise CaseError(
            f"fillet_radius {part.fillet_radius:g} mm does not fit between the {part.shape} and its eyes of "
            f"{eyes}; reduce it, increase eye_diameter or "
            f"eye_thickness, or move the pins further apart{arms}"
        ) from None
    for pin in () if part.has_holes else small.pins:
        tools += kernel.upright(pin, pin.diameter, 2.0 * small.ring(pin).height)
        tools += [] if pin.fork is None else [kernel.fork_gap(pin, pin.fork)]
    tools += _hole_rows(kernel, small)  # one cut, since a second one works on all faces that the first one made
    solid = _imprint(kernel, small, kernel.cut(solid, tools))
    kernel.occ.synchronize()
    kernel.only(gmsh.model.getEntities(3))
    return Solid(tag=solid[1], unit=unit, body=small)


def present(gmsh: Any, tag: int) -> None:
    """Show a single solid to mesher and queries, of those that the kernel has in the present model.

    Parameters
    ----------
    gmsh : module
        gmsh.
    tag : int
        Tag of the solid.
    """
    gmsh.model.occ.synchronize()
    gmsh.model.removeEntities([solid for solid in gmsh.model.getEntities(3) if solid[1] != tag], recursive=True)


def _imprint(kernel: Kernel, body: Body, solid: Entity) -> Entity:
    """Split flat faces along the borders of the surfaces that carry names.

    These are the rings about holes where eyes lie flush with their bar, arm or disc, and the loaded patches. A round
    part has its patches from the start.
    """
    occ, section = kernel.occ, body.part.section
    borders: list[Entity] = []
    height = section.height
    for pin in body.pins:
        ring = body.ring(pin)
        if ring.diameter > 0.0 and (body.part.has_holes or flush(body, pin)):
            borders += [_flat_eye(kernel, pin, body.part.flat_diameter(body, pin), z) for z in (ring.low, ring.high)]
    if body.part.patches_anywhere:
        occ.synchronize()
        borders += [
            border for end in body.ends for border in patch_borders(kernel.gmsh, solid[1], end, body.part.patch_height)
        ]
    for end in () if body.part.patches_anywhere or section.round else body.ends:
        low, high = patch_span(body, end)
        start, stop = (body.part.half_width(body, x) for x in (low, high))
        wide, slope = max(start, stop), math.atan2(stop - start, high - low)
        for side in (-1.0, 1.0):
            flat = occ.addRectangle(low, -wide, side * height / 2.0, high - low, 2.0 * wide)
            upright = occ.addRectangle(low, -height / 2.0, side * start, (high - low) / math.cos(slope), height)
            occ.rotate([(2, upright)], 0, 0, 0, 1, 0, 0, math.pi / 2.0)
            if slope:
                occ.rotate([(2, upright)], low, -side * start, 0, 0, 0, 1, -side * slope)
            borders += [(2, flat), (2, upright)]
    if not borders:
        return solid
    pieces, _ = occ.fragment([solid], borders)
    occ.synchronize()
    # What lay over a hole belongs to no solid.
    occ.remove([p for p in pieces if p[0] == 2 and not kernel.model.getAdjacencies(*p)[0].size], recursive=True)
    return kernel.only([p for p in pieces if p[0] == 3])


def _flat_eye(kernel: Kernel, pin: Pin, diameter: float, z: float) -> Entity:
    """Return the outline of an eye as a face at a height."""
    occ, radius = kernel.occ, diameter / 2.0
    if pin.slot == 0.0:
        return 2, occ.addDisk(pin.x, pin.y, z, radius, radius)
    low, high = pin.span
    corners = [
        occ.addPoint(x, pin.y + side * radius, z)
        for x, side in ((low, -1.0), (high, -1.0), (high, 0.0), (high, 1.0), (low, 1.0), (low, 0.0))
    ]
    # The middles of the arcs lie outwards.
    middles = [occ.addPoint(x, pin.y, z) for x in (high, low)]
    occ.translate([(0, corners[2])], radius, 0, 0)
    occ.translate([(0, corners[5])], -radius, 0, 0)
    border = [
        occ.addLine(corners[0], corners[1]),
        occ.addCircleArc(corners[1], middles[0], corners[2]),
        occ.addCircleArc(corners[2], middles[0], corners[3]),
        occ.addLine(corners[3], corners[4]),
        occ.addCircleArc(corners[4], middles[1], corners[5]),
        occ.addCircleArc(corners[5], middles[1], corners[0]),
    ]
    occ.remove([(0, middle) for middle in middles])
    return 2, occ.addPlaneSurface([occ.addCurveLoop(border)])


def _hole_rows(kernel: Kernel, body: Body) -> list[Entity]:
    """Return what the rows cut out; of a bar with arms just through its section, since an arm may pass beside it."""
    section, arms = body.part.section, any(pin.foot for pin in body.pins)
    stations = [x for row in body.holes for x in row.positions]
    reach = 2.0 * max([section.width, section.height, *(2.0 * body.part.half_width(body, x) for x in stations)])
    holes: list[Entity] = []
    for row in body.holes:
        if arms:
            reach = 0.51 * (section.width if row.along == "y" else section.height)
        dy, dz = (1, 0) if row.along == "y" else (0, 1)
        start, axis = (-reach * dy, -reach * dz), (2.0 * reach * dy, 2.0 * reach * dz)
        holes += [kernel.cylinder((x, *start), (0, *axis), row.diameter / 2.0) for x in row.positions]
    return holes


def write_step(gmsh: Any, solid: Solid, path: Path) -> None:
    """Write a solid as STEP in mm.

    The solid passes through a file to be scaled as it is read: the kernel's own scaling of a solid
    (``occ.dilate``) redraws every face as a spline and moves a filleted one.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid as its model.
    solid : Solid
        The solid.
    path : Path
        The file, whose name is ASCII.

    Raises
    ------
    CannotRunError
        Where the volume in the file is another.
    """
    volume = gmsh.model.occ.getMass(3, solid.tag) * solid.unit**3
    unscaled = path.with_suffix(".brep")
    gmsh.write(str(unscaled))
    gmsh.model.add("scaled")
    gmsh.option.setNumber("Geometry.OCCScaling", solid.unit)
    try:
        [imported] = gmsh.model.occ.importShapes(str(unscaled))
        gmsh.model.occ.synchronize()
        unscaled.unlink()
        written = gmsh.model.occ.getMass(*imported)
        if abs(written - volume) > 1e-5 * volume:
            raise CannotRunError(f"the STEP file would hold {written:.6g} mm³, but the part has {volume:.6g} mm³")
        gmsh.write(str(path))
    finally:
        gmsh.option.setNumber("Geometry.OCCScaling", 1.0)
        gmsh.model.remove()


def volume_centroid_inertia(gmsh: Any, solid: Solid) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Return the volume integrals of a solid.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid as its model.
    solid : Solid
        The solid.

    Returns
    -------
    volume : float
        Volume [mm³].
    centroid : ndarray
        Centroid (3,) [mm].
    inertia : ndarray
        Inertia tensor (3, 3) about the centroid, for unit density [mm⁵].
    """
    occ = gmsh.model.occ
    inertia = np.asarray(occ.getMatrixOfInertia(3, solid.tag)).reshape(3, 3)
    return (
        occ.getMass(3, solid.tag) * solid.unit**3,
        np.asarray(occ.getCenterOfMass(3, solid.tag)) * solid.unit,
        inertia * solid.unit**5,
    )
