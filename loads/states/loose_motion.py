"""What the play of pins does over a motion: how far points, drive effort, joint forces and dead points may be off.

Every joint may stand anywhere in its play at every pose, since forces turn round as the linkage moves. All numbers are
to first order, from the gradients of ``alula.loads.states.play`` at all poses at once; a single pose is also solved at
its worst offsets (``Play``). Offsets stand still in global axes: the speed at which a pin crosses its play is left out.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.ties import first_largest, first_least
from alula.geometry.linkage.play import LooseJoints
from alula.loads.case.joint_rules import clearances
from alula.loads.states.case_motion import CaseMotion, with_inertia
from alula.loads.states.play import Play, held_rows, play_at

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
_ROUNDING = 1e-12
"""Free motion below this share of the longest link is none."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LooseMotion:
    """A case over the n poses of its motion, with play.

    Attributes
    ----------
    moved : CaseMotion
        Without play.
    poses : int array (m,)
        Those that are not at a dead point of the drive: at the others nothing has an end.
    """

    moved: CaseMotion
    poses: NDArray[np.int64]

    @property
    def clearances(self) -> dict[str, float]:
        """Joint -> its play [mm]."""
        return clearances(self.moved.case)

    @cached_property
    def loose(self) -> LooseJoints:
        """The joints with play at ``poses``, with the drive held."""
        place, radii = self.moved.motion.placement.chosen(self.poses), self.clearances
        held = held_rows(place, self.moved.drive)
        return LooseJoints(place=place.at_rest, radii={n: play / 2.0 for n, play in radii.items()}, held=held)

    def _spread(self, values: NDArray[Any], beyond: float) -> NDArray[Any]:
        found = np.full((len(self.moved.motion.angles), *values.shape[1:]), beyond, dtype=values.dtype)
        found[self.poses] = values
        return found

    def outline(self, link: str, point: str) -> Complex:
        """Return the outline of where a point may be at each pose, about its place without play.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex array (n, directions)
            [mm]; NaN at a dead point.
        """
        return self._spread(self.loose.outline(link, point), np.nan)

    def free_motion(self, link: str, point: str) -> Real:
        """Return how far a point may go to either side with the drive held.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        array (n,)
            [mm]; infinite where play may take the linkage through a dead point.
        """
        free = np.abs(self.loose.outline(link, point)).max(axis=-1)
        free = np.where(free > _ROUNDING * self.moved.motion.linkage.longest, free, 0.0)
        return np.where(self.passes, np.inf, self._spread(free, np.inf))

    @cached_property
    def plays(self) -> Mapping[str, Play]:
        """Load case -> its play at ``poses``."""
        found = {}
        for name in self.moved.loads:
            play = self.play(name, self.poses)
            assert play is not None
            found[name] = play
        return found

    def play(self, load_case: str, poses: int | NDArray[np.int64]) -> Play | None:
        """Return what play does under a load case at one or some poses.

        Parameters
        ----------
        load_case : str
            Its name.
        poses : int or int array (m,)

        Returns
        -------
        Play or None
            As ``play_at``.
        """
        moved, case = self.moved, self.moved.case
        motion = moved.forces[load_case].motion
        moves = float(with_inertia(case, load_case))
        place, rates = motion.placement.chosen(poses), (moves * motion.speed[poses], moves * motion.acceleration[poses])
        return play_at(case, load_case, place, moved.masses, motion.coordinate, *rates)

    @cached_property
    def passes(self) -> NDArray[np.bool_]:
        """Where (n,) play may take the linkage through a dead point of its drive, to first order.

        So it is at least at the poses on both sides of a dead point of the motion.
        """
        play = next(iter(self.plays.values()))
        found = self._spread(~play.plain.sound | (play.plain.distance <= play.slack("distance")), True)
        for angle in self.moved.dead_points:
            between = self.moved.motion.passing(angle)
            found[np.concatenate([between, between + 1])] = True
        return found

    def slack(self, load_case: str, key: str) -> Real:
        """Return how far a number of ``Play.gradients`` may go to either side.

        Parameters
        ----------
        load_case : str
            Its name.
        key : str
            "effort" [N mm or N], "distance" or "force J" of a joint J [N].

        Returns
        -------
        array (n,)
            Infinite where play may take the linkage through a dead point. Of a force, which is a vector, at least
            what its size changes by.
        """
        return np.where(self.passes, np.inf, self._spread(self.plays[load_case].slack(key), np.inf))

    def effort(self, load_case: str) -> tuple[Real, Real]:
        """Return the least and the largest drive torque [N mm], or force [N] where the drive pushes.

        Parameters
        ----------
        load_case : str
            Its name.

        Returns
        -------
        tuple of 2 array (n,)
            Without bounds where play may take the linkage through a dead point.
        """
        torque, slack = np.nan_to_num(self.moved.torque[load_case]), self.slack(load_case, "effort")
        return torque - slack, torque + slack

    @cached_property
    def distance(self) -> tuple[Real, Real]:
        """Distance (n,) to a dead point of the drive, without play and the least; it does not depend on the loads."""
        load_case, play = next(iter(self.plays.items()))
        value = self._spread(play.plain.distance, 0.0)
        return value, np.maximum(value - self.slack(load_case, "distance"), 0.0)

    def farthest(self, link: str, point: str) -> tuple[float, int]:
        """Return the largest free motion of a point over the motion, and the number of its pose.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        tuple of (float, int)
            [mm], solved at the worst offsets there.
        """
        free = self.free_motion(link, point)
        pose = first_largest(free)
        play = self._one(next(iter(self.plays)), pose)
        return (max(free[pose], play.free_motion(link, point)), pose) if np.isfinite(free[pose]) else (np.inf, pose)

    def nearest(self) -> tuple[float, int]:
        """Return the least distance to a dead point over the motion, and the number of its pose.

        Returns
        -------
        tuple of (float, int)
            Solved at the worst offsets there.
        """
        pose = first_least(self.distance[1])
        least = self.distance[1][pose]
        return (min(least, self._one(next(iter(self.plays)), pose).distance.low) if least > 0.0 else 0.0), pose

    def extreme_effort(self, load_case: str, sign: float) -> tuple[float, int]:
        """Return the least or the largest drive torque or force over the motion, and the number of its pose.

        Parameters
        ----------
        load_case : str
            Its name.
        sign : float
            1 for the largest, -1 for the least.

        Returns
        -------
        tuple of (float, int)
            [N mm] or [N], solved at the worst offsets there.
        """
        ends = sign * self.effort(load_case)[int(sign > 0.0)]
        pose = first_largest(ends)
        if not np.isfinite(ends[pose]):
            return sign * np.inf, pose
        span = self._one(load_case, pose).effort
        solved = self.moved.torque[load_case][pose] + (span.high if sign > 0.0 else span.low) - span.value
        return sign * max(ends[pose], sign * solved), pose

    def _one(self, load_case: str, pose: int) -> Play:
        found = self.play(load_case, pose)
        assert found is not None
        return found


@lru_cache(maxsize=4)
def loose_motion(moved: CaseMotion) -> LooseMotion | None:
    """Return what play does over a motion.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    LooseMotion or None
        None where no joint has play, or no pose has a drive torque.
    """
    if not clearances(moved.case) or not moved.forces:
        return None
    balanced = np.all([np.isfinite(torque) for torque in moved.torque.values()], axis=0)
    return LooseMotion(moved=moved, poses=np.flatnonzero(balanced)) if balanced.any() else None
