"""What the verdict of a report does not cover, derived from the case and its result."""

import math
from collections.abc import Iterable, Iterator

from alula.fea.common.verdict import LINKAGE, Quantity, Subject
from alula.fea.outcomes.result import CheckResult, LinkResult, SolidResult
from alula.fea.solid.buckling_factor import MOST
from alula.loads.case.joint_rules import clearances, rubbing_joints
from alula.reports.sentences import told as in_words
from alula.reports.words.numbers import joined

STACKING = (
    "The case states no layers, so all links lie in one plane. In a real linkage they are stacked along the pins; the "
    "offset causes additional bending and torsion."
)
LAYERS = (
    "Pins between layers are beams from mid-plane to mid-plane. The bands hold how they share couples: with the pins "
    "of any link tilting in it or in their other link, and with all holes open that are not tight_in. That "
    "washers, heads and faces that touch bear some of them is left out."
)
TILT = (
    " How far pins without a stated clearance tilt in their holes is in no displacement, and not in the gaps between "
    "layers."
)
TRANSFER = (
    "How the torque passes between {joints} and the links that turn with them, by a key, a clamp, a screw or glue, is "
    "not checked: neither what holds there nor the stress beside it."
)
CLAMPS = (
    "What holds the links at {joints}, by friction, screws or glue, is not checked: neither whether they slip, nor the "
    "stress that the clamp's grip alone makes. Displacements take what is held for rigid up to the mouth of the clamp."
)
LINES = (
    "Pins in slots at {joints} touch a flank along a line. The pressure of this line contact, indentation and wear are "
    "not checked."
)
WINGS = (
    "All force of the air acts on the axis of {links}: what turns a wing about that axis, the chordwise twist of wing "
    "and link, and the give of the wing's plate are not modelled."
)
SPRINGS = (
    "Springs, tendons and stops have no mass, no friction and no give of their own but the stated stiffness. Where "
    "stops, and the legs of springs about joints, touch the links is not modelled: their moment enters at the eye of "
    "the joint."
)
IMPACT = "A sudden load causes higher stresses than the same load applied slowly."


def not_covered(result: CheckResult) -> tuple[tuple[str, str], ...]:
    """Return each effect that the models of this check do not cover.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of tuple
        Pairs (title, text).
    """
    moves = result.case.motion is not None
    springs = (("Springs and stops", SPRINGS),) if result.case.sprung else ()
    return (
        ("Other poses", "Only this pose was checked; another pose can give higher stresses"
         + (". The command alula envelope checks all poses of the motion." if moves else ".")),
        ("Layers", _layers(result)) if result.case.layered else ("Stacking", STACKING),
        ("Pins and contact", _pins(result)),
        *_features(result),
        *springs,
        ("Fatigue", "The loads are static. Repeated loads break parts at lower stresses"
         + (". The command alula envelope checks fatigue over the motion." if moves else ".")),
        ("Creep, temperature, moisture, ageing", _conditions(result)),
        ("Large displacements", _large_displacement(result)),
        ("Buckling", _buckling(result)),
        ("Impact", IMPACT),
        ("Manufacture and scatter", _scatter(result)),
        ("Bands", _bands(result)),
    )  # fmt: skip


def _layers(result: CheckResult) -> str:
    linkage, loose = result.case.linkage, clearances(result.case)
    tilting = [name for name in linkage.joints if linkage.rise(name) != 0.0 and name not in loose]
    return LAYERS + TILT if any(not linkage.joints[name].bonded for name in tilting) else LAYERS


def _features(result: CheckResult) -> Iterator[tuple[str, str]]:
    """What is not checked of shafts, slots and wings, where the case has some."""
    case = result.case
    joints = case.linkage.joints.items()
    held = [name for name, joint in joints if joint.clamped and joint.clamp_length is not None]
    turned = [name for name, joint in joints if joint.type == "revolute" and joint.bonded and name not in held]
    drive = case.pinned_drive
    if drive is not None and not drive.pushes(case.linkage):
        turned = [drive.joint, *turned]
    if turned:
        yield "Torque at shafts", TRANSFER.format(joints=f"the pins of {joined(list(dict.fromkeys(turned)))}")
    if held:
        yield "Clamps", CLAMPS.format(joints=joined(held))
    slotted = [name for name, joint in case.joints.items() if joint.type == "pin-in-slot"]
    if slotted:
        yield "Contact in slots", LINES.format(joints=joined(slotted))
    flapping = [name for name in result.load_cases if case.load_cases[name].flapping is not None]
    if flapping:
        yield "Wings", WINGS.format(links=joined(list(dict.fromkeys(wing.link for wing in case.wings))))


def _pins(result: CheckResult) -> str:
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
    guided = [name for name in rubbing if case.joints[name].type == "slider" and case.joints[name].guide_length is None]
    if guided:
        found += f". The moments of {joined(guided)} add no friction, since no guide_length is stated"
    return f"{found}. Wear is not modelled. {own}."


def _conditions(result: CheckResult) -> str:
    stated = result.case.conditions
    if stated.duration is None and stated.temperature is None:
        held = "the case states no conditions, so short-term values at room temperature are used"
    elif stated.temperature is None:
        held = "stiffness and stress are those after the stated time under load, at room temperature"
    elif stated.duration is None:
        held = "strengths and moduli are short-term values at the stated temperature, as far as cards tell"
    else:
        held = "strengths and moduli are those at the stated temperature after the stated time, as far as cards tell"
    return (
        "Plastics lose strength and stiffness with time under load, temperature and age: "
        f"{held}. Moisture and ageing are not modelled."
    )


