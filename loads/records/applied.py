"""Loads on links as plain records: forces at points, forces spread along a link, weight and inertia.

Every record serves one pose or n of them, along a leading axis of its arrays, in global axes or in its link's own.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement, vector

Real = NDArray[np.float64]
Axes = Literal["global", "link"]


@dataclass(frozen=True, kw_only=True)
class PartMass:
    """Mass of a link.

    Attributes
    ----------
    mass : float
        [tonne]
    centroid : array (2,)
        In the link's frame [mm].
    inertia : float
        Moment of inertia about the centroid and the axis z, in which the linkage moves [tonne mm²].
    """

    mass: float
    centroid: np.ndarray[tuple[int], np.dtype[np.float64]]
    inertia: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PointLoad:
    """A force and moment at a point of a link.

    Attributes
    ----------
    link, point : str
        Where it acts.
    wrench : array (..., 6)
        Fx, Fy, Fz [N] and Mx, My, Mz [N mm] about the point.
    axes : str
        Axes of the components: "global", or "link" for a load that turns with its link.
    arm : array (..., 3)
        From the point to where the force acts, which turns with the link as it deforms; the moment of the force about
        the point is in the wrench [mm].
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("wrench", "arm")
    SCALARS: ClassVar[tuple[str, ...]] = ()
    link: str
    point: str
    wrench: Real
    axes: Axes = "global"
    arm: Real = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        """Have the arm at every pose of the wrench."""
        object.__setattr__(self, "arm", np.broadcast_to(self.arm, (*np.shape(self.wrench)[:-1], 3)))

    def resultant(self, place: Placement) -> Real:
        """Return the wrench about the origin of the link's frame, in global axes.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (..., 6)
            [N, N mm]
        """
        return shifted(in_axes(self, "global", place).wrench, vector(place.arm(self.link, self.point)))


@dataclass(frozen=True, kw_only=True)
class FrictionLoad(PointLoad):
    """Friction at a joint, on one of its two links: a couple in a bore, a force along a slot or guide.

    Attributes
    ----------
    joint : str
        The joint. The other link bears the opposite.
    """

    joint: str


@dataclass(frozen=True, kw_only=True)
class LineLoad:
    """A force spread along the axis of a link (y = z = 0), linear between two stations.

    Attributes
    ----------
    link : str
        On which it acts.
    start, end : float
        Stations, x in the link's frame [mm], start < end.
    at_start, at_end : array (..., 3)
        Force per length there [N/mm].
    axes : str
        Axes of the components, as for ``PointLoad``.
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("at_start", "at_end")
    SCALARS: ClassVar[tuple[str, ...]] = ()
    link: str
    start: float
    end: float
    at_start: Real
    at_end: Real
    axes: Axes = "global"

    @property
    def force(self) -> Real:
        """Its whole force (..., 3) [N]."""
        return np.asarray(0.5 * (self.end - self.start) * (self.at_start + self.at_end))

    @property
    def first_moment(self) -> Real:
        """Integral (..., 3) of x times the force per length [N mm]."""
        length = self.end - self.start
        return np.asarray(self.start * self.force + length**2 * (self.at_start + 2.0 * self.at_end) / 6.0)

    def about_origin(self, along: Real) -> Real:
        """Return the wrench (..., 6) about the origin of the link's frame.

        Parameters
        ----------
        along : array (..., 3)
            The link's x, in the axes of the components.

        Returns
        -------
        array (..., 6)
            [N, N mm]
        """
        none = np.zeros(self.first_moment.shape)
        moment = shifted(np.concatenate([self.first_moment, none], axis=-1), along)[..., 3:]
        return np.concatenate([np.broadcast_to(self.force, moment.shape), moment], axis=-1)

    def resultant(self, place: Placement) -> Real:
        """Return the wrench about the origin of the link's frame, in global axes.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (..., 6)
            [N, N mm]
        """
        line = in_axes(self, "global", place)
        return line.about_origin(vector(place.direction(self.link)))


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """Weight and inertia of a link: force per mass s - α z × r + ω² r, at r from the origin of the link's frame.

    Attributes
    ----------
    link : str
        On which it acts.
    mass : PartMass
        On which it acts there.
    specific_force : array (..., 3)
        s, gravity less the acceleration of the origin of the link's frame [mm/s²].
    angular_acceleration : array (...)
        α about z [rad/s²].
    angular_speed_squared : array (...)
        ω² [rad²/s²].
    axes : str
        Axes of the components, as for ``PointLoad``.
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("specific_force",)
    SCALARS: ClassVar[tuple[str, ...]] = ("angular_acceleration", "angular_speed_squared")
    link: str
    mass: PartMass
    specific_force: Real
    angular_acceleration: Real | float = 0.0
    angular_speed_squared: Real | float = 0.0
    axes: Axes = "global"

    def per_mass(self, at: Real) -> Real:
        """Return the force per mass (..., 3) [mm/s²].

        Parameters
        ----------
        at : array (..., 3)
            Places of the link, from the origin of its frame in the axes of the components [mm].

        Returns
        -------
        array (..., 3)
            [mm/s²]
        """
        x, y, rate, square = at[..., 0], at[..., 1], self.angular_acceleration, self.angular_speed_squared
        turning = np.stack([square * x + rate * y, square * y - rate * x, np.zeros(np.shape(square * x))], axis=-1)
        return np.asarray(self.specific_force + turning)

    def at_centroid(self, arm: Real) -> Real:
        """Return the wrench (..., 6) on the mass about its centroid.

        Parameters
        ----------
        arm : array (..., 3)
            From the origin of the link's frame to the centroid in the axes of the components [mm].

        Returns
        -------
        array (..., 6)
            [N, N mm]
        """
        force = self.mass.mass * self.per_mass(arm)
        wrench = np.zeros((*force.shape[:-1], 6))
        wrench[..., :3], wrench[..., 5] = force, -self.mass.inertia * np.asarray(self.angular_acceleration)
        return wrench

    def resultant(self, place: Placement) -> Real:
        """Return the wrench about the origin of the link's frame, in global axes.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (..., 6)
            [N, N mm]
        """
        arm = vector(place.direction(self.link) * complex(*self.mass.centroid))
        return shifted(in_axes(self, "global", place).at_centroid(arm), arm)


