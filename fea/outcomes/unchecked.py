"""What a reader of a verdict must know besides: what no check looks at, what is assumed, and what is unusual.

Every feature tells its own, in its own file; here they are gathered.
"""

from collections.abc import Iterator

from alula.fea.asked.asked import asked_of, asks
from alula.fea.asked.at_temperature import as_if_cold, temperature_caveats
from alula.fea.asked.lasting import creep_caveats, fatigue_caveats
from alula.fea.buckling.wall import wall_caveats
from alula.fea.common.reason import Reason, reason, together
from alula.fea.outcomes.limits import layer_caveats, limit_caveats
from alula.fea.outcomes.pins import shaft_caveats, shared_pin_caveats
from alula.geometry.materials.plausible import untold, unusual
from alula.loads.case.break_rules import eye_caveats
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import joint_caveats
from alula.loads.case.level_case import level_caveats
from alula.loads.case.load_rules import load_caveats
from alula.loads.case.toleranced import tolerance_caveats
from alula.loads.records.check_spec import (
    FrequencyCheck,
    NotchCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    SustainedCheck,
)
from alula.loads.states.case_motion import cycle_caveats, inertia_caveats, step_caveats
from alula.loads.states.clearance import collision_caveats
from alula.loads.states.extent import size_caveats
from alula.loads.states.standing import drive_caveats
from alula.loads.states.weighed import mass_caveats
from alula.loads.text.caveat import Caveat, Heading, Topic


def caveats(case: Case, *, over_motion: bool = False, harmonic: Reason | None = None) -> tuple[Caveat, ...]:
    """Return all that a reader of a case's verdict must know besides.

    Parameters
    ----------
    case : Case
    over_motion : bool, optional
        True for a verdict on the motion (``alula envelope``), False for one on the stated pose.
    harmonic : Reason, optional
        What is known of vibration without a check of it, as ``nearest_harmonic`` says.

    Returns
    -------
    tuple of Caveat
    """
    return (
        *_left_out(case, over_motion),
        *mass_caveats(case),
        *size_caveats(case),
        *inertia_caveats(case, over_motion=over_motion),
        *(step_caveats(case) if over_motion else cycle_caveats(case)),
        *load_caveats(case),
        *level_caveats(case),
        *_vibration(case, harmonic),
        *drive_caveats(case),
        *joint_caveats(case),
        *shaft_caveats(case),
        *shared_pin_caveats(case, {*asked_of(case, PinCheck)}),
        *collision_caveats(case),
        *_pins(case),
        *wall_caveats(case),
        *eye_caveats(case),
        *limit_caveats(case),
        *tolerance_caveats(case),
        *layer_caveats(case),
        *creep_caveats(case),
        *fatigue_caveats(case, over_motion=over_motion),
        *temperature_caveats(case),
    )


def _left_out(case: Case, over_motion: bool) -> Iterator[Caveat]:
    """Yield the links and pins that no check looks at."""
    for link in case.linkage.moving:
        if link not in case.checked_links:
            yield Caveat(topic=Topic.PART, what=link, why=reason("no_part"))
    in_pose = () if over_motion else (SustainedCheck, NotchCheck)
    stressed = asked_of(case, SafetyFactorCheck, PlasticCollapseCheck, *in_pose)
    pinned = asked_of(case, PinCheck)
    left = [link for link in case.checked_links if link not in stressed]
    if left:
        yield Caveat(topic=Topic.STRESS, what=reason("stress_of", links=left), why=reason("no_check"))
    pins = [name for name, joint in case.joints.items() if joint.kind.has_pin and not joint.clamped]
    loose = [name for name in pins if name not in pinned]
    if loose:
        which = reason("pins") if loose == pins else reason("pins_of", joints=loose)
        yield Caveat(topic=Topic.PINS, what=which, why=reason("no_check"))


def _vibration(case: Case, harmonic: Reason | None) -> Iterator[Caveat]:
    """Yield vibration where the drive has a speed and no check asks for frequencies."""
    if not asks(case, FrequencyCheck) and any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        why = together(reason("no_frequency_check"), harmonic)
        yield Caveat(topic=Topic.VIBRATION, what=reason("vibration"), why=why)


def _pins(case: Case) -> Iterator[Caveat]:
    """Yield the material of pins that are checked and state none."""
    silent = [x for x in asked_of(case, PinCheck) if "pin_material" not in case.joints[x].model_fields_set]
    for material in dict.fromkeys(case.joints[name].pin_material for name in silent):
        own = [name for name in silent if case.joints[name].pin_material == material]
        which = () if len(own) == len(case.pinned_joints) else tuple(own)
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.MATERIAL,
            what=reason("material_of_pins", joints=which, material=material),
            why=reason("no_pin_material"),
        )


def unusual_materials(case: Case) -> list[Reason | str]:
    """Return a sentence for what is unusual in materials of links and checked pins, lacks a source, or is not known.

    Parameters
    ----------
    case : Case

    Returns
    -------
    list of Reason or str
    """
    used = [case.part_of(link).material for link in case.checked_links]
    used += [case.joints[name].pin_material for name in asked_of(case, PinCheck)]
    cards = {name: case.all_materials[name] for name in dict.fromkeys(used)}
    found = [said for name, card in cards.items() for said in (*unusual(name, card), *untold(name, card))]
    return [*found, *as_if_cold(case)]
