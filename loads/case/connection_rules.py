"""What checks of connections and of line contact need of their joints: a torque that goes through, a shaft, a slot."""

from alula.geometry.base.errors import CaseError
from alula.loads.case.core import CoreCase
from alula.loads.case.eyes import other_link
from alula.loads.records.check_spec import ConnectionCheck, LineContactCheck
from alula.loads.records.connection import Bond, CrossPin, Flat, Press, Screws
from alula.loads.statics.effort import DriveEffort
from alula.loads.text.explain import require


def turned_by_drive(case: CoreCase, joint: str) -> bool:
    """Return True of the joint at which the drive exerts a torque, in whose place neither stop nor balance stands.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Returns
    -------
    bool
    """
    drive = case.pinned_drive
    if drive is None or drive.joint != joint or drive.stop or drive.idle:
        return False
    return drive.effort(case.linkage) is DriveEffort.TORQUE


def connected_link(case: CoreCase, check: ConnectionCheck) -> str:
    """Return the link that a connection fixes.

    Parameters
    ----------
    case : CoreCase
    check : ConnectionCheck

    Returns
    -------
    str
    """
    drive = case.pinned_drive
    driven = drive.link if drive is not None and drive.joint == check.joint else None
    return check.link or driven or case.joints[check.joint].links[1]


def connected_joints(case: CoreCase, *, on_shaft: bool = False) -> set[str]:
    """Return the joints whose connection a check judges.

    Parameters
    ----------
    case : CoreCase
    on_shaft : bool, optional
        Those alone of which the shaft is judged, too.

    Returns
    -------
    set of str
    """
    checks = [check for check in case.checks.values() if isinstance(check, ConnectionCheck)]
    return {check.joint for check in checks if check.on_shaft or not on_shaft}


def check_connection(case: CoreCase, name: str, check: ConnectionCheck) -> None:
    """Check that a torque goes through a connection, and that its sizes fit together.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : ConnectionCheck

    Raises
    ------
    CaseError
        For another joint or link, and for sizes of which one contradicts another.
    """
    entry = f"checks.{name}"
    require(f"{entry}.joint", check.joint, case.joints, "is unknown")
    joint = case.linkage.joints[check.joint]
    if not joint.fixed and not turned_by_drive(case, check.joint):
        raise CaseError(
            f"{entry}.joint: no torque goes through '{check.joint}', which is neither the joint of a drive with a "
            "torque nor bonded nor clamped; name such a joint, or leave the check out"
        )
    if check.link is not None:
        require(f"{entry}.link", check.link, joint.links, f"is no link of joint '{check.joint}'")
    for kind, stated in (("cross_pin", check.cross_pin), ("screws", check.screws)):
        if stated is not None:
            require(f"{entry}.{kind}.material", stated.material, case.all_materials, "is no material")
    link, way = connected_link(case, check), check.way
    if case.links[link].part is None and (isinstance(way, Flat | CrossPin | Screws) or check.press_by_excess):
        raise CaseError(
            f"{entry}.link: what the connection bears needs the material of link '{link}', which has no part; give it "
            f"one, or name '{other_link(case.linkage, check.joint, link)}'"
        )
    if check.on_shaft:
        _check_shaft(case, entry, check, link)


