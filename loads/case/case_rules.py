"""What must fit together in a case: names, numbers of joints and drives, places of loads, limits of checks."""

import math
from typing import TYPE_CHECKING

import numpy as np

from geometry.base.errors import CaseError
from geometry.base.model import check_file_names
from geometry.parts.body_rules import check_body
from geometry.parts.part import Body
from loads.records.aero import check_air
from loads.records.carried import Carried, CarriedSpread
from loads.records.check_spec import (
    BearingCheck,
    DisplacementCheck,
    MotorCheck,
    PinCheck,
    SafetyFactorCheck,
    SustainedCheck,
)
from loads.records.conditions import Conditions
from loads.records.load_case import LoadCase, PointMoment
from loads.records.mass_rules import check_masses, check_weighed
from loads.statics.statics import Drive, check_drive

if TYPE_CHECKING:
    from loads.case.core import CoreCase, WaysToHold

MOST_RESULTS = 2_000
"""Load cases times links with a part: each pair is solved, drawn and told of."""
MOST_MOTION = 40_000_000
"""Entries of a motion's equilibrium equations, some 44 bytes each (measured: 100,000 poses of four moving links)."""


def check_rules(case: "CoreCase") -> None:
    """Check that all of a case fits together; raises ``CaseError``."""
    check_file_names("links", case.links)
    check_file_names("load_cases", case.load_cases)
    check_drive(case.linkage, case.pinned_drive)
    if case.linkage.mobility > 0 and case.drive is None and case.joint_model == "pinned":
        raise CaseError(
            f"drive: the linkage has mobility {case.linkage.mobility}, but nothing drives it; "
            "add a [drive] with its link and joint"
        )
    drives = 1 if case.drive else 0
    fits = case.linkage.mobility == drives or (case.linkage.mobility < drives and case.moves)
    if not fits and case.joint_model == "pinned":
        raise CaseError(
            f"drive: the linkage has mobility {case.linkage.mobility} (Gruebler) but {1 if case.drive else 0} "
            "drive; they must be equal, so add or remove joints or links"
        )
    _check_pose(case)
    for name, part in case.parts.items():
        if part.material not in case.all_materials:
            raise CaseError(
                f"parts.{name}.material: '{part.material}' is unknown; choose one of "
                f"{', '.join(case.all_materials)} or add a card under [materials]"
            )
    for name, joint in case.joints.items():
        if joint.pin_material not in case.all_materials:
            raise CaseError(
                f"joints.{name}.pin_material: '{joint.pin_material}' is unknown; choose one of "
                f"{', '.join(case.all_materials)} or add a card under [materials]"
            )
    for name, link in case.links.items():
        if link.part is not None and link.part not in case.parts:
            raise CaseError(
                f"links.{name}.part: '{link.part}' is unknown; the parts are {', '.join(case.parts) or 'none'}"
            )
        if link.part is not None:
            _check_body(f"links.{name}", case.body(name))
        elif link.slots or link.arms:
            raise CaseError(f"links.{name}: it has slots or arms, but no part that they shape; name its part")
    for i, mass in enumerate(case.carried):
        _check_carried(case, f"carried.{i}", mass)
    for name, load_case in case.load_cases.items():
        _check_loads(case, f"load_cases.{name}", load_case)
    _check_masses(case)
    for name, check in case.checks.items():
        if isinstance(check, PinCheck | BearingCheck):
            _check_pins(case, name, check)
            continue
        if isinstance(check, MotorCheck):
            _check_motor(case, name)
            continue
        if isinstance(check, DisplacementCheck) and (check.at, check.link) != (None, None):
            _check_displaced(case, name, check)
            continue
        if isinstance(check, SustainedCheck) and case.conditions.duration is None:
            raise CaseError(
                f"checks.{name}: a sustained load needs to be known for how long; "
                'add [conditions] with its duration, for example "10 year"'
            )
        for checked in check.links:
            if checked not in case.checked_links:
                raise CaseError(
                    f"checks.{name}.links: '{checked}' is no moving link with a part; "
                    f"choose among {', '.join(case.checked_links) or 'none'}"
                )
        for checked in check.links or case.checked_links:
            stated = not isinstance(check, SafetyFactorCheck) or check.minimum is not None
            if not stated and case.material_of(checked).minimum_safety_factor is None:
                raise CaseError(
                    f"checks.{name}.minimum: it is missing, and '{case.part_of(checked).material}', the material "
                    f"of link '{checked}', states no minimum_safety_factor; add one of the two"
                )
    if case.conditions != Conditions():
        for checked in case.checked_links:
            case.material_of(checked)
    if case.ways_to_hold is not None:
        check_point(case, "ways_to_hold", case.ways_to_hold.link, case.ways_to_hold.at)
        _check_published(case, case.ways_to_hold)
    _check_size(case)
    for name, hand in case.hand_calculations.items():
        if hand.part not in case.parts:
            raise CaseError(
                f"hand_calculations.{name}.part: '{hand.part}' is unknown; the parts are {', '.join(case.parts)}"
            )
    if case.motion is not None:
        _check_motion(case)


