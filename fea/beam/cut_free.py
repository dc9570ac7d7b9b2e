"""Cutting a link free: all that acts on it, in its own frame, for the beam and for the solid."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam import loads as beam
from alula.fea.beam.cut_beam import changes
from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import extent, hand_section, mouth
from alula.geometry.bodies.seat import Seat, Side
from alula.geometry.joints.holes import Known
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.placement import Placement
from alula.geometry.parts.part import Body, Pin, PlainEnd
from alula.loads.records.applied import (
    BodyForce,
    FrictionLoad,
    LineLoad,
    Load,
    PointLoad,
    in_axes,
    rotated,
    shifted,
    turned,
)
from alula.loads.statics.statics import Equilibrium

Real = NDArray[np.float64]

ACROSS_SLOT = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 0.0])
"""Components of a wrench that a pin in a slot along x carries: the force across it, and the moment about x."""


def link_loads(
    name: str,
    link: str,
    body: Body,
    reactions: Equilibrium,
    loads: Sequence[Load],
    axes: Real | None = None,
) -> LinkLoads:
    """Return all that acts on a link in a load case: a balanced set, at one pose or at n.

    Forces at a pin are summed to one wrench. The drive torque stays apart, since it enters the part in its own way. On
    the ground its support acts at the point where it is held, with the wrench that balances all else.

    Parameters
    ----------
    name : str
        Of the load case.
    link : str
    body : Body
        The link's.
    reactions : Equilibrium
        Joint reactions and drive torque.
    loads : sequence of Load
        All else that acts on the links, at the same poses.
    axes : array (3, 3), optional
        Axes of the result, as columns in global ones; the link's own when left out.

    Returns
    -------
    LinkLoads
    """
    place = reactions.placement
    turn = (place.axes(link) if axes is None else axes).swapaxes(-1, -2)
    wrenches: dict[str, Real] = {}
    rubbed: dict[str, Real] = {}
    lines: list[LineLoad] = []
    inertia: BodyForce | None = None
    for point, wrench in reactions.on_link(link):
        wrenches[point] = wrenches.get(point, np.zeros(6)) + rotated(turn, wrench)
    for load in loads:
        if load.link != link:
            continue
        own = in_axes(load, "link", place) if axes is None else turned(in_axes(load, "global", place), turn)
        if isinstance(own, PointLoad):
            wrenches[own.point] = wrenches.get(own.point, np.zeros(6)) + own.wrench
            if isinstance(own, FrictionLoad) and place.linkage.joints[own.joint].kind.has_pin:
                rubbed[own.point] = rubbed.get(own.point, np.zeros(6)) + own.wrench
        elif isinstance(own, LineLoad):
            lines.append(own)
        else:
            inertia = own
    for point in _pressed(place, link):  # a shaft that is pressed in turns its bore by shear
        turned_by = wrenches.get(point, np.zeros(6)) * np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        rubbed[point] = rubbed.get(point, np.zeros(6)) + turned_by
    nothing = np.zeros((*place.shape, 6))
    drive, torque = reactions.drive, np.asarray(reactions.torque_on(link), dtype=float)[()]
    held_at = place.linkage.links[link].held_at
    if held_at is not None:
        wrenches[held_at] = nothing
    found = LinkLoads(
        name=name,
        link=link,
        pins=tuple(
            replace(
                _pin_load(
                    place, link, pin, wrenches.get(pin.name, nothing), rubbed.get(pin.name, nothing), axes is None
                ),
                seat=seat(place.linkage, link, body, pin) if axes is None else None,
            )
            for pin in body.pins
        ),
        couples=(
            (DriveCouple(pin=place.linkage.point_of(drive.joint, link), torque=torque),)
            if drive is not None and np.any(torque)
            else ()
        ),
        ends=tuple(_end_load(body, end, wrenches[end.name]) for end in body.ends if end.name in wrenches),
        lines=tuple(lines),
        inertia=inertia,
    )
    return found if held_at is None else _supported(found, held_at)


def _pressed(place: Placement, link: str) -> set[str]:
    """Points of a link at which a clamped joint holds it."""
    linkage = place.linkage
    return {linkage.point_of(name, link) for name in linkage.joints_of(link) if linkage.joints[name].clamped}


def _end_load(body: Body, end: PlainEnd, wrench: Real) -> EndLoad:
    """Return the load of an end from its wrench (..., 6) about the link's point; of a clamped end about its mouth."""
    point, at = np.array([end.x, end.y, 0.0]), np.array([mouth(body, end), end.y, 0.0])
    moved = shifted(wrench, point - at) if np.any(point != at) else wrench
    return EndLoad(name=end.name, point=at, wrench=moved, clamped=end.clamped and body.part.is_beam)