Load = PointLoad | LineLoad | BodyForce
AnyLoad = TypeVar("AnyLoad", bound=Load)


def in_axes(load: AnyLoad, axes: Axes, place: Placement) -> AnyLoad:
    """Return a load in global axes or in those of its link.

    Parameters
    ----------
    load : PointLoad, LineLoad or BodyForce
        In either axes.
    axes : str
        The axes that are wanted.
    place : Placement
        Where the links stand.

    Returns
    -------
    PointLoad, LineLoad or BodyForce
        The same load.
    """
    if load.axes == axes:
        return load
    turn = place.axes(load.link)
    return _with(turned(load, turn if axes == "global" else turn.swapaxes(-1, -2)), axes=axes)


def turned(load: AnyLoad, turn: Real) -> AnyLoad:
    """Return a load with all of its vectors turned.

    Parameters
    ----------
    load : PointLoad, LineLoad or BodyForce
        The load.
    turn : array (..., 3, 3)
        What its vectors are multiplied by.

    Returns
    -------
    PointLoad, LineLoad or BodyForce
        The load, its axes named as before.
    """
    return _with(load, **{name: rotated(turn, getattr(load, name)) for name in load.VECTORS})


def rotated(turn: Real, vectors: Real) -> Real:
    """Return the product of matrices with one or more vectors side by side.

    Parameters
    ----------
    turn : array (..., 3, 3)
        The matrices.
    vectors : array (..., 3 k)
        k vectors.

    Returns
    -------
    array (..., 3 k)
        The products.
    """
    rows = vectors.reshape(*vectors.shape[:-1], -1, 3) @ turn.swapaxes(-1, -2)
    return np.asarray(rows.reshape(*rows.shape[:-2], -1))


def at_poses(load: AnyLoad, shape: tuple[int, ...]) -> AnyLoad:
    """Return a load with the poses as leading axes of all of its arrays, where it is the same at every pose.

    Parameters
    ----------
    load : PointLoad, LineLoad or BodyForce
        The load.
    shape : tuple
        () for one pose, (n,) for n.

    Returns
    -------
    PointLoad, LineLoad or BodyForce
        With arrays (n, ...).
    """
    vectors = {name: getattr(load, name) for name in load.VECTORS}
    scalars = {name: np.broadcast_to(getattr(load, name), shape) for name in load.SCALARS}
    spread = {name: np.broadcast_to(vector, (*shape, vector.shape[-1])) for name, vector in vectors.items()}
    return _with(load, **spread, **scalars)


