"""What a reader of a verdict must know besides: what no check looks at, what is assumed, and what is unusual."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from fea.common.at_temperature import as_if_cold, cold_pins
from fea.common.lasting import unjudged_creep, unjudged_fatigue
from fea.outcomes.layers import unknown_layers
from geometry.materials.plausible import untold, unusual
from loads.case.case import Case
from loads.case.joint_rules import clearances
from loads.records.check_spec import (
    BearingCheck,
    FrequencyCheck,
    LimitLoadCheck,
    MassCheck,
    PinCheck,
    SafetyFactorCheck,
    SizeCheck,
    SustainedCheck,
)
from loads.states.extent import unmeasured
from loads.states.weighed import unweighed

Strength = type[SafetyFactorCheck] | type[SustainedCheck]
LOOSE = 0.1
"""Play over the diameter of its pin above which it is unusual: ISO 286 H11/c11, a loose fit, leaves 0.06 at 3 mm."""


class Heading(StrEnum):
    """Under which heading a caveat is told."""

    NOT_CHECKED = "not checked"
    ASSUMED = "assumed"
    UNUSUAL = "unusual"


class Topic(StrEnum):
    """What a caveat is about."""

    PART = "part"
    STRESS = "stress"
    PINS = "pins"
    MASS = "mass"
    SIZE = "size"
    INERTIA = "inertia"
    WEIGHT = "weight"
    VIBRATION = "vibration"
    BONDS = "bonds"
    MATERIAL = "material"
    LIMIT = "limit"
    PLAY = "play"
    TEMPERATURE = "temperature"
    LAYERS = "layers"
    CREEP = "creep"
    FATIGUE = "fatigue"


@dataclass(frozen=True, kw_only=True)
class Caveat:
    """Something on which a verdict stands that no check judges.

    Attributes
    ----------
    heading : Heading
    topic : Topic
    what : str
        In a few words.
    why : str
        Its reason; "" where ``what`` has it.
    """

    heading: Heading = Heading.NOT_CHECKED
    topic: Topic
    what: str
    why: str = ""

    def __str__(self) -> str:
        """For people: ``thigh (no part)``."""
        return f"{self.what} ({self.why})" if self.why else self.what


def caveats(case: Case, strength: Sequence[Strength] = (SafetyFactorCheck, SustainedCheck)) -> tuple[Caveat, ...]:
    """Return all that a reader of a case's verdict must know besides.

    Parameters
    ----------
    case : Case
    strength : sequence of type
        The kinds of check that set a link's stress against a strength; an envelope knows the first alone.

    Returns
    -------
    tuple of Caveat
    """
    return (*_left_out(case, strength), *_inertia(case, strength), *_weight(case), *_vibration(case),
        *_bonds(case), *_pins(case),
            *_limits(case), *_play(case), *_material(case, strength))  # fmt: skip


def unchecked(case: Case, strength: Sequence[Strength] = (SafetyFactorCheck, SustainedCheck)) -> tuple[str, ...]:
    """Return what is not checked, each in a few words with the reason: ``thigh (no part)``.

    Parameters
    ----------
    case : Case
    strength : sequence of type
        As of ``caveats``.

    Returns
    -------
    tuple of str
    """
    return tuple(str(one) for one in caveats(case, strength) if one.heading is Heading.NOT_CHECKED)


def _left_out(case: Case, strength: Sequence[Strength]) -> Iterator[Caveat]:
    """Yield the links and pins that no check looks at, and what is not counted of mass and size."""
    for link in case.linkage.moving:
        if link not in case.checked_links:
            yield Caveat(topic=Topic.PART, what=link, why="no part")
    stressed: set[str] = set()
    pinned: set[str] = set()
    for check in case.all_checks.values():
        if isinstance(check, PinCheck):
            pinned.update(check.joints or case.pinned_joints)
        elif isinstance(check, SafetyFactorCheck | SustainedCheck) and isinstance(check, tuple(strength)):
            stressed.update(check.links or case.checked_links)
        elif isinstance(check, MassCheck) and check.others is None:
            yield from (Caveat(topic=Topic.MASS, what=f"mass of {what}") for what in unweighed(case))
        elif isinstance(check, SizeCheck):
            yield from (Caveat(topic=Topic.SIZE, what=f"size of {what}") for what in unmeasured(case))
    left = [link for link in case.checked_links if link not in stressed]
    if left:
        yield Caveat(topic=Topic.STRESS, what=f"stress of {', '.join(left)}", why="no check")
    pins = [name for name, joint in case.joints.items() if joint.type != "slider"]
    loose = [name for name in pins if name not in pinned]
    if loose:
        which = "pins" if loose == pins else f"pin{'s' if len(loose) > 1 else ''} {', '.join(loose)}"
        yield Caveat(topic=Topic.PINS, what=which, why="no check")


def _inertia(case: Case, strength: Sequence[Strength]) -> Iterator[Caveat]:
    """Yield inertia that a stated speed would give, and that the case leaves out or no single pose has."""
    motion = case.motion
    if motion is None or motion.rate == (0.0, 0.0):
        return
    if motion.inertia is False:
        yield Caveat(topic=Topic.INERTIA, what="inertia", why="motion.inertia is false")
    elif case.inert and not case.turns_steadily and SustainedCheck in strength:
        yield Caveat(topic=Topic.INERTIA, what="inertia in this pose", why="alula envelope has that of the motion")


def _weight(case: Case) -> Iterator[Caveat]:
    """Yield what links carry without its weight."""
    light = [name for name, one in case.load_cases.items() if case.carried and one.carried and not one.own_weight]
    if light:
        yield Caveat(topic=Topic.WEIGHT, what="weight of what links carry", why=f"no own_weight in {', '.join(light)}")


def _vibration(case: Case) -> Iterator[Caveat]:
    """Yield vibration where the drive has a speed and no check asks for frequencies."""
    asked = any(isinstance(check, FrequencyCheck) for check in case.checks.values())
    if not asked and any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        yield Caveat(topic=Topic.VIBRATION, what="vibration", why='no check of type "frequency"')


def _bonds(case: Case) -> Iterator[Caveat]:
    """Yield the joints that state that their links hold together, which no check judges."""
    bonded = [name for name, joint in case.joints.items() if joint.bonded]
    if bonded:
        yield Caveat(topic=Topic.BONDS, what=f"bonds {', '.join(bonded)}", why="what holds them is not judged")


def _pins(case: Case) -> Iterator[Caveat]:
    """Yield the material of pins that are checked and state none."""
    asked = [check.joints or case.pinned_joints for check in case.all_checks.values() if isinstance(check, PinCheck)]
    silent = dict.fromkeys(x for names in asked for x in names if "pin_material" not in case.joints[x].model_fields_set)
    for material in dict.fromkeys(case.joints[name].pin_material for name in silent):
        own = [name for name in silent if case.joints[name].pin_material == material]
        which = "pins" if len(own) == len(case.pinned_joints) else f"pins {', '.join(own)}"
        yield Caveat(
            heading=Heading.ASSUMED, topic=Topic.MATERIAL, what=f"{which} of {material}", why="no pin_material stated"
        )


def _material(case: Case, strength: Sequence[Strength]) -> Iterator[Caveat]:
    """Yield what a material may suffer that nothing judges: layers that part, creep, fatigue, another temperature."""
    for topic, found in (
        (Topic.LAYERS, unknown_layers(case)),
        (Topic.CREEP, unjudged_creep(case)),
        (Topic.FATIGUE, unjudged_fatigue(case, followed=SustainedCheck not in strength)),
        (Topic.TEMPERATURE, cold_pins(case)),
    ):
        yield from (Caveat(topic=topic, what=what, why=why) for what, why in found)


def _limits(case: Case) -> Iterator[Caveat]:
    """Yield limits that let pass what fails under its own load."""
    for name, check in case.checks.items():
        least = (
            check.minimum if isinstance(check, SafetyFactorCheck | PinCheck | BearingCheck | LimitLoadCheck) else None
        )
        if least is not None and least < 1.0:
            yield Caveat(
                heading=Heading.UNUSUAL,
                topic=Topic.LIMIT,
                what=f"checks.{name}.minimum = {least:g}",
                why="below 1 it lets pass what the load breaks",
            )


def _play(case: Case) -> Iterator[Caveat]:
    """Yield play that is large for its pin."""
    for name, play in clearances(case).items():
        diameter = case.joints[name].pin_diameter or math.inf
        if play > LOOSE * diameter:
            yield Caveat(
                heading=Heading.UNUSUAL,
                topic=Topic.PLAY,
                what=f"play of {play:g} mm at {name}",
                why=f"its pin has {diameter:g} mm",
            )


def unusual_materials(case: Case) -> list[str]:
    """Return a sentence for what is unusual in materials of links and checked pins, lacks a source, or is not known.

    Parameters
    ----------
    case : Case

    Returns
    -------
    list of str
    """
    used = [case.part_of(link).material for link in case.checked_links]
    for check in case.all_checks.values():
        if isinstance(check, PinCheck):
            used += [case.joints[name].pin_material for name in check.joints or case.pinned_joints]
    cards = {name: case.all_materials[name] for name in dict.fromkeys(used)}
    found = [said for name, card in cards.items() for said in (*unusual(name, card), *untold(name, card))]
    return [*found, *as_if_cold(case)]
