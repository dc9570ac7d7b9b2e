"""What the drive does with and without friction: power, work, efficiency, and where the linkage holds itself."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.motion import Motion
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.states.kinetostatics import relative_motion
from alula.loads.states.rubbing import WAYS, at_one_pose
from alula.loads.statics.statics import Drive, Reactions

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class DriveWork:
    """What the drive does with and without friction, at n poses.

    Attributes
    ----------
    way : str
        Direction of the motion, "forward", "backward" or "cycle".
    without, effort : array (n,)
        Torque [N mm] or force [N] of the drive without friction, and with it.
    power_without, power : array (n,)
        Power per unit speed of the coordinate, in the direction of the motion [N mm].
    angles : array (n,)
        The coordinate [rad, mm].
    ends : array (2, n) or None
        Least and largest effort with the friction that may be, infinite where the linkage then locks itself; None where
        they were not calculated.
    """

    way: str
    without: Real
    effort: Real
    power_without: Real
    power: Real
    angles: Real
    ends: Real | None = None

    @property
    def efficiency(self) -> Real:
        """Work out over work in (n,): from 0 to 1; NaN where nothing is driven.

        Where the drive moves the load, it is the power without friction over that with it; where the load moves the
        drive, the inverse, and 0 where the load cannot.
        """
        return efficiency(self.power_without, self.power)

    @property
    def total_without(self) -> float:
        """Work of the drive over all poses without friction [N mm]; zero where rounding alone is left."""
        whole, sizes = (self._integral(power) for power in (self.power_without, np.abs(self.power_without)))
        return 0.0 if abs(whole) <= 1e-9 * sizes else whole

    @property
    def total(self) -> float:
        """Work of the drive over all poses with friction [N mm]; NaN where it is locked or at a dead point."""
        return self._integral(self.power)

    @property
    def of_cycle(self) -> float:
        """Work out over work in over all poses; NaN where no work is left over them without friction."""
        return float(efficiency(self.total_without, self.total))

    def between(self, efforts: Sequence[Real | float]) -> "DriveWork":
        """Return the same with the ends of what friction may be.

        Parameters
        ----------
        efforts : sequence of array (n,) or float
            Of the drive, with the least and with the largest friction; NaN where the linkage then locks itself.

        Returns
        -------
        DriveWork
        """
        drives = np.where(np.sign(self.power) == np.sign(self.effort), 1.0, -1.0)  # the sense of efforts that drive
        every = [np.where(np.isnan(one), drives * np.inf, one) for one in efforts]
        known = [self.effort, *every]
        return replace(self, ends=np.array([np.minimum.reduce(known), np.maximum.reduce(known)]))

    def _integral(self, power: Real) -> float:
        return float(np.trapezoid(power, np.concatenate([[0.0], np.abs(np.diff(self.angles)).cumsum()])))

    @property
    def holds_itself(self) -> NDArray[np.bool_]:
        """True (n,) where the load would move the linkage without friction, and does not with it."""
        rounding = 1e-12 * float(np.nanmax(np.abs(self.power_without), initial=0.0))
        return np.asarray((self.power_without < -rounding) & (self.power >= 0.0))


def efficiency(without: Real | float, power: Real | float) -> Real:
    """Return work out over work in from the drive's work without friction and with it.

    Parameters
    ----------
    without, power : float or array (...)
        In the direction of the motion; negative where the load moves the drive. ``power`` is the larger of the two.

    Returns
    -------
    array (...)
        From 0 to 1; NaN where no work is done or it is not known.

    References
    ----------
    Norton, Design of Machinery, 5th ed., chapter 6 (mechanical efficiency).
    """
    out, given = np.asarray(without, dtype=float), np.asarray(power, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(out > 0.0, out / given, np.maximum(np.where(out < 0.0, given / out, np.nan), 0.0))


def drive_work(motion: Motion, drive: Drive, way: tuple[str, Real | float], without: Real, effort: Real) -> DriveWork:
    """Return what the drive does with and without friction.

    Parameters
    ----------
    motion : Motion
        The n poses.
    drive : Drive
    way : tuple of (str, float or array (n,))
        Direction of the motion and its sense, 1 where the coordinate grows and -1 where it falls.
    without, effort : array (n,)
        Torque [N mm] or force [N] of the drive without friction, and with it.

    Returns
    -------
    DriveWork
    """
    moved = way[1] * relative_motion(motion, drive)
    return DriveWork(
        way=way[0],
        without=without,
        effort=effort,
        power_without=without * moved,
        power=effort * moved,
        angles=motion.angles,
    )


def pose_work(case: Case, load_case: str, pose: Pose, without: Reactions, reactions: Reactions) -> DriveWork:
    """Return what the drive does with and without friction at one pose.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name; it states its direction.
    pose : Pose
    without, reactions : Reactions
        Without friction, and with it.

    Returns
    -------
    DriveWork
        At n = 1 pose.
    """
    drive = case.pinned_drive
    assert drive is not None
    efforts = (np.array([one.drive_torque + one.drive_force]) for one in (without, reactions))
    way = case.load_cases[load_case].direction
    return drive_work(at_one_pose(pose), drive, (way, WAYS[way]), *efforts)
