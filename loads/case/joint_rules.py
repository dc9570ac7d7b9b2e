"""What friction and play of the joints need of a case."""

import itertools
import math
from collections.abc import Iterator, Sequence

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.fits import RUNNING
from alula.geometry.joints.hole_rules import check_holes
from alula.geometry.joints.holes import Known, largest_clearance
from alula.geometry.joints.joint_kinds import Surface
from alula.loads.case.connection_rules import connected_joints
from alula.loads.case.core import CoreCase
from alula.loads.case.layers import pins
from alula.loads.records.check_spec import MotorCheck
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.loads.text.reason import reason

LOOSE = 0.1
"""Play over the diameter of its pin above which it is unusual: ISO 286 H11/c11, a loose fit, leaves 0.06 at 3 mm."""


def rubbing_joints(case: CoreCase) -> tuple[str, ...]:
    """Return the joints with friction.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of str
    """
    return tuple(name for name, joint in case.joints.items() if joint.friction > 0.0)


def guides_without_length(case: CoreCase) -> tuple[str, ...]:
    """Return the guides with friction of which nothing says over which length they hold, so that moments add none.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of str
    """
    joints = case.joints
    guides = (name for name in rubbing_joints(case) if joints[name].kind.rubs is Surface.GUIDE)
    return tuple(name for name in guides if joints[name].guide_length is None)


def friction_ranges(case: CoreCase) -> dict[str, tuple[float, float]]:
    """Return the least and the largest coefficient of every joint with friction.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    dict of str to tuple of float
    """
    return {name: case.joints[name].friction_ends for name in rubbing_joints(case)}


def check_friction(case: CoreCase) -> None:
    """Check that friction has what it follows from: a pin's diameter, a joint that moves, a direction.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    for name, joint in case.joints.items():
        if joint.guide_length is not None and joint.kind.rubs is not Surface.GUIDE:
            raise CaseError(f"joints.{name}.guide_length: joint {name} is no slider and has no guide; leave it out")
    rubbing = rubbing_joints(case)
    for name in rubbing:
        entry, joint = f"joints.{name}.friction: it is {case.joints[name].friction:g}", case.joints[name]
        low, high = joint.friction_ends
        if not low <= joint.friction <= high:
            raise CaseError(
                f"joints.{name}.friction_range: it goes from {low:g} to {high:g}, but friction is {joint.friction:g}; "
                "state the least and the largest coefficient about it"
            )
        if joint.kind.rubs is Surface.BORE and joint.pin_diameter is None:
            raise CaseError(
                f"{entry}, but the torque of friction needs the radius of the pin; add joints.{name}.pin_diameter"
            )
        if case.linkage.joints[name].fixed:
            raise CaseError(f"{entry}, but a bonded joint does not turn; leave friction out, or do not bond it")
        if case.pose.equilibrium:
            raise CaseError(
                f"{entry}, with which a linkage that is let go stops anywhere about its balance; leave friction out, "
                "or pose.equilibrium"
            )
        if case.drive is None or case.pose.coordinate is None:
            raise CaseError(f"{entry}, but friction opposes a motion and nothing drives this linkage; leave it out")
    for names in shared_pins(case):
        _check_rubbing_pin(case, names)
    for name in case.load_cases if rubbing else ():
        for way in ("forward", "backward"):
            if f"{name} {way}" in case.load_cases:
                raise CaseError(
                    f"load_cases.{name} {way}: with friction, load case '{name}' in one direction has this name as "
                    "well; rename it"
                )


def shared_pins(case: CoreCase) -> tuple[tuple[str, ...], ...]:
    """Return the joints of every pin of several joints that rubs.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of tuple of str
        Of each pin, those without friction too.
    """
    own, joints = set(rubbing_joints(case)), case.joints
    return tuple(names for names in pins(case) if len(names) > 1 and any(joints[n].pivots and n in own for n in names))


def standing_link(case: CoreCase, names: Sequence[str]) -> str | None:
    """Return the link that all joints of a pin have in common: it is taken to stand there, and the others rub on it.

    Parameters
    ----------
    case : CoreCase
    names : sequence of str
        Its joints.

    Returns
    -------
    str or None
        None where there is none.
    """
    first, *others = (case.joints[name].bored for name in names)
    return next((link for link in first if all(link in other for other in others)), None)


def _check_rubbing_pin(case: CoreCase, names: Sequence[str]) -> None:
    """Refuse friction on a pin of several joints that does not stand in the link that these have in common.

    The friction of a joint is that of its own force. In the link in which the pin stands all of them press.
    """
    stands = standing_link(case, names)
    tight = [(name, link) for name in names for link in case.joints[name].tight_in]
    name = next(name for name in names if case.joints[name].friction > 0.0)
    entry = f"joints.{name}.friction: its pin is that of {', '.join(map(repr, names))}"
    if stands is None:
        raise CaseError(
            f"{entry}, which have no link in common, so that nothing tells in which link the pin stands while "
            "others rub on it; let all of these joints have that link"
        )
    if tight and all(link != stands for _, link in tight):
        raise CaseError(
            f"{entry} and is tight in '{tight[0][1]}', so that all other links rub there, but the link that these "
            f"joints have in common is '{stands}'; let all of them have '{tight[0][1]}'"
        )


def check_clamps(case: CoreCase) -> None:
    """Check that clamps have what their parts need: the length that is held, or the bore.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    held: dict[tuple[str, str], str] = {}
    for name, joint in case.joints.items():
        for link, point in zip(joint.links, case.linkage.joint_points(name), strict=True):
            other = held.setdefault((link, point), name)
            if case.links[link].part is None:
                continue
            if joint.clamped and joint.clamp_length is None and joint.pin_diameter is None:
                raise CaseError(
                    f"joints.{name}.clamp_length: link '{link}' has a part, so this clamp needs the length over which "
                    'it holds the end of it; state it, for example "20 mm", or the pin_diameter of the shaft on which '
                    "the part is pressed"
                )
            if joint.clamp_length != case.joints[other].clamp_length:
                raise CaseError(
                    f"joints.{name}.clamp_length: joint '{other}' is at the same point of link '{link}', but differs "
                    "in what it holds there; give both the same clamp_length, or each a point of its own"
                )