def reshaped(load: AnyLoad, shape: tuple[int, ...]) -> AnyLoad:
    """Return a load with its poses along other axes.

    Parameters
    ----------
    load : PointLoad, LineLoad or BodyForce
        With all of its arrays at the same poses.
    shape : tuple
        Of the poses, as ``numpy.reshape`` takes it.

    Returns
    -------
    PointLoad, LineLoad or BodyForce
    """
    vectors = {name: getattr(load, name) for name in load.VECTORS}
    spread = {name: vector.reshape(*shape, vector.shape[-1]) for name, vector in vectors.items()}
    return _with(load, **spread, **{name: np.reshape(getattr(load, name), shape) for name in load.SCALARS})


def _with(load: AnyLoad, **changes: Any) -> AnyLoad:
    changed: Any = load
    found: AnyLoad = replace(changed, **changes)
    return found


def load_size(loads: Iterable[Load], length: float) -> float:
    """Return the largest of the loads' sizes but for weight and inertia, which act inside their link anyway.

    Parameters
    ----------
    loads : iterable of Load
    length : float
        By which moments are divided [mm].

    Returns
    -------
    float
        [N]
    """
    sizes = [0.0]
    for load in loads:
        if isinstance(load, PointLoad):
            sizes.append(wrench_size(load.wrench, length))
        elif not isinstance(load, BodyForce):
            most = max(float(np.linalg.norm(end)) for end in (load.at_start, load.at_end))
            sizes.append(most * (load.end - load.start))
    return max(sizes)


def wrench_size(wrench: Real, length: float) -> float:
    """Return the largest force or moment over a length of a wrench at any pose.

    Parameters
    ----------
    wrench : ndarray, shape (..., 6)
        [N], [N mm]
    length : float
        By which moments are divided [mm].

    Returns
    -------
    float
        [N]
    """
    return float(
        max(np.linalg.norm(wrench[..., :3], axis=-1).max(), np.linalg.norm(wrench[..., 3:], axis=-1).max() / length)
    )


def chosen(record: Any, poses: Any) -> Any:
    """Return a record of loads at one or some of its poses.

    Parameters
    ----------
    record : Load, or part of the loads on a link
        With poses as the leading axis of its ``VECTORS`` and ``SCALARS``.
    poses : int, slice, numbers or mask (n,)
        Which poses.

    Returns
    -------
    Load, or part of the loads on a link
        At these poses.
    """
    values = {name: np.asarray(getattr(record, name)) for name in (*record.VECTORS, *record.SCALARS)}
    return replace(record, **{name: value[poses] if value.ndim else value for name, value in values.items()})


def together(records: Sequence[Any]) -> Any:
    """Return a record of loads at n poses from itself at each; ``chosen`` goes the other way.

    Parameters
    ----------
    records : sequence of Load, or part of the loads on a link
        Alike but for their ``VECTORS`` and ``SCALARS``.

    Returns
    -------
    Load, or part of the loads on a link
    """
    first = records[0]
    names = (*first.VECTORS, *first.SCALARS)
    return replace(first, **{name: np.stack([getattr(one, name) for one in records]) for name in names})


def shifted(wrench: Real, arm: Real) -> Real:
    """Return the same wrench about another point.

    Parameters
    ----------
    wrench : array (..., 6)
        Force [N] and moment [N mm] about its own point.
    arm : array (..., 3)
        Its own point as seen from the other one [mm].

    Returns
    -------
    array (..., 6)
        About the other point.
    """
    (fx, fy, fz), (x, y, z) = ([part[..., i] for i in range(3)] for part in (wrench, arm))
    found = np.empty((*np.broadcast_shapes(wrench.shape[:-1], arm.shape[:-1]), 6))
    found[...] = wrench
    found[..., 3] += y * fz - z * fy
    found[..., 4] += z * fx - x * fz
    found[..., 5] += x * fy - y * fx
    return found