def _supported(loads: LinkLoads, held_at: str) -> LinkLoads:
    """Return the loads on the ground with the wrench of its support, at an end or in a bore where nothing else acts."""
    rest = -loads.resultant()
    pins = [replace(p, wrench=shifted(rest, -p.centre)) if p.name == held_at else p for p in loads.pins]
    ends = [replace(e, wrench=shifted(rest, -e.point)) if e.name == held_at else e for e in loads.ends]
    return replace(loads, pins=tuple(pins), ends=tuple(ends))


def _pin_load(place: Placement, link: str, pin: Pin, wrench: Real, rubbed: Real, own_axes: bool) -> PinLoad:
    """Return the load of a pin from its wrench (..., 6) about the link's point; in a slot, about the pin's place.

    In a slot and the link's axes, components that such a pin does not carry (``ACROSS_SLOT``) are those of friction.
    """
    centre = np.zeros((*place.shape, 3))
    centre[..., 0], centre[..., 1] = pin.x, pin.y
    if pin.slot == 0.0:
        return PinLoad(name=pin.name, centre=centre, diameter=pin.diameter, wrench=wrench, friction=rubbed[..., 5])
    centre[..., 0] = slot_place(place, link, pin)
    x, y = place.linkage.links[link].points[pin.name]
    about, by_friction = (shifted(each, np.array([x, y, 0.0]) - centre) for each in (wrench, rubbed))
    taken = about * ACROSS_SLOT + by_friction * (1.0 - ACROSS_SLOT) if own_axes else about
    return PinLoad(
        name=pin.name,
        centre=centre,
        diameter=pin.pin_diameter,
        wrench=taken,
        slotted=True,
        friction=by_friction[..., 0],
    )


def seat(linkage: Linkage, link: str, body: Body, pin: Pin) -> Seat | None:
    """Return how a pin sits in a link's hole.

    Parameters
    ----------
    linkage : Linkage
        With the moduli of links and pins.
    link : str
    body : Body
        The link's.
    pin : Pin
        Its hole.

    Returns
    -------
    Seat or None
        None for a slot, for a hole of several walls, and where the joint has no pin or several joints meet.
    """
    joints = linkage.joints_at(link, pin.name)
    if pin.slot or not joints or link not in linkage.moduli:
        return None
    joint, ring, own = linkage.joints[joints[0]], body.ring(pin), linkage.pin_holes(joints[0])[link]
    if joint.clamped or own.known is Known.NO_PIN or ring.gaps or joints[0] not in linkage.pin_moduli:
        return None
    loose = own.stated and own.known is not Known.PRESSED and len(joints) == 1 and math.isfinite(own.high)
    height = linkage.heights.get(link, 0.0)
    others = {other for name in joints for other in linkage.joints[name].links if other != link}
    rises = [linkage.heights.get(other, 0.0) - height for other in others]
    above, below = any(rise > 0.0 for rise in rises), any(rise < 0.0 for rise in rises)
    side: Side | None = (0 if below else 1) if above else (-1 if below else None)
    return Seat(
        young=linkage.moduli[link],
        pin_young=linkage.pin_moduli[joints[0]],
        diameter=pin.pin_diameter,
        length=ring.thickness,
        eye=ring.diameter,
        away=_away(body, pin),
        side=side,
        clearance=(own.low, own.high) if loose else None,
    )


