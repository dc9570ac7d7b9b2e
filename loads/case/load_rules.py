"""What must fit together between a case's links and what acts on them: places of loads and masses, weight."""

from collections.abc import Iterator

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.loads.case.core import CoreCase
from alula.loads.records.aero import AirPatch, check_air
from alula.loads.records.attachment import Attachment
from alula.loads.records.carried import CarriedBody, CarriedSpread
from alula.loads.records.check_spec import FrequencyCheck
from alula.loads.records.flapping import WIDEST, Wing, check_flapping
from alula.loads.records.load_case import (
    FacePressure,
    LoadCase,
    LoadLine,
    PointForce,
    PointMoment,
    SpreadForce,
    force_size,
)
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.loads.text.places import check_moving, check_point
from alula.loads.text.reason import reason

_Load = PointForce | PointMoment | FacePressure | SpreadForce | LoadLine | Attachment | AirPatch
Place = _Load | CarriedBody | CarriedSpread | Wing


def check_loads(case: CoreCase, where: str, load_case: LoadCase) -> None:
    """Check where the loads of a load case act, and that its speed means something.

    Parameters
    ----------
    case : CoreCase
        The case.
    where : str
        Path of the load case in the case file, for messages.
    load_case : LoadCase
        The load case.

    Raises
    ------
    CaseError
        For the first load that does not fit.
    """
    for kind in ("forces", "moments", "spread"):
        for i, load in enumerate(getattr(load_case, kind)):
            check_place(case, f"{where}.{kind}.{i}", load)
            if kind == "moments" and load.moment[2] != 0.0:
                _check_torque(case, f"{where}.{kind}.{i}", load)
    for i, load in enumerate(load_case.pressures):
        entry = f"{where}.pressures.{i}"
        check_place(case, entry, load)
        if case.face(load.link, load.at) is None:
            raise CaseError(
                f"{entry}.at: a pressure acts on a named face, but point '{load.at}' of link '{load.link}' is none; "
                f'name the face in its part, faces.{load.at} = "face 1" (parts of shape "step")'
            )
    for i, line in enumerate(load_case.load_lines):
        entry = f"{where}.load_lines.{i}"
        for path, end in ((entry, line), (f"{entry}.leaves", line.leaves)):
            if end is not None:
                check_place(case, path, end)
                _check_torque(case, path, end)
    for i, air in enumerate(load_case.air):
        check_air(air, f"{where}.air.{i}")
        for j, patch in enumerate(air.spread):
            check_place(case, f"{where}.air.{i}.spread.{j}", patch)
    if load_case.flapping is not None:
        _check_flapping(case, where, load_case)
    if load_case.least is not None and case.conditions.cycles is None:
        raise CaseError(
            f"{where}.least: it says how cycles go, but none are stated; add cycles to [conditions] or leave least out"
        )
    if load_case.speed != 0.0 and case.pose.coordinate is None:
        raise CaseError(f"{where}.speed: the linkage cannot move, so it has no speed; remove it")
    if load_case.speed != 0.0 and case.pose.travel is not None:
        raise CaseError(
            f"{where}.speed: it is the angular speed of the pose's coordinate, but '{case.pose.coordinate}' is a "
            "slider; leave it out and state motion.travel_speed"
        )


def check_permanent_set(case: CoreCase, name: str) -> None:
    """Check that each load case states one force, along which a permanent set is.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.

    Raises
    ------
    CaseError
        For the first load case of which that is not so, and where no link has a part.
    """
    if not case.checked_links:
        raise CaseError(f"checks.{name}: no link has a part, so nothing stays bent; give a link a part")
    for load_case, stated in case.load_cases.items():
        if force_size(stated) == 0.0:
            raise CaseError(
                f"checks.{name}: a permanent set is along the line of one force, but load case '{load_case}' does not "
                "state one force, or one load line, and no other load; put what else acts in a case of its own"
            )


