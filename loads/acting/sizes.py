"""Sizes along which something acts: the length of a line through points, the angle of a joint, a travel.

A revolute joint's angle is that of its second link to its first. In the stated pose it is the one less than half a turn
from a given one (a spring's free angle, the middle of a joint's stops). Over a motion angles go on without jumps.
"""

import itertools
import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Complex, Placement, vector
from alula.loads.acting.acting import End

Real = NDArray[np.float64]

_TIE = 9
"""Decimals of an angle [rad] to which two poses are equally near the stated one."""


@dataclass(frozen=True)
class Length:
    """The length of the line through k points.

    Attributes
    ----------
    ends : tuple of End
        The points, from one end to the other.
    """

    ends: tuple[End, ...]
    turns: ClassVar[bool] = False

    def of(self, place: Placement) -> Real:
        """Return its value.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (...)
            [mm]
        """
        return self.between(places(place, self.ends), np.zeros(len(self.ends)))

    def between(self, at: Complex, angles: Real) -> Real:
        """Return its value where its ends are anywhere, up to a constant.

        Parameters
        ----------
        at : complex array (k, ...)
            Where they stand [mm].
        angles : array (k, ...)
            By how much they are turned [rad].

        Returns
        -------
        array (...)
            [mm]
        """
        return np.asarray(np.abs(np.diff(at, axis=0)).sum(axis=0))

    def gradient(self, at: Complex) -> Real:
        """Return its derivative by x, y and rotation of its ends; none by a piece without length.

        Parameters
        ----------
        at : complex array (k, ...)
            Where they stand [mm].

        Returns
        -------
        array (k, ..., 3)
            [1, 1, mm]
        """
        found = np.zeros((*at.shape, 3))
        for i, piece in enumerate(np.diff(at, axis=0)):
            length = np.abs(piece)
            way = piece / np.where(length > 0.0, length, 1.0)
            found[i, ..., 0], found[i, ..., 1] = found[i, ..., 0] - way.real, found[i, ..., 1] - way.imag
            found[i + 1, ..., 0], found[i + 1, ..., 1] = way.real, way.imag
        return found

    def bend(self, at: Complex) -> Real:
        """Return its second derivatives.

        Parameters
        ----------
        at : complex array (k,)
            Where its ends stand [mm].

        Returns
        -------
        array (3 k, 3 k)
            By x, y and rotation of each end.
        """
        found = np.zeros((len(at), 3, len(at), 3))
        for i, (a, b) in enumerate(itertools.pairwise(at)):
            normal = vector(1j * (b - a) / abs(b - a))[:2]
            across = np.outer(normal, normal) / abs(b - a)
            found[i : i + 2, :2, i : i + 2, :2] += np.einsum("ij,ab->iajb", [[1.0, -1.0], [-1.0, 1.0]], across)
        return found.reshape(3 * len(at), -1)

    def meeting(self, at: Complex, slack: float) -> tuple[NDArray[np.bool_], ...]:
        """Return for each piece whether its ends are so near that its direction is not known.

        Parameters
        ----------
        at : complex array (k, ...)
            Where its ends stand [mm].
        slack : float
            How near [mm].

        Returns
        -------
        tuple of k - 1 bool array (...)
        """
        return tuple(np.abs(np.diff(at, axis=0)) <= slack)


@dataclass(frozen=True)
class Angle:
    """The angle of a revolute joint's second link to its first.

    Attributes
    ----------
    joint : str
    stated : Placement
        The stated pose.
    near : float or None
        From which the angle is less than half a turn in the stated pose [rad]; None: it is the difference of both.
    """

    joint: str
    stated: Placement
    near: float | None = None
    turns: ClassVar[bool] = True

    @property
    def ends(self) -> tuple[End, ...]:
        """The joint's points, on its first link and on its second."""
        return joint_ends(self.stated, self.joint)

    @property
    def at_stated(self) -> float:
        """The angle in the stated pose [rad]."""
        found = float(self._relative(self.stated))
        return found if self.near is None else self.near + math.remainder(found - self.near, 2.0 * math.pi)

    def of(self, place: Placement) -> Real:
        """Return its value, without jumps over the poses.

        Of angles that differ by full turns, the stated pose counts as the one nearest to the poses of the motion.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (...)
            [rad]
        """
        stated = self._relative(self.stated)
        found, every = self._relative(place) - stated, np.ravel(self._relative(place.whole) - stated)
        if len(every):
            off = np.round(np.abs(np.remainder(every + np.pi, 2.0 * np.pi) - np.pi), _TIE)
            found = found - 2.0 * np.pi * np.round(every[int(np.argmin(off))] / (2.0 * np.pi))
        return np.asarray(self.at_stated + found)

    def between(self, at: Complex, angles: Real) -> Real:
        """As ``Length.between``."""
        return np.asarray(angles[1] - angles[0])

    def gradient(self, at: Complex) -> Real:
        """As ``Length.gradient``."""
        found = np.zeros((*at.shape, 3))
        found[0, ..., 2], found[1, ..., 2] = -1.0, 1.0
        return found

    def bend(self, at: Complex) -> Real:
        """As ``Length.bend``: none."""
        return np.zeros((6, 6))

    def meeting(self, at: Complex, slack: float) -> tuple[NDArray[np.bool_], ...]:
        """As ``Length.meeting``: a moment needs no direction."""
        return ()

    def _relative(self, place: Placement) -> Real:
        first, second = place.linkage.joints[self.joint].links
        return np.asarray(place.angle(second) - place.angle(first))


def travel(place: Placement, joint: str) -> Real:
    """Return the travel of a slider.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    joint : str

    Returns
    -------
    array (...)
        [mm]
    """
    return np.asarray(place.q[..., len(place.linkage.moving) + place.closure.slots.index(joint)])


def places(place: Placement, ends: tuple[End, ...]) -> Complex:
    """Return where points of links stand.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    ends : tuple of End

    Returns
    -------
    complex array (k, ...)
        [mm]
    """
    return np.array([place.position(link, at) if at else place.origin(link) for link, at in ends])


def joint_ends(place: Placement, joint: str) -> tuple[End, ...]:
    """Return the points that a joint brings together, on its first link and on its second.

    Parameters
    ----------
    place : Placement
        Of its linkage.
    joint : str

    Returns
    -------
    tuple of 2 End
    """
    return tuple(zip(place.linkage.joints[joint].links, place.linkage.joint_points(joint), strict=True))
