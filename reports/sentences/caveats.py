"""Sentences on what no check looks at, what is assumed and what is unusual: each in a few words, and why."""

from collections.abc import Iterable

from alula.fea.common.reason import Reason
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.reports.sentences.catalogue import Sentence, told

_ENTRIES = {
    "no_guide_length": 'under [joints.{joint}]: guide_length = "20 mm"',
    "none_states_friction": "under [joints.{joint}]: friction = 0.15",
    "no_drive_stiffness": 'under [drive]: stiffness = "{usual}"',
    "no_own_weight": "under [load_cases.{first}]: own_weight = true",
}
"""The line that a case may lack, and the table in which it stands, by the kind of the reason."""


def caveat(found: Caveat, *, short: bool = False) -> str:
    """Return a caveat in words, such as ``thigh (no part)``.

    Parameters
    ----------
    found : Caveat
    short : bool, optional
        True for a headline: without the reason where most cases have the same, and without the line to paste.

    Returns
    -------
    str
    """
    if not found.why or (short and found.topic in (Topic.SHAFT, Topic.COLLISIONS)):
        return told(found.what)
    why = told(found.why)
    if not short and isinstance(found.why, Reason) and found.why.kind in _ENTRIES:
        why += f"; {_ENTRIES[found.why.kind].format(**dict(found.why.facts))}"
    return f"{told(found.what)} ({why})"


def not_checked(found: Iterable[Caveat]) -> list[str]:
    """Return what is not checked, each in a few words with the reason.

    Parameters
    ----------
    found : iterable of Caveat
        Of all headings.

    Returns
    -------
    list of str
    """
    return [caveat(one) for one in found if one.heading is Heading.NOT_CHECKED]


def by_heading(found: Iterable[Caveat]) -> tuple[tuple[str, str], ...]:
    """Return caveats in words under their headings, with the lines to paste.

    Parameters
    ----------
    found : iterable of Caveat

    Returns
    -------
    tuple of (str, str)
        Heading, and its caveats as one sentence.
    """
    headings: dict[Heading, list[str]] = {}
    for one in found:
        headings.setdefault(one.heading, []).append(caveat(one))
    return tuple((heading.capitalize(), f"{'; '.join(texts)}.") for heading, texts in headings.items())


def _some(one: str, names: tuple[str, ...]) -> str:
    return f"{one}{'s' if len(names) > 1 else ''} {', '.join(names)}"


def _pins_left_out(joints: tuple[str, ...], why: Reason) -> str:
    return f"{_some('pin', joints)} ({told(why)})"


def _material_of_pins(joints: tuple[str, ...], material: str) -> str:
    return f"pins {', '.join(joints)} of {material}" if joints else f"pins of {material}"


def _what_links_carry(links: tuple[str, ...] = ()) -> str:
    return f"what {', '.join(links)} carr{'ies' if len(links) == 1 else 'y'}" if links else "what links carry"


SENTENCES: dict[str, Sentence] = {
    # Links, pins and stress without a check.
    "no_part": "no part",
    "no_check": "no check",
    "stress_of": "stress of {links}",
    "pins": "pins",
    "pins_of": lambda joints: _some("pin", joints),
    "material_of_pins": _material_of_pins,
    "no_pin_material": "no pin_material stated",
    "drive_shaft": "drive shaft at {joint}",
    "torque_by_flat_faces": 'its torque enters by the flat faces; with drive.transfer = "bore-shear" it twists the pin',
    "buckling_of_walls": "buckling of the wall of {links}",
    "thin_wall": "it is so thin that it may buckle before it yields",
    "layers": "layers",
    "layers_of": "layers of {links}",
    "strength_between_layers_unknown": "strength between the layers of a print is not known",
    "entry_is": "{entry} = {value:plain}",
    "lets_pass_what_breaks": "below 1 it lets pass what the load breaks",
    "lets_pass_what_rings": "below 1 it lets pass what rings below its drive",
    # Joints and drive.
    "bonds": "bonds {joints}",
    "clamps": "clamps {joints}",
    "not_judged_what_holds": "what holds them is not judged",
    "no_couple_on": "no couple on {joints}",
    "no_guide_length": "no guide_length",
    "joints_without_friction": "joints without friction",
    "none_states_friction": "none states any",
    "large_play": "play of {play:plain} mm at {joint}",
    "diameter_of_pin": "its pin has {diameter:plain} mm",
    "rigid_drive": "a drive that does not give",
    "stiffness_for_frequencies": "its stiffness counts for natural frequencies alone",
    "no_drive_stiffness": "no drive.stiffness",
    "collisions_and_couples": "collisions of links and couples of their pins",
    "no_layer_stated": "no link states a layer",
    # Loads, mass and size.
    "weight_of_carried": "weight of what links carry",
    "no_own_weight": "no own_weight in {load_cases}",
    "what_links_carry": _what_links_carry,
    "carried_is_false": "carried is false in every load case",
    "forces_on_pins": lambda places: f"force{'s' if len(places) > 1 else ''} at {', '.join(places)}",
    "pin_bears_it": "the pin there bears it, not the link's eye",
    "mass_of": "mass of {what}",
    "size_of": "size of {what}",
    "link_without_part": "{link} (no part)",
    "beyond_points": "{link} beyond its points (no part)",
    "wing_without_mass": "wing of {link} (it carries no mass)",
    "pins_without_lengths": "pins (no layers, hence no lengths)",
    "pins_left_out": _pins_left_out,
    "no_diameter": "no diameter",
    "in_ground_without_part": "in {ground}, which has no part",
    "spring_or_tendon": "{kind} {name}",
    # The motion.
    "inertia": "inertia",
    "inertia_is_false": "motion.inertia is false",
    "pose_at_rest": "the pose is found at rest, pose.equilibrium is true",
    "inertia_in_pose": "inertia in this pose",
    "envelope_has_inertia": "alula envelope has that of the motion",
    "all_stand_still": "every load case states that it stands still",
    "between_poses": "what lies between the {poses} poses of the motion",
    "poses_apart": "they are {degrees:short3}° apart",
    "vibration": "vibration",
    "no_frequency_check": 'no check of type "frequency"',
    "tolerances": "tolerances",
    "tolerance_looks_at_them": "alula tolerance looks at them",
    # What lasts, repeats or is warm.
    "creep": "creep under loads that stay",
    "no_duration": "no conditions.duration",
    "creep_of": "creep of {links}",
    "fatigue": "fatigue",
    "envelope_follows_motion": "alula envelope follows the motion",
    "no_fatigue_data_of": "no fatigue data of {materials}",
    "thermal_expansion": "thermal expansion",
    "sizes_as_stated": "at {temperature:plain} degC sizes are taken as stated",
    "pins_at_temperature": "pins at {temperature:plain} degC",
    "no_temperature_factors": ("no temperature_factors of {materials}; its strength is that of room temperature"),
}
