"""Links as solids of gmsh's OpenCASCADE kernel, with the faces that loads and checks refer to.

Runs in a child process only (see ``geometry.meshing.mesh``), since the kernel can crash or loop for ever.
OpenCASCADE works to 1e-7 in whatever unit, so a body is built in a unit of its own: a tenth of its
section's smaller size. What this module is given and returns is in mm.
"""

import itertools
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CannotRunError, CaseError
from geometry.parts.body_rules import extent, patch_span, plain_eye, section_height, section_width
from geometry.parts.part import Bar, Body, Disc, HoleRow, Part, Pin, PlainEnd, Tube

Entity = tuple[int, int]

# Distance, in the scaled unit, within which a point counts as lying on a surface.
ON_SURFACE = 1e-5
# Sections are ten units across.
SECTION_UNITS = 10.0
CLEAR_EYE = 1.1
"""Eye over width of a bar from which on the eye's rim stands clear of the bar's sides."""


@dataclass(frozen=True, kw_only=True)
class Solid:
    """A solid in the kernel: its tag, the faces of each named surface, and mm per scaled unit."""

    volume: int
    faces: dict[str, list[int]]
    unit: float
    body: Body
    """The body in scaled units."""


@contextmanager
def kernel() -> Iterator[Any]:
    """Yield gmsh, silent, on one thread and with fixed random numbers; finalise it afterwards."""
    import gmsh

    gmsh.initialize(argv=[""], readConfigFiles=False, interruptible=False)
    try:
        for option, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.RandomSeed": 1,
            "Geometry.OCCUnionUnify": 0,
            "Geometry.OCCBoundsUseStl": 0,
            "Geometry.OCCParallel": 0,
        }.items():
            gmsh.option.setNumber(option, value)
        yield gmsh
    finally:
        gmsh.finalize()


def mm_per_unit(body: Body) -> float:
    """Return the length in mm of the unit in which the body is built."""
    return min(section_width(body.part), section_height(body.part)) / SECTION_UNITS


def scaled(body: Body, unit: float) -> Body:
    """Return the body with lengths in multiples of ``unit``, rounded so that its real size leaves no trace."""

    def s(length: float) -> float:
        return round(length / unit, 9)

    part = body.part
    lengths = {name: s(value) for name, value in part.model_dump().items() if name not in {"shape", "material"}}
    return Body(
        part=part.model_copy(update=lengths),
        pins=tuple(
            replace(
                p,
                x=s(p.x),
                y=s(p.y),
                diameter=s(p.diameter),
                slot=s(p.slot),
                clearance=s(p.clearance),
                foot=None if p.foot is None else (s(p.foot[0]), s(p.foot[1])),
            )
            for p in body.pins
        ),
        ends=tuple(PlainEnd(name=e.name, x=s(e.x), patch=s(e.patch)) for e in body.ends),
        holes=tuple(
            HoleRow.model_construct(
                count=r.count, diameter=s(r.diameter), first=s(r.first), last=s(r.last), along=r.along
            )
            for r in body.holes
        ),
    )


def build(gmsh: Any, body: Body) -> Solid:
    """Build the body in a fresh model of the kernel and name its faces.

    Raises ``CaseError`` where the fillets do not fit, ``CannotRunError`` where the kernel fails otherwise.
    """
    unit = mm_per_unit(body)
    small = scaled(body, unit)
    gmsh.model.add("body")
    if isinstance(small.part, Disc):
        height = small.part.thickness
        solid = (3, gmsh.model.occ.addCylinder(0, 0, -height / 2.0, 0, 0, height, small.part.diameter / 2.0))
    else:
        solid = _tube(gmsh, small, body) if isinstance(small.part, Tube) else _bar(gmsh, small, body)
    solid = _cut(gmsh, solid, _pin_holes(gmsh, small) + _hole_rows(gmsh, small))
    solid = _imprint(gmsh, small, solid)
    gmsh.model.occ.synchronize()
    if len(gmsh.model.getEntities(3)) != 1:
        raise CannotRunError(f"the part came out as {len(gmsh.model.getEntities(3))} solids instead of one")
    return Solid(volume=solid[1], faces=_named_faces(gmsh, small), unit=unit, body=small)


