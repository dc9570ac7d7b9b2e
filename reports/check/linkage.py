"""The linkage in its pose: pictures, points, directions of the links, distance to a dead point."""

import math
from collections.abc import Iterator
from typing import Any

from alula.fea.common.verdict import by_nearness
from alula.fea.outcomes.result import CheckResult
from alula.geometry.linkage.pose import NEAR_DEAD_POINT
from alula.reports.figures.drawings import linkage_drawing
from alula.reports.sections.reactions import pose_tables, shown_components
from alula.reports.sections.section import Beside, Folded, Part, Picture, Section, paragraph, say
from alula.reports.sections.table import Number
from alula.reports.sentences.verdicts import checks_of
from alula.reports.words.numbers import plain


def governing_load_cases(result: CheckResult) -> tuple[str, ...]:
    """Return the load cases of which a drawing is made: those that stress some link most, and the first.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of str
        That of the check nearest to its limit first.
    """
    first, checks = next(iter(result.load_cases.values())), by_nearness(checks_of(result))
    names = dict.fromkeys([first.name, *(result.governing(link).name for link in first.links)])
    return tuple(sorted(names, key=lambda name: not checks or name != checks[0].load_case))


def linkage_picture(result: CheckResult, name: str, kind: str = "") -> Picture:
    """Return the drawing of the linkage under a load case.

    Parameters
    ----------
    result : CheckResult
    name : str
        Of the load case.
    kind : str, optional
        As of ``Picture``.

    Returns
    -------
    Picture
    """
    stated = result.case.load_cases[name]
    told = [
        f"Load case “{name}”{f': {stated.title}' if stated.title else ''}. To scale.",
        "Each joint force is drawn as it acts on the link in its label; "
        "the other link of the joint bears the opposite force.",
    ]
    acts = [what for what, there in (("own weight", stated.own_weight), ("inertia", stated.speed)) if there]
    if acts:
        verbs = ("acts", "is") if len(acts) == 1 else ("act", "are")
        told.append(f"{' and '.join(acts).capitalize()} of the links {verbs[0]} as well and {verbs[1]} not drawn.")
    if len(shown_components(result.load_cases[name].reactions)) > 3:
        told.append("Forces and moments out of the plane are not drawn.")
    if stated.air:
        told.append("The air’s force is drawn as far as it lies in the plane.")
    return Picture(
        name=f"linkage-{name}",
        alt=f"The linkage to scale with the joint forces of load case {name}",
        caption=" ".join(told),
        draw=lambda: linkage_drawing(result, name),
        kind=kind,
    )


def linkage_section(result: CheckResult) -> Section:
    """Return the linkage in its pose.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        The first screen has the drawing of the load case that decides; those of the others stand here.
    """
    pose = result.pose
    parts: list[Part] = [linkage_picture(result, name, "half") for name in governing_load_cases(result)[1:]]
    parts += _held(result)
    closure = say(
        "Closure residual {residual} of the longest link ({length})",
        residual=Number(pose.residual, "", 2),
        length=Number(pose.linkage.longest, "mm", stated=True),
    )
    folded = (closure, Beside(pose_tables(pose, result.case), "columns"), *_dead_points(result))
    parts.append(Folded("Points, directions, closure and distance to a dead point", folded))
    return Section(
        key="linkage",
        title="The linkage and its joint forces",
        short="Linkage",
        parts=tuple(parts),
        data={"pose": _data(result)},
    )


def _held(result: CheckResult) -> Iterator[Part]:
    pose, balanced, told = result.pose, result.case.pose.equilibrium, list[str | Number]()
    if pose.coordinate is not None and pose.coordinate.slides:
        held = f"The pose is fixed by joint {pose.coordinate}, whose travel is "
        told = [held, Number(pose.held, "mm"), " in balance. " if balanced else ". "]
    elif pose.coordinate is not None:
        angle = Number(math.degrees(pose.held) % 360.0, "", 6)
        held = f"The pose is {'in balance with' if balanced else 'fixed by'} link {pose.coordinate}, whose axis points "
        told = [f"{held}to ", angle, "° (counter-clockwise from x). "]
    yield paragraph(*told, f"Degrees of freedom after Gruebler: {pose.linkage.mobility}")


def _dead_points(result: CheckResult) -> Iterator[Part]:
    told: list[str | Number] = [
        "Distance to a dead point (a ratio): the smallest singular value of the scaled constraint Jacobian with the "
        "pose coordinate held, or the driven link against the other link of its joint (sliders: the travel); 0 at the "
        f"dead point, below {plain(NEAR_DEAD_POINT)} there is a warning: "
    ]
    for what, link, distance in dead_points(result):
        told += [f"{what} {link} ", Number(distance, "", 3), ", "]
    if len(told) > 1:
        yield paragraph(*told[:-1])


def dead_points(result: CheckResult) -> Iterator[tuple[str, str, float]]:
    """Yield what is held, its link, and the distance from its dead point.

    Parameters
    ----------
    result : CheckResult

    Yields
    ------
    tuple of (str, str, float)
    """
    pose, drive = result.pose, None if result.case.pose.equilibrium else result.case.pinned_drive
    if pose.coordinate is not None:
        yield "the pose coordinate", pose.coordinate.name, pose.dead_point_distance(pose.coordinate)
    if drive is not None:
        yield "the driven link", drive.link, drive.dead_point_distance(pose)


def _data(result: CheckResult) -> dict[str, Any]:
    pose, coordinate = result.pose, result.pose.coordinate
    angles = {link: math.degrees(angle) % 360.0 for link, angle in pose.angles.items()}
    held = {what: {"link": link, "distance": distance} for what, link, distance in dead_points(result)}
    return {
        "points": {name: [float(x) for x in at] for name, at in pose.points.items()},
        "link_angles": angles,
        "coordinate": coordinate and coordinate.name,
        "coordinate_angle": angles[coordinate.name] if coordinate and not coordinate.slides else None,
        "coordinate_travel": pose.held if coordinate and coordinate.slides else None,
        "mobility": pose.linkage.mobility,
        "closure_residual": pose.residual,
        "longest_link": pose.linkage.longest,
        "dead_points": {
            "pose_coordinate": held.get("the pose coordinate"),
            "driven_link": held.get("the driven link"),
        },
    }
