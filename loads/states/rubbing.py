"""Friction at the joints of a case: the directions of the motion, the loads it makes, where it locks the linkage."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.motion import Motion, solve_motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import Load, at_poses, chosen, reshaped
from alula.loads.records.load_case import LoadCase
from alula.loads.states.kinetostatics import is_determinate
from alula.loads.statics.friction import NOTHING_MORE, Presses, solve_friction
from alula.loads.statics.statics import Drive

Real = NDArray[np.float64]

WAYS = {"forward": 1.0, "backward": -1.0}
CYCLE = "cycle"
"""Direction of a motion that a table states: as its coordinate goes from row to row."""
_BEYOND = 8.0
"""Share of the friction up to which poses beside a locked one are followed, to find where the locking begins."""


def each_direction(case: Case, *, moving: bool = False) -> Case:
    """Return the case with a load case for either direction of the motion, where friction makes them differ.

    A load case that states its direction or a speed keeps its name; so do all where the motion has a speed.

    Parameters
    ----------
    case : Case
    moving : bool, optional
        Whether the case moves as its table [motion] says.

    Returns
    -------
    Case
        The same where no joint has friction.

    Raises
    ------
    CaseError
        For a load case whose direction is against its speed.
    """
    if not rubbing_joints(case):
        return case
    found: dict[str, LoadCase] = {}
    for name, load_case in case.load_cases.items():
        way = load_case.direction if load_case.direction != "both" else _known_way(case, load_case, moving)
        if load_case.speed * WAYS.get(way, 0.0) < 0.0:
            raise CaseError(
                f"load_cases.{name}.direction: it is {way}, against the speed that the load case or the motion states; "
                "leave it out, or state a speed of 0 in the load case"
            )
        ways = {name: way} if way else {f"{name} {way}": way for way in WAYS}
        found |= {title: load_case.model_copy(update={"direction": way}) for title, way in ways.items()}
    return case if found == case.load_cases else case.model_copy(update={"load_cases": found})


def is_of(name: str, stated: str) -> bool:
    """Return True where a load case of ``each_direction`` is the stated one, in either direction.

    Parameters
    ----------
    name, stated : str

    Returns
    -------
    bool
    """
    return name in (stated, *(f"{stated} {way}" for way in WAYS))


def _known_way(case: Case, load_case: LoadCase, moving: bool) -> str:
    """The direction that a speed or a cycle gives; "" where none is stated."""
    speed = load_case.speed
    if moving and case.motion is not None and case.motion.states is not None:
        return CYCLE
    if speed == 0.0 and moving and case.motion is not None and case.motion.rate != (0.0, 0.0):
        ends = case.motion.ends
        speed = math.copysign(1.0, case.motion.speed) if ends is None else ends[1] - ends[0]
    return "" if speed == 0.0 else "forward" if speed > 0.0 else "backward"


def at_one_pose(pose: Pose) -> Motion:
    """Return a pose as a motion of one pose, with the derivatives by its coordinate.

    Parameters
    ----------
    pose : Pose
        With a coordinate, and not at its dead point.

    Returns
    -------
    Motion
    """
    return replace(solve_motion(pose, [pose.held]), q=pose.q[None])


def pose_friction(
    case: Case, load_case: str, pose: Pose, loads: Sequence[Load], presses: Presses = NOTHING_MORE
) -> tuple[Load, ...]:
    """Return the friction at one pose as loads, where equilibrium alone gives the joint forces.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name; it states its direction.
    pose : Pose
        No dead point of the drive.
    loads : sequence of Load
        All else that acts.
    presses : mapping of str to array (1,), optional
        As for ``solve_friction``.

    Returns
    -------
    tuple of Load

    Raises
    ------
    CaseError
        Where the linkage locks itself.
    """
    assert pose.coordinate is not None
    place = at_one_pose(pose).virtual
    way = case.load_cases[load_case].direction
    found = solve_friction(
        place, case.pinned_drive, [at_poses(load, (1,)) for load in loads], WAYS[way], presses=presses
    )
    if found.locked[0]:
        raise CaseError(
            f"load_cases.{load_case}: with friction the linkage locks itself in this pose, driven "
            f"{told_direction(way, pose.coordinate)}: no drive moves it, and joint forces grow without "
            f"bound; with less than {_percent(found.lock[0])} of joints.*.friction it would move. Change the friction, "
            "the pose or the drive, or state the direction of the load case if it never moves that way"
        )
    return tuple(chosen(load, 0) for load in found.loads(place))


def friction_at(
    driven: DrivenClosure,
    place: Placement,
    drive: Drive | None,
    loads: Sequence[Load],
    sense: Real | float,
    presses: Presses = NOTHING_MORE,
) -> tuple[tuple[Load, ...], NDArray[np.bool_]]:
    """Return the friction at one pose or at n as loads, and where it locks the linkage.

    Parameters
    ----------
    driven : DrivenClosure
        The loops of the linkage, with what moves it.
    place : Placement
        Where the links stand.
    drive : Drive or None
    loads : sequence of Load
        All else that acts.
    sense : float or array (...)
        1 where the coordinate grows, -1 where it falls.
    presses : mapping of str to array (...), optional
        As for ``solve_friction``.

    Returns
    -------
    tuple of (tuple of Load, bool array (...))
        Loads mean nothing where the second is true.
    """
    moved = replace(place, qdot=driven.coefficients(place.q)[0], qddot=None).listed
    listed, senses = [reshaped(load, (-1,)) for load in loads], np.broadcast_to(sense, place.shape).ravel()
    found = solve_friction(moved, drive, listed, senses, presses=presses)
    return tuple(reshaped(load, place.shape) for load in found.loads(moved)), np.reshape(found.locked, place.shape)


@dataclass(frozen=True, kw_only=True, eq=False)
class Rubbing:
    """Friction under one load case over a motion.

    Attributes
    ----------
    way : str
        "forward", "backward" or "cycle".
    sense : float or array (n,)
        1 where the coordinate grows, -1 where it falls.
    loads : tuple of Load
        Friction at the n poses; NaN where the linkage is locked.
    locked : array of bool (n,)
        Where no drive moves the linkage.
    spans : tuple of (float, float)
        Stretches in which it is locked, as ``Motion.progress`` tells them.
    """

    way: str
    sense: Real | float
    loads: tuple[Load, ...]
    locked: NDArray[np.bool_]
    spans: tuple[tuple[float, float], ...]


def motion_friction(
    case: Case, load_case: str, motion: Motion, drive: Drive, loads: Sequence[Load], presses: Presses = NOTHING_MORE
) -> Rubbing:
    """Return the friction at the poses of a motion; none at dead points of the drive.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name; it states its direction.
    motion : Motion
        The n poses.
    drive : Drive
    loads : sequence of Load
        All else that acts, at these poses.
    presses : mapping of str to array (n,), optional
        As for ``solve_friction``.

    Returns
    -------
    Rubbing

    Raises
    ------
    CaseError
        Where the joint forces do not follow from equilibrium.
    """
    if not is_determinate(case.linkage):
        raise CaseError(
            f"joints.{rubbing_joints(case)[0]}.friction: the linkage is redundant, so the joint forces over a motion "
            "that friction depends on do not follow from equilibrium; leave friction out, or check single poses"
        )
    way = case.load_cases[load_case].direction
    sense = sense_of(case, load_case, np.arange(len(motion.angles)))
    assert sense is not None
    found = solve_friction(motion.virtual, drive, loads, sense, presses=presses)
    locked, lock = found.locked, found.lock.copy()
    beside = np.flatnonzero(~locked & (np.roll(locked, 1) | np.roll(locked, -1)))
    if len(beside):
        acting = [chosen(at_poses(load, locked.shape), beside) for load in loads]
        own = {name: ratio[beside] for name, ratio in presses.items()}
        place = motion.virtual.chosen(beside)
        here = np.broadcast_to(sense, locked.shape)[beside]
        lock[beside] = solve_friction(place, drive, acting, here, most=_BEYOND, presses=own).lock
    spans = _spans(motion, locked, lock)
    return Rubbing(way=way, sense=sense, loads=found.loads(motion.virtual), locked=locked, spans=spans)


def sense_of(case: Case, load_case: str, rows: NDArray[np.int64] | None) -> Real | float | None:
    """Return in which sense the coordinate moves under a load case.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    rows : array of int (...) or None
        Rows of the cycle at which that is asked, where there is one.

    Returns
    -------
    float, array (...) or None
        1 where it grows, -1 where it falls; None where the load case states no direction.
    """
    way = case.load_cases[load_case].direction
    states = None if case.motion is None else case.motion.states
    if str(way) == CYCLE and states is not None and rows is not None:
        return np.asarray(states.sense[rows])
    return WAYS.get(way)


def _spans(motion: Motion, locked: NDArray[np.bool_], lock: Real) -> tuple[tuple[float, float], ...]:
    """Stretches of the motion that are locked; their ends lie where the share that locks is one."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], locked, [False]]).astype(int)))
    found = []
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        low, high = float(motion.progress[first]), float(motion.progress[end - 1])
        if first > 0:
            low = _crossing(motion, lock, first, first - 1)
        if end < len(locked):
            high = _crossing(motion, lock, end - 1, end)
        found.append((low, high))
    return tuple(found)