def _stations(body: Body) -> list[float]:
    """Return the x at which the outer surface is split: its ends and the borders of loaded patches."""
    stations = set(extent(body))
    for end in body.ends:
        stations.update(patch_span(body, end))
    return sorted(stations)


def _eyes(gmsh: Any, body: Body) -> list[Entity]:
    part, found = body.part, []
    for pin in body.pins:
        plain = plain_eye(body, pin)
        if not plain or pin.foot is not None or {*pin.span} & {*extent(body)}:  # else within the bar
            found += _upright(gmsh, pin, section_width(part) if plain else part.eye_diameter, part.eye_thickness)
    return found


def _upright(gmsh: Any, pin: Pin, diameter: float, height: float) -> list[Entity]:
    """Return a cylinder along the pin about the mid-plane; about a slot, the pieces of one drawn out along x."""
    occ, low = gmsh.model.occ, -height / 2.0
    pieces = [(3, occ.addCylinder(x, pin.y, low, 0, 0, height, diameter / 2.0)) for x in sorted(set(pin.span))]
    if pin.slot > 0.0:
        pieces.append((3, occ.addBox(pin.span[0], pin.y - diameter / 2.0, low, pin.slot, diameter, height)))
    return pieces


def _from_pin(pin: Pin, x: NDArray[np.float64] | float, y: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Return the distance of places from a pin's axis, or from a slot's centre line."""
    along = np.maximum(np.abs(np.asarray(x) - pin.x) - pin.slot / 2.0, 0.0)
    return np.asarray(np.hypot(along, np.asarray(y) - pin.y))


def _tube(gmsh: Any, body: Body, named: Body) -> Entity:
    occ, part = gmsh.model.occ, body.part
    assert isinstance(part, Tube)
    stations = _stations(body)
    pieces = [
        (3, occ.addCylinder(low, 0, 0, high - low, 0, 0, part.outer_diameter / 2.0))
        for low, high in itertools.pairwise(stations)
    ]
    solid = _fuse(gmsh, pieces + _eyes(gmsh, body))
    radius = part.outer_diameter / 2.0

    def at_eye(p: NDArray[np.float64]) -> bool:
        return abs(math.hypot(p[1], p[2]) - radius) < ON_SURFACE and _on_an_eye(body, p)

    solid = _fillet(gmsh, solid, _curves(gmsh, at_eye), part.fillet_radius, named)
    return _cut(gmsh, solid, _hollows(gmsh, body))


def _on_an_eye(body: Body, p: NDArray[np.float64]) -> bool:
    radius = body.part.eye_diameter / 2.0
    raised = [pin for pin in body.pins if not plain_eye(body, pin)]
    return any(abs(_from_pin(pin, p[0], p[1]) - radius) < ON_SURFACE for pin in raised)


def hollow_spans(body: Body) -> list[tuple[float, float]]:
    """Return the x between which a tube is hollow: up to each eye's nearest generator, and open at a plain end.

    The bottom of the bore touches the eye's cylinder and is flat but for a fillet at its rim, of
    ``hollow_fillet``: a bore that ran on to the cylinder would leave a re-entrant edge.
    """
    part = body.part
    assert isinstance(part, Tube)
    bore, radius = part.inner_diameter / 2.0, part.eye_diameter / 2.0
    first, last = extent(body)
    spans: list[tuple[float, float]] = []
    start = first
    for pin in sorted(body.pins, key=lambda p: p.x):
        half = math.sqrt(max(radius**2 - max(abs(pin.y) - bore, 0.0) ** 2, 0.0))
        spans.append((start, pin.x - half))
        start = max(start, pin.x + half)
    spans.append((start, last))
    return [(low, high) for low, high in spans if high - low > 2.0 * hollow_fillet(part) and bore > 0.0]


def hollow_fillet(part: Tube) -> float:
    """Return the fillet radius at the bottom of a tube's bore: the part's, but at most half the bore's radius."""
    return min(part.fillet_radius, part.inner_diameter / 4.0)


def _hollows(gmsh: Any, body: Body) -> list[Entity]:
    occ, part = gmsh.model.occ, body.part
    assert isinstance(part, Tube)
    first, last = extent(body)
    hollows: list[Entity] = []
    for low, high in hollow_spans(body):
        tag = occ.addCylinder(low, 0, 0, high - low, 0, 0, part.inner_diameter / 2.0)
        occ.synchronize()
        rims = [
            curve
            for _, curve in gmsh.model.getBoundary(
                gmsh.model.getBoundary([(3, tag)], oriented=False), combined=False, oriented=False
            )
            for x in (_point_on_curve(gmsh, curve, 0.3)[0],)
            if gmsh.model.getType(1, curve) == "Circle"
            and (abs(x - low) < ON_SURFACE < low - first or abs(x - high) < ON_SURFACE < last - high)
        ]
        if rims and part.fillet_radius > 0.0:
            [(_, tag)] = occ.fillet([tag], sorted(set(rims)), [hollow_fillet(part)])
        hollows.append((3, tag))
    return hollows


def _bar(gmsh: Any, body: Body, named: Body) -> Entity:
    occ, part = gmsh.model.occ, body.part
    assert isinstance(part, Bar)
    first, last = extent(body)
    # Where each straight piece starts, its direction and its length: the bar itself, and its arms.
    pieces = [((first, 0.0), 0.0, last - first)]
    for pin in body.pins:
        if pin.foot is not None:
            along = pin.x - pin.foot[0], pin.y - pin.foot[1]
            pieces.append((pin.foot, math.atan2(along[1], along[0]), math.hypot(*along)))
    boxes: list[Entity] = []
    for (x, y), angle, length in pieces:
        boxes.append(
            (3, occ.addBox(x, y - part.width / 2.0, -part.thickness / 2.0, length, part.width, part.thickness))
        )
        occ.rotate(boxes[-1:], x, y, 0, 0, 0, 1, angle)
    # Eye and bar of one thickness must share one flat face while the corners between them are filleted.
    gmsh.option.setNumber("Geometry.OCCUnionUnify", 1)
    solid = _fuse(gmsh, [*boxes, *_eyes(gmsh, body)])
    gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)

    def on_piece(p: NDArray[np.float64], start: tuple[float, float], angle: float, length: float) -> tuple[bool, bool]:
        """Whether a point lies on a side of a straight piece, and on its top or bottom."""
        x, y = p[0] - start[0], p[1] - start[1]
        u, v = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
        within = -ON_SURFACE < u < length + ON_SURFACE
        on_side = abs(abs(v) - part.width / 2.0) < ON_SURFACE and abs(p[2]) < part.thickness / 2.0 + ON_SURFACE
        on_top = abs(abs(p[2]) - part.thickness / 2.0) < ON_SURFACE and abs(v) < part.width / 2.0 + ON_SURFACE
        return within and on_side, within and on_top

    def to_fillet(p: NDArray[np.float64]) -> bool:
        """Whether a point lies where a piece meets an eye, or an arm's side the bar's."""
        found = [on_piece(p, *piece) for piece in pieces]
        sides = sum(on_side for on_side, _ in found)
        at_eye = sides > 0 or (part.has_step and any(on_top for _, on_top in found))
        return sides > 1 or (at_eye and _on_an_eye(body, p))

    return _fillet(gmsh, solid, _curves(gmsh, to_fillet), part.fillet_radius, named)


