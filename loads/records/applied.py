"""Loads on links as plain records: forces at points, forces spread along a link, body forces."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.linkage.pose import Pose

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """A force [N] and moment [N mm] at a point of a link, in global axes.

    wrench  (6,) Fx, Fy, Fz, Mx, My, Mz about the point
    """

    link: str
    point: str
    wrench: Real

    def resultant(self, pose: Pose) -> Real:
        """Wrench (6,) about the origin of the link's frame, in global axes."""
        arm = pose.position(self.link, self.point) - pose.origins[self.link]
        return shifted(self.wrench, np.array([*arm, 0.0]))


@dataclass(frozen=True, kw_only=True)
class LineLoad:
    """A force spread along the axis of a link between two stations, in global axes.

    start, end      x in the link's frame [mm], start < end
    at_start, at_end  (3,) force per length [N/mm] at the two stations, linear between them
    """

    link: str
    start: float
    end: float
    at_start: Real
    at_end: Real

    def resultant(self, pose: Pose) -> Real:
        """Wrench (6,) about the origin of the link's frame, in global axes."""
        length = self.end - self.start
        total = 0.5 * length * (self.at_start + self.at_end)
        first = length * (
            self.start * (self.at_start + self.at_end) / 2 + length * (self.at_start + 2 * self.at_end) / 6
        )
        axis = np.array([*pose.rotation(self.link)[:, 0], 0.0])
        return np.concatenate([total, np.cross(axis, first)])


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """A force proportional to mass, such as a part's own weight.

    mass          [tonne]
    centroid      (2,) in the link's frame [mm]
    acceleration  (3,) force per mass at the centroid in global axes [mm/s²]: g itself for weight
    angular_speed, angular_acceleration  of the link [rad/s, rad/s²]; where stated, the force per mass varies
                  as - alpha z x r + omega^2 r with r from the centroid
    inertia       moment of inertia about the centroid and z [tonne mm²]
    """

    link: str
    mass: float
    centroid: Real
    acceleration: Real
    angular_speed: float = 0.0
    angular_acceleration: float = 0.0
    inertia: float = 0.0

    def resultant(self, pose: Pose) -> Real:
        """Wrench (6,) about the origin of the link's frame, in global axes."""
        moment = np.array([0.0, 0.0, -self.inertia * self.angular_acceleration])
        force = np.concatenate([self.mass * self.acceleration, moment])
        arm = pose.rotation(self.link) @ self.centroid
        return shifted(force, np.array([*arm, 0.0]))


Load = PointLoad | LineLoad | BodyForce


def shifted(wrench: Real, arm: Real) -> Real:
    """The same wrench (6,) about a point from which its own point is seen at ``arm`` (3,)."""
    return np.concatenate([wrench[:3], wrench[3:] + np.cross(arm, wrench[:3])])
