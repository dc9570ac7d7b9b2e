"""Moving a linkage along one branch to stated values of its coordinate."""

import math

import numpy as np
from numpy.typing import ArrayLike

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import follow
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.motion_record import BLOCK, Motion
from alula.geometry.linkage.pose_record import Pose

__all__ = ["Motion", "solve_motion"]


def solve_motion(
    pose: Pose,
    angles: ArrayLike,
    *,
    speed: ArrayLike = 0.0,
    acceleration: ArrayLike = 0.0,
    coordinate: str | None = None,
    slides: bool = False,
) -> Motion:
    """Move a linkage from a start pose along its branch to every one of the given angles.

    Parameters
    ----------
    pose : Pose
        Where the branch is entered; its angle counts as its multiple, by full turns, that is nearest to the angles.
    angles : array_like
        Angles (n,) of the coordinate in any order [rad], or travels [mm].
    speed : array_like
        Angular speed of the driven link [rad/s] (of a slider its speed [mm/s]), one or (n,).
    acceleration : array_like
        Angular acceleration of it [rad/s²] (of a slider its acceleration [mm/s²]), one or (n,).
    coordinate : str, optional
        Name of the link whose angle is prescribed; the pose's coordinate unless given.
    slides : bool
        Whether the coordinate is a slider or slot.

    Returns
    -------
    Motion
        The motion.

    Raises
    ------
    DeadPointError
        (a ``CaseError``) where a dead point, or a crossing of two branches, lies on the
        way, with its angle to some 1e-9 rad; ``CaseError`` for a link that does not move.
    """
    name = coordinate or pose.coordinate
    slides = slides if coordinate else pose.slides
    known, what = (pose.closure.slots, "slider or slot") if slides else (pose.linkage.moving, "moving link")
    if name is None or name not in known:
        raise CaseError(f"motion.coordinate: '{name}' is not a {what}; choose one of {', '.join(known) or 'none'}")
    wanted = np.asarray(angles, dtype=float)
    if wanted.ndim != 1 or not len(wanted) or not np.all(np.isfinite(wanted)):
        raise CaseError("motion: the angles must be a list of at least one finite number; give the poses' angles")
    driven = DrivenClosure(pose.closure, name, slides)
    low, high = float(wanted.min()), float(wanted.max())
    start = pose.q.copy()
    here = float(start[driven.column])
    turns = 0 if slides else round((0.5 * (low + high) - here) / (2.0 * math.pi))
    start[driven.column] = here + 2.0 * math.pi * turns
    track = follow(driven, start, low, high)
    q = track.at(wanted)
    first, second = np.empty_like(q), np.empty_like(q)
    for i in range(0, len(q), BLOCK):
        first[i : i + BLOCK], second[i : i + BLOCK] = driven.coefficients(q[i : i + BLOCK])
    return Motion(
        linkage=pose.linkage,
        coordinate=name,
        angles=wanted,
        speed=np.broadcast_to(np.asarray(speed, dtype=float), wanted.shape).copy(),
        acceleration=np.broadcast_to(np.asarray(acceleration, dtype=float), wanted.shape).copy(),
        q=q,
        first=first,
        second=second,
        residual=max(
            float(np.max(np.abs(driven.gaps(q[i : i + BLOCK])), initial=0.0)) for i in range(0, len(q), BLOCK)
        ),
        track=track,
    )
