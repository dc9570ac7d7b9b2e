"""A linkage in one position, and how far that is from a dead point."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.placement import Placement

Real = NDArray[np.float64]

CLOSED = 1e-10
"""Largest closure residual of an assembled pose, as a share of the longest link."""


@dataclass(frozen=True, kw_only=True)
class Pose:
    """A linkage in one position.

    Attributes
    ----------
    linkage : Linkage
        The linkage.
    q : ndarray
        Angles of the moving links [rad] and travels in the slots [mm] (unknowns,).
    coordinate : Coordinate, optional
        The angle or travel that fixes the pose; None where nothing moves.
    residual : float
        Largest closure residual as a share of the longest link.
    offsets : mapping of str to complex
        Joint -> how far play sets its two points apart [mm], as ``LoopClosure`` has it.
    among : ndarray, optional
        As ``Placement`` has it.
    """

    linkage: Linkage
    q: Real
    coordinate: Coordinate | None
    residual: float
    offsets: Mapping[str, complex] = field(default_factory=dict)
    among: Real | None = field(default=None, repr=False, compare=False)

    @cached_property
    def closure(self) -> LoopClosure:
        """The loop equations that the pose fulfils."""
        return LoopClosure(self.linkage, offsets=self.offsets)

    @cached_property
    def placement(self) -> Placement:
        """Where the links stand, at rest."""
        return Placement(closure=self.closure, q=self.q, among=self.among)

    @cached_property
    def angles(self) -> Mapping[str, float]:
        """Direction of every link's x axis [rad]."""
        moving = self.linkage.moving
        return dict(zip(moving, map(float, self.q[: len(moving)]), strict=True)) | {self.linkage.ground: 0.0}

    @cached_property
    def origins(self) -> Mapping[str, Real]:
        """Origin of every link's frame in global axes [mm]."""
        origins = self.closure.origins(self.q)
        found = {name: np.array([z.real, z.imag]) for name, z in zip(self.linkage.moving, origins, strict=True)}
        return found | {self.linkage.ground: np.zeros(2)}

    @cached_property
    def _positions(self) -> Mapping[tuple[str, str], Real]:
        values = self.closure.positions(self.q)
        return {key: np.array([z.real, z.imag]) for key, z in zip(self.closure.point_names, values, strict=True)}

    @cached_property
    def travels(self) -> Mapping[str, float]:
        """Travel of the pin in every slot and slider [mm]."""
        return dict(zip(self.closure.slots, map(float, self.q[len(self.linkage.moving) :]), strict=True))

    @property
    def held_column(self) -> int:
        """Column of the coordinate among the unknowns; only where the pose has one."""
        assert self.coordinate is not None
        return self.coordinate.column(self.closure)

    @property
    def held(self) -> float:
        """Angle [rad] or travel [mm] of the coordinate; 0 where nothing moves."""
        return 0.0 if self.coordinate is None else float(self.q[self.held_column])

    def position(self, link: str, point: str) -> Real:
        """Position of a link's point in global axes (2,) [mm].

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
        return self._positions[link, point]

    @cached_property
    def points(self) -> Mapping[str, Real]:
        """Every point by name; ``link.point`` where links have different points of one name."""
        named: dict[str, Real] = {}
        for (link, point), here in self._positions.items():
            twins = [p for (_, other), p in self._positions.items() if other == point]
            same = all(np.linalg.norm(p - here) <= 1e-9 * self.linkage.longest for p in twins)
            named[point if same else f"{link}.{point}"] = here
        return named

    def rotation(self, link: str) -> Real:
        """Matrix (2, 2) that turns vectors of the link's frame into global axes.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        ndarray
            Matrix (2, 2).
        """
        c, s = math.cos(self.angles[link]), math.sin(self.angles[link])
        return np.array([[c, -s], [s, c]])

    def dead_point_distance(self, driven: Coordinate, *, bonds: bool = True) -> float:
        """How far the pose is from a dead point of the given driven link, slider or slot (0 at the dead point).

        Smallest singular value of the scaled constraint Jacobian with it held: coordinates are
        (x, y, L phi) of every moving link with L the longest link, so all entries are pure
        numbers. Where it vanishes the linkage moves although it is held.

        Parameters
        ----------
        driven : Coordinate
            What is held.
        bonds : bool
            As ``constraint_jacobian`` takes it.

        Returns
        -------
        float
            The distance, without unit.
        """
        return self.distance_holding(held_motion(self, driven), bonds=bonds)

    def distance_holding(self, row: Real, *, bonds: bool = True) -> float:
        """How far the pose is from a dead point of what a row holds, as ``dead_point_distance`` counts it.

        Parameters
        ----------
        row : ndarray, shape (coordinates,)
            As of ``held_motion`` or ``turning``.
        bonds : bool
            As ``constraint_jacobian`` takes it.

        Returns
        -------
        float
            The distance, without unit.
        """
        matrix = np.vstack([constraint_jacobian(self, bonds=bonds), row])
        return float(np.linalg.svd(matrix, compute_uv=False)[-1])


def held_motion(pose: Pose, driven: Coordinate) -> Real:
    """Row (coordinates,) that holds a link's angle, or a slider or slot.

    Parameters
    ----------
    pose : Pose
        The pose.
    driven : Coordinate
        What is held.

    Returns
    -------
    ndarray
        Row (coordinates,).
    """
    return _joint_motion(pose, driven.name)[0] if driven.slides else _held(pose.linkage, driven.name)


def turning(pose: Pose, joint: str) -> Real:
    """Row (coordinates,) that holds the angle between the two links of a joint.

    Parameters
    ----------
    pose : Pose
        The pose.
    joint : str
        Its name.

    Returns
    -------
    ndarray
        Row (coordinates,).
    """
    return _joint_motion(pose, joint)[2]


def constraint_jacobian(pose: Pose, *, bonds: bool = True) -> Real:
    """Jacobian of all joint constraints by (x, y, L phi) of every moving link, without dimensions.

    Rows: two per revolute joint (x, y) and a third where it is bonded, one per pin in slot (normal), two per slider
    (normal and angle). García de Jalón & Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 1994,
    section 2.3 (reference-point coordinates).

    Parameters
    ----------
    pose : Pose
        The pose.
    bonds : bool
        Whether bonded joints without a stated angle count as such, too; they do not take part in assembling the pose.

    Returns
    -------
    ndarray
        Matrix (constraints, coordinates).
    """
    linkage = pose.linkage
    rows: list[Real] = []
    for name, joint in linkage.joints.items():
        along, across, turn = _joint_motion(pose, name)
        rows += [across] if joint.slides else [along, across]
        if joint.bears_moment and (bonds or joint.fixes_angle):
            rows.append(turn)
    return np.array(rows)


def _joint_motion(pose: Pose, name: str) -> tuple[Real, Real, Real]:
    """Motion of a joint's second link against its first: along and across its direction, and turning.

    Rows (coordinates,) by (x, y, L phi) of every moving link; along x and y for a revolute joint.
    """
    linkage, joint = pose.linkage, pose.linkage.joints[name]
    at = pose.position(joint.links[1], linkage.joint_points(name)[1])
    relative, turn = np.zeros((2, 3 * len(linkage.moving))), np.zeros(3 * len(linkage.moving))
    for link, sign in zip(joint.links, (-1.0, 1.0), strict=True):
        if link != linkage.ground:
            k = 3 * linkage.moving.index(link)
            arm = at - pose.origins[link]
            relative[:, k : k + 2] = sign * np.eye(2)
            relative[:, k + 2] = sign * np.array([-arm[1], arm[0]]) / linkage.longest
            turn[k + 2] = sign
    along = complex(pose.placement.along(name))
    c, s = along.real, along.imag
    return np.array([c, s]) @ relative, np.array([-s, c]) @ relative, turn


def _held(linkage: Linkage, link: str) -> Real:
    row = np.zeros(3 * len(linkage.moving))
    row[3 * linkage.moving.index(link) + 2] = 1.0
    return row