def _check_shaft(case: CoreCase, entry: str, check: ConnectionCheck, link: str) -> None:
    joint, way = case.joints[check.joint], check.way
    if joint.clamp_length is not None:
        raise CaseError(
            f"{entry}: joint '{check.joint}' holds the end of a link over a clamp_length and has no shaft along its "
            "axis; state screws, or a bond with an outer_diameter, or leave the check out"
        )
    shaft = joint.pin_diameter
    if shaft is None:
        raise CaseError(f'joints.{check.joint}.pin_diameter: {entry} needs it as the shaft; state it, such as "5 mm"')
    hub = getattr(way, "hub_diameter", None)
    if hub is not None and hub <= shaft:
        raise CaseError(f"{entry}: hub_diameter is {hub:g} mm, but must be above the shaft's {shaft:g} mm; correct one")
    inner = way.shaft_bore if isinstance(way, Press) else way.diameter if isinstance(way, CrossPin) else 0.0
    if inner >= shaft:
        what = "shaft_bore" if isinstance(way, Press) else "the cross pin's diameter"
        raise CaseError(f"{entry}: {what} is {inner:g} mm, but must be below the shaft's {shaft:g} mm; correct one")
    if isinstance(way, Flat) and not shaft / 2.0 <= way.across < shaft:
        raise CaseError(
            f"{entry}.flat.across: it is {way.across:g} mm, but the shaft of {shaft:g} mm has a flat where that is "
            "between its radius and its diameter; measure from the flat to the round side"
        )
    if isinstance(way, Press) and way.hub_diameter is not None:
        _check_hub(case, entry, way, check.joint, link)


def _check_hub(case: CoreCase, entry: str, press: Press, joint: str, link: str) -> None:
    """Check that hub and shaft stay elastic under the largest interference, which the formula of its pressure needs."""
    shaft, hub, material = case.joints[joint].pin_diameter, press.hub_diameter, case.fresh_material(link)
    assert shaft is not None
    assert hub is not None
    pin = case.pin_material(joint)
    _, pressure = press.pressures(shaft, material, pin)
    share, bored = (shaft / hub) ** 2, (press.shaft_bore / shaft) ** 2
    stressed = [
        (f"hub, link '{link}'", material, ((1.0 + share) if material.brittle else 2.0) / (1.0 - share)),
        # Nothing pulls in the shaft, so that a brittle one stays whole.
        (f"shaft of joint '{joint}'", pin, 0.0 if pin.brittle else 2.0 / (1.0 - bored) if bored > 0.0 else 1.0),
    ]
    for what, card, times in stressed:
        strength = min((card.allowable, *(card.strength_range or ())))
        if times * pressure > strength:
            raise CaseError(
                f"{entry}.press.interference: it makes a pressure of {pressure:.4g} MPa and {times * pressure:.4g} MPa "
                f"in the {what}, above its strength of {strength:g} MPa, so that its pressure is not known; state less "
                "interference, a larger hub_diameter or less of a shaft_bore, or a measured pressure"
            )


def check_line_contact(case: CoreCase, name: str, check: LineContactCheck) -> None:
    """Check that a check of line contact has slots, and materials whose yield strengths are known.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : LineContactCheck

    Raises
    ------
    CaseError
        For a joint without a slot in a part or without a pin diameter, and for a brittle material.
    """
    entry = f"checks.{name}"
    for joint in check.joints:
        require(f"{entry}.joints", joint, case.slotted_joints, "is no pin in the slot of a link with a part")
    if not case.slotted_joints:
        raise CaseError(f"{entry}: no pin slides in the slot of a link with a part; leave the check out")
    for joint in check.joints or case.slotted_joints:
        link = case.joints[joint].slotted
        assert link is not None
        cards = {case.part_of(link).material: case.material_of(link)}
        cards |= {case.joints[joint].pin_material: case.pin_material(joint)}
        brittle = [card for card, material in cards.items() if material.brittle]
        if brittle and check.pressure is None:
            raise CaseError(
                f"{entry}.pressure: it is missing, but '{brittle[0]}' at joint '{joint}' is brittle and has no yield "
                "strength to judge by; state the largest pressure that it bears"
            )


def cards_of_connection(case: CoreCase, check: ConnectionCheck) -> tuple[str, ...]:
    """Return the names of the materials on whose strength a connection stands.

    Parameters
    ----------
    case : CoreCase
    check : ConnectionCheck

    Returns
    -------
    tuple of str
    """
    way, found = check.way, list[str]()
    if not isinstance(way, Bond | Press):
        found.append(case.part_of(connected_link(case, check)).material)
    if isinstance(way, CrossPin | Screws):
        found.append(way.material)
    return (*found, *((case.joints[check.joint].pin_material,) if check.on_shaft else ()))
