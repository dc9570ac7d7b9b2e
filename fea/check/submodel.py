"""One eye or hole of a link as a solid of its own, cut where the section's stress is linear, loaded there by the beam.

By Saint-Venant's principle what is left of an eye's or hole's disturbance a diameter or two away is small (Timoshenko &
Goodier, Theory of Elasticity, 3rd ed., art. 18): the beam's N, V, M and T, spread over the last stretch of the
submodel, then stand for the rest of the link. Of weight and inertia the beam knows those of its section, with the rest
of eyes and holes as lumps at its ends; what the true mass of the piece leaves open the last cut balances.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.beam.resultant import resultant
from fea.beam.theory import BeamCheck
from fea.common.link_loads import EndLoad, LineLoad, LinkLoads
from fea.refine.refinement import LinkTask
from geometry.meshing.mesh import MassProperties, mass_properties
from geometry.parts.body_rules import extent, eye_reach, patch_span, section_width
from geometry.parts.part import Body, HoleRow, Pin, PlainEnd
from loads.records.applied import shifted

CLEAR = 1.5
"""Widths of plain section between an eye or hole and the loaded stretch at a cut."""
PATCH = 1.0
"""Length of that stretch, in widths."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Submodel:
    """The part of a link about one eye or hole.

    task     to be solved like a whole link
    name     for people: "the eye at B", "the hole at x = 20 mm"
    covered  stations [mm] between which its stress is that of the whole link
    """

    task: LinkTask
    name: str
    covered: tuple[float, float]

    @property
    def body(self) -> Body:
        """Its shape, in the link's frame."""
        return self.task.body


def eye_submodel(task: LinkTask, beams: Sequence[BeamCheck], pin: str, *, clear: float = CLEAR) -> Submodel | None:
    """Cut the eye at a pin out of a link; None where the link leaves no room for a cut.

    beams   of the task's load cases, in their order
    clear   widths between the eye and the loaded stretch of a cut
    """
    place = next(p for p in task.body.pins if p.name == pin)
    return _submodel(task, beams, f"the eye at {pin}", (place,), place.x, eye_reach(task.body, place), clear)


def hole_submodel(task: LinkTask, beams: Sequence[BeamCheck], x: float, *, clear: float = CLEAR) -> Submodel | None:
    """Cut the cross hole at a station out of a link, between two cuts; otherwise like ``eye_submodel``."""
    radius = max(row.diameter / 2.0 for row in task.body.holes if x in row.positions)
    return _submodel(task, beams, f"the hole at x = {x:g} mm", (), x, radius, clear)


def _submodel(
    task: LinkTask,
    beams: Sequence[BeamCheck],
    name: str,
    pins: tuple[Pin, ...],
    middle: float,
    reach: float,
    clear: float,
) -> Submodel | None:
    """Cut out what reaches that far from a station."""
    body = task.body
    before, after = (_cut(body, middle, reach, side, clear) for side in (-1, 1))
    if before is None or after is None:
        return None
    (first, cut_first), (last, cut_last) = before, after
    if not (cut_first or cut_last):
        return None
    patch, width = PATCH * section_width(body.part), section_width(body.part)
    cuts = [("cut before", first)] if cut_first else []
    cuts += [("cut after", last)] if cut_last else []
    ends = tuple(PlainEnd(name=name, x=x, patch=patch) for name, x in cuts)
    kept = tuple(end for end in body.ends if first <= end.x <= last)
    part = Body(part=body.part, pins=pins, ends=(*ends, *kept), holes=_rows(body, first, last))
    names = {end.name for end in kept}
    pinned = {pin.name for pin in pins}
    sides = [*(f"bore:{pin.name}" for pin in pins), *(f"end:{end.name}" for end in part.ends)]
    loads = tuple(
        LinkLoads(
            name=load.name,
            pins=tuple(p for p in load.pins if p.name in pinned),
            couples=tuple(c for c in load.couples if c.pin in pinned),
            ends=(*(e for e in load.ends if e.name in names), *_cut_loads(beam, cuts, first)),
            bodies=load.bodies,
            lines=tuple(_clipped(line, first, last) for line in load.lines if line.first < last and line.last > first),
        )
        for load, beam in zip(task.loads, beams, strict=True)
    )
    if any(load.bodies for load in loads):
        solid = mass_properties(part)
        loads = tuple(_balanced(load, solid, task.density, cuts[-1][0]) for load in loads)
    near = clear / 2.0 * width + patch
    return Submodel(
        task=replace(task, body=part, loads=loads, line=(sides[0], sides[1]), displacement_limits=()),
        name=name,
        covered=(first + near if cut_first else first, last - near if cut_last else last),
    )


def _balanced(loads: LinkLoads, solid: MassProperties, density: float, cut: str) -> LinkLoads:
    """Return the loads with what they lack of balance added at a cut."""
    rest = -resultant(loads, solid, density)
    ends = tuple(
        replace(end, wrench=end.wrench + shifted(rest, -end.point)) if end.name == cut else end for end in loads.ends
    )
    return replace(loads, ends=ends)


def _cut(body: Body, middle: float, reach: float, side: int, clear: float) -> tuple[float, bool] | None:
    """Return where the submodel ends on one side of its middle and whether by a cut; None where there is no room.

    A cut is moved on behind holes that come too near to its loaded stretch.
    """
    first, last = extent(body)
    border = last if side > 0 else first
    if middle == border:
        return border, False
    width = section_width(body.part)
    away, patch = clear * width, PATCH * width
    # Distances from the middle, outwards: (where it begins, where it ends).
    holes = [(side * (x - middle), row.diameter / 2.0) for row in body.holes for x in row.positions]
    features = sorted((at - radius, at + radius) for at, radius in holes if at > 0.0)
    eyes = [side * (p.x - middle) - eye_reach(body, p) for p in body.pins if side * (p.x - middle) > 0.0]
    spans = [patch_span(body, end) for end in body.ends if side * (end.x - middle) > 0.0]
    eyes += [min(side * (low - middle), side * (high - middle)) for low, high in spans]
    for low, high in features:
        if low >= reach + away + patch:
            break
        reach = max(reach, high)
    cut = reach + away + patch
    if cut >= min([*eyes, side * (border - middle)]):
        return None
    return middle + side * cut, True


def _rows(body: Body, first: float, last: float) -> tuple[HoleRow, ...]:
    """Holes between two stations, one row each."""
    return tuple(
        HoleRow.model_construct(count=1, diameter=row.diameter, first=x, last=x, along=row.along)
        for row in body.holes
        for x in row.positions
        if first < x < last
    )


def _cut_loads(beam: BeamCheck, cuts: Sequence[tuple[str, float]], first: float) -> list[EndLoad]:
    """What the rest of the link does at the cuts: the section's forces, reversed on the side before the pin."""
    found = []
    for name, x in cuts:
        if beam.forces.breaks[0] <= x <= beam.forces.breaks[-1]:
            wrench = beam.forces.at(x) * (-1.0 if x == first else 1.0)
            found.append(EndLoad(name=name, point=np.array([x, 0.0, 0.0]), wrench=wrench))
    return found


def _clipped(line: LineLoad, first: float, last: float) -> LineLoad:
    """Return the part of a spread load between two stations."""
    low, high = max(line.first, first), min(line.last, last)
    slope = (line.intensity[1] - line.intensity[0]) / (line.last - line.first)
    intensity = np.array([line.intensity[0] + slope * (x - line.first) for x in (low, high)])
    return LineLoad(first=low, last=high, intensity=intensity)