def _check_size(case: "CoreCase") -> None:
    results = len(case.load_cases) * len(case.checked_links)
    if results > MOST_RESULTS:
        raise CaseError(
            f"load_cases: {len(case.load_cases)} load cases of {len(case.checked_links)} links with a part are "
            f"{results:,} results, but at most {MOST_RESULTS:,} are computed; spread the load cases over several cases"
        )
    if case.motion is None:
        return
    unknowns = 3 * len(case.linkage.moving)
    each = unknowns * (unknowns + len(case.load_cases))
    if case.motion.poses * each > MOST_MOTION:
        raise CaseError(
            f"motion.poses: {case.motion.poses:,} poses of {len(case.linkage.moving)} moving links under "
            f"{len(case.load_cases)} load cases need about {44e-9 * case.motion.poses * each:.2g} GB of memory; "
            f"ask for at most {MOST_MOTION // each:,} poses"
        )


def _check_pose(case: "CoreCase") -> None:
    moving, slides = case.linkage.moving, case.pose.travel is not None
    for entry, names in (("pose.coordinate", [case.pose.coordinate]), ("pose.near", [*case.pose.near])):
        for name in names:
            if entry == "pose.coordinate" and slides:
                _check_slides(case, entry, "pose.travel", name)
            elif name is not None and name not in moving:
                raise CaseError(f"{entry}: '{name}' is not a moving link; choose among {', '.join(moving)}")
    if slides and "angle" in case.pose.model_fields_set:
        raise CaseError("pose.angle: a travel fixes the pose already; leave one of the two out")
    if case.linkage.mobility == 1 and case.pose.coordinate is None:
        raise CaseError("pose.coordinate: the linkage can move, but no link fixes its pose; name one and its angle")
    if case.drive is None and case.linkage.mobility == 0 and case.pose.coordinate is not None:
        raise CaseError(
            f"pose.coordinate: it is '{case.pose.coordinate}', but the linkage cannot move (mobility 0); remove it"
        )


def _check_slides(case: "CoreCase", entry: str, stated: str, name: str | None) -> None:
    slots = [joint for joint, record in case.joints.items() if record.type != "revolute"]
    if name not in slots:
        raise CaseError(
            f"{entry}: {stated} is the travel of a slider or slot, but '{name}' is none; "
            f"choose among {', '.join(slots) or 'none'}"
        )


def _check_motion(case: "CoreCase") -> None:
    spec, name = case.motion, case.motion_coordinate
    assert spec is not None
    if spec.travel is not None:
        _check_slides(case, "motion.coordinate", "motion.travel", name)
    elif spec.coordinate is None and case.pose.travel is not None:
        raise CaseError(
            f"motion: the pose's coordinate '{name}' is a slider, so the motion needs its travel, for example "
            'travel = ["0 mm", "10 mm"], or a coordinate of its own'
        )
    elif name not in case.linkage.moving:
        raise CaseError(f"motion: '{name}' is not a moving link; choose among {', '.join(case.linkage.moving)}")


def _check_body(entry: str, body: Body) -> None:
    try:
        check_body(body)
    except CaseError as error:
        raise CaseError(f"{entry}: {error}") from None


