"""Loads on links as plain records: forces at points, forces spread along a link, body forces."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.linkage.pose import Pose

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """A force and moment at a point of a link.

    Attributes
    ----------
    link, point : str
        Their names.
    wrench : array (6,)
        Fx, Fy, Fz [N], Mx, My, Mz [N mm] about the point, in global axes.
    """

    link: str
    point: str
    wrench: Real

    def resultant(self, pose: Pose) -> Real:
        """Sum the load.

        Parameters
        ----------
        pose : Pose
            Where the links are.

        Returns
        -------
        array (6,)
            Wrench about the origin of the link's frame, in global axes [N, N mm].
        """
        arm = pose.position(self.link, self.point) - pose.origins[self.link]
        return shifted(self.wrench, np.array([*arm, 0.0]))


@dataclass(frozen=True, kw_only=True)
class LineLoad:
    """A force spread along the axis of a link between two stations.

    Attributes
    ----------
    link : str
        Name of the link.
    start, end : float
        Stations x in the link's frame [mm], start < end.
    at_start, at_end : array (3,)
        Force per length at the two stations in global axes [N/mm], linear between them.
    """

    link: str
    start: float
    end: float
    at_start: Real
    at_end: Real

    def resultant(self, pose: Pose) -> Real:
        """Sum the load.

        Parameters
        ----------
        pose : Pose
            Where the links are.

        Returns
        -------
        array (6,)
            Wrench about the origin of the link's frame, in global axes [N, N mm].
        """
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

    Attributes
    ----------
    link : str
        Name of the link.
    mass : float
        Mass [tonne].
    centroid : array (2,)
        In the link's frame [mm].
    acceleration : array (3,)
        Force per mass at the centroid in global axes [mm/s²]: g itself for weight.
    angular_speed, angular_acceleration : float
        Of the link [rad/s, rad/s²]; where stated, the force per mass varies as - alpha z x r + omega^2 r with r from
        the centroid.
    inertia : float
        Moment of inertia about the centroid and z [tonne mm²].
    """

    link: str
    mass: float
    centroid: Real
    acceleration: Real
    angular_speed: float = 0.0
    angular_acceleration: float = 0.0
    inertia: float = 0.0

    def resultant(self, pose: Pose) -> Real:
        """Sum the load.

        Parameters
        ----------
        pose : Pose
            Where the links are.

        Returns
        -------
        array (6,)
            Wrench about the origin of the link's frame, in global axes [N, N mm].
        """
        moment = np.array([0.0, 0.0, -self.inertia * self.angular_acceleration])
        force = np.concatenate([self.mass * self.acceleration, moment])
        arm = pose.rotation(self.link) @ self.centroid
        return shifted(force, np.array([*arm, 0.0]))


Load = PointLoad | LineLoad | BodyForce


def shifted(wrench: Real, arm: Real) -> Real:
    """Return the same wrench about another point.

    Parameters
    ----------
    wrench : array (6,)
        Force [N] and moment [N mm] about its own point.
    arm : array (3,)
        Its own point as seen from the other one [mm].

    Returns
    -------
    array (6,)
        Force [N] and moment [N mm] about the other point.
    """
    return np.concatenate([wrench[:3], wrench[3:] + np.cross(arm, wrench[:3])])
