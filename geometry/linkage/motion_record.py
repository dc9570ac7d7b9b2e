"""The motion of a linkage: positions, velocities and accelerations along one branch, all poses at once."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.continuation import Track
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose_record import Pose

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

BLOCK = 1024


@dataclass(frozen=True, kw_only=True, eq=False)
class Instants:
    """When a motion comes to each of its poses, where a table says so.

    Attributes
    ----------
    percent : ndarray, shape (n,)
        Of the cycle [%].
    times : ndarray, shape (n,), or None
        Since the first pose [s]; None where the cycle states no period.
    """

    percent: Real
    times: Real | None


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """A linkage at n poses of one branch.

    Attributes
    ----------
    linkage : Linkage
        The linkage.
    coordinate : Coordinate
        The angle of a link, or the travel of a slider or slot, that is prescribed.
    angles : ndarray
        Its angles (n,) [rad], or travels [mm].
    speed : ndarray
        Its angular speeds (n,) [rad/s], or speeds [mm/s].
    acceleration : ndarray
        Its angular accelerations (n,) [rad/s²], or accelerations [mm/s²].
    q : ndarray
        Angles of the moving links [rad] and travels in the slots [mm] (n, unknowns).
    first : ndarray
        dq / d angle (or travel) (n, unknowns), the first-order kinematic coefficients.
    second : ndarray
        d²q / d angle² (n, unknowns).
    residual : float
        Largest closure residual as a share of the longest link.
    track : Track
        The branch from which the poses were taken.
    instants : Instants or None
        Of a cycle, whose angles a table states in any order; None where they run from the first to the last.
    """

    linkage: Linkage
    coordinate: Coordinate
    angles: Real
    speed: Real
    acceleration: Real
    q: Real
    first: Real
    second: Real
    residual: float
    track: Track
    instants: Instants | None = None

    @cached_property
    def closure(self) -> LoopClosure:
        """The loop equations that every pose fulfils."""
        return self.track.driven.closure

    @cached_property
    def placement(self) -> Placement:
        """Where the links stand at every pose, and how they move."""
        return Placement(closure=self.closure, q=self.q, qdot=self.qdot, qddot=self.qddot, rows=self._rows)

    @cached_property
    def virtual(self) -> Placement:
        """The poses with derivatives by the coordinate for rates, as virtual work asks for."""
        return Placement(closure=self.closure, q=self.q, qdot=self.first, rows=self._rows)

    @property
    def _rows(self) -> NDArray[np.int64] | None:
        return None if self.instants is None else np.arange(len(self.angles))

    @property
    def progress(self) -> Real:
        """What people tell the poses (n,) by, in ``progress_unit``: per cent of the cycle, else the coordinate."""
        return self.told(self.angles) if self.instants is None else self.instants.percent

    @property
    def progress_unit(self) -> str:
        """Unit of ``progress``."""
        return self.unit if self.instants is None else "%"

    @property
    def progress_title(self) -> str:
        """Name of ``progress`` with its unit, for the axis of a plot and the head of a column."""
        if self.instants is not None:
            return "cycle [%]"
        return f"{'travel' if self.coordinate.slides else 'direction'} of {self.coordinate} [{self.unit}]"

    def at_progress(self, progress: float) -> str:
        """Return where in the motion something is, for people.

        Parameters
        ----------
        progress : float
            As ``progress`` has it.

        Returns
        -------
        str
            Such as "crank = 30 deg" or "45 % of the cycle".
        """
        if self.instants is not None:
            return f"{progress:.5g} % of the cycle"
        return f"{self.coordinate} = {progress:.5g} {self.unit}"

    def passing(self, value: float) -> NDArray[np.int64]:
        """Return after which poses the motion passes a value of its coordinate, or stands at it.

        Parameters
        ----------
        value : float
            [rad, mm]

        Returns
        -------
        ndarray of int, shape (k,)
            i where it lies between the poses i and i + 1.
        """
        off = np.sign(self.angles - value)
        return np.flatnonzero(off[1:] * off[:-1] <= 0.0)

    @property
    def moves(self) -> bool:
        """True where the coordinate has a speed or an acceleration."""
        return bool(np.any(self.speed) or np.any(self.acceleration))

    @property
    def unit(self) -> str:
        """Unit in which the coordinate is told to people."""
        return self.coordinate.measure.unit

    def told(self, values: ArrayLike) -> Real:
        """Return values of the coordinate in that unit.

        Parameters
        ----------
        values : array_like
            Angles [rad] or travels [mm].

        Returns
        -------
        ndarray
            Values in ``unit``.
        """
        return self.coordinate.measure.told(values)

    @cached_property
    def qdot(self) -> Real:
        """Rates of the unknowns (n, unknowns) [rad/s, mm/s]."""
        return np.asarray(self.first * self.speed[:, None])

    @cached_property
    def qddot(self) -> Real:
        """Second rates of the unknowns (n, unknowns) [rad/s², mm/s²]."""
        return np.asarray(self.first * self.acceleration[:, None] + self.second * self.speed[:, None] ** 2)

    def _of_link(self, values: Real, link: str) -> Real:
        if link == self.linkage.ground:
            return np.zeros(len(values))
        return values[:, self.linkage.moving.index(link)]

    def angle(self, link: str) -> Real:
        """Direction of a link's x axis (n,) [rad], without jumps by full turns.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        ndarray
            Angles (n,) [rad].
        """
        return self._of_link(self.q, link)

    def angular_speed(self, link: str) -> Real:
        """Angular speed of a link (n,) [rad/s].

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        ndarray
            Speeds (n,) [rad/s].
        """
        return self._of_link(self.qdot, link)

    def angular_acceleration(self, link: str) -> Real:
        """Angular acceleration of a link (n,) [rad/s²].

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        ndarray
            Accelerations (n,) [rad/s²].
        """
        return self._of_link(self.qddot, link)

    def travel(self, joint: str) -> Real:
        """Travel in a slot (n,) [mm].

        Parameters
        ----------
        joint : str
            Name of the joint.

        Returns
        -------
        ndarray
            Travels (n,) [mm].
        """
        return self.q[:, len(self.linkage.moving) + self.closure.slots.index(joint)]

    @cached_property
    def points(self) -> Complex:
        """Positions x + iy of all points (n, points) [mm], in the order of ``closure.point_names``."""
        return _in_blocks(self.closure.positions, self.q)

    @cached_property
    def points_first(self) -> Complex:
        """Derivatives of all points (n, points) by the coordinate's angle [mm]."""
        return _in_blocks(self.closure.velocities, self.q, self.first)

    @cached_property
    def points_second(self) -> Complex:
        """Second derivatives of all points (n, points) by the coordinate's angle [mm]."""
        return _in_blocks(self.closure.accelerations, self.q, self.first, self.second)

    @cached_property
    def point_velocities(self) -> Complex:
        """Velocities of all points (n, points) [mm/s]."""
        return np.asarray(self.points_first * self.speed[:, None])

    @cached_property
    def point_accelerations(self) -> Complex:
        """Accelerations of all points (n, points) [mm/s²]."""
        return np.asarray(
            self.points_first * self.acceleration[:, None] + self.points_second * self.speed[:, None] ** 2
        )

    def column(self, link: str, point: str) -> int:
        """Column of a link's point in ``points``.

        Parameters
        ----------
        link : str
            Name of the link.
        point : str
            Name of the point.

        Returns
        -------
        int
            The column.
        """
        return self.closure.point_names.index((link, point))

    def _of_point(self, values: Complex, link: str, point: str) -> Real:
        here = values[:, self.column(link, point)]
        return np.stack([here.real, here.imag], axis=-1)

    def position(self, link: str, point: str) -> Real:
        """Positions of a link's point (n, 2) [mm].

        Parameters
        ----------
        link : str
            Name of the link.
        point : str
            Name of the point.

        Returns
        -------
        ndarray
            Places, (2,) of a pose or (n, 2) of a motion [mm].
        """
        return self._of_point(self.points, link, point)

    def velocity(self, link: str, point: str) -> Real:
        """Velocities of a link's point (n, 2) [mm/s].

        Parameters
        ----------
        link : str
            Name of the link.
        point : str
            Name of the point.

        Returns
        -------
        ndarray
            Velocities (n, 2) [mm/s].
        """
        return self._of_point(self.point_velocities, link, point)

    def linear_acceleration(self, link: str, point: str) -> Real:
        """Accelerations of a link's point (n, 2) [mm/s²].

        Parameters
        ----------
        link : str
            Name of the link.
        point : str
            Name of the point.

        Returns
        -------
        ndarray
            Accelerations (n, 2) [mm/s²].
        """
        return self._of_point(self.point_accelerations, link, point)

    @cached_property
    def times(self) -> Real | None:
        """Time since the first pose (n,) [s]; None where the linkage stands still.

        For constant acceleration: 2 (angle - first angle) / (speed + first speed).
        """
        if self.instants is not None:
            return self.instants.times
        mean = 0.5 * (self.speed + self.speed[0])
        if len(mean) < 2 or np.any(mean[1:] == 0.0):
            return None
        return np.concatenate([[0.0], (self.angles[1:] - self.angles[0]) / mean[1:]])

    @cached_property
    def returns(self) -> bool:
        """True where the last pose is the first one again, after full turns."""
        moving = len(self.linkage.moving)
        turned = np.exp(1j * self.q[-1, :moving]) - np.exp(1j * self.q[0, :moving])
        slid = (self.q[-1, moving:] - self.q[0, moving:]) / self.linkage.longest
        return bool(np.max(np.abs(np.concatenate([turned, slid]))) < 1e-9)

    def pose(self, index: int) -> Pose:
        """Return one of the poses.

        Parameters
        ----------
        index : int
            Number of the pose.

        Returns
        -------
        Pose
            The pose.
        """
        return Pose(
            linkage=self.linkage,
            q=self.q[index],
            coordinate=self.coordinate,
            residual=self.residual,
            among=self.q,
        )

    def stopping_points(self, joint: str) -> tuple[float, ...]:
        """Values of the coordinate [rad, mm] at which the travel in a slot or slider turns back, rising.

        Parameters
        ----------
        joint : str
            Name of the joint.

        Returns
        -------
        tuple of float
            Values of the coordinate [rad, mm].
        """
        return self._zeros([len(self.linkage.moving) + self.closure.slots.index(joint)], np.ones(1))

    def turning_points(self, link: str, against: str | None = None) -> tuple[float, ...]:
        """Values of the coordinate [rad, mm] at which ``link`` turns back relative to ``against`` (the ground).

        There the link cannot drive: a dead point of that link. Within the range of the motion, rising.

        Parameters
        ----------
        link : str
            Name of the link.
        against : str, optional
            Name of the link that counts as fixed; the ground unless given.

        Returns
        -------
        tuple of float
            Values of the coordinate [rad, mm].
        """
        columns = [self.linkage.moving.index(n) for n in (link, against) if n not in (None, self.linkage.ground)]
        signs = np.array([1.0, -1.0][: len(columns)]) if link != self.linkage.ground else np.array([-1.0])
        return self._zeros(columns, signs)

    def _zeros(self, columns: list[int], signs: Real) -> tuple[float, ...]:
        """Values of the coordinate at which a combination of the unknowns turns back."""
        low, high = float(self.angles.min()), float(self.angles.max())
        nodes = self.track.angles
        nodes = np.concatenate([[low], nodes[(nodes > low) & (nodes < high)], [high]])
        rate = self._rates(nodes)[0][:, columns] @ signs
        found = [low] if rate[0] == 0.0 else []
        for i in np.flatnonzero((np.sign(rate[1:]) != np.sign(rate[:-1])) & (rate[:-1] != 0.0)):
            a, b, x = nodes[i], nodes[i + 1], 0.5 * (nodes[i] + nodes[i + 1])
            for _ in range(60):
                first, second = self._rates(np.array([x]))
                value, slope = float(first[0, columns] @ signs), float(second[0, columns] @ signs)
                a, b = (x, b) if value * rate[i] > 0.0 else (a, x)
                step = -value / slope if slope != 0.0 else math.inf
                new = x + step if a <= x + step <= b else 0.5 * (a + b)
                if abs(new - x) <= 1e-14 * max(self.track.driven.size, abs(x)):
                    break
                x = new
            found.append(float(x))
        return tuple(found)

    def _rates(self, angles: Real) -> tuple[Real, Real]:
        return self.track.driven.coefficients(self.track.at(angles))


def _in_blocks(function: Callable[..., Complex], *arrays: Real) -> Complex:
    """Evaluate a function of many poses some at a time, so that its arrays stay in the processor's cache."""
    blocks = range(0, len(arrays[0]), BLOCK)
    return np.concatenate([function(*(a[i : i + BLOCK] for a in arrays)) for i in blocks])
