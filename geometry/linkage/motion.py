"""The motion of a linkage: positions, velocities and accelerations along one branch, all poses at once."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.base.errors import CaseError
from geometry.linkage.closure import LoopClosure
from geometry.linkage.continuation import DrivenClosure, Track, follow
from geometry.linkage.linkage import Linkage
from geometry.linkage.pose import Pose

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_BLOCK = 1024


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """A linkage at n poses of one branch.

    coordinate  the link whose angle is prescribed; where ``slides``, the slider or slot whose travel is
    angles      (n,) its angle [rad], or travel [mm]
    speed       (n,) its angular speed [rad/s], or speed [mm/s]
    acceleration  (n,) its angular acceleration [rad/s²], or acceleration [mm/s²]
    q           (n, unknowns) angles of the moving links [rad] and travels in the slots [mm]
    first       (n, unknowns) dq / d angle (or travel), the first-order kinematic coefficients
    second      (n, unknowns) d²q / d angle²
    residual    largest closure residual as a share of the longest link
    track       the branch from which the poses were taken
    """

    linkage: Linkage
    coordinate: str
    angles: Real
    speed: Real
    acceleration: Real
    q: Real
    first: Real
    second: Real
    residual: float
    track: Track

    @cached_property
    def closure(self) -> LoopClosure:
        """The loop equations that every pose fulfils."""
        return self.track.driven.closure

    @property
    def slides(self) -> bool:
        """True where a travel is prescribed and not an angle."""
        return self.track.driven.slides

    @property
    def unit(self) -> str:
        """Unit in which the coordinate is told to people."""
        return "mm" if self.slides else "deg"

    def told(self, values: ArrayLike) -> Real:
        """Return values of the coordinate in that unit."""
        return np.asarray(values, dtype=float) if self.slides else np.degrees(values)

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
        """Direction of a link's x axis (n,) [rad], without jumps by full turns."""
        return self._of_link(self.q, link)

    def angular_speed(self, link: str) -> Real:
        """Angular speed of a link (n,) [rad/s]."""
        return self._of_link(self.qdot, link)

    def angular_acceleration(self, link: str) -> Real:
        """Angular acceleration of a link (n,) [rad/s²]."""
        return self._of_link(self.qddot, link)

    def travel(self, joint: str) -> Real:
        """Travel in a slot (n,) [mm]."""
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
        """Column of a link's point in ``points``."""
        return self.closure.point_names.index((link, point))

    def _of_point(self, values: Complex, link: str, point: str) -> Real:
        here = values[:, self.column(link, point)]
        return np.stack([here.real, here.imag], axis=-1)

    def position(self, link: str, point: str) -> Real:
        """Positions of a link's point (n, 2) [mm]."""
        return self._of_point(self.points, link, point)

    def velocity(self, link: str, point: str) -> Real:
        """Velocities of a link's point (n, 2) [mm/s]."""
        return self._of_point(self.point_velocities, link, point)

    def linear_acceleration(self, link: str, point: str) -> Real:
        """Accelerations of a link's point (n, 2) [mm/s²]."""
        return self._of_point(self.point_accelerations, link, point)

    @cached_property
    def times(self) -> Real | None:
        """Time since the first pose (n,) [s]; None where the linkage stands still.

        For constant acceleration: 2 (angle - first angle) / (speed + first speed).
        """
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
        """Return one of the poses."""
        return Pose(
            linkage=self.linkage,
            q=self.q[index],
            coordinate=self.coordinate,
            residual=self.residual,
            slides=self.slides,
        )

    def travel_rate(self, joint: str) -> Real:
        """Rate of the travel in a slot (n,) [mm/s]."""
        return self.qdot[:, len(self.linkage.moving) + self.closure.slots.index(joint)]

    def stopping_points(self, joint: str) -> tuple[float, ...]:
        """Values of the coordinate [rad, mm] at which the travel in a slot or slider turns back, rising."""
        return self._zeros([len(self.linkage.moving) + self.closure.slots.index(joint)], np.ones(1))

    def turning_points(self, link: str, against: str | None = None) -> tuple[float, ...]:
        """Values of the coordinate [rad, mm] at which ``link`` turns back relative to ``against`` (the ground).

        There the link cannot drive: a dead point of that link. Within the range of the motion, rising.
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
    blocks = range(0, len(arrays[0]), _BLOCK)
    return np.concatenate([function(*(a[i : i + _BLOCK] for a in arrays)) for i in blocks])


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

    pose          where the branch is entered; its own angle need not be among the given ones
    angles        (n,) angles [rad] of the coordinate's link, in any order; the pose's angle counts as
                  the one of its multiples (plus full turns) that is nearest to them
    speed         angular speed [rad/s] of that link, one or (n,)
    acceleration  angular acceleration [rad/s²] of that link, one or (n,)
    coordinate    the link whose angle is prescribed; the pose's coordinate when left out
    slides        True where ``coordinate`` is a slider or slot, whose travels [mm] stand for the angles and whose
                  speed [mm/s] and acceleration [mm/s²] for theirs

    Raises ``DeadPointError`` (a ``CaseError``) where a dead point, or a crossing of two branches,
    lies on the way, with its angle to some 1e-9 rad; ``CaseError`` for a link that does not move.
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
    for i in range(0, len(q), _BLOCK):
        first[i : i + _BLOCK], second[i : i + _BLOCK] = driven.coefficients(q[i : i + _BLOCK])
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
            float(np.max(np.abs(driven.gaps(q[i : i + _BLOCK])), initial=0.0)) for i in range(0, len(q), _BLOCK)
        ),
        track=track,
    )