def clearances(case: CoreCase) -> dict[str, float]:
    """Return the play of every joint that has some: of the pin in its hole, and of a pin in a slot across it as well.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    dict of str to float
        Joint -> diametral play [mm]; empty where the linkage has more constraints than equilibrium has equations, or
        is let go: play of slots is not followed there.
    """
    return dict(case.linkage.plays) if _follows_play(case) else {}


def check_clearances(case: CoreCase) -> None:
    """Check that play is stated where a pin turns in a hole, and that the pin is larger.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first rule that is broken.
    """
    for name, joint in case.joints.items():
        check_holes(name, joint)
        widest = largest_clearance(joint)
        if widest == 0.0:
            continue
        entry = f"joints.{name}.{'fit' if joint.clearance is None else 'clearance'}"
        if not joint.kind.has_pin:
            raise CaseError(
                f"{entry}: a slider has no pin with play, and play of its guide is not modelled; leave it out"
            )
        if case.linkage.joints[name].fixed and not joint.fixed:
            continue  # bonds of the whole case leave play without meaning
        if joint.clearance is None and (joint.fixed or not _follows_play(case)):
            continue  # the pin sits as stated, but has no play that is followed; ``joint_caveats`` tells it
        if joint.fixed:
            raise CaseError(f"{entry}: a bonded joint has no play; leave it out, or let the joint turn")
        if _redundant(case):
            raise CaseError(
                f"{entry}: the linkage has more constraints than equilibrium has equations, and how its forces are "
                "shared with play is not modelled; leave it out or remove a redundant link"
            )
        if case.pose.equilibrium:
            raise CaseError(
                f"{entry}: play of a linkage that is let go is not modelled; leave it out, or state pose and drive"
            )
        size, what = _bound(case, name)
        if widest >= size:
            raise CaseError(f"{entry}: it is {widest:g} mm, but must stay below {what}, {size:g} mm; make it smaller")


def _bound(case: CoreCase, name: str) -> tuple[float, str]:
    """Return what the play of a joint must stay below, and its name: its pin, or the shortest of its links' pieces."""
    joint = case.joints[name]
    if joint.pin_diameter is not None:
        return joint.pin_diameter, "the pin's diameter"
    apart = [
        math.dist(a, b) for link in joint.links for a, b in itertools.combinations(case.links[link].points.values(), 2)
    ]
    return min((d for d in apart if d > 0.0), default=math.inf), "the shortest distance between points of its links"


def _follows_play(case: CoreCase) -> bool:
    """Whether play in the plane is modelled: not where it decides which links bear load, or where a pose balances."""
    return not _redundant(case) and not case.pose.equilibrium


def _redundant(case: CoreCase) -> bool:
    """Whether equilibrium has fewer equations than unknowns."""
    return case.linkage.borne + bool(case.drive) > 3 * len(case.linkage.moving)


def joint_caveats(case: CoreCase) -> Iterator[Caveat]:
    """Yield what is taken of the joints without a check: bonds, guides without length, running fits, large play.

    Parameters
    ----------
    case : CoreCase

    Yields
    ------
    Caveat
    """
    for kind, clamped in (("bonds", False), ("clamps", True)):
        joints, judged = case.linkage.joints.items(), connected_joints(case)
        held = [name for name, joint in joints if joint.fixed and joint.clamped == clamped and name not in judged]
        if held:
            yield Caveat(topic=Topic.BONDS, what=reason(kind, joints=held), why=reason("no_connection_check"))
    if short := guides_without_length(case):
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.FRICTION,
            what=reason("no_couple_on", joints=short),
            why=reason("no_guide_length", joint=short[0]),
        )
    for names in shared_pins(case):
        stands = standing_link(case, names)
        if not any(case.joints[name].tight_in for name in names):
            yield Caveat(
                heading=Heading.ASSUMED,
                topic=Topic.FRICTION,
                what=reason("shared_pin_stands", joints=list(names), link=stands),
                why=reason("none_is_tight"),
            )
    asked = any(isinstance(check, MotorCheck) for check in case.checks.values())
    if asked and not rubbing_joints(case):
        first = next(iter(case.pinned_joints), next(iter(case.joints)))
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.FRICTION,
            what=reason("joints_without_friction"),
            why=reason("none_states_friction", joint=first),
        )
    holes = {name: case.linkage.pin_holes(name).holes for name in case.joints}
    if running := [name for name, both in holes.items() if any(hole.known is Known.RUNNING for hole in both)]:
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.PLAY,
            what=reason("running_pins", joints=running),
            why=reason("running_is_assumed", fit=RUNNING),
        )
    loose = list(case.linkage.plays)
    if left := [name for name in loose if case.joints[name].fit is not None and not _follows_play(case)]:
        yield Caveat(
            topic=Topic.PLAY,
            what=reason("play_in_the_plane", joints=left),
            why=reason("let_go" if case.pose.equilibrium else "redundant"),
        )
    for name, play in clearances(case).items():
        diameter = case.joints[name].pin_diameter or math.inf
        if play > LOOSE * diameter:
            yield Caveat(
                heading=Heading.UNUSUAL,
                topic=Topic.PLAY,
                what=reason("large_play", play=play, joint=name),
                why=reason("diameter_of_pin", diameter=diameter),
            )
