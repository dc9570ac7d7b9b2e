"""Play of pins under a load case."""

import math
from collections.abc import Iterator
from typing import Any

from alula.fea.common.band import Band
from alula.fea.common.source import play_source
from alula.loads.case.case import Case
from alula.loads.records.check_spec import DisplacementCheck
from alula.loads.states.play import Play, Span
from alula.reports.sections.data import data
from alula.reports.sections.section import Column, Number, Part, Table, Text, say, words


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
    yield Table(
        key="play",
        columns=(
            words("point"),
            Column("to either side", "mm"),
            Column("both ways", "mm"),
            Column("at rest x", "mm"),
            Column("at rest y", "mm"),
        ),
        rows=tuple(
            (
                f"{point} of {link}",
                Number(free, "", 3),
                Number(2.0 * free, "", 3, derived=True),
                *(Number(at, "", 3, beside=free) for at in _at_rest(play, link, point) or (None, None)),
            )
            for link, point in tips(case)
            for free in [play.free_motion(link, point)]
        ),
        caption="Play: how far points can move to either side, each joint standing worst in its hole, and where they "
        "rest under the load",
        under=(("load case", name),),
    )
    yield Table(
        key="joints with play",
        columns=(words("joint"), Column("play", "mm"), Column("force (band)", "N")),
        rows=tuple(
            (name, Number(play.clearances.get(name, 0.0), stated=True, derived=True), Number(_band(play, span), "", 4))
            for name, span in play.forces.items()
        ),
        caption="Joint forces in the undeformed pose, with play anywhere",
        under=(("load case", name),),
    )


def _told(play: Play) -> Text:
    free = {pair: play.free_motion(*pair) for pair in tips(play.case)}
    link, point = max(free, key=lambda pair: free[pair])
    most, drive = free[link, point], play.drive
    held = "" if drive is None else f" with {drive.link} held"
    told = f"Play of pins: {point} of {link} can move by {{most}} to either side{held}, {{both}} both ways"
    facts: dict[str, object] = {"most": Number(most, "mm", 3), "both": Number(2.0 * most, "mm", 3, derived=True)}
    if play.settled is not None:
        told += "; under the load it rests {off} off"
        facts["off"] = Number(abs(complex(play.shift(link, point))), "mm", 3, derived=True)
    if play.case.layered:
        told += (
            ". That is with pins along z; where they tilt in their holes points move further, as checks of points hold"
        )
    if drive is not None and play.nominal is not None:
        pushes = drive.pushes(play.case.linkage)
        told += f". Drive {'force' if pushes else 'torque'} {{effort}}, distance to a dead point of {drive.link} "
        told += "(a ratio) {distance}"
        facts["effort"] = Number(_band(play, play.effort), "N" if pushes else "N·mm")
        facts["distance"] = Number(_band(play, play.distance))
    return say(told, **facts)


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
