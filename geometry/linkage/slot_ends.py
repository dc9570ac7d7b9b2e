"""Whether pins stay in their slots over a motion."""

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.motion_record import Motion
from alula.geometry.linkage.pose import Pose

Real = NDArray[np.float64]

_SLACK = 1e-6
"""Of a slot's length, by which a pin may pass its end by rounding."""
_POSES = 181


def refuse_slot_ends(pose: Pose, values: Real, *, coordinate: str | None = None, slides: bool = False) -> None:
    """Refuse a motion that takes a pin out of its slot.

    A cubic spline through 181 poses or more finds how far each pin goes between them.

    Parameters
    ----------
    pose : Pose
        From which the motion starts.
    values : array (n,)
        Of its coordinate, from the first to the last [rad, mm].
    coordinate, slides : optional
        As in ``solve_motion``.

    Raises
    ------
    CaseError
        With how far the pin goes.
    """
    links = pose.linkage.links
    if not any(link.slots for link in links.values()):
        return
    fine = np.linspace(values[0], values[-1], max(len(values), _POSES))
    try:
        motion = solve_motion(pose, fine, coordinate=coordinate, slides=slides)
    except CaseError:
        return  # a motion that does not exist is refused where it is asked for, with its own reason
    for link, record in links.items():
        for point, slot in record.slots.items():
            _refuse(motion, link, point, (slot.first, slot.last))


def _refuse(motion: Motion, link: str, point: str, ends: tuple[float, float]) -> None:
    from scipy.interpolate import CubicSpline

    place, linkage = motion.placement, motion.linkage
    joint = next(name for name in linkage.joints_of(link) if linkage.point_of(name, link) == point)
    other = linkage.joints[joint].links[1]
    arm = place.position(other, linkage.point_of(joint, other)) - place.origin(link)
    along = CubicSpline(steps := np.arange(len(motion.angles)), (np.conj(place.direction(link)) * arm).real)
    at = np.unique([*steps, *along.derivative().roots(extrapolate=False)])
    x, (low, high) = along(at), ends
    slack = _SLACK * (high - low)
    if x.min() < low - slack or x.max() > high + slack:
        raise CaseError(
            f"links.{link}.slots.{point}: over the motion its pin goes from x = {x.min():.6g} to {x.max():.6g} mm, but "
            f"the slot runs from {low:g} to {high:g} mm; lengthen the slot, or shorten the motion"
        )
