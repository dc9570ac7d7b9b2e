"""Friction at the joints over a motion: drive with and without it, efficiency, what locks or holds itself."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.rubbing import told_direction
from alula.reports.motion.extremes import finite_or_none, stretches
from alula.reports.sections.section import Number, Text, say

Real = NDArray[np.float64]


def friction_over_motion(moved: CaseMotion, work: DriveWork, load_case: str) -> dict[str, Any]:
    """Return friction over a motion as an entry of ``result.json``.

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
        Spans are pairs of values of the coordinate in its unit, or of per cent of the cycle.
    """
    rubbing, motion = moved.rubbing[load_case], moved.motion
    shares = work.efficiency[np.isfinite(work.efficiency)]
    return {
        "direction": rubbing.way,
        "drive_band": [finite_or_none(end) for end in _ends(work)],
        "work": finite_or_none(work.total),
        "work_without": finite_or_none(work.total_without),
        "efficiency_of_motion": finite_or_none(work.of_cycle),
        "efficiency_smallest": float(shares.min()) if shares.size else None,
        "efficiency_largest": float(shares.max()) if shares.size else None,
        "locked": [[float(x) for x in span] for span in rubbing.spans],
        "holds_itself": stretches(motion, work.holds_itself),
    }


def friction_texts(moved: CaseMotion, work: DriveWork, load_case: str) -> Iterator[Text]:
    """Yield what friction does over a motion.

    Parameters
    ----------
    moved : CaseMotion
        With friction.
    work : DriveWork
        Under this load case, with the ends of what friction may be.
    load_case : str

    Yields
    ------
    Text
    """
    record, motion = friction_over_motion(moved, work, load_case), moved.motion
    what, unit = moved.effort.word, moved.effort.unit
    torque, without = (_range(of[load_case]) for of in (moved.torque, moved.frictionless))
    low, high = _ends(work)
    yield say(
        f"Friction, driven {told_direction(record['direction'], motion.coordinate)}: drive {what} "
        f"{{with_low}} to {{with_high}} {unit}, without friction {{without_low}} to {{without_high}} {unit}; with all "
        f"friction that may be {{all_low}} to {{all_high}} {unit}",
        with_low=torque[0],
        with_high=torque[1],
        without_low=without[0],
        without_high=without[1],
        all_low=Number(low, beside=max(abs(low), abs(high))) if math.isfinite(low) else "−∞",
        all_high=Number(high, beside=max(abs(low), abs(high))) if math.isfinite(high) else "∞",
    )
    if record["efficiency_smallest"] is not None:
        of = {key: record[f"efficiency_{key}"] for key in ("smallest", "largest", "of_motion")}
        shares = {key: Number(one, "%", decimals=1, factor=100.0) for key, one in of.items() if one is not None}
        over = ", {of_motion} over the motion" if "of_motion" in shares else ""
        yield say(f"Efficiency {{smallest}} to {{largest}} by pose{over}", **shares)
    if record["work"] is not None:
        lost = Number(record["work"] - record["work_without"], "N·mm", derived=True)
        done = Number(record["work"], "N·mm")
        yield say("Work of the drive over the motion {done}, of it {lost} rubbed", done=done, lost=lost)
    for key, text, why in (
        ("holds_itself", "Holds itself", "the load does not drive it this way"),
        ("locked", "Locks itself", "no drive moves it there"),
    ):
        if record[key]:
            where = " and ".join(f"from {Number(a)} to {Number(b)} {motion.progress_unit}" for a, b in record[key])
            yield Text(f"{text} {where}: {why}.")


def _range(values: Real) -> tuple[Number | str, Number | str]:
    known = values[np.isfinite(values)]
    if not known.size:
        return "not known", "not known"
    low, high = (Number(float(x), beside=float(np.abs(known).max()), derived=True) for x in (known.min(), known.max()))
    return low, high


def _ends(work: DriveWork) -> tuple[float, float]:
    """Return the least and the largest effort of all poses at which it is known as stated."""
    assert work.ends is not None
    known = work.ends[:, np.isfinite(work.effort)]
    return (float(known[0].min()), float(known[1].max())) if known.size else (math.nan, math.nan)