def _check_loads(case: "CoreCase", where: str, load_case: LoadCase) -> None:
    for kind in ("forces", "moments", "spread"):
        for i, load in enumerate(getattr(load_case, kind)):
            entry = f"{where}.{kind}.{i}"
            if load.link not in case.links:
                raise CaseError(f"{entry}.link: '{load.link}' does not exist; the links are {', '.join(case.links)}")
            _check_moves(case, entry, load.link)
            points = case.links[load.link].points
            for point in (load.start, load.end) if kind == "spread" else (load.at,):
                if point not in points:
                    raise CaseError(
                        f"{entry}: link '{load.link}' has no point '{point}'; its points are {', '.join(points)}"
                    )
            if kind != "spread":
                _check_no_slot(case, entry, load.link, load.at)
            if kind == "spread" and np.isclose(points[load.start][0], points[load.end][0]):
                raise CaseError(f"{entry}: start and end lie at the same station; name two different points")
            if kind == "moments" and load.moment[2] != 0.0:
                _check_torque(case, entry, load)
    for i, air in enumerate(load_case.air):
        check_air(air, f"{where}.air.{i}", case.link_points)
        for patch in air.spread:
            _check_moves(case, f"{where}.air.{i}.spread", patch.link)
            if patch.at is not None:
                _check_no_slot(case, f"{where}.air.{i}", patch.link, patch.at)
    if load_case.speed != 0.0 and case.pose.coordinate is None:
        raise CaseError(f"{where}.speed: the linkage cannot move, so it has no speed; remove it")
    if load_case.speed != 0.0 and case.pose.travel is not None:
        raise CaseError(
            f"{where}.speed: it is the angular speed of the pose's coordinate, but '{case.pose.coordinate}' is a "
            "slider; leave it out and state motion.travel_speed"
        )


def _check_moves(case: "CoreCase", entry: str, link: str) -> None:
    if link == case.linkage.ground:
        raise CaseError(
            f"{entry}.link: '{link}' is the ground, where a load does nothing; name a moving link: "
            f"{', '.join(case.linkage.moving)}"
        )


def _check_torque(case: "CoreCase", entry: str, load: PointMoment) -> None:
    """A pin that turns freely passes no torque about its own axis; only the drive's does."""
    linkage = case.linkage
    pins = [name for name in linkage.joints_of(load.link)
            if linkage.point_of(name, load.link) == load.at and linkage.joints[name].type == "revolute"]  # fmt: skip
    driven = case.drive is not None and case.drive.joint in pins
    if pins and not driven and case.joint_model == "pinned":
        raise CaseError(
            f"{entry}: the pin at '{load.at}' turns freely and nothing drives it, so no torque about z enters link "
            f"'{load.link}' there; name a point of the link without pin, drive that joint, or write "
            'joint_model = "bonded"'
        )


def _check_masses(case: "CoreCase") -> None:
    known = {
        "moving": case.linkage.moving,
        "with_part": case.checked_links,
        "carrying": [mass.link for mass in case.carried],
        "massless": case.massless,
    }
    check_masses(**known)
    for name, load_case in case.load_cases.items():
        if load_case.own_weight or load_case.speed != 0.0:
            check_weighed(f"load_cases.{name}.{'own_weight' if load_case.own_weight else 'speed'}", **known)
    if case.motion is not None and case.motion.inertia:
        check_weighed("motion.inertia", **known)


def _check_pins(case: "CoreCase", name: str, check: PinCheck | BearingCheck) -> None:
    bearing = isinstance(check, BearingCheck)
    known = case.bearing_joints if bearing else case.pinned_joints
    for joint in check.joints:
        if joint not in known:
            raise CaseError(
                f"checks.{name}.joints: '{joint}' is no revolute joint{' or slot' if bearing else ''} of a link with a "
                f"part; choose among {', '.join(known) or 'none'}"
            )
    if isinstance(check, BearingCheck):
        return
    for joint in check.joints or case.pinned_joints:
        if check.minimum is None and case.pin_material(joint).minimum_safety_factor is None:
            raise CaseError(
                f"checks.{name}.minimum: it is missing, and '{case.joints[joint].pin_material}', the material of the "
                f"pin at joint '{joint}', states no minimum_safety_factor; add one of the two"
            )


def check_point(case: "CoreCase", entry: str, link: str, point: str) -> None:
    """Raise ``CaseError`` where ``link`` does not move or has no such point."""
    if link not in case.linkage.moving:
        raise CaseError(f"{entry}.link: '{link}' is not a moving link; choose among {', '.join(case.linkage.moving)}")
    if point not in case.links[link].points:
        raise CaseError(
            f"{entry}: link '{link}' has no point '{point}'; its points are {', '.join(case.links[link].points)}"
        )


def _check_published(case: "CoreCase", asked: "WaysToHold") -> None:
    """A published displacement stands beside that of the loads that it was published for, and of no others."""
    known = ", ".join(case.load_cases)
    if asked.load_case is not None and asked.load_case not in case.load_cases:
        raise CaseError(f"ways_to_hold.load_case: '{asked.load_case}' does not exist; the load cases are {known}")
    if asked.published is not None and asked.load_case is None and len(case.load_cases) > 1:
        raise CaseError(f"ways_to_hold.load_case: it is missing; name the one that was published for, among {known}")


