"""What the play of pins does over a motion."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.joint_paths import loosest, moving_points
from alula.fea.findings.of_motion import MotionFindings
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.extremes import stretches, with_pose
from alula.reports.sections.section import Column, Number, Part, Section, Table, Text, say, words

Real = NDArray[np.float64]


def play_section(found: MotionFindings) -> Section:
    """Return what play does over a motion.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    Section
        Without parts where no joint has play.
    """
    record = play_record(found)
    return Section(
        key="play",
        title="Play of pins",
        short="Play",
        parts=() if record is None else tuple(_parts(found.moved, record)),
        data={"play": record},
    )


def play_record(found: MotionFindings) -> dict[str, Any] | None:
    """Return what play does over a motion as an entry of ``result.json``.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without play. Numbers without end are infinite.
    """
    motion, play = found.moved.motion, found.play
    if play is None:
        return None
    points = {}
    for label in moving_points(motion):
        point = play.points[loosest(motion, play, label)]
        points[label] = {"smallest": float(point.free.min()), **with_pose(motion, "largest", *point.farthest)}
    return {
        "clearances": play.clearances,
        "through_dead_point": stretches(motion, play.passes),
        "dead_point_distance": with_pose(motion, "smallest", *play.nearest),
        "points": points,
        found.moved.effort.entry: {
            name: with_pose(motion, "smallest", *play.smallest[name])
            | with_pose(motion, "largest", *play.largest[name])
            for name in found.moved.loads
        },
    }


def _parts(moved: CaseMotion, record: Mapping[str, Any]) -> Iterator[Part]:
    unit, drive = moved.motion.progress_unit, moved.drive.link
    ended = {label: row for label, row in record["points"].items() if 0.0 < row["largest"] < math.inf}
    if ended:
        largest = (Column("to either side, largest", "mm"), Column("largest at", unit))
        found = []
        for label, row in ended.items():
            most, at, least = Number(row["largest"], "", 3), Number(row["largest_at"], decimals=1), row["smallest"]
            found.append((label, most, at, Number(least, "", 3)))
        yield Table(
            key="play",
            columns=(words("point"), *largest, Column("smallest", "mm")),
            rows=tuple(found),
            caption=f"How far play lets points move with {drive} held, to either side (twice as much both ways)",
        )
    near = record["dead_point_distance"]
    if near["smallest"] > 0.0:
        least, at = Number(near["smallest"], "", 3), Number(near["smallest_at"], unit, decimals=1)
        yield say("With play the least distance to a dead point (a ratio) is {least}, at {at}", least=least, at=at)
    if record["through_dead_point"]:
        where = ", ".join(
            f"{Number(low, decimals=1)} to {Number(high, decimals=1)}" for low, high in record["through_dead_point"]
        )
        yield Text(
            f"Play of pins may take the linkage through a dead point of {drive} at {where} {unit}: neither drive, "
            "joint forces nor free motion have an end there."
        )


def drive_with_play(moved: CaseMotion, record: Mapping[str, Any], load_case: str) -> Text:
    """Return between which ends play may bring the drive torque or force over a motion.

    Parameters
    ----------
    moved : CaseMotion
    record : mapping
        From ``play_record``.
    load_case : str

    Returns
    -------
    Text
    """
    what, unit, at = moved.effort.word, moved.effort.unit, moved.motion.progress_unit
    row = record[f"drive_{what}"][load_case]
    if not math.isfinite(row["largest"] - row["smallest"]):
        return Text(f"With play of pins the drive {what} has no end next to a dead point.")
    facts = {end: Number(row[end], unit) for end in ("smallest", "largest")}
    facts |= {f"{end}_at": Number(row[f"{end}_at"], at, decimals=1) for end in ("smallest", "largest")}
    return say(
        f"With play of pins the drive {what} lies between {{smallest}} at {{smallest_at}} and {{largest}} at "
        "{largest_at}",
        **facts,
    )


def point_play(found: MotionFindings, label: str) -> dict[str, Real]:
    """Return the column of the free motion of a point; none without play.

    Parameters
    ----------
    found : MotionFindings
    label : str
        As ``moving_points`` has it.

    Returns
    -------
    dict of str to array (n,)
    """
    play = found.play
    if play is None:
        return {}
    return {f"{label} play to either side [mm]": play.points[loosest(found.moved.motion, play, label)].free}


def drive_play(found: MotionFindings, load_case: str) -> dict[str, Real]:
    """Return the columns of drive and distance to a dead point with play; none without play.

    Parameters
    ----------
    found : MotionFindings
    load_case : str

    Returns
    -------
    dict of str to array (n,)
    """
    play = found.play
    if play is None:
        return {}
    what, unit = found.moved.effort.word, found.moved.effort.unit.replace("·", " ")
    low, high = play.effort[load_case]
    value, least = play.distance
    return {
        f"least {what} with play [{unit}]": low,
        f"largest {what} with play [{unit}]": high,
        "distance to a dead point [1]": value,
        "least distance with play [1]": least,
    }
