"""Which harmonics of the drive meet which natural frequencies over a motion, and where.

A linkage that turns evenly moves unevenly: its inertia, and what its loads do, repeat with each turn of the drive, and
are a sum of sines at 1, 2, 3, ... times its turn rate (Fourier). Each of these harmonics excites a natural frequency
that it meets, the less the higher it is. Natural frequencies change over the motion and are known within bands, so
that a harmonic meets one over ranges of the coordinate.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asks
from alula.fea.common.reason import Reason, reason
from alula.fea.vibration.over_motion import FrequencyHistory, pose_frequencies
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.case import Case
from alula.loads.records.check_spec import FrequencyCheck

Real = NDArray[np.float64]
HIGHEST = 10
"""The highest harmonic that is looked at: those of a linkage die away fast, and in a band some high one always lies."""


@dataclass(frozen=True, kw_only=True)
class Meeting:
    """A harmonic of the drive within the band of a natural frequency.

    Attributes
    ----------
    harmonic : int
        Times the driving frequency.
    frequency : float
        Of the harmonic [Hz].
    mode : int
        Number of the natural frequency, 1 for the lowest.
    ranges : tuple of tuple of 2 float
        First and last value of the coordinate of every range over which they meet [rad, mm].
    """

    harmonic: int
    frequency: float
    mode: int
    ranges: tuple[tuple[float, float], ...]


def meetings(history: FrequencyHistory) -> tuple[Meeting, ...]:
    """Return the harmonics that meet a natural frequency, the lowest harmonic first.

    Between two poses the ends of a band are taken to run straight.

    Parameters
    ----------
    history : FrequencyHistory
        Natural frequencies over a motion.

    Returns
    -------
    tuple of Meeting
        Empty where nothing drives.
    """
    if not history.driving > 0.0:
        return ()
    return tuple(
        Meeting(harmonic=harmonic, frequency=harmonic * history.driving, mode=k + 1, ranges=ranges)
        for harmonic in range(1, HIGHEST + 1)
        for k in range(history.low.shape[1])
        if (ranges := _within(history.at, history.low[:, k], history.high[:, k], harmonic * history.driving))
    )


def _within(at: Real, low: Real, high: Real, level: float) -> tuple[tuple[float, float], ...]:
    """Return the ranges over which a level lies between two curves."""
    if len(at) == 1:
        return ((float(at[0]), float(at[0])),) if low[0] <= level <= high[0] else ()
    pieces: list[tuple[float, float]] = []
    for i in np.flatnonzero(np.isfinite(low[1:] + low[:-1] + high[1:] + high[:-1])):
        first, last = _below(low[i], low[i + 1], level)
        least, most = _below(-high[i], -high[i + 1], -level)
        first, last = max(first, least), min(last, most)
        if first > last:
            continue
        start, end = (float(at[i] + share * (at[i + 1] - at[i])) for share in (first, last))
        if pieces and math.isclose(pieces[-1][1], start, rel_tol=1e-12, abs_tol=1e-12):
            start = pieces.pop()[0]
        pieces.append((start, end))
    return tuple(pieces)


def _below(first: float, last: float, level: float) -> tuple[float, float]:
    """Return where a straight line from ``first`` to ``last`` is at most ``level``, as shares of the way."""
    if max(first, last) <= level:
        return 0.0, 1.0
    if min(first, last) > level:
        return 1.0, 0.0
    crossing = (level - first) / (last - first)
    return (0.0, crossing) if first <= level else (crossing, 1.0)


def nearest_harmonic(case: Case) -> Reason | None:
    """Return which harmonic comes nearest to the lowest natural frequency in the stated pose, where no check asks.

    By the frame of centre lines alone: some 20 ms of processor time for a four-bar linkage.

    Parameters
    ----------
    case : Case

    Returns
    -------
    Reason or None
        Of the load case in which one comes nearest; None where a check asks for frequencies, nothing drives, or no
        natural frequency is found.
    """
    if asks(case, FrequencyCheck):
        return None
    driven = {name: one for name, one in case.load_cases.items() if one.speed != 0.0}
    if not driven:
        return None  # before anything is weighed
    try:
        found = pose_frequencies(case.model_copy(update={"load_cases": driven}), count=1)
    except (CannotRunError, CaseError):
        return None
    nearest, said = math.inf, None
    for history in found.values():
        frequency, driving = history.lowest.modes[0].frequency, history.driving
        if not 0.0 < frequency.value < math.inf:
            continue
        far = [abs(math.log(n * driving / frequency.value)) for n in range(1, HIGHEST + 1)]
        harmonic = 1 + far.index(min(far))
        ratio = harmonic * driving / frequency.value
        if abs(math.log(ratio)) < nearest:
            nearest = abs(math.log(ratio))
            said = reason("harmonic_in_pose", harmonic=harmonic, rpm=60.0 * driving, ratio=ratio, frequency=frequency)
    return said
