"""Friction at the joints: drive with and without it, efficiency, what locks or holds itself, as data and as text."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.loads.records.applied import Load
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.rubbing import told_direction
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.rounding import size_of
from alula.loads.statics.statics import Reactions
from alula.reports.words.numbers import number

Real = NDArray[np.float64]


def friction_record(work: DriveWork, loads: Sequence[Load]) -> dict[str, Any]:
    """Return friction at one pose as plain data.

    Parameters
    ----------
    work : DriveWork
        At that pose.
    loads : sequence of Load
        All loads of the load case, friction among them.

    Returns
    -------
    dict
        Efforts of the drive [N mm or N], efficiency, and by joint the force [N] and moment [N mm] of its first link on
        its second by friction.
    """
    return {
        "direction": work.way,
        "drive_without": float(work.without[0]),
        "drive": float(work.effort[0]),
        "drive_band": None if work.ends is None else [_finite(end) for end in _ends(work)],
        "efficiency": _finite(work.efficiency[0]),
        "holds_itself": bool(work.holds_itself[0]),
        "joints": {
            joint: {"force": wrench[:2].tolist(), "moment": float(wrench[5])}
            for joint, wrench in friction_wrenches(loads).items()
        },
    }


def friction_sentence(work: DriveWork, reactions: Reactions) -> str:
    """Tell what friction does to the drive at one pose.

    Parameters
    ----------
    work : DriveWork
        At that pose.
    reactions : Reactions
        With friction.

    Returns
    -------
    str
    """
    pose, drive = reactions.pose, reactions.drive
    pushes = drive is not None and drive.pushes(pose.linkage)
    unit, size = ("N", size_of(reactions)[0]) if pushes else ("N·mm", size_of(reactions)[5])
    found = (
        f"Friction, driven {told_direction(work.way, pose.coordinate, pose.slides)}: drive "
        f"{number(float(work.effort[0]), beside=size)}{_between(work, size)} {unit}, without friction "
        f"{number(float(work.without[0]), beside=size)} {unit}"
    )
    if bool(work.holds_itself[0]):
        return f"{found}; the linkage holds itself: the load does not drive it this way"
    share = float(work.efficiency[0])
    return found if math.isnan(share) else f"{found}; efficiency {100.0 * share:.1f} %"


def _between(work: DriveWork, size: float) -> str:
    """Return the ends of the effort at one pose, for people."""
    return "" if work.ends is None else f" ({_told(work, size)})"


def _ends(work: DriveWork) -> tuple[float, float]:
    """Return the least and the largest effort of all poses at which it is known as stated."""
    assert work.ends is not None
    known = work.ends[:, np.isfinite(work.effort)]
    return (float(known[0].min()), float(known[1].max())) if known.size else (math.nan, math.nan)


def _told(work: DriveWork, size: float | None = None) -> str:
    ends = _ends(work)
    size = max((abs(end) for end in ends if math.isfinite(end)), default=1.0) if size is None else size
    low, high = (number(end, beside=size) if math.isfinite(end) else "−∞" if end < 0.0 else "∞" for end in ends)
    return f"{low} to {high}"


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