def _imprint(gmsh: Any, body: Body, solid: Entity) -> Entity:
    """Split the faces of a bar or disc along the borders of the surfaces that carry names.

    These are the discs of the eyes where they lie flush with the bar, and the loaded patches.
    """
    occ, part = gmsh.model.occ, body.part
    if isinstance(part, Tube):
        return solid
    discs: list[Entity] = []
    width = section_width(part)
    if part.eye_thickness - part.thickness < ON_SURFACE:
        for side in (-0.5, 0.5):
            discs += [_flat_eye(gmsh, p, _ring(part, p), side * part.thickness) for p in body.pins]
    for end in body.ends:
        low, high = patch_span(body, end)
        for side in (-0.5, 0.5):
            flat = occ.addRectangle(low, -width / 2.0, side * part.thickness, high - low, width)
            upright = occ.addRectangle(low, -part.thickness / 2.0, side * width, high - low, part.thickness)
            occ.rotate([(2, upright)], 0, 0, 0, 1, 0, 0, math.pi / 2.0)
            discs += [(2, flat), (2, upright)]
    if not discs:
        return solid
    pieces, _ = occ.fragment([solid], discs)
    occ.synchronize()
    # What lay over a hole belongs to no solid.
    occ.remove([p for p in pieces if p[0] == 2 and not gmsh.model.getAdjacencies(*p)[0].size], recursive=True)
    return _only([p for p in pieces if p[0] == 3])