def _away(body: Body, pin: Pin) -> Literal[-1, 0, 1]:
    """Return the direction along x in which a pin pulls an eye off its shank; 0 of an eye that does not end a link."""
    first, last = extent(body)
    if not body.part.is_beam or pin.foot is not None or first == last:
        return 0
    return 1 if pin.x == last else -1 if pin.x == first else 0


def slot_place(place: Placement, link: str, pin: Pin) -> Real:
    """Return where a pin stands in its slot.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    link : str
        The link with the slot.
    pin : Pin
        The slot.

    Returns
    -------
    array (...)
        x in the link's frame [mm].

    Raises
    ------
    CaseError
        Where it stands beyond an end of the slot.
    """
    linkage = place.linkage
    joint = linkage.joints_at(link, pin.name)[0]
    other = linkage.joints[joint].links[1]
    arm = place.position(other, linkage.point_of(joint, other)) - place.origin(link)
    return in_slot(pin, np.asarray((np.conj(place.direction(link)) * arm).real), link)


def in_slot(pin: Pin, x: Real, link: str) -> Real:
    """Return places in a slot; one beyond an end by rounding is moved to that end.

    Parameters
    ----------
    pin : Pin
        The slot.
    x : array (...)
        In the link's frame [mm].
    link : str
        The link with the slot.

    Returns
    -------
    array (...)
        x [mm].

    Raises
    ------
    CaseError
        Where a place lies beyond an end of the slot.
    """
    low, high = pin.span
    slack = 1e-6 * pin.slot
    if x.min() < low - slack or x.max() > high + slack:
        beyond = np.ravel(x)[np.argmax(np.abs(x - pin.x))]
        raise CaseError(
            f"links.{link}.slots.{pin.name}: its pin stands at x = {beyond:.6g} mm, but the slot runs from {low:g} to "
            f"{high:g} mm; lengthen the slot"
        )
    return np.asarray(np.clip(x, low, high))


def _on_beam(pin: PinLoad, foot: tuple[float, float] | None) -> beam.PointLoad:
    """Return the load of a pin on the beam; a pin on an arm loads it where the arm starts."""
    if foot is None:
        return beam.PointLoad(point=pin.place, wrench=pin.wrench)
    start = np.array([*foot, 0.0])
    return beam.PointLoad(point=start, wrench=shifted(pin.wrench, pin.place - start))


def _spread(body: Body, density: float) -> list[tuple[float, float, float]]:
    """Return the stretches of the part between its ends: start, end [mm] and mass per length [tonne/mm]."""
    first, last = extent(body)
    places = [first, *changes(body), last]
    if len(places) == 2:
        return [(first, last, hand_section(body).area * density)]
    return [(a, b, body.section_at((a + b) / 2.0).area * density) for a, b in itertools.pairwise(places)]


def _eyes(body: Body, density: float, spread: list[tuple[float, float, float]]) -> list[tuple[float, float]]:
    """Return, for each eye on the axis, its station [mm] and its mass less that of the tube or bar there [tonne]."""
    if not body.part.is_beam:
        return []
    found = []
    for pin in body.pins:
        if pin.y == 0.0:
            ring, radius = body.ring(pin), body.ring(pin).diameter / 2.0
            volume = (math.pi * radius**2 + ring.diameter * pin.slot) * ring.thickness
            volume -= (math.pi * pin.diameter**2 / 4.0 + pin.diameter * pin.slot) * ring.thickness
            reach = radius + pin.slot / 2.0
            low, high = pin.x - reach, pin.x + reach
            replaced = sum(p * max(min(high, b) - max(low, a), 0.0) for a, b, p in spread)
            found.append((pin.x, density * volume - replaced))
    return found