def _large_displacement(result: CheckResult) -> str:
    states = {name: case.large_displacement for name, case in result.load_cases.items()}
    followed = [name for name, moved in states.items() if moved.followed]
    blind = [name for name, moved in states.items() if moved.state in ("off", "unknown")]
    small = [name for name in states if name not in followed and name not in blind]
    told = []
    if small:
        told.append(f"{_under(result, small)}forces are those of the undeformed pose, since displacements are small")
    if blind:
        told.append(f"{_under(result, blind)}forces are those of the undeformed pose, without check of displacements")
    if followed:
        told.append(
            f"{_under(result, followed)}equilibrium is that of the deformed pose under loads of constant direction"
        )
        stated = [result.case.load_cases[name] for name in followed]
        axes = {force.axes for case in stated for force in case.forces}
        if result.case.springs or result.case.tendons:
            told.append("springs and tendons follow the points at which they are fastened")
        if "link" in axes | {spread.axes for case in stated for spread in case.spread}:
            told.append("a load in link axes turns with the pose of its link, but not with the deformation")
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}."


def _under(result: CheckResult, names: list[str]) -> str:
    return "" if len(names) == len(result.load_cases) else f"under {joined(names)} "


def _buckling(result: CheckResult) -> str:
    judged = {
        check.subject
        for case in result.load_cases.values()
        for check in case.checks
        if check.quantity is Quantity.BUCKLING_FACTOR
    }
    links = [link for link in result.case.checked_links if Subject.link(link) in judged]
    columns = [link for link in links if result.case.part_of(link).is_beam]
    solids = [link for link in result.case.checked_links if not result.case.part_of(link).is_beam]
    found = (
        f"{joined(columns)} {_was(columns)} checked"
        if columns
        else f"No {'beam' if solids else 'link'} is in compression; one that is would be checked"
    )
    found += f" as {'straight elastic columns' if len(columns) > 1 else 'a straight elastic column'}"
    if solids:
        found += f". {joined(solids)} {'is no beam' if len(solids) == 1 else 'are no beams'}: elastic solids are looked"
        found += f" at up to {MOST:g} times the load"
    found += ". Initial curvature is not modelled, nor is local buckling of thin walls of beams"
    followed = all(case.large_displacement.followed for case in result.load_cases.values())
    unseen = [n for n, case in result.load_cases.items() if case.large_displacement.buckling is None]
    if unseen:
        found += f". Buckling of the whole linkage was not checked {_under(result, unseen)}".rstrip()
    elif LINKAGE in judged and not followed:
        found += ". Buckling of the whole linkage was checked by linear theory"
    return f"{found}."


def _scatter(result: CheckResult) -> str:
    case = result.case
    used = dict.fromkeys(case.part_of(link).material for link in case.checked_links)
    bare = {
        "strength": [name for name in used if case.all_materials[name].strength_range is None],
        "modulus": [name for name in used if case.all_materials[name].youngs_modulus_range is None],
        "the loads": [name for name in result.load_cases if len(set(case.load_cases[name].scatter)) == 1],
    }
    whole = {"strength": len(used), "modulus": len(used), "the loads": len(result.load_cases)}
    missing = [
        what if len(names) == whole[what] else f"{what} ({joined(names)})" for what, names in bare.items() if names
    ]
    text = "The safety factor must cover voids, print layers, notches and scatter of dimensions"
    if missing:
        text += f", and scatter of {joined(missing)}, for which the case states no range"
    parts = {link: case.part_of(link) for link in case.checked_links if case.part_of(link).build_direction is None}
    unknown = [
        link for link, part in parts.items() if case.all_materials[part.material].strength_across_layers is not None
    ]
    layers = (
        f" Safety factors of {joined(unknown)} hold layers of any direction, since no build_direction is stated."
        if unknown
        else ""
    )
    return f"{text}. Stated ranges are part of the bands.{layers}"


def _bands(result: CheckResult) -> str:
    every = [link for case in result.load_cases.values() for link in case.links.values()]
    loaded = [link for link in every if not math.isinf(link.safety_factor.value)]
    alone = _names(link for link in loaded if link.safety_factor.without)
    solid = _names(link for link in loaded if link.link not in alone and isinstance(link, SolidResult))
    hand = _names(link for link in loaded if link.link not in (*alone, *solid))
    told = []
    if solid:
        told.append(f"the discretisation error in the bands of {joined(solid)} is an estimate, not a bound")
    if hand:
        told.append(f"{joined(hand)} {_was(hand)} not meshed: the bands come from solid models of similar parts")
    if alone:
        reasons = [in_words(link.safety_factor.without) for link in loaded]
        why = joined(list(dict.fromkeys(filter(None, reasons))))
        told.append(f"{joined(alone)} {'has' if len(alone) == 1 else 'have'} no band for model error ({why})")
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}." if text else "No load acts on any checked link."


def _was(names: list[str]) -> str:
    return "was" if len(names) == 1 else "were"


def _names(links: Iterable[LinkResult]) -> list[str]:
    return list(dict.fromkeys(link.link for link in links))