def _ring(part: Bar | Disc, pin: Pin) -> float:
    """Return the diameter of the flat face about a hole on which a torque or a thrust enters.

    That of the eye; where the bar's sides pass close to the eye's rim, three quarters of the wall: circle and sides
    would leave cusps between them that no mesh fills.
    """
    if isinstance(part, Bar) and part.eye_diameter < CLEAR_EYE * part.width:
        return pin.diameter + 0.75 * (min(part.eye_diameter, part.width) - pin.diameter)
    return part.eye_diameter


def _flat_eye(gmsh: Any, pin: Pin, diameter: float, z: float) -> Entity:
    """Return the outline of an eye as a face at a height."""
    occ, radius = gmsh.model.occ, diameter / 2.0
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


def _pin_holes(gmsh: Any, body: Body) -> list[Entity]:
    return [e for p in body.pins for e in _upright(gmsh, p, p.diameter, 2.0 * body.part.eye_thickness)]


def _hole_rows(gmsh: Any, body: Body) -> list[Entity]:
    reach = 2.0 * max(section_width(body.part), section_height(body.part))
    holes: list[Entity] = []
    for row in body.holes:
        dy, dz = (1, 0) if row.along == "y" else (0, 1)
        for x in row.positions:
            tag = gmsh.model.occ.addCylinder(
                x, -reach * dy, -reach * dz, 0, 2.0 * reach * dy, 2.0 * reach * dz, row.diameter / 2.0
            )
            holes.append((3, tag))
    return holes


def _fuse(gmsh: Any, pieces: list[Entity]) -> Entity:
    if len(pieces) == 1:
        return pieces[0]
    solids, _ = gmsh.model.occ.fuse(pieces[:1], pieces[1:])
    return _only(solids)


def _cut(gmsh: Any, solid: Entity, tools: list[Entity]) -> Entity:
    if not tools:
        return solid
    solids, _ = gmsh.model.occ.cut([solid], tools)
    return _only(solids)


def _only(solids: list[Entity]) -> Entity:
    if len(solids) != 1:
        raise CannotRunError(f"the part came out as {len(solids)} solids instead of one")
    return solids[0]


def _fillet(gmsh: Any, solid: Entity, curves: list[int], radius: float, named: Body) -> Entity:
    if radius == 0.0 or all(plain_eye(named, pin) and pin.foot is None for pin in named.pins):
        return solid
    part = named.part
    assert not isinstance(part, Disc)
    try:
        solids = gmsh.model.occ.fillet([solid[1]], curves, [radius])
    except Exception as error:
        raise CaseError(
            f"fillet_radius {part.fillet_radius:g} mm does not fit where the {part.shape} meets its eyes of "
            f"{part.eye_diameter:g} mm by {part.eye_thickness:g} mm; "
            "make the fillet smaller, the eyes thicker or wider, or the distance between pins longer"
            + (", or turn an arm further from bar and arms beside it" if any(p.foot for p in named.pins) else "")
        ) from error
    return _only(solids)


def _curves(gmsh: Any, holds: Callable[[NDArray[np.float64]], bool]) -> list[int]:
    """Return the curves of the model on which a condition holds at several points."""
    gmsh.model.occ.synchronize()
    return [
        tag
        for _, tag in gmsh.model.getEntities(1)
        if all(holds(_point_on_curve(gmsh, tag, at)) for at in (0.13, 0.5, 0.77))
    ]


def _point_on_curve(gmsh: Any, tag: int, at: float) -> NDArray[np.float64]:
    low, high = gmsh.model.getParametrizationBounds(1, tag)
    return np.asarray(gmsh.model.getValue(1, tag, [low[0] + at * (high[0] - low[0])]))


def _points_on_face(gmsh: Any, tag: int) -> NDArray[np.float64]:
    """Return points (n, 3) of the surface that carries a face (they may lie outside its borders)."""
    low, high = gmsh.model.getParametrizationBounds(2, tag)
    at = np.array([[a, b] for a in (0.1, 0.45, 0.8) for b in (0.2, 0.6, 0.9)])
    uv = np.asarray(low) + at * (np.asarray(high) - np.asarray(low))
    return np.asarray(gmsh.model.getValue(2, tag, uv.ravel())).reshape(-1, 3)