def beam_loads(loads: LinkLoads, body: Body, density: float) -> beam.BeamLoads:
    """Return the loads of a link on its axis, in one state or in n.

    A body force is spread along the tube or bar between the link's ends by its mass per length. The additional mass of
    an eye is a point load at its pin. Point loads at both ends stand for what holes and fillets change of the mass and
    of its centroid.

    Parameters
    ----------
    loads : LinkLoads
        At one pose, or in n states with pins at the same places.
    body : Body
        The link's.
    density : float
        Of its material [tonne/mm³].

    Returns
    -------
    beam.BeamLoads
    """
    feet = {pin.name: pin.foot for pin in body.pins}
    points = [_on_beam(pin, feet[pin.name]) for pin in loads.pins]
    places = {pin.name: pin.place for pin in loads.pins}
    for couple in loads.couples:
        wrench = np.asarray(couple.torque)[..., None] * np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        points.append(beam.PointLoad(point=places[couple.pin], wrench=wrench))
    points += [beam.PointLoad(point=end.point, wrench=end.wrench) for end in loads.ends]
    # What a clamp holds is part of the beam, though nothing is in it.
    held = [end.x for end in body.ends if mouth(body, end) != end.x]
    points += [beam.PointLoad(point=np.array([x, 0.0, 0.0]), wrench=np.zeros(6)) for x in held]
    lines = [
        beam.LineLoad(start=line.start, end=line.end, first=line.at_start, last=line.at_end) for line in loads.lines
    ]
    if loads.inertia is not None:
        force, mass = loads.inertia, loads.inertia.mass
        height = float(mass.centroid[1])  # y at which the body force is evaluated for the axis

        def per_mass(x: float) -> Real:
            return force.per_mass(np.array([x, height, 0.0]))

        first, last = extent(body)
        spread = _spread(body, density)
        lumps = _eyes(body, density, spread)
        excess = mass.mass - sum(p * (b - a) for a, b, p in spread) - sum(lump for _, lump in lumps)
        moment = mass.mass * mass.centroid[0] - sum(p * (b**2 - a**2) / 2.0 for a, b, p in spread)
        moment -= sum(x * lump for x, lump in lumps)
        at_last = (moment - excess * first) / (last - first)
        lumps += [(first, excess - at_last), (last, at_last)]
        for start, end, per_length in spread:
            ends = [per_length * per_mass(x) for x in (start, end)]
            lines.append(beam.LineLoad(start=start, end=end, first=ends[0], last=ends[1]))
        for x, lump in lumps:
            pull = lump * per_mass(x)
            wrench = np.concatenate([pull, np.zeros(pull.shape)], axis=-1)
            points.append(beam.PointLoad(point=np.array([x, 0.0, 0.0]), wrench=wrench))
        # The centroid's distance from the axis adds a moment, and so do the widths of eyes and tube by their inertia.
        off_axis = np.cross([0.0, height, 0.0], mass.mass * per_mass(mass.centroid[0]))
        on_line = sum(
            p * (b - a) * ((b - a) ** 2 / 12.0 + ((a + b) / 2.0 - mass.centroid[0]) ** 2) for a, b, p in spread
        )
        on_line += sum(lump * (x - mass.centroid[0]) ** 2 for x, lump in lumps)
        off_axis[..., 2] -= (mass.inertia - on_line) * force.angular_acceleration
        wrench = np.concatenate([np.zeros(off_axis.shape), off_axis], axis=-1)
        points.append(beam.PointLoad(point=np.array([first, 0.0, 0.0]), wrench=wrench))
    if not lines and len({float(point.point[0]) for point in points}) < 2:  # loaded at its only pin, or not at all
        stations = (np.array([x, 0.0, 0.0]) for x in extent(body))
        points += [beam.PointLoad(point=at, wrench=np.zeros(6)) for at in stations]
    return beam.BeamLoads(points=tuple(points), lines=tuple(lines))
