"""Cutting a link free: all that acts on it, in its own frame, for the beam and for the solid."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fea.beam import loads as beam
from fea.common.link_loads import BodyLoad, DriveCouple, EndLoad, LineLoad, LinkLoads, PinLoad
from geometry.base.errors import CaseError
from geometry.linkage.pose import Pose
from geometry.parts.body import extent, hand_section
from geometry.parts.part import Body, Pin
from loads.records import applied
from loads.states.actions import PartMass
from loads.statics.statics import Reactions

Real = NDArray[np.float64]


def link_axes(pose: Pose, link: str) -> Real:
    """Return the link's x, y, z in global axes, as columns (3, 3)."""
    axes = np.eye(3)
    axes[:2, :2] = pose.rotation(link)
    return axes


def link_loads(
    name: str,
    link: str,
    body: Body,
    reactions: Reactions,
    loads: Sequence[applied.Load],
    axes: Real | None = None,
) -> LinkLoads:
    """Everything that acts on a link in a load case called ``name``: a balanced set.

    Forces at a pin are taken together as one wrench of the pin; the drive torque stays apart,
    since it enters the part in a way of its own. ``axes`` (3, 3), as columns in global ones, are those in
    which all is given: the link's own in the pose when left out.
    """
    pose = reactions.pose
    turn = (link_axes(pose, link) if axes is None else axes).T

    def local(vector: Real) -> Real:
        return np.concatenate([turn @ part for part in vector.reshape(-1, 3)])

    wrenches: dict[str, Real] = {}
    for point, wrench in reactions.on_link(link):
        wrenches[point] = wrenches.get(point, np.zeros(6)) + local(wrench)
    lines: list[LineLoad] = []
    bodies: list[BodyLoad] = []
    for load in loads:
        if load.link != link:
            continue
        if isinstance(load, applied.PointLoad):
            wrenches[load.point] = wrenches.get(load.point, np.zeros(6)) + local(load.wrench)
        elif isinstance(load, applied.LineLoad):
            intensity = np.array([local(load.at_start), local(load.at_end)])
            lines.append(LineLoad(first=load.start, last=load.end, intensity=intensity))
        else:
            bodies.append(
                BodyLoad(
                    specific_force=local(load.acceleration),
                    about=np.array([*load.centroid, 0.0]),
                    angular_acceleration=load.angular_acceleration,
                    angular_speed=load.angular_speed,
                )
            )
    torque = reactions.torque_on(link)
    drive = reactions.drive
    return LinkLoads(
        name=name,
        pins=tuple(_pin_load(pose, link, pin, wrenches.get(pin.name, np.zeros(6))) for pin in body.pins),
        couples=(
            (DriveCouple(pin=pose.linkage.point_of(drive.joint, link), torque=torque),) if drive and torque else ()
        ),
        ends=tuple(
            EndLoad(name=end.name, point=np.array([end.x, 0.0, 0.0]), wrench=wrenches[end.name])
            for end in body.ends
            if end.name in wrenches
        ),
        bodies=tuple(bodies),
        lines=tuple(lines),
    )


def _pin_load(pose: Pose, link: str, pin: Pin, wrench: Real) -> PinLoad:
    """Return the load of a pin from its wrench (6,) about its point; in a slot, the wrench about where it stands."""
    if pin.slot == 0.0:
        return PinLoad(name=pin.name, centre=np.array([pin.x, pin.y, 0.0]), diameter=pin.diameter, wrench=wrench)
    centre = np.array([slot_place(pose, link, pin), pin.y, 0.0])
    point = np.array([*pose.linkage.links[link].points[pin.name], 0.0])
    moved = np.concatenate([wrench[:3], wrench[3:] - np.cross(centre - point, wrench[:3])])
    return PinLoad(name=pin.name, centre=centre, diameter=pin.pin_diameter, wrench=moved, slotted=True)


def slot_place(pose: Pose, link: str, pin: Pin) -> float:
    """Return the x at which a pin stands in its slot, in the link's frame [mm]; ``CaseError`` where it ends before."""
    linkage = pose.linkage
    joint = next(name for name in linkage.joints_of(link) if linkage.point_of(name, link) == pin.name)
    other = linkage.joints[joint].links[1]
    place = pose.rotation(link).T @ (pose.position(other, linkage.point_of(joint, other)) - pose.origins[link])
    return float(in_slot(pin, place[:1], link)[0])


def in_slot(pin: Pin, x: Real, link: str) -> Real:
    """Return places x (n,), held to the slot's ends within rounding; ``CaseError`` where one lies beyond them."""
    low, high = pin.span
    slack = 1e-6 * pin.slot
    if x.min() < low - slack or x.max() > high + slack:
        beyond = x[np.argmax(np.abs(x - pin.x))]
        raise CaseError(
            f"links.{link}.slots.{pin.name}: its pin stands at x = {beyond:.6g} mm, but the slot runs from {low:g} to "
            f"{high:g} mm; lengthen the slot"
        )
    return np.asarray(np.clip(x, low, high))


