"""What must fit together in a case: names, numbers of joints and drives, places of loads, limits of checks."""

import math

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import check_file_names
from alula.geometry.bodies.body_rules import check_body, check_length
from alula.geometry.linkage.coordinate import Measure
from alula.geometry.materials.directional import directional
from alula.geometry.materials.material import Material
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.part import Body, FilePart
from alula.geometry.parts.step import ImportedPart
from alula.geometry.parts.tube import Tube
from alula.loads.case.break_rules import check_break_check, check_eye_check
from alula.loads.case.connection_rules import check_connection, check_line_contact
from alula.loads.case.core import CoreCase
from alula.loads.case.forks import check_fork, check_pair
from alula.loads.case.heights import layer_of
from alula.loads.case.joint_rules import check_clamps, check_clearances, check_friction
from alula.loads.case.layers import check_layers, pin_masses
from alula.loads.case.load_rules import (
    check_frequency,
    check_loads,
    check_masses,
    check_permanent_set,
    check_place,
    check_wings,
)
from alula.loads.case.spring_rules import check_equilibrium, check_springs, check_stops
from alula.loads.case.toleranced import toleranced
from alula.loads.records.check_spec import (
    BearingCheck,
    Check,
    ClearanceCheck,
    ConnectionCheck,
    DisplacementCheck,
    EyeCheck,
    FatigueCheck,
    FrequencyCheck,
    LimitLoadCheck,
    LineContactCheck,
    MassCheck,
    MotorCheck,
    NotchCheck,
    PermanentSetCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    SustainedCheck,
    WallCheck,
)
from alula.loads.records.conditions import Conditions
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.records.settings import WaysToHold
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.statics import Drive, check_drive
from alula.loads.text.explain import require
from alula.loads.text.places import check_moving, check_point

MOST_RESULTS = 2_000
"""Load cases times links with a part: each pair is solved, drawn and told of."""
MOST_MOTION = 40_000_000
"""Entries of a motion's equilibrium equations, some 44 bytes each (measured: 100,000 poses of four moving links)."""


