"""Pins between their links: bending and shear, and what the models of pins, slots and connections leave out."""

from collections.abc import Iterator
from typing import Any

from alula.fea.asked.asked import asked_of
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import connected_joints
from alula.loads.case.forks import forked_link
from alula.loads.case.joint_rules import clearances, guides_without_length, rubbing_joints
from alula.loads.records.check_spec import LineContactCheck
from alula.loads.statics.effort import DriveEffort
from alula.reports.sections.data import entries
from alula.reports.sections.section import Part, Section, Text
from alula.reports.sections.table import Column, Table, numbers, words
from alula.reports.words.numbers import joined

_TRANSFER = (
    "How the torque passes between {joints} and the links that turn with them, by a press, a flat, a pin, screws or "
    'glue, is not checked; a check of type "connection" does.'
)
_CLAMPS = (
    "The stress that the grip of clamps at {joints} alone makes is not checked{slips}. Displacements take what is held "
    "for rigid up to the mouth of the clamp."
)
_LINES = 'Pins in slots at {joints} touch a flank along a line; a check of type "line-contact" judges its pressure.'


def pin_parts(stated: Case, case: LoadCaseResult) -> Iterator[Part]:
    """Yield the stresses of the pins under a load case.

    Parameters
    ----------
    stated : Case
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    if not case.pins:
        return
    deformed = ". Forces of the deformed pose" if case.large_displacement.reactions else ""
    joints, pins = [stated.joints[name] for name in case.pins], case.pins.values()
    yield Table.by_columns(
        {
            words("pin"): case.pins,
            words("material"): [joint.pin_material for joint in joints],
            Column("diameter", "mm"): numbers((joint.pin_diameter for joint in joints), stated=True, derived=True),
            Column("lever", "mm"): numbers((pin.lever for pin in pins), stated=True),
            Column("moment", "N·mm"): numbers(pin.moment for pin in pins),
            Column("bending", "MPa"): numbers(pin.bending for pin in pins),
            Column("shear", "MPa"): numbers((pin.shear for pin in pins), 3),
        },
        key="pins",
        caption="Pins; the lever is the distance between the middles of the two eyes, and in a fork from a cheek to "
        f"the middle of half the eye{deformed}",
        under=(("load case", case.name),),
    )
    forked = any(forked_link(stated, name) is not None for name in stated.joints)
    fork = "; in a fork, from half of what crosses a gap to forces spread evenly along cheeks and eye" if forked else ""
    holes = "; and over how pins may stand in their holes" if case.forces.pins is not None else ""
    band = "The band reaches from an equal share of the couple for both eyes to the whole couple on one eye"
    yield Text(f"{band}{fork}{holes}.", "note")


def pin_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return the stresses of the pins as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    return [{"joint": joint} | entries(pin, "lever moment bending shear") for joint, pin in case.pins.items()]


def pins_left_out(result: CheckResult) -> Section:
    """Return what the models of pins, shafts, clamps and slots leave out.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts.
    """
    return Section(
        key="pins", not_covered=(("Pins and contact", _contact(result)), *_transfer(result.case), *_slots(result.case))
    )


def _transfer(case: Case) -> Iterator[tuple[str, str]]:
    joints = case.linkage.joints.items()
    held = [name for name, joint in joints if joint.clamped and joint.clamp_length is not None]
    judged = connected_joints(case)
    turned = [name for name, joint in joints if joint.fixed and name not in held]
    drive = case.pinned_drive
    if drive is not None and drive.effort(case.linkage) is DriveEffort.TORQUE:
        turned = [drive.joint, *turned]
    if turned := [name for name in turned if name not in judged]:
        yield "Torque at shafts", _TRANSFER.format(joints=f"the pins of {joined(list(dict.fromkeys(turned)))}")
    if held:
        loose = [name for name in held if name not in judged]
        slips = f', nor what keeps links from slipping at {joined(loose)}; a check of type "connection" judges that'
        yield "Clamps", _CLAMPS.format(joints=joined(held), slips=slips if loose else "")


def _slots(case: Case) -> Iterator[tuple[str, str]]:
    judged = asked_of(case, LineContactCheck)
    slotted = [name for name, joint in case.joints.items() if joint.slotted is not None and name not in judged]
    if slotted:
        yield "Contact in slots", _LINES.format(joints=joined(slotted))


def _contact(result: CheckResult) -> str:
    checked = list(dict.fromkeys(joint for case in result.load_cases.values() for joint in case.pins))
    own = f"Checked pins: {joined(checked)}" if checked else "No pin was checked"
    rubbing, case, loose = rubbing_joints(result.case), result.case, clearances(result.case)
    smooth = [name for name in case.joints if name not in rubbing]
    left_out = "friction" if not rubbing else f"friction at {joined(smooth)}" if smooth else ""
    without = joined([*([] if loose else ["clearance"]), *filter(None, [left_out])])
    found = f"Each pin is modelled as a pressure on its hole{', without ' if without else ''}{without}"
    if loose:
        found += (
            f". The play at {joined(list(loose))} is in pose, forces and displacements, each pin standing anywhere in "
            "its hole; impact where a pin changes sides, and a narrower contact in a wider hole, are not modelled"
        )
    if guided := guides_without_length(case):
        found += f". The moments of {joined(guided)} add no friction, since no guide_length is stated"
    return f"{found}. Wear is not modelled. {own}."