def _check_flapping(case: CoreCase, where: str, load_case: LoadCase) -> None:
    """Check that a load case with air has wings that move in it."""
    assert load_case.flapping is not None
    if not case.wings:
        raise CaseError(
            f"{where}.flapping: the case states no wings for the air to act on; add [[wings]] with link, chord, "
            "start and end"
        )
    moves = case.inert
    if load_case.speed == 0.0 and not moves:
        raise CaseError(
            f"{where}.flapping: the linkage stands still in this load case, so its wings do not flap; state "
            'its speed, for example speed = "180 rpm"'
        )
    check_flapping(load_case.flapping, f"{where}.flapping")


def check_wings(case: CoreCase) -> None:
    """Check where wings are held, and that they are wings.

    Parameters
    ----------
    case : CoreCase
        The case.

    Raises
    ------
    CaseError
        For the first that does not fit.
    """
    for i, wing in enumerate(case.wings):
        check_place(case, f"wings.{i}", wing)
        points = case.links[wing.link].points
        first, last = wing.span or (points[wing.start or ""][0], points[wing.end or ""][0])
        span, chord = abs(last - first), sum(wing.chord) / 2.0
        if chord > WIDEST * span:
            raise CaseError(
                f"wings.{i}.chord: on average it is {chord:.4g} mm, more than {WIDEST:g} times the wing's span of "
                f"{span:.4g} mm, and strips along the span describe no such plate; correct chord or span"
            )


def check_frequency(case: CoreCase, name: str, check: FrequencyCheck) -> None:
    """Check that there is something to vibrate, and a speed that drives it.

    Parameters
    ----------
    case : CoreCase
        The case.
    name : str
        Of the check.
    check : FrequencyCheck
        The check.

    Raises
    ------
    CaseError
        For a case without parts or without a speed.
    """
    if not case.checked_links:
        raise CaseError(f"checks.{name}: no moving link has a part, so nothing vibrates; give a link a part")
    if case.pose.travel is not None:
        raise CaseError(
            f"checks.{name}: the driving frequency is that of a link that turns, but the pose's coordinate "
            f"'{case.pose.coordinate}' is a slider; fix the pose by the angle of a link, or remove the check"
        )
    if not any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        raise CaseError(
            f"checks.{name}: no load case states the speed of the drive, so there is no driving frequency; "
            f'add one, for example load_cases.{next(iter(case.load_cases), "turning")}.speed = "150 rpm"'
        )


def check_place(case: CoreCase, entry: str, place: Place) -> None:
    """Check where a load or a mass acts: at a point of a moving link, or between two points along it.

    Parameters
    ----------
    case : CoreCase
        The case.
    entry : str
        Path of the load or mass in the case file, for messages.
    place : record with a link and a point, or two points
        The load or mass.

    Raises
    ------
    CaseError
        Where the link does not move or lacks a point, at a slot, and between points at one station.
    """
    at, start, end = (getattr(place, name, None) for name in ("at", "start", "end"))
    for point in (at, start, end):
        if point is not None:
            check_point(case.linkage, entry, place.link, point)
    if at in case.links[place.link].slots:
        raise CaseError(
            f"{entry}: point '{at}' of link '{place.link}' is a slot, where the pin alone can push; name another point"
        )
    if at in case.bare_feet(place.link):
        raise CaseError(
            f"{entry}: point '{at}' of link '{place.link}' is where an arm starts, and no load enters there; name "
            "another point"
        )
    points = case.links[place.link].points
    if start is not None and end is not None and np.isclose(points[start][0], points[end][0]):
        raise CaseError(f"{entry}: start and end lie at the same station; name two different points")