def check_rules(case: CoreCase) -> None:
    """Check that all of a case fits together.

    Parameters
    ----------
    case : CoreCase
        The case, whose records are valid each by itself.

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    check_file_names("links", case.links)
    check_file_names("level.tests", case.level.tests if case.level else ())
    check_file_names("load_cases", case.load_cases)
    check_layers(case)
    _check_drive(case)
    _check_pose(case)
    check_friction(case)
    for name, part in case.parts.items():
        _check_material(case, f"parts.{name}.material", part.material)
    for name, joint in case.joints.items():
        _check_material(case, f"joints.{name}.pin_material", joint.pin_material)
    check_clearances(case)
    check_clamps(case)
    for name, link in case.links.items():
        _check_held(case, name)
        if link.part is not None:
            require(f"links.{name}.part", link.part, case.parts, "is unknown")
            _check_slots(case, name)
            _check_eyes(case, name)
            _check_body(f"links.{name}", case.body(name), moves=not link.ground)
        elif link.slots or link.arms or link.eyes:
            raise CaseError(
                f"links.{name}.part: it is missing, but slots, arms and eyes are shapes of a part; name one"
            )
        check_pair(case, name)
    check_springs(case)
    check_stops(case)
    check_equilibrium(case)
    for name in case.joints:
        check_fork(case, name)
    for i, mass in enumerate(case.carried):
        check_place(case, f"carried.{i}", mass)
    check_wings(case)
    if case.level is not None:
        check_place(case, "level.enters", case.level.enters)
        if case.level.leaves is not None:
            check_place(case, "level.leaves", case.level.leaves)
    for name, load_case in case.load_cases.items():
        check_loads(case, f"load_cases.{name}", load_case)
    check_masses(case)
    _check_transfer(case)
    for name, check in case.checks.items():
        check_check(case, name, check)
    if case.conditions != Conditions():
        for checked in case.checked_links:
            case.material_of(checked)
    if case.ways_to_hold is not None:
        _check_ways_to_hold(case, case.ways_to_hold)
    _check_size(case)
    for name, hand in case.hand_calculations.items():
        drawn = [part for part, record in case.parts.items() if not isinstance(record, FilePart)]
        require(f"hand_calculations.{name}.part", hand.part, drawn, "is no part of a shape of alula's own")
    if case.motion is not None:
        _check_motion(case, case.motion)
    if case.cycle is not None:
        _check_cycle(case)
    toleranced(case)


def _check_drive(case: CoreCase) -> None:
    check_drive(case.linkage, case.pinned_drive)
    if case.drive is not None and case.drive.stiffness is not None:
        pushed = case.joints[case.drive.joint].kind.guided
        if (case.drive.stiffness.measure is Measure.TRAVEL) != pushed:
            kind, unit = ("slider", "20 N/mm") if pushed else ("revolute joint", "2 N*m/rad")
            raise CaseError(
                f"drive.stiffness: joint '{case.drive.joint}' is a {kind}, whose drive has a stiffness such as "
                f'"{unit}"; state that'
            )
    mobility = case.linkage.mobility
    if case.drive is not None and case.joints[case.drive.joint].fixed:
        held_as = "clamped" if case.joints[case.drive.joint].clamped else "bonded"
        raise CaseError(
            f"drive.joint: joint '{case.drive.joint}' is {held_as}, so it bears the moment that a drive would; drive "
            "another joint, or leave out one of the two"
        )
    let_go = case.pose.equilibrium
    drives = 1 if case.drive or let_go else 0
    held = sum(joint.as_posed for joint in case.linkage.joints.values())
    clamped = any(joint.clamped for joint in case.joints.values())
    if mobility <= drives + held and (held or clamped):
        return  # the pose tells whether clamps fit together, and statics whether these bonds hold the linkage
    if mobility > 0 and case.drive is None and not let_go:
        raise CaseError(
            f"drive: the linkage has mobility {mobility}, but nothing drives it; add a [drive] with its link and joint"
        )
    if mobility != drives and not (mobility < drives and case.moves):
        raise CaseError(
            f"drive: the linkage has mobility {mobility} (Gruebler) but {drives} drive; they must be equal, so add or "
            "remove joints or links"
        )


def _check_transfer(case: CoreCase) -> None:
    """Refuse a torque that is to enter by flat faces where its part has none about the hole."""
    drive = case.drive
    if drive is None or "transfer" not in drive.model_fields_set or drive.transfer != "eye-faces":
        return
    for link in set(case.joints[drive.joint].links) & set(case.checked_links):
        body, point = case.body(link), case.linkage.point_of(drive.joint, link)
        if any(pin.name == point and body.ring(pin).diameter == 0.0 for pin in body.pins):
            raise CaseError(
                f"drive.transfer: the part of link {link} has no flat ring about its hole at {point}, so no torque "
                'can enter by "eye-faces"; state "bore-shear", or leave transfer out'
            )


def _check_material(case: CoreCase, entry: str, name: str) -> None:
    known = case.all_materials.get(name)
    if why := directional(f"{name} {known.title if known else ''}"):
        raise CaseError(f"{entry}: '{name}' {why}")
    require(entry, name, case.all_materials, "is unknown", "or add a card under [materials]")


def _check_size(case: CoreCase) -> None:
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


def _check_pose(case: CoreCase) -> None:
    linkage, pose = case.linkage, case.pose
    if pose.travel is not None:
        _check_slides(case, "pose.coordinate", pose.coordinate)
        if "angle" in pose.model_fields_set:
            raise CaseError("pose.angle: the travel fixes the pose already; remove one of the two")
    elif pose.coordinate is not None:
        check_moving(case.linkage, "pose.coordinate", pose.coordinate)
    for name in pose.near:
        check_moving(case.linkage, "pose.near", name)
    if linkage.mobility == 1 and pose.coordinate is None:
        raise CaseError("pose.coordinate: the linkage can move, but no link fixes its pose; name one and its angle")
    if case.drive is None and not pose.equilibrium and linkage.mobility == 0 and pose.coordinate is not None:
        raise CaseError(
            f"pose.coordinate: it is '{pose.coordinate}', but the linkage cannot move (mobility 0); remove it"
        )


def _check_slides(case: CoreCase, entry: str, name: str | None) -> None:
    slots = [joint for joint, record in case.joints.items() if record.slides]
    require(entry, name, slots, "is no slider or slot, but a travel is stated")


def _check_motion(case: CoreCase, spec: MotionSpec) -> None:
    if spec.states is not None and case.pose.coordinate is None:  # a structure under the loads of a cycle
        if spec.instant_centre is not None:
            raise CaseError("motion.instant_centre: the case has no coordinate that could move; leave it out")
        return
    name = case.motion_coordinate.name
    if spec.travel is not None:
        _check_slides(case, "motion.coordinate", name)
    elif spec.coordinate is None and case.pose.travel is not None:
        raise CaseError(
            f"motion: the pose's coordinate '{name}' is a slider, so the motion needs its travel, for example "
            'travel = ["0 mm", "10 mm"], or a coordinate of its own'
        )
    else:
        check_moving(case.linkage, "motion.coordinate", name)
    if spec.instant_centre is not None:
        check_moving(case.linkage, "motion.instant_centre", spec.instant_centre)
    if spec.against is not None:
        require("motion.against", spec.against, case.links, "is no link")


def _check_cycle(case: CoreCase) -> None:
    """Check that no load case has a speed of its own: the table says how fast the linkage moves."""
    for name, load_case in case.load_cases.items():
        if load_case.speed != 0.0:
            raise CaseError(
                f"load_cases.{name}.speed: the table of the cycle says how fast the linkage moves; leave it out, and "
                "state cycle.period"
            )


def _check_body(entry: str, body: Body, *, moves: bool) -> None:
    try:
        check_body(body)
        if moves:
            check_length(body)
    except CaseError as error:
        raise CaseError(f"{entry}: {error}") from None


def check_check(case: CoreCase, name: str, check: Check) -> None:
    """Check what a check refers to.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : Check

    Raises
    ------
    CaseError
        For a link or joint that it is not for, and for what it needs besides.
    """
    for entry in ("links", "joints"):
        named = vars(check).get(entry, ())
        if twice := [one for i, one in enumerate(named) if one in named[:i]]:
            raise CaseError(f"checks.{name}.{entry}: '{twice[0]}' stands there twice; name each once")
    for link in vars(check).get("links", ()):
        require(f"checks.{name}.links", link, case.checked_links, "is no link with a part")
    if isinstance(check, PinCheck | BearingCheck):
        _check_pins(case, name, check)
    elif isinstance(check, MotorCheck):
        _check_motor(case, name)
    elif isinstance(check, DisplacementCheck) and (check.at, check.link) != (None, None):
        _check_displaced(case, name, check)
    elif isinstance(check, ClearanceCheck):
        if not case.stacked:
            raise CaseError(
                f"checks.{name}: a check of clearance needs to know which links lie at one height, but all lie in one "
                f'plane; give every link a layer or z, such as {layer_of(case.links)} with layer_spacing = "7 mm"'
            )
    elif isinstance(check, MassCheck):
        if not (case.checked_links or case.carried or check.others or pin_masses(case)):
            raise CaseError(
                f"checks.{name}: no link has a part or carries a mass, and no others are stated, so nothing weighs "
                "anything; give a link a part, or state others"
            )
    elif isinstance(check, FrequencyCheck):
        check_frequency(case, name, check)
    elif isinstance(check, LimitLoadCheck):
        if not case.checked_links:
            raise CaseError(f"checks.{name}: no moving link has a part, so nothing gives way; give a link a part")
    elif isinstance(check, EyeCheck):
        check_eye_check(case, name, check)
    elif isinstance(check, WallCheck):
        for link in check.links or case.checked_links:
            _check_thin(case, name, link)
    elif isinstance(check, ConnectionCheck):
        check_connection(case, name, check)
    elif isinstance(check, LineContactCheck):
        check_line_contact(case, name, check)
    elif isinstance(check, PlasticCollapseCheck | NotchCheck):
        check_break_check(case, name, check)
    elif isinstance(check, PermanentSetCheck):
        check_permanent_set(case, name)
    elif isinstance(check, FatigueCheck) and case.conditions.cycles is None:
        raise CaseError(
            f"checks.{name}: a check of fatigue needs the number of cycles; add [conditions] with cycles, for example "
            "1e6"
        )
    elif isinstance(check, SustainedCheck) and case.conditions.duration is None:
        raise CaseError(
            f"checks.{name}: a check of sustained load needs the duration of the load; "
            'add [conditions] with its duration, for example "10 year"'
        )
    elif isinstance(check, SafetyFactorCheck) and check.minimum is None:
        for link in check.links or case.checked_links:
            _check_minimum(name, case.part_of(link).material, case.material_of(link), f"link '{link}'")


def _check_thin(case: CoreCase, name: str, link: str) -> None:
    """Check that a link is of a shape whose buckling as a thin one has a formula."""
    part = case.part_of(link)
    slotted = any(pin.slot > 0.0 for pin in case.body(link).pins)
    varying = isinstance(part, Bar) and bool(part.widths)
    if not isinstance(part, Tube | Bar) or slotted or varying:
        kind = "file, whose section is not known" if isinstance(part, ImportedPart) else part.shape
        what = "has a slot" if slotted else f"is a {kind}{' of varying width' if varying else ''}"
        raise CaseError(
            f"checks.{name}.links: its formulas are those of tubes and of bars of one section, but link '{link}' "
            f"{what}; name the other links alone"
        )


def _check_minimum(name: str, title: str, material: Material, of: str) -> None:
    if material.minimum_safety_factor is None:
        raise CaseError(
            f"checks.{name}.minimum: it is missing, and '{title}', the material of {of}, states no "
            "minimum_safety_factor; add one of the two"
        )


def _check_pins(case: CoreCase, name: str, check: PinCheck | BearingCheck) -> None:
    bearing = isinstance(check, BearingCheck)
    known = case.bearing_joints if bearing else case.pinned_joints
    clamped = [joint for joint in check.joints or case.joints if joint in case.joints and case.joints[joint].clamped]
    if clamped and (check.joints or not known):
        what = "bears on a bore" if bearing else "could be judged"
        raise CaseError(
            f"checks.{name}: joint '{clamped[0]}' is clamped and has no pin that {what}; leave "
            f"{'it' if check.joints else 'the check'} out"
        )
    for joint in check.joints:
        rule = f"is no revolute joint{' or slot' if bearing else ''} of a link with a part"
        require(f"checks.{name}.joints", joint, known, rule)
    if not bearing and check.minimum is None:
        for joint in check.joints or known:
            of = f"the pin at joint '{joint}'"
            _check_minimum(name, case.joints[joint].pin_material, case.pin_material(joint), of)


def _check_ways_to_hold(case: CoreCase, asked: WaysToHold) -> None:
    """A published displacement stands beside that of the loads that it was published for, and of no others."""
    check_point(case.linkage, "ways_to_hold", asked.link, asked.at)
    if not any(case.linkage.ground in joint.links and not joint.slides for joint in case.joints.values()):
        raise CaseError("ways_to_hold: no revolute joint on the ground, where a link could be held; leave it out")
    if asked.load_case is not None:
        require("ways_to_hold.load_case", asked.load_case, case.load_cases, "does not exist")
    elif asked.published is not None and len(case.load_cases) > 1:
        known = ", ".join(case.load_cases)
        raise CaseError(f"ways_to_hold.load_case: it is missing; name the one that was published for, among {known}")


def _check_displaced(case: CoreCase, name: str, check: DisplacementCheck) -> None:
    if check.at is None:
        raise CaseError(f"checks.{name}.at: it is missing; add the point of link '{check.link}', or use links")
    if check.links:
        raise CaseError(
            f"checks.{name}: at is about one point of the linkage, links about each link by itself; remove one"
        )
    case.displaced_point(name, check)


def _check_motor(case: CoreCase, name: str) -> None:
    if case.motion is None or case.drive is None:
        raise CaseError(f"checks.{name}: a motor needs a motion to drive; add [motion] and [drive]")
    if Drive(link=case.drive.link, joint=case.drive.joint).effort(case.linkage) is DriveEffort.FORCE:
        raise CaseError(f"checks.{name}: a motor turns, but the drive pushes slider '{case.drive.joint}'; remove one")
    timed = case.motion.states is not None and case.motion.moves
    if not timed and not any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        raise CaseError(
            f"checks.{name}: no load case states the speed at which the motor runs; "
            'add one, for example speed = "150 rpm"'
        )


def _check_eyes(case: CoreCase, link: str) -> None:
    """Check that a link states eyes at its pins, and that its part takes them."""
    linkage, record = case.linkage, case.links[link]
    part = case.parts[record.part or ""]
    pinned = list(dict.fromkeys(linkage.point_of(name, link) for name in linkage.joints_of(link)))
    for point in record.eyes:
        require(f"links.{link}.eyes", point, pinned, "is no point with a joint")
        if isinstance(part, FilePart):
            if record.eyes[point].model_fields_set - {"fork"}:
                raise CaseError(
                    f"links.{link}.eyes.{point}: a part of shape {part.shape} takes no eyes of their own, only what "
                    "its file has; leave out all but fork"
                )
        elif "eyes of their own" not in part.takes:
            raise CaseError(
                f"links.{link}.eyes.{point}: a part of shape {part.shape} takes no eyes of their own; leave them out"
            )


def _check_held(case: CoreCase, link: str) -> None:
    """Check that the ground's part, and no other, is held at a point that its support has for itself."""
    record, entry = case.links[link], f"links.{link}.held_at"
    if record.held_at is None:
        if record.ground and record.part is not None:
            raise CaseError(
                f"{entry}: it is missing, but the ground has a part, which something must hold; name a point of the "
                "link without a joint, or remove the part"
            )
        return
    if not record.ground:
        raise CaseError(f"{entry}: link '{link}' moves, and its joints hold it; remove held_at")
    if record.part is None:
        raise CaseError(f"{entry}: the ground has no part that could be held; name a part, or remove held_at")
    require(entry, record.held_at, record.points, "is no point of the link")
    joints = case.linkage.joints_at(link, record.held_at)
    if joints:
        raise CaseError(
            f"{entry}: '{record.held_at}' is the point of joint '{joints[0]}', where another link acts; name a point "
            "without a joint"
        )


