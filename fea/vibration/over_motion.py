"""Natural frequencies of a case over its motion, for every load case with its own prestress and carried masses.

The motion is looked at in poses that are evenly spaced. The least first frequency between them is found by golden
section (Press et al., Numerical Recipes, 3rd ed., section 10.2) beside the least pose, on a grid ``FINE`` times as
fine. Poses without equilibrium, such as dead points of the driven link, are left out. Friction is left out too.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import reason
from alula.fea.common.threads import bounded
from alula.fea.frame.build import build_frame
from alula.fea.vibration.link_modes import LinkModes, link_modes
from alula.fea.vibration.linkage_modes import LinkageModes, linkage_modes, on_rims
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.ties import TIE, first_least
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import Load, PartMass, chosen
from alula.loads.states.actions import acting_loads, placed
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.loads.states.masses import part_masses
from alula.loads.states.standing import stand

Floats = NDArray[np.float64]

FINE = 8
"""Poses of the fine grid from one pose to the next."""
_GOLDEN = (3.0 - math.sqrt(5.0)) / 2.0


@dataclass(frozen=True, kw_only=True, eq=False)
class FrequencyHistory:
    """The lowest natural frequencies of a linkage over its motion, under one load case.

    Attributes
    ----------
    driving : float
        Turns of the drive per second [Hz]; 0 where no angular speed is stated.
    at : ndarray, shape (k,)
        Values of the motion's coordinate [rad, mm]; the pose's own where there is no motion, 0 for a structure.
    frequencies : ndarray, shape (k, count)
        [Hz]; 0 where unstable, infinite where so few unknowns have mass.
    low : ndarray, shape (k, count)
        Low ends of their bands.
    high : ndarray, shape (k, count)
        High ends of their bands.
    lowest : LinkageModes
        At the pose where the low end of the first frequency is least.
    left_out : tuple of float
        Values of the coordinate at which there is no equilibrium.
    """

    driving: float
    at: Floats
    frequencies: Floats
    low: Floats
    high: Floats
    lowest: LinkageModes
    left_out: tuple[float, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseFrequencies:
    """The natural frequencies of a case.

    Attributes
    ----------
    case : Case
    histories : mapping of str to FrequencyHistory
        By load case.
    links : mapping of str to LinkModes
        Of each link with a part, by itself.
    """

    case: Case
    histories: Mapping[str, FrequencyHistory]
    links: Mapping[str, LinkModes] = field(default_factory=dict)


def case_frequencies(
    case: Case, *, poses: int = 25, count: int = 4, solid: bool = False, threads: int = 2
) -> CaseFrequencies:
    """Return the natural frequencies of a case over its motion, or in its pose where it states none.

    Parameters
    ----------
    case : Case
    poses : int, optional
        Poses over the motion, both ends included.
    count : int, optional
        Frequencies of each pose.
    solid : bool, optional
        Whether links by themselves are solids; else beams.
    threads : int, optional
        Of the solids' solver.

    Returns
    -------
    CaseFrequencies

    Raises
    ------
    CaseError
        For a linkage without parts, or a pose that cannot be assembled.
    CannotRunError
        Where no pose has frequencies.
    """
    case = _smooth(case)
    masses = part_masses(case)
    with bounded(1):  # matrices are small, and threads would wait for one another
        histories = _moving(case, masses, poses, count) if case.sweeps else _standing(case, masses, count)
    own = threads if solid else 1
    links = {x: link_modes(case, x, count=count, solid=solid, threads=own) for x in case.checked_links}
    return CaseFrequencies(case=case, histories=histories, links=links)


def pose_frequencies(case: Case, *, count: int = 4) -> dict[str, FrequencyHistory]:
    """Return the natural frequencies of a linkage in its pose, under every load case.

    Parameters
    ----------
    case : Case
    count : int, optional
        Frequencies.

    Returns
    -------
    dict of str to FrequencyHistory
        Each of one pose.

    Raises
    ------
    CaseError, CannotRunError
        As ``case_frequencies``.
    """
    case = _smooth(case)
    with bounded(1):
        return _standing(case, part_masses(case), count)


def _smooth(case: Case) -> Case:
    """Return the case without friction."""
    if not rubbing_joints(case):
        return case
    joints = {name: joint.model_copy(update={"friction": 0.0}) for name, joint in case.joints.items()}
    return case.model_copy(update={"joints": joints})


def _standing(case: Case, masses: Mapping[str, PartMass], count: int) -> dict[str, FrequencyHistory]:
    found = {}
    for name, load_case in case.load_cases.items():
        standing = stand(case, name, masses)
        own, pose = standing.case, standing.pose
        loads = acting_loads(own, load_case, placed(pose, load_case.speed), masses)
        modes = on_rims(own, _at(own, name, pose, loads, masses, count), masses)
        at = pose.held if pose.coordinate is not None else 0.0
        found[name] = _history(abs(load_case.speed) / (2.0 * math.pi), {at: modes}, (), count)
    return found


def _moving(case: Case, masses: Mapping[str, PartMass], poses: int, count: int) -> dict[str, FrequencyHistory]:
    assert case.motion is not None
    fine = (poses - 1) * FINE + 1
    motion = case.motion.through(None).model_copy(update={"poses": fine})  # of a cycle, over its range once
    moved = solve_case_motion(case.model_copy(update={"motion": motion}))
    return {name: _over(moved, name, masses, count) for name in moved.loads}


def _over(moved: CaseMotion, name: str, masses: Mapping[str, PartMass], count: int) -> FrequencyHistory:
    case, motion = moved.case, moved.motion
    known: dict[int, LinkageModes | None] = {}

    def modes(i: int) -> LinkageModes | None:
        if i not in known:
            known[i] = None
            if np.isfinite(moved.torque[name][i]):
                loads = [chosen(load, i) for load in moved.loads[name]]
                try:
                    known[i] = _at(case, name, motion.pose(i), loads, masses, count)
                except (CannotRunError, CaseError):
                    known[i] = None
        return known[i]

    def least(i: int) -> tuple[float, float]:
        found = modes(i)
        return (math.inf, math.inf) if found is None else _ends(found)

    size = len(motion.angles)
    coarse = range(0, size, FINE)
    best = coarse[lowest_pose(*np.transpose([least(i) for i in coarse]))]
    if modes(best) is None:
        raise CannotRunError(f"load case {name}: no pose of the motion has an equilibrium that a frame can hold")
    _least_between(least, max(best - FINE, 0), min(best + FINE, size - 1))
    found = {i: one for i, one in sorted(known.items()) if one is not None}
    told = list(found)[lowest_pose(*np.transpose([_ends(one) for one in found.values()]))]
    known[told] = on_rims(case, found[told], masses)
    spec, load_case = case.motion, case.load_cases[name]
    assert spec is not None
    speed = load_case.speed or spec.speed
    at = {float(motion.angles[i]): one for i, one in sorted(known.items()) if one is not None}
    left_out = tuple(float(motion.angles[i]) for i, one in sorted(known.items()) if one is None)
    return _history(abs(speed) / (2.0 * math.pi), at, left_out, count)


def _ends(modes: LinkageModes) -> tuple[float, float]:
    """Low end of the lowest frequency, and the frequency, which tells where pins that run leave all poses at 0."""
    return modes.modes[0].frequency.low, modes.modes[0].frequency.value


def _least_between(function: Callable[[int], tuple[float, float]], low: int, high: int) -> None:
    """Look for the least value of a function of whole numbers, which keeps what it found, by golden section."""
    while high - low > 2:
        step = max(round(_GOLDEN * (high - low)), 1)
        first, second = low + step, high - step
        if first >= second:
            first, second = low + 1, high - 1
        found = np.transpose([function(second), function(first)])
        low, high = (low, second) if lowest_pose(*found) else (first, high)
    for i in range(low, high + 1):
        function(i)


def _at(
    case: Case, name: str, pose: Pose, loads: Sequence[Load], masses: Mapping[str, PartMass], count: int
) -> LinkageModes:
    frame = build_frame(case, pose, loads, held=case.pinned_drive, spatial=True)
    return linkage_modes(case, name, frame, masses, count=count)


def lowest_pose(low: Floats, value: Floats) -> int:
    """Return the number of the pose of the least low end; of several alike, such as 0, that of the least value.

    Parameters
    ----------
    low, value : array (n,)
        Lowest natural frequency of every pose, and the low end of its band [Hz].

    Returns
    -------
    int
    """
    least = low[first_least(low)]
    return first_least(np.where(low <= (1.0 + TIE) * least, value, math.inf))


def _history(
    driving: float, found: Mapping[float, LinkageModes], left_out: tuple[float, ...], count: int
) -> FrequencyHistory:
    bands = [[mode.frequency for mode in modes.modes] for modes in found.values()]

    def rows(end: str) -> Floats:
        values = [[float(getattr(band, end)) for band in row] for row in bands]
        return np.array([row + [math.inf] * (count - len(row)) for row in values])

    first = [modes.modes[0].frequency for modes in found.values()]
    number = lowest_pose(np.array([band.low for band in first]), np.array([band.value for band in first]))
    lowest = list(found.values())[number]
    if left_out:
        lowest = replace(lowest, notes=(*lowest.notes, reason("poses_left_out", count=len(left_out))))
    return FrequencyHistory(
        driving=driving,
        at=np.array(list(found)),
        frequencies=rows("value"),
        low=rows("low"),
        high=rows("high"),
        lowest=lowest,
        left_out=left_out,
    )
