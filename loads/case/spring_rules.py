"""What must fit together between springs, tendons and stops and the linkage that they act in."""

import itertools
import math

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Measure
from alula.loads.case.core import CoreCase
from alula.loads.records.attachment import Attachment
from alula.loads.text.explain import require


def check_springs(case: CoreCase) -> None:
    """Check where springs and tendons are fastened.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first point, or joint, that is not there or cannot take their force.
    """
    for table, records in (("springs", case.springs), ("tendons", case.tendons)):
        for name, one in records.items():
            for where, place in one.fastened.items():
                _check_attachment(case, f"{table}.{name}.{where}", place)
            if one.hinge is not None:
                require(f"{table}.{name}.joint", one.hinge, _turning(case), "is no revolute joint that turns")
    for name, tendon in case.tendons.items():
        for first, other in itertools.pairwise(tendon.through):
            if first == other:
                raise CaseError(
                    f"tendons.{name}.through: point '{first.at}' of link '{first.link}' stands there twice in a row; "
                    "remove one of the two"
                )


def _check_attachment(case: CoreCase, entry: str, place: Attachment) -> None:
    require(f"{entry}.link", place.link, case.links, "is no link")
    link = case.links[place.link]
    require(f"{entry}.at", place.at, link.points, f"is no point of link '{place.link}'", "or add it to its points")
    if place.at in link.slots:
        raise CaseError(
            f"{entry}: point '{place.at}' of link '{place.link}' is a slot, where the pin alone can push; name another "
            "point"
        )
    if place.at in case.bare_feet(place.link):
        raise CaseError(
            f"{entry}: point '{place.at}' of link '{place.link}' is where an arm starts, and no load enters there; "
            "name another point"
        )


def _turning(case: CoreCase) -> list[str]:
    """Return the joints whose links turn against each other, and do not slide."""
    return [name for name, joint in case.linkage.joints.items() if joint.pivots]


def check_stops(case: CoreCase) -> None:
    """Check that every stop is in a joint that it can stop, and that those of one joint leave it a range.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        For the first stop that does not fit.
    """
    ranges: dict[str, dict[float, float]] = {}
    for name, stop in case.stops.items():
        sliders = [joint for joint, record in case.joints.items() if record.kind.guided]
        require(f"stops.{name}.joint", stop.joint, [*_turning(case), *sliders], "is no joint that turns, and no slider")
        slides = case.joints[stop.joint].kind.guided
        entry = f"stops.{name}.{'at_least' if stop.at_least is not None else 'at_most'}"
        if slides != (stop.limit.measure is Measure.TRAVEL):
            kind = 'a slider, so it needs a travel: "5 mm"' if slides else 'revolute, so it needs an angle: "30 deg"'
            raise CaseError(f"{entry}: joint '{stop.joint}' is {kind}")
        if case.pose.coordinate is None:
            raise CaseError(f"stops.{name}: the linkage cannot move, so it comes to no stop; remove it")
        ends = ranges.setdefault(stop.joint, {})
        if stop.sense in ends:
            raise CaseError(f"{entry}: joint '{stop.joint}' has another stop of this sense; keep one of them")
        ends[stop.sense] = stop.limit.value
        if len(ends) == 2 and not 0.0 < ends[-1.0] - ends[1.0] < (math.inf if slides else 2.0 * math.pi):
            more = "" if slides else ", and less than a turn"
            raise CaseError(
                f"{entry}: the stops of joint '{stop.joint}' leave no range; at_most must be more than at_least{more}"
            )


def check_equilibrium(case: CoreCase) -> None:
    """Check that a linkage that is let go can move, under one load case at rest.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        Where it cannot.
    """
    if not case.pose.equilibrium:
        return
    if case.pose.coordinate is None:
        raise CaseError(
            "pose.equilibrium: no coordinate is stated along which the linkage moves to its balance; add "
            "pose.coordinate with an angle or travel to start from"
        )
    for name, joint in case.linkage.joints.items():
        if joint.as_posed:
            raise CaseError(
                f"pose.equilibrium: joint '{name}' is bonded, so the linkage keeps the stated pose; remove one of the "
                "two, or state the angle of the bond"
            )
    if len(case.load_cases) > 1:
        raise CaseError(
            f"pose.equilibrium: each of the {len(case.load_cases)} load cases has a balance of its own; keep one load "
            "case, and write a case file for each"
        )
    for name, load_case in case.load_cases.items():
        if load_case.speed != 0.0:
            raise CaseError(
                f"load_cases.{name}.speed: with pose.equilibrium the linkage is at rest; remove one of the two"
            )
