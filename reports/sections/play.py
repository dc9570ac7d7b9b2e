"""Play of pins under a load case."""

import math
from collections.abc import Iterator
from typing import Any

from alula.fea.common.band import Band
from alula.fea.common.source import play_source
from alula.loads.case.case import Case
from alula.loads.records.check_spec import DisplacementCheck
from alula.loads.states.play import Play, Span
from alula.loads.statics.effort import DriveEffort
from alula.reports.sections.data import data
from alula.reports.sections.section import Part, Text, paragraph
from alula.reports.sections.table import Column, Number, Table, numbers, words


def play_parts(case: Case, name: str, play: Play | None) -> Iterator[Part]:
    """Yield what play does under a load case.

    Parameters
    ----------
    case : Case
    name : str
        Of the load case.
    play : Play or None
        None without any.

    Yields
    ------
    Part
    """
    if play is None:
        return
    yield _told(play)
    free = {pair: play.free_motion(*pair) for pair in tips(case)}
    rest = [(size, _at_rest(play, *pair) or (None, None)) for pair, size in free.items()]
    yield Table.by_columns(
        {
            words("point"): [f"{point} of {link}" for link, point in free],
            Column("to either side", "mm"): numbers(free.values(), 3),
            Column("both ways", "mm"): numbers((2.0 * size for size in free.values()), 3, derived=True),
            Column("at rest x", "mm"): [Number(at[0], "", 3, beside=size) for size, at in rest],
            Column("at rest y", "mm"): [Number(at[1], "", 3, beside=size) for size, at in rest],
        },
        key="play",
        caption="Play: how far points can move to either side, each joint standing worst in its hole, and where they "
        "rest under the load",
        under=(("load case", name),),
    )
    clearances = (play.clearances.get(joint, 0.0) for joint in play.forces)
    yield Table.by_columns(
        {
            words("joint"): play.forces,
            Column("play", "mm"): numbers(clearances, stated=True, derived=True),
            Column("force (band)", "N"): numbers((_band(play, span) for span in play.forces.values()), 4),
        },
        key="joints with play",
        caption="Joint forces in the undeformed pose, with play anywhere",
        under=(("load case", name),),
    )


def _told(play: Play) -> Text:
    free = {pair: play.free_motion(*pair) for pair in tips(play.case)}
    link, point = max(free, key=lambda pair: free[pair])
    most, drive = free[link, point], play.drive
    held = "" if drive is None else f" with {drive.link} held"
    told = [f"Play of pins: {point} of {link} can move by ", Number(most, "mm", 3), f" to either side{held}, "]
    told += [Number(2.0 * most, "mm", 3, derived=True), " both ways"]
    if play.settled is not None:
        off = Number(abs(complex(play.shift(link, point))), "mm", 3, derived=True)
        told += ["; under the load it rests ", off, " off"]
    if play.case.layered:
        told += [
            ". That is with pins along z; where they tilt in their holes points move further, as checks of points hold"
        ]
    if drive is not None and play.nominal is not None:
        effort = drive.effort(play.case.linkage)
        told += [f". Drive {effort.word} ", Number(_band(play, play.effort), effort.unit)]
        told += [f", distance to a dead point of {drive.link} (a ratio) ", Number(_band(play, play.distance))]
    return paragraph(*told)


def play_record(play: Play | None) -> dict[str, Any] | None:
    """Return what play does under a load case as an entry of ``result.json``.

    Parameters
    ----------
    play : Play or None

    Returns
    -------
    dict or None
        None without play.
    """
    if play is None:
        return None
    driven, effort, distance = DriveEffort.TORQUE, None, None
    if play.drive is not None:
        driven = play.drive.effort(play.case.linkage)
        effort, distance = data(_band(play, play.effort)), data(_band(play, play.distance))
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
        **driven.alone(effort, None),
        "dead_point_distance": distance,
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
