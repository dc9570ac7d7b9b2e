"""Play of pins: free motion of points, and its bands of forces, drive and dead point, as data and as text."""

import math
from typing import Any

from fea.common.band import Band
from fea.common.source import play_source
from loads.case.case import Case
from loads.records.check_spec import DisplacementCheck
from loads.states.play import Play, Span
from reports.tables.data import data
from reports.words.wording import band, number


def play_record(play: Play | None) -> dict[str, Any] | None:
    """Return what play does under a load case as plain data.

    Parameters
    ----------
    play : Play or None

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without play.
    """
    if play is None:
        return None
    pushes = play.drive is not None and play.drive.pushes(play.case.linkage)
    effort = None if play.drive is None else data(_band(play, play.effort))
    return {
        "clearances": play.clearances,
        "through_dead_point": play.through_dead_point,
        "points": [
            {
                "link": link,
                "point": point,
                "free_motion": play.free_motion(link, point),
                "at_rest": _at_rest(play, link, point),
            }
            for link in play.case.linkage.moving
            for point in play.case.links[link].points
        ],
        "joints": [{"joint": name, "force": data(_band(play, span))} for name, span in play.forces.items()],
        "drive_torque": None if pushes else effort,
        "drive_force": effort if pushes else None,
        "dead_point_distance": None if play.drive is None else data(_band(play, play.distance)),
    }


def _at_rest(play: Play, link: str, point: str) -> list[float] | None:
    if play.settled is None:
        return None
    shift = complex(play.shift(link, point))
    return [shift.real, shift.imag]


def _band(play: Play, span: Span) -> Band:
    if math.isnan(span.value):
        return Band.unknown("the pose is a dead point")
    return Band(value=span.value, low=span.low, high=span.high, sources=(play_source(play.clearances),))


def tips(case: Case) -> tuple[tuple[str, str], ...]:
    """Return the points whose free motion is told: those without joint, and those that checks ask for.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of (str, str)
        Links and points; every pin where all points are pins.
    """
    pinned = {
        pair for name, j in case.joints.items() for pair in zip(j.links, case.linkage.joint_points(name), strict=True)
    }
    every = [(link, point) for link in case.linkage.moving for point in case.links[link].points]
    asked = [case.displaced_point(n, c) for n, c in case.checks.items() if isinstance(c, DisplacementCheck) and c.at]
    if case.ways_to_hold is not None:
        asked.append((case.ways_to_hold.link, case.ways_to_hold.at))
    return tuple(dict.fromkeys([*(pair for pair in every if pair not in pinned), *asked])) or tuple(every)


def play_line(play: Play) -> str:
    """Return what play does under a load case, in a few sentences.

    Parameters
    ----------
    play : Play

    Returns
    -------
    str
    """
    free = {pair: play.free_motion(*pair) for pair in tips(play.case)}
    link, point = max(free, key=lambda pair: free[pair])
    most, drive = free[link, point], play.drive
    held = "" if drive is None else f" with {drive.link} held"
    told = f"Play of pins: {point} of {link} can move by {number(most, 3)} mm to either side{held}"
    told += f", {number(2.0 * most, 3)} mm both ways"
    if play.settled is not None:
        told += f"; under the load it rests {number(abs(complex(play.shift(link, point))), 3)} mm off"
    if drive is None or play.nominal is None:
        return f"{told}."
    pushes = drive.pushes(play.case.linkage)
    what, unit = ("force", "N") if pushes else ("torque", "N·mm")
    return (
        f"{told}. Drive {what} {band(_band(play, play.effort))} {unit}, distance to a dead point of {drive.link} "
        f"{band(_band(play, play.distance))}."
    )
