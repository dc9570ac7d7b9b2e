"""Friction at the joints over a motion: drive with and without it, efficiency, what locks or holds itself."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.rubbing import told_direction
from alula.reports.motion.extremes import finite_or_none
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
        Spans are pairs of values of the coordinate in its unit.
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
        "locked": [[float(x) for x in motion.told(span)] for span in rubbing.spans],
        "holds_itself": [
            [float(x) for x in motion.told(span)] for span in _stretches(motion.angles, work.holds_itself)
        ],
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
    record, motion, (what, unit) = friction_over_motion(moved, work, load_case), moved.motion, moved.effort
    torque, without = (_range(of[load_case]) for of in (moved.torque, moved.frictionless))
    low, high = _ends(work)
    yield say(
        f"Friction, driven {told_direction(record['direction'], motion.coordinate, motion.slides)}: drive {what} "
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
        text, facts = "Efficiency {smallest} to {largest} by pose", {
            key: _percent(record[f"efficiency_{key}"]) for key in ("smallest", "largest")
        }  # fmt: skip
        if record["efficiency_of_motion"] is not None:
            text, facts = f"{text}, {{motion}} over the motion", facts | {
                "motion": _percent(record["efficiency_of_motion"])
            }  # fmt: skip
        yield say(text, **facts)
    if record["work"] is not None:
        lost = Number(record["work"] - record["work_without"], "N·mm", derived=True)
        done = Number(record["work"], "N·mm")
        yield say("Work of the drive over the motion {done}, of it {lost} rubbed", done=done, lost=lost)
    for key, text, why in (
        ("holds_itself", "Holds itself", "the load does not drive it this way"),
        ("locked", "Locks itself", "no drive moves it there"),
    ):
        if record[key]:
            where = " and ".join(f"from {Number(a)} to {Number(b)} {motion.unit}" for a, b in record[key])
            yield Text(f"{text} {where}: {why}.")


def _percent(share: float) -> Number:
    return Number(share, "%", decimals=1, factor=100.0)


def _range(values: Real) -> tuple[Number | str, Number | str]:
    known = values[np.isfinite(values)]
    if not known.size:
        return "not known", "not known"
    size = float(np.abs(known).max())
    return Number(float(known.min()), beside=size, derived=True), Number(float(known.max()), beside=size, derived=True)


def _ends(work: DriveWork) -> tuple[float, float]:
    """Return the least and the largest effort of all poses at which it is known as stated."""
    assert work.ends is not None
    known = work.ends[:, np.isfinite(work.effort)]
    return (float(known[0].min()), float(known[1].max())) if known.size else (math.nan, math.nan)


def _stretches(angles: Real, true: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """First and last value of the coordinate of every run of true poses."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    return [(float(angles[a]), float(angles[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]
