"""Moving a linkage along one branch to stated values of its coordinate, and whether pins stay in their slots then."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import Track, follow
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.motion_record import BLOCK, Instants, Motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose_record import Pose

__all__ = ["Instants", "Motion", "ends_of", "refuse_beyond_slots", "refuse_slot_ends", "solve_motion", "still_motion"]

Real = NDArray[np.float64]

_SLACK = 1e-6
"""Of a slot's length, by which a pin may pass its end by rounding."""
_POSES = 181


def solve_motion(
    pose: Pose,
    angles: ArrayLike,
    *,
    speed: ArrayLike = 0.0,
    acceleration: ArrayLike = 0.0,
    coordinate: Coordinate | None = None,
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
    coordinate : Coordinate, optional
        What is prescribed; the pose's coordinate unless given.

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
    coordinate = coordinate or pose.coordinate
    slides = coordinate is not None and coordinate.slides
    known, what = (pose.closure.slots, "slider or slot") if slides else (pose.linkage.moving, "moving link")
    if coordinate is None or coordinate.name not in known:
        raise CaseError(
            f"motion.coordinate: '{coordinate}' is not a {what}; choose one of {', '.join(known) or 'none'}"
        )
    wanted = np.asarray(angles, dtype=float)
    if wanted.ndim != 1 or not len(wanted) or not np.all(np.isfinite(wanted)):
        raise CaseError("motion: the angles must be a list of at least one finite number; give the poses' angles")
    driven = DrivenClosure(pose.closure, coordinate)
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
        coordinate=coordinate,
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


def still_motion(pose: Pose, instants: Instants) -> Motion:
    """Return a structure at the instants of a cycle, at each of which it stands in its one pose.

    Parameters
    ----------
    pose : Pose
        Of a structure, without a coordinate.
    instants : Instants

    Returns
    -------
    Motion
        Told by the direction of the first of its links.
    """
    count, coordinate = len(instants.percent), Coordinate(pose.linkage.moving[0])
    q, none = np.tile(pose.q, (count, 1)), np.zeros((count, len(pose.q)))
    still = Track(
        driven=DrivenClosure(pose.closure, coordinate), angles=q[:1, 0], q=q[:1], first=none[:1], second=none[:1]
    )
    return Motion(
        linkage=pose.linkage,
        coordinate=coordinate,
        angles=q[:, 0],
        speed=none[:, 0],
        acceleration=none[:, 0],
        q=q,
        first=none,
        second=none,
        residual=pose.residual,
        track=still,
        instants=instants,
    )


def refuse_slot_ends(pose: Pose, values: Real, *, coordinate: Coordinate | None = None) -> None:
    """Refuse a motion that takes a pin out of its slot.

    A cubic spline through 181 poses or more finds how far each pin goes between them.

    Parameters
    ----------
    pose : Pose
        From which the motion starts.
    values : array (n,)
        Of its coordinate, from the first to the last [rad, mm].
    coordinate : Coordinate, optional
        As in ``solve_motion``.

    Raises
    ------
    CaseError
        With how far the pin goes.
    """
    links = pose.linkage.links
    if not any(link.slots for link in links.values()):
        return
    fine = np.linspace(*ends_of(values), max(len(values), _POSES))
    try:
        motion = solve_motion(pose, fine, coordinate=coordinate)
    except CaseError:
        return  # a motion that does not exist is refused where it is asked for, with its own reason
    for link, record in links.items():
        for point, slot in record.slots.items():
            _refuse(motion, link, point, (slot.first, slot.last))


def refuse_beyond_slots(pose: Pose) -> None:
    """Refuse a pose in which a pin stands beyond an end of its slot.

    Parameters
    ----------
    pose : Pose

    Raises
    ------
    CaseError
        With where the pin stands.
    """
    for link, record in pose.linkage.links.items():
        for point, slot in record.slots.items():
            x, slack = float(_along(pose.placement, link, point)), _SLACK * (slot.last - slot.first)
            if not slot.first - slack <= x <= slot.last + slack:
                raise CaseError(
                    f"links.{link}.slots.{point}: its pin stands at x = {x:.6g} mm, but the slot runs from "
                    f"{slot.first:g} to {slot.last:g} mm; lengthen the slot"
                )


def ends_of(values: Real) -> tuple[float, float]:
    """Return the ends of the way that a coordinate goes.

    Parameters
    ----------
    values : array (n,)
        Of the coordinate, pose by pose [rad, mm].

    Returns
    -------
    tuple of float
        The first and the last; where it turns back on the way, the least and the largest.
    """
    steps = np.sign(np.diff(values))
    if len(steps) and abs(steps.sum()) < len(steps):
        return float(values.min()), float(values.max())
    return float(values[0]), float(values[-1])


def _along(place: Placement, link: str, point: str) -> Real:
    """Return the x at which the pin in a slot stands, in the frame of the link with the slot [mm]."""
    linkage = place.linkage
    joint = linkage.joints_at(link, point)[0]
    other = linkage.joints[joint].links[1]
    arm = place.position(other, linkage.point_of(joint, other)) - place.origin(link)
    return np.asarray((np.conj(place.direction(link)) * arm).real)


def _refuse(motion: Motion, link: str, point: str, ends: tuple[float, float]) -> None:
    from scipy.interpolate import CubicSpline

    along = CubicSpline(steps := np.arange(len(motion.angles)), _along(motion.placement, link, point))
    at = np.unique([*steps, *along.derivative().roots(extrapolate=False)])
    x, (low, high) = along(at), ends
    slack = _SLACK * (high - low)
    if x.min() < low - slack or x.max() > high + slack:
        raise CaseError(
            f"links.{link}.slots.{point}: over the motion its pin goes from x = {x.min():.6g} to {x.max():.6g} mm, but "
            f"the slot runs from {low:g} to {high:g} mm; lengthen the slot, or shorten the motion"
        )