def _per_mass(load: BodyLoad, x: float) -> Real:
    """Force per mass (3,) of a body load at the station x of the axis, the centroid's height taken as the axis."""
    along = x - load.about[0]
    turning = np.array([load.angular_speed**2 * along, -load.angular_acceleration * along, 0.0])
    return np.asarray(load.specific_force + turning)


def _on_beam(pin: PinLoad, foot: tuple[float, float] | None) -> beam.PointLoad:
    """Return the load of a pin on the beam; that of a pin on an arm enters where the arm starts."""
    if foot is None:
        return beam.PointLoad(point=pin.centre, wrench=pin.wrench)
    start = np.array([*foot, 0.0])
    moment = pin.wrench[3:] + np.cross(pin.centre - start, pin.wrench[:3])
    return beam.PointLoad(point=start, wrench=np.concatenate([pin.wrench[:3], moment]))


def _eyes(body: Body, density: float, per_length: float) -> list[tuple[float, float]]:
    """What each eye on the axis weighs more than the tube or bar that it stands for: station [mm], mass [tonne]."""
    part = body.part
    if not part.is_beam:
        return []
    first, last = extent(body)
    radius, found = part.eye_diameter / 2.0, []
    for pin in body.pins:
        if pin.y == 0.0:
            volume = (math.pi * radius**2 + part.eye_diameter * pin.slot) * part.eye_thickness
            volume -= (math.pi * pin.diameter**2 / 4.0 + pin.diameter * pin.slot) * part.eye_thickness
            reach = radius + pin.slot / 2.0
            replaced = min(pin.x + reach, last) - max(pin.x - reach, first)
            found.append((pin.x, density * volume - per_length * replaced))
    return found


def beam_loads(loads: LinkLoads, body: Body, density: float, mass: PartMass | None) -> beam.BeamLoads:
    """The same loads on the link's axis.

    A body force is spread along the tube or bar between the link's ends by its mass per length
    (``density`` in tonne/mm³); what an eye adds stands as a point load at its pin, and what holes and
    fillets change of the mass, or of its centroid, as one at each end.
    """
    feet = {pin.name: pin.foot for pin in body.pins}
    points = [_on_beam(pin, feet[pin.name]) for pin in loads.pins]
    centres = {pin.name: pin.centre for pin in loads.pins}
    for couple in loads.couples:
        wrench = np.array([0.0, 0.0, 0.0, 0.0, 0.0, couple.torque])
        points.append(beam.PointLoad(point=centres[couple.pin], wrench=wrench))
    points += [beam.PointLoad(point=end.point, wrench=end.wrench) for end in loads.ends]
    lines = [
        beam.LineLoad(start=line.first, end=line.last, first=line.intensity[0], last=line.intensity[1])
        for line in loads.lines
    ]
    if loads.bodies and mass is not None:
        first, last = extent(body)
        per_length = hand_section(body).area * density
        lumps = _eyes(body, density, per_length)
        excess = mass.mass - per_length * (last - first) - sum(lump for _, lump in lumps)
        moment = mass.mass * mass.centroid[0] - per_length * (last**2 - first**2) / 2.0
        moment -= sum(x * lump for x, lump in lumps)
        at_last = (moment - excess * first) / (last - first)
        lumps += [(first, excess - at_last), (last, at_last)]
        for load in loads.bodies:
            ends = [_per_mass(load, x) for x in (first, last)]
            lines.append(beam.LineLoad(start=first, end=last, first=per_length * ends[0], last=per_length * ends[1]))
            for x, lump in lumps:
                wrench = np.concatenate([lump * _per_mass(load, x), np.zeros(3)])
                points.append(beam.PointLoad(point=np.array([x, 0.0, 0.0]), wrench=wrench))
            # The centroid's distance from the axis is felt as a moment, and so is the width of eyes and tube.
            off_axis = np.cross([0.0, mass.centroid[1], 0.0], mass.mass * load.specific_force)
            spread = per_length * (last - first) ** 3 / 12.0
            on_line = spread + per_length * (last - first) * ((first + last) / 2.0 - mass.centroid[0]) ** 2
            on_line += sum(lump * (x - mass.centroid[0]) ** 2 for x, lump in lumps)
            off_axis[2] -= (mass.inertia - on_line) * load.angular_acceleration
            points.append(
                beam.PointLoad(point=np.array([first, 0.0, 0.0]), wrench=np.concatenate([np.zeros(3), off_axis]))
            )
    return beam.BeamLoads(points=tuple(points), lines=tuple(lines))
