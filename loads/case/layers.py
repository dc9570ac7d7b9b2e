"""Layers: how much of the height along the pins links and pins take up, what pins weigh, and what must fit together."""

import math
from collections import Counter
from itertools import pairwise

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.holes import HolePlay
from alula.loads.case.core import CoreCase
from alula.loads.case.forks import levels, outer_link
from alula.loads.case.heights import thickness
from alula.loads.records.carried import CarriedBody

Eye = tuple[str, str]
"""Link and point."""


def slab(case: CoreCase, name: str) -> tuple[float, float]:
    """Return the heights between which the material of a link lies; of a pair, that of both plates.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the link.

    Returns
    -------
    tuple of float
        Lowest and highest z [mm]; equal where its thickness is not known.
    """
    at, known = levels(case, name), thickness(case.links[name], case.parts)
    lowest, highest = at[0], at[-1]
    if known is None and case.links[name].part is not None:
        body = case.body(name)
        rings = [body.ring(pin) for pin in body.pins]
        return lowest + min(ring.low for ring in rings), highest + max(ring.high for ring in rings)
    half = (known or 0.0) / 2.0
    return lowest - half, highest + half


def on_one_axis(case: CoreCase) -> tuple[tuple[str, ...], ...]:
    """Return the joints, those together whose pins stand in one hole of a link, and so are one pin.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of tuple of str
        Every joint once.
    """
    groups: list[tuple[set[tuple[str, str]], tuple[str, ...]]] = []
    for name, joint in case.joints.items():
        axis = {(link, case.linkage.point_of(name, link)) for link in joint.bored}
        names: tuple[str, ...] = ()
        for group in [group for group in groups if group[0] & axis]:
            groups.remove(group)
            axis, names = axis | group[0], names + group[1]
        groups.append((axis, (*names, name)))
    return tuple(names for _, names in groups)


def joints_of_pin(case: CoreCase, joint: str) -> tuple[str, ...]:
    """Return the joints that a pin is of.

    Parameters
    ----------
    case : CoreCase
    joint : str
        One of them.

    Returns
    -------
    tuple of str
        Itself alone where it has no pin.
    """
    return next((names for names in pins(case) if joint in names), (joint,))


def pins(case: CoreCase) -> tuple[tuple[str, ...], ...]:
    """Return the joints of each pin; a slider along a guide has none.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of tuple of str
    """
    every = (tuple(name for name in names if case.joints[name].kind.has_pin) for names in on_one_axis(case))
    return tuple(names for names in every if names)


def pin_stretches(case: CoreCase) -> dict[str, tuple[Eye, Eye]]:
    """Return between which eyes the pin of each joint runs; where several joints are one pin, from link to link.

    A pin is built into one link of its joint: into the first, of several joints into that on which most of them turn,
    and of one in a slot or along a guide into the second, since the first cannot hold it. Where the pin of a shorter
    joint goes the same way from that link, it goes on from that joint's other link.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    dict of str to tuple of 2 Eye
        Joint, from the shortest on -> the eye from which its pin goes on, and that where it ends.
    """
    linkage, found = case.linkage, dict[str, tuple[Eye, Eye]]()
    eyes = {name: [(link, linkage.point_of(name, link)) for link in case.joints[name].links] for name in case.joints}
    turning = Counter(eye for name, own in eyes.items() if case.joints[name].pivots for eye in own)

    def height(eye: Eye) -> float:
        return linkage.heights.get(eye[0], 0.0)

    for name in sorted(case.joints, key=lambda one: abs(linkage.rise(one))):
        joint, (start, end) = case.joints[name], eyes[name]
        if joint.slides or (joint.pivots and turning[end] > turning[start]):
            start, end = end, start
        up = height(end) - height(start)
        for begins, until in (own for other, own in found.items() if joint.pivots and case.joints[other].pivots):
            reach, left = height(until) - height(start), height(end) - height(until)
            if begins == start and min(up * reach, up * left) > 0.0:
                start = until
        found[name] = start, end
    return found


def pin_masses(case: CoreCase) -> dict[str, CarriedBody]:
    """Return what the pins of a layered case weigh: cylinders from the lowest to the highest face of their links.

    A pin moves with the link in which it is tight, else with the first one of its joint; one in a slot with the link
    that slides. Pins on one axis of one diameter are one.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    dict of str to CarriedBody
        First joint of a pin -> its mass, at the joint. Pins without diameter are left out, and those that stand in a
        ground without part; there are none without layers.
    """
    found: dict[str, CarriedBody] = {}
    for own in pins(case) if case.layered else ():
        for diameter in dict.fromkeys(case.joints[name].pin_diameter for name in own):
            alike = [name for name in own if case.joints[name].pin_diameter == diameter]
            link, point = _standing_in(case, alike)
            if diameter is None or (link == case.linkage.ground and case.links[link].part is None):
                continue
            faces = [z for name in alike for link_of in case.joints[name].links for z in slab(case, link_of)]
            density = case.all_materials[case.joints[alike[0]].pin_material].density
            mass = density * math.pi / 4.0 * diameter**2 * (max(faces) - min(faces))
            if mass > 0.0:
                found[alike[0]] = CarriedBody.model_construct(link=link, at=point, mass=mass)
    return found