def _check_displaced(case: "CoreCase", name: str, check: DisplacementCheck) -> None:
    if check.at is None:
        raise CaseError(f"checks.{name}.link: it says whose point is meant, but none is named; add at, or use links")
    if check.links:
        raise CaseError(
            f"checks.{name}.at: it is about one point of the linkage, but links are about each by itself; remove one"
        )
    case.displaced_point(name, check)


def _check_motor(case: "CoreCase", name: str) -> None:
    if case.motion is None or case.drive is None:
        raise CaseError(f"checks.{name}: a motor needs a motion to drive; add [motion] and [drive]")
    if Drive(link=case.drive.link, joint=case.drive.joint).pushes(case.linkage):
        raise CaseError(f"checks.{name}: a motor turns, but the drive pushes slider '{case.drive.joint}'; remove one")
    if not any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        raise CaseError(
            f"checks.{name}: no load case states the speed at which the motor runs; "
            'add one, for example speed = "150 rpm"'
        )


def _check_carried(case: "CoreCase", entry: str, mass: Carried) -> None:
    if mass.link not in case.linkage.moving:
        raise CaseError(
            f"{entry}.link: '{mass.link}' is not a moving link; choose among {', '.join(case.linkage.moving)}"
        )
    points = case.links[mass.link].points
    named = (mass.start, mass.end) if isinstance(mass, CarriedSpread) else (mass.at,)
    for point in named:
        if point not in points:
            raise CaseError(f"{entry}: link '{mass.link}' has no point '{point}'; its points are {', '.join(points)}")
    if not isinstance(mass, CarriedSpread):
        _check_no_slot(case, entry, mass.link, mass.at)
    if isinstance(mass, CarriedSpread) and np.isclose(points[mass.start][0], points[mass.end][0]):
        raise CaseError(f"{entry}: start and end lie at the same station; name two different points")


def _check_no_slot(case: "CoreCase", entry: str, link: str, point: str) -> None:
    if point in case.links[link].slots:
        raise CaseError(
            f"{entry}: point '{point}' of link '{link}' is a slot, where the pin alone can push; name another point"
        )


def check_slots(case: "CoreCase", link: str) -> None:
    """Check that a link's slots and arms are where pins are, and that every pin that slides in it has a slot."""
    record, linkage = case.links[link], case.linkage
    sliding = {linkage.point_of(name, link): name for name in linkage.joints_of(link)
               if linkage.joints[name].type == "pin-in-slot" and linkage.joints[name].links[0] == link}  # fmt: skip
    for point in record.slots:
        joints = [name for name in linkage.joints_of(link) if linkage.point_of(name, link) == point]
        if point not in sliding or len(joints) != 1:
            raise CaseError(
                f"links.{link}.slots.{point}: a slot belongs to a point with one joint, a pin in slot with "
                f"'{link}' first, but this point has {', '.join(joints) or 'none'}; name another point"
            )
        if case.drive is not None and case.drive.joint in joints:
            raise CaseError(
                f"links.{link}.slots.{point}: its joint '{joints[0]}' is driven, but no torque enters a part at a "
                "slot; drive the linkage at another joint"
            )
        if abs(math.sin(linkage.joints[joints[0]].direction)) > 1e-9:
            raise CaseError(
                f"links.{link}.slots.{point}: a part's slot runs along its link's axis, but joint '{joints[0]}' slides "
                f"in another direction, {math.degrees(linkage.joints[joints[0]].direction):g} deg; state 0 deg and "
                "turn the link's frame"
            )
    for point, name in sliding.items():
        if point not in record.slots:
            raise CaseError(
                f"links.{link}.slots: the pin of joint '{name}' slides in this link, whose part needs a slot for it; "
                f'add slots.{point} = {{ first = "...", last = "..." }}, how far the pin travels along x'
            )
    for point, foot in record.arms.items():
        if point not in record.points or foot not in record.points:
            raise CaseError(
                f"links.{link}.arms: an arm from '{foot}' to '{point}' needs two points of the link; "
                f"its points are {', '.join(record.points)}"
            )
        if not {point, foot} <= {linkage.point_of(name, link) for name in linkage.joints_of(link)}:
            raise CaseError(
                f"links.{link}.arms: an arm from '{foot}' to '{point}' needs a pin at both; make them joints"
            )
