"""What the play of pins does over a motion, as data, as lines of text and as columns of tables."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.of_motion import MotionFindings
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.joint_paths import loosest, moving_points
from alula.reports.words.numbers import number

Real = NDArray[np.float64]


def motion_play_record(found: MotionFindings) -> dict[str, Any] | None:
    """Return what play does over a motion as plain data.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without play. Numbers without end are infinite.
    """
    moved, play = found.moved, found.play
    if play is None:
        return None
    points = {}
    for label in moving_points(moved.motion):
        point = play.points[loosest(moved.motion, play, label)]
        points[label] = {"smallest": float(point.free.min()), **_told(moved, "largest", *point.farthest)}
    return {
        "clearances": play.clearances,
        "through_dead_point": list(_spans(moved, play.passes)),
        "dead_point_distance": _told(moved, "smallest", *play.nearest),
        "points": points,
        f"drive_{moved.effort[0]}": {
            name: _told(moved, "smallest", *play.smallest[name]) | _told(moved, "largest", *play.largest[name])
            for name in moved.loads
        },
    }


def _told(moved: CaseMotion, what: str, value: float, pose: int) -> dict[str, float]:
    return {what: float(value), f"{what}_at": float(moved.motion.told(moved.motion.angles[pose]))}


def _spans(moved: CaseMotion, passes: NDArray[np.bool_]) -> Iterator[list[float]]:
    """Values of the coordinate between which play may take the linkage through a dead point."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], passes, [False]]).astype(int)))
    for first, after in edges.reshape(-1, 2):
        yield [float(moved.motion.told(moved.motion.angles[i])) for i in (first, after - 1)]


def play_lines(moved: CaseMotion, found: dict[str, Any]) -> list[str]:
    """Return what play does over a motion, a sentence a line.

    Parameters
    ----------
    moved : CaseMotion
    found : dict
        From ``motion_play_record``.

    Returns
    -------
    list of str
    """
    unit, points, lines = moved.motion.unit, found["points"], []
    ended = {label: row for label, row in points.items() if 0.0 < row["largest"] < math.inf}
    if ended:
        told = "; ".join(f"{label} by up to {_reach(row, unit)}" for label, row in ended.items())
        held = f"with {moved.drive.link} held, to either side (twice as much both ways)"
        lines.append(f"Play of pins lets points move {held}: {told}.")
    near = found["dead_point_distance"]
    if near["smallest"] > 0.0:
        lines.append(
            f"With play the least distance to a dead point (a ratio) is {number(near['smallest'], 3)}, at "
            f"{near['smallest_at']:.1f} {unit}."
        )
    if found["through_dead_point"]:
        where = ", ".join(f"{a:.1f} to {b:.1f}" for a, b in found["through_dead_point"])
        lines.append(
            f"Play of pins may take the linkage through a dead point of {moved.drive.link} at {where} {unit}: neither "
            "drive, joint forces nor free motion have an end there."
        )
    return lines


def _reach(row: dict[str, float], unit: str) -> str:
    most, least = number(row["largest"], 3), number(row["smallest"], 3)
    return f"{most} mm" + ("" if most == least else f" (at {row['largest_at']:.1f} {unit}; at least {least} mm)")


def drive_line(moved: CaseMotion, found: dict[str, Any], load_case: str) -> str:
    """Return between which ends play may bring the drive torque or force over a motion.

    Parameters
    ----------
    moved : CaseMotion
    found : dict
        From ``motion_play_record``.
    load_case : str

    Returns
    -------
    str
    """
    (what, unit), row, at = moved.effort, found[f"drive_{moved.effort[0]}"][load_case], moved.motion.unit
    if not math.isfinite(row["largest"] - row["smallest"]):
        return f"with play of pins the drive {what} has no end next to a dead point"
    low, high = (f"{number(row[end])} {unit} at {row[f'{end}_at']:.1f} {at}" for end in ("smallest", "largest"))
    return f"with play of pins the drive {what} lies between {low} and {high}"


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
    (what, unit), (low, high) = found.moved.effort, play.effort[load_case]
    unit = unit.replace("·", " ")
    value, least = play.distance
    return {
        f"least {what} with play [{unit}]": low,
        f"largest {what} with play [{unit}]": high,
        "distance to a dead point [1]": value,
        "least distance with play [1]": least,
    }