def _crossing(motion: Motion, lock: Real, inside: int, outside: int) -> float:
    """Where the share that locks is one, linear between a locked pose and a free one beside it."""
    a, b = float(motion.progress[inside]), float(motion.progress[outside])
    if not math.isfinite(lock[outside]):
        return a
    return a + (b - a) * float((1.0 - lock[inside]) / (lock[outside] - lock[inside]))


def lock_sentence(load_case: str, rubbing: Rubbing, motion: Motion) -> str:
    """Tell where a load case's friction locks the linkage.

    Parameters
    ----------
    load_case : str
    rubbing : Rubbing
    motion : Motion

    Returns
    -------
    str
        A sentence; "" where it is locked nowhere.
    """
    if not rubbing.spans:
        return ""
    where = " and ".join(f"from {low:.4g} to {high:.4g} {motion.progress_unit}" for low, high in rubbing.spans)
    of = motion.coordinate if motion.instants is None else "the cycle"
    return (
        f"load case {load_case}: with friction the linkage locks itself {where} of {of}, driven "
        f"{told_direction(rubbing.way, motion.coordinate)}; no drive moves it there"
    )


def told_direction(way: str, coordinate: Coordinate) -> str:
    """Return a direction of the motion for people.

    Parameters
    ----------
    way : str
        "forward", "backward" or "cycle".
    coordinate : Coordinate
        Of the pose or motion.

    Returns
    -------
    str
    """
    if way == CYCLE:
        return f"as the cycle goes (friction against {coordinate} at each instant)"
    grows = "grows" if way == "forward" else "falls"
    return f"{way} (the {coordinate.measure.word} of {coordinate} {grows})"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"