def _named_faces(gmsh: Any, body: Body) -> dict[str, list[int]]:
    part = body.part
    names = [f"{kind}:{pin.name}" for pin in body.pins for kind in ("bore", "top", "bottom")]
    faces: dict[str, list[int]] = {name: [] for name in names + [f"end:{end.name}" for end in body.ends]}
    for _, tag in gmsh.model.getEntities(2):
        points = _points_on_face(gmsh, tag)
        centre = np.asarray(gmsh.model.occ.getCenterOfMass(2, tag))
        flat = gmsh.model.getType(2, tag) == "Plane"
        for pin in sorted(body.pins, key=lambda p: float(_from_pin(p, centre[0], centre[1])))[:1]:
            # The middle of a large face with a hole may lie in an eye as well, but not its borders.
            box = gmsh.model.getBoundingBox(2, tag)
            corners = (max(_from_pin(pin, x, pin.y) for x in box[0::3]), max(abs(y - pin.y) for y in box[1::3]))
            off = max(_from_pin(pin, centre[0], centre[1]), *(corner - 1e-3 for corner in corners))
            for side, height in (("top", part.eye_thickness / 2.0), ("bottom", -part.eye_thickness / 2.0)):
                if flat and np.abs(points[:, 2] - height).max() < ON_SURFACE and off < part.eye_diameter / 2.0:
                    faces[f"{side}:{pin.name}"].append(tag)
        for pin in body.pins:
            distance = _from_pin(pin, points[:, 0], points[:, 1])
            if (pin.slot > 0.0 or not flat) and np.abs(distance - pin.diameter / 2.0).max() < ON_SURFACE:
                faces[f"bore:{pin.name}"].append(tag)
        for end in body.ends:
            low, high = patch_span(body, end)
            if low < centre[0] < high and _on_outside(part, points):
                faces[f"end:{end.name}"].append(tag)
    for name, tags in faces.items():
        if not tags:
            raise CannotRunError(f"the part came out without a face for surface '{name}'")
    return faces


def _on_outside(part: Part, points: NDArray[np.float64]) -> bool:
    """Whether a face belongs to the outer surface of the tube or to the four sides of the bar."""
    assert not isinstance(part, Disc)
    if isinstance(part, Tube):
        radius = np.hypot(points[:, 1], points[:, 2])
        return bool(np.abs(radius - part.outer_diameter / 2.0).max() < ON_SURFACE)
    offsets = ((points[:, 1], part.width / 2.0), (points[:, 2], part.thickness / 2.0))
    return any(bool(np.abs(np.abs(offset.mean()) - half) < ON_SURFACE > np.ptp(offset)) for offset, half in offsets)


def write_step(gmsh: Any, solid: Solid, path: Path) -> None:
    """Write the solid as STEP in mm.

    The solid passes through a file to be scaled as it is read: the kernel's own scaling of a solid
    (``occ.dilate``) redraws every face as a spline and moves a filleted one.
    """
    volume = gmsh.model.occ.getMass(3, solid.volume) * solid.unit**3
    unscaled = path.with_suffix(".brep")
    gmsh.write(str(unscaled))
    gmsh.model.add("scaled")
    gmsh.option.setNumber("Geometry.OCCScaling", solid.unit)
    [imported] = gmsh.model.occ.importShapes(str(unscaled))
    gmsh.model.occ.synchronize()
    unscaled.unlink()
    written = gmsh.model.occ.getMass(*imported)
    if abs(written - volume) > 1e-5 * volume:
        raise CannotRunError(f"the STEP file would hold {written:.6g} mm³, but the part has {volume:.6g} mm³")
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.write(str(path))


def volume_centroid_inertia(gmsh: Any, solid: Solid) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Return volume [mm³], centroid (3,) [mm] and inertia about it for unit density (3, 3) [mm⁵]."""
    occ = gmsh.model.occ
    inertia = np.asarray(occ.getMatrixOfInertia(3, solid.volume)).reshape(3, 3)
    return (
        occ.getMass(3, solid.volume) * solid.unit**3,
        np.asarray(occ.getCenterOfMass(3, solid.volume)) * solid.unit,
        inertia * solid.unit**5,
    )