def _check_slots(case: CoreCase, link: str) -> None:
    """Check that a link's slots and arms are where pins are, and that every pin that slides in it has a slot.

    Parameters
    ----------
    case : CoreCase
        The case.
    link : str
        Name of a link with a part.

    Raises
    ------
    CaseError
        For the first slot, pin or arm that does not fit.
    """
    record, linkage = case.links[link], case.linkage
    part = case.parts[record.part or ""]
    if record.arms and isinstance(part, FilePart):
        raise CaseError(
            f"links.{link}.arms.{next(iter(record.arms))}: a part of shape {part.shape} takes no arms; leave them out"
        )
    sliding = {linkage.point_of(name, link): name for name, joint in linkage.joints.items() if joint.slotted == link}
    for point in record.slots:
        joints = linkage.joints_at(link, point)
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
        pinned = {linkage.point_of(name, link) for name in linkage.joints_of(link)}
        if part.shape == "tube" and (foot in pinned or foot == record.held_at or record.points[foot][1] != 0.0):
            raise CaseError(
                f"links.{link}.arms: the arm of a tube from '{foot}' to '{point}' starts on its plain wall, at a point "
                "on the axis (y = 0) without a joint or support; add such a point to points"
            )
        if not {point, *([] if part.shape == "tube" else [foot])} <= pinned:
            raise CaseError(
                f"links.{link}.arms: an arm from '{foot}' to '{point}' needs a pin at both; make them joints"
                if part.shape != "tube"
                else f"links.{link}.arms: an arm from '{foot}' to '{point}' needs a pin at '{point}'; make it a joint"
            )
