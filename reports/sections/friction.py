"""Friction at the joints: drive with and without it, efficiency, what locks or holds itself, as data and as text."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.loads.records.applied import Load
from alula.loads.states.case_motion import CaseMotion
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


def motion_friction_record(moved: CaseMotion, work: DriveWork, load_case: str) -> dict[str, Any]:
    """Return friction over a motion as plain data.

    Parameters
    ----------
    moved : CaseMotion
        With friction.
    work : DriveWork
        Under this load case, with the ends of what friction may be.
    load_case : str

    Returns
    -------
    dict
        Spans are pairs of values of the coordinate in its unit.
    """
    rubbing, motion = moved.rubbing[load_case], moved.motion
    shares = work.efficiency[np.isfinite(work.efficiency)]
    return {
        "direction": rubbing.way,
        "drive_band": [_finite(end) for end in _ends(work)],
        "work": _finite(work.total),
        "work_without": _finite(work.total_without),
        "efficiency_of_motion": _finite(work.of_cycle),
        "efficiency_smallest": float(shares.min()) if shares.size else None,
        "efficiency_largest": float(shares.max()) if shares.size else None,
        "locked": [[float(x) for x in motion.told(span)] for span in rubbing.spans],
        "holds_itself": [
            [float(x) for x in motion.told(span)] for span in _stretches(motion.angles, work.holds_itself)
        ],
    }


def motion_friction_lines(moved: CaseMotion, work: DriveWork, load_case: str) -> list[str]:
    """Return friction over a motion as lines of text.

    Parameters
    ----------
    moved : CaseMotion
        With friction.
    work : DriveWork
        Under this load case, with the ends of what friction may be.
    load_case : str

    Returns
    -------
    list of str
    """
    data, motion = motion_friction_record(moved, work, load_case), moved.motion
    without = moved.frictionless[load_case]
    way = told_direction(data["direction"], motion.coordinate, motion.slides)
    what, unit, torque = *moved.effort, moved.torque[load_case]
    found = [
        f"friction, driven {way}: drive {what} {_range(torque)} {unit}, without friction {_range(without)} {unit}",
        f"with all friction that may be: drive {what} {_told(work)} {unit}",
    ]
    if data["efficiency_smallest"] is not None:
        text = f"efficiency {_percent(data['efficiency_smallest'])} to {_percent(data['efficiency_largest'])} by pose"
        if data["efficiency_of_motion"] is not None:
            text += f", {_percent(data['efficiency_of_motion'])} over the motion"
        found.append(text)
    if data["work"] is not None:
        lost = data["work"] - data["work_without"]
        found.append(f"work of the drive over the motion {number(data['work'])} N·mm, of it {number(lost)} N·mm rubbed")
    if data["holds_itself"]:
        found.append(f"holds itself {_spans(data['holds_itself'], motion.unit)}: the load does not drive it this way")
    if data["locked"]:
        found.append(f"locks itself {_spans(data['locked'], motion.unit)}: no drive moves it there")
    return found


def _range(values: Real) -> str:
    known = values[np.isfinite(values)]
    if not known.size:
        return "not known"
    size = float(np.abs(known).max())
    return " to ".join(number(float(end), beside=size) for end in (known.min(), known.max()))


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


def _spans(spans: list[list[float]], unit: str) -> str:
    return " and ".join(f"from {low:.4g} to {high:.4g} {unit}" for low, high in spans)


def _stretches(angles: Real, true: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """First and last value of the coordinate of every run of true poses."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    return [(float(angles[a]), float(angles[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