def _check_torque(case: CoreCase, entry: str, load: PointMoment | LoadLine | Attachment) -> None:
    """A pin that turns freely passes no torque about its own axis; only the drive's does."""
    linkage = case.linkage
    pins = [name for name in linkage.joints_at(load.link, load.at) if not linkage.joints[name].slides]
    driven = case.drive is not None and case.drive.joint in pins
    if pins and not driven and not any(linkage.joints[name].fixed for name in pins):
        raise CaseError(
            f"{entry}: the pin at '{load.at}' turns freely and nothing drives it, so no torque about z enters link "
            f"'{load.link}' there; name a point of the link without pin, drive that joint, or write "
            f"joints.{pins[0]}.bonded = true"
        )


def check_masses(case: CoreCase) -> None:
    """Check that where weight or inertia acts, the case says of every moving link where its mass comes from.

    Parameters
    ----------
    case : CoreCase
        The case.

    Raises
    ------
    CaseError
        For a link whose mass is unknown, and for a massless one that has a mass.
    """
    carrying = {mass.link for mass in case.carried}
    for link in case.massless:
        check_moving(case.linkage, "massless", link)
        if link in case.checked_links or link in carrying:
            what = "has a part" if link in case.checked_links else "carries a mass"
            raise CaseError(f"massless: link '{link}' {what}, so it weighs something; remove one of the two statements")
    for name, load_case in case.load_cases.items():
        if case.carried and load_case.carried and "own_weight" not in load_case.model_fields_set:
            raise CaseError(
                f"load_cases.{name}.own_weight: link '{case.carried[0].link}' carries a mass, and where down is the "
                "case does not say; write own_weight = true, with gravity_direction (-90 deg where left out), or "
                "own_weight = false"
            )
    asking = ["motion.speed"] if case.inert else []
    asking += [
        f"load_cases.{name}.{'own_weight' if load_case.own_weight else 'speed'}"
        for name, load_case in case.load_cases.items()
        if load_case.own_weight or load_case.speed != 0.0
    ]
    unknown = [link for link in case.linkage.moving if link not in {*case.checked_links, *carrying, *case.massless}]
    off = ", or motion.inertia = false" if case.inert and case.motion and case.motion.inertia is None else ""
    if asking and unknown:
        raise CaseError(
            f"{asking[0]}: link '{unknown[0]}' has neither a part nor a mass, so its weight is unknown; give it a "
            f'part, a mass under [[carried]], or state massless = ["{unknown[0]}"]{off}'
        )


def load_caveats(case: CoreCase) -> Iterator[Caveat]:
    """Yield what load cases leave out of a linkage that has it, and what is taken of where loads act.

    Parameters
    ----------
    case : CoreCase

    Yields
    ------
    Caveat
    """
    light = [name for name, one in case.load_cases.items() if case.carried and one.carried and not one.own_weight]
    if light:
        why = reason("no_own_weight", load_cases=light, first=light[0])
        yield Caveat(topic=Topic.WEIGHT, what=reason("weight_of_carried"), why=why)
    if case.carried and not any(one.carried for one in case.load_cases.values()):
        yield Caveat(topic=Topic.WEIGHT, what=reason("what_links_carry", links=()), why=reason("carried_is_false"))
    pinned = {(link, case.linkage.point_of(name, link)) for name, joint in case.joints.items() for link in joint.links}
    on_pins = dict.fromkeys(
        f"{force.at} of {force.link}"
        for load_case in case.load_cases.values()
        for force in load_case.forces
        if (force.link, force.at) in pinned
    )
    if on_pins:
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.LOADS,
            what=reason("forces_on_pins", places=tuple(on_pins)),
            why=reason("pin_bears_it"),
        )
    lines = [line for load_case in case.load_cases.values() for line in load_case.load_lines]
    ends = [end for line in lines for end in (line, line.leaves) if end is not None]
    places = tuple(dict.fromkeys(f"{end.at} of {end.link}" for end in ends))
    if places:
        yield Caveat(heading=Heading.ASSUMED, topic=Topic.LOADS, what=reason("rigid_levers", places=places))
        yield Caveat(topic=Topic.LOADS, what=reason("beyond_levers", places=places), why=reason("not_modelled"))
