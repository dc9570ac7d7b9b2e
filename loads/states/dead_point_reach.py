"""How far a motion stays away from a dead point of its driven link: over its poses, and beyond its ends."""

import math

import numpy as np

from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.motion import Motion, solve_motion
from alula.geometry.linkage.pose import Pose
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.kinetostatics import dead_points

_TRAVEL = 2.0
"""How far beyond its range a slider is moved in search of a dead point, over the links' lengths together."""
_TURN = math.radians(359.0)
"""How far beyond its range a link is turned in search of one; short of a turn, by which angles are told apart."""
_SHORT = 1e-6
"""By which the search ends before the coordinate's own dead point [rad], or over the longest link."""


def least_dead_point_distance(moved: CaseMotion) -> float:
    """Return the least distance of a motion from a dead point of its driven link, as ``Pose.dead_point_distance``.

    Parameters
    ----------
    moved : CaseMotion
        At n poses.

    Returns
    -------
    float
        0 where a dead point lies in the range, else the least of all poses.
    """
    if moved.dead_points:
        return 0.0
    return min(moved.drive.dead_point_distance(moved.motion.pose(i)) for i in range(len(moved.motion.angles)))


def way_to_dead_point(moved: CaseMotion) -> float:
    """Return how far the coordinate may go on beyond its range until the driven link meets a dead point.

    The branch is followed from both ends, through a turn at the most, as far as the coordinate can fix the pose.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    float
        From the nearer end [rad], or of a slider [mm]; 0 where one lies in the range, infinite where none was met.
    """
    motion = moved.motion
    if moved.dead_points:
        return 0.0
    first, last = int(np.argmin(motion.angles)), int(np.argmax(motion.angles))
    return min(_beyond(moved, first, -1.0), _beyond(moved, last, 1.0))


def _beyond(moved: CaseMotion, number: int, sense: float) -> float:
    """Return the way from a pose of the motion to the next dead point in one sense."""
    motion, linkage = moved.motion, moved.motion.linkage
    most, short = _TURN, _SHORT
    if motion.coordinate.slides:
        most, short = _TRAVEL * len(linkage.moving) * linkage.longest, _SHORT * linkage.longest
    end, pose = float(motion.angles[number]), motion.pose(number)
    try:
        on = _on(motion, pose, end, sense * most)
    except DeadPointError as error:
        way = sense * (error.angle - end)
        if _holds_coordinate(moved):
            return way
        if way <= short:
            return math.inf
        on = _on(motion, pose, end, sense * (way - short))
    return min((abs(at - end) for at in dead_points(on, moved.drive)), default=math.inf)


def _on(motion: Motion, pose: Pose, start: float, way: float) -> Motion:
    return solve_motion(pose, [start, start + way], coordinate=motion.coordinate)


def _holds_coordinate(moved: CaseMotion) -> bool:
    """Return whether the drive holds what the motion prescribes, so that both have the same dead points."""
    motion, drive = moved.motion, moved.drive
    held, joint = drive.coordinate(motion.linkage), moved.case.joints[drive.joint]
    return held == motion.coordinate and (held.slides or motion.linkage.ground in joint.links)