def _standing_in(case: CoreCase, names: list[str]) -> tuple[str, str]:
    """Return link and point with which the pin of joints on one axis moves."""
    stated = [n for n in names if case.joints[n].tight_in and not case.joints[n].slides]
    name = (stated or names)[0]
    joint = case.joints[name]
    link = (*(() if joint.slides else joint.tight_in), *joint.bored)[0]
    return link, case.linkage.point_of(name, link)


def check_layers(case: CoreCase) -> None:
    """Check that heights are known, and what joints state about pins between layers.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        As ``heights``; for a pin that is tight in a link that its joint does not have, or where no layers are stated (a
        layer_spacing of 0, which takes stated ones back, passes it over); for a gap that the layers tell already; for
        heads of one joint of a pin alone, and joints of one pin that state one hole in two ways.
    """
    case.linkage  # noqa: B018 - its own rules come first
    _check_heads(case)
    _check_shared_holes(case)
    _check_one_pin(case)
    layered = case.layered
    taken_back = case.layer_spacing == 0.0
    for name, joint in case.joints.items():
        for link in joint.tight_in:
            if link not in joint.links:
                raise CaseError(
                    f"joints.{name}.tight_in: '{link}' is no link of this joint; choose one of {', '.join(joint.links)}"
                )
        for entry in ("pin_gap",) if layered else () if taken_back else ("tight_in", "heads"):
            in_fork = (layered or entry == "tight_in") and outer_link(case, name) is not None  # both lie in one layer
            if entry in joint.model_fields_set and not in_fork:
                why = "the layers tell the gap" if layered else "it has a meaning only where links lie in layers"
                raise CaseError(f"joints.{name}.{entry}: {why}; leave it out")


def _check_heads(case: CoreCase) -> None:
    """Refuse heads of some joints of a pin: the gaps of all of its links are one."""
    for names in on_one_axis(case):
        turning = [name for name in names if case.joints[name].pivots]
        without = [name for name in turning if case.joints[name].heads is None]
        if without and len(without) < len(turning):
            name = next(name for name in turning if name not in without)
            raise CaseError(
                f"joints.{name}.heads: joint '{without[0]}' is on the same pin and states none, but its links share "
                "the gap; state heads of both, whose gaps add up, or of neither"
            )


def _check_one_pin(case: CoreCase) -> None:
    """Refuse a pin of several joints of which one passes a link that it does not go on from."""
    stretches = pin_stretches(case) if case.layered else {}
    for names in on_one_axis(case) if case.layered else ():
        own = [name for name in names if case.joints[name].pivots and case.linkage.rise(name) != 0.0]
        heights = {name: sorted(case.linkage.heights.get(eye[0], 0.0) for eye in stretches[name]) for name in own}
        ordered = sorted(own, key=lambda name: heights[name])
        for one, other in pairwise(ordered):
            if heights[other] != heights[one] and heights[other][0] < heights[one][1]:
                links = dict.fromkeys(link for name in own for link in case.joints[name].links)
                raise CaseError(
                    f"joints.{other}: its pin is that of joint '{one}' as well and runs past one of its links; let all "
                    f"joints there have one of {', '.join(links)} in common"
                )


def _check_shared_holes(case: CoreCase) -> None:
    """Refuse two joints of one pin between layers that state the hole of a link in two ways."""
    stated: dict[tuple[str, str], tuple[str, HolePlay]] = {}
    for name, joint in case.joints.items() if case.layered else ():
        sits = case.linkage.pin_holes(name)
        for hole in sits.holes if joint.pivots and sits.shared is None else ():
            if not hole.stated:
                continue
            eye = hole.link, case.linkage.point_of(name, hole.link)
            first, other = stated.setdefault(eye, (name, hole))
            if (hole.low, hole.high) != (other.low, other.high):
                raise CaseError(
                    f"joints.{name}: it states {_width(hole)} in the hole of '{hole.link}', but joint '{first}' on the "
                    f"same pin states {_width(other)} there; state the same in both, or leave it out of one"
                )


def _width(hole: HolePlay) -> str:
    if hole.high == 0.0:
        return "a tight pin"
    return (
        f"a clearance of {hole.low:.4g} to {hole.high:.4g} mm"
        if hole.low < hole.high
        else (f"a clearance of {hole.high:.4g} mm")
    )
