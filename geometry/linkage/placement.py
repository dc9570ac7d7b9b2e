"""Where the links of a linkage stand at one pose or at many, and how they move."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.linkage import Linkage

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_INFINITE = 1e6
"""Distance of an instant centre, over the longest link, from which it counts as infinite: a load line's distance from
it would be lost to the rounding of velocities, some 1e-10 of them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Placement:
    """The frames of all links at one pose, or at n of them along a leading axis of every array.

    A pose alone needs no rates, so that it may stand at a dead point. Vectors of the plane are complex, x + iy.

    Attributes
    ----------
    closure : LoopClosure
        The loop equations of the linkage.
    q : array (..., unknowns)
        Angles of the moving links [rad] and travels in the slots [mm].
    qdot, qddot : array (..., unknowns), optional
        Their rates and second rates [1/s, 1/s²]; None at rest.
    rows : array of int (...), optional
        Row of the cycle's table in which what acts at each pose is stated; None where that is the same at every pose.
    among : array (n, unknowns), optional
        ``q`` of the whole motion that the poses are of, over which turns of links count; None where these are all.
    """

    closure: LoopClosure
    q: Real
    qdot: Real | None = None
    qddot: Real | None = None
    rows: NDArray[np.int64] | None = None
    among: Real | None = None

    @property
    def linkage(self) -> Linkage:
        """The linkage."""
        return self.closure.linkage

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the poses: () for one, (n,) for n."""
        return self.q.shape[:-1]

    @property
    def whole(self) -> "Placement":
        """The whole motion that the poses are of, at rest."""
        return self if self.among is None else Placement(closure=self.closure, q=self.among)

    @property
    def at_rest(self) -> "Placement":
        """The same poses without rates."""
        return replace(self, qdot=None, qddot=None)

    @property
    def listed(self) -> "Placement":
        """The same poses along one axis."""
        qdot, qddot = (x if x is None else x.reshape(-1, x.shape[-1]) for x in (self.qdot, self.qddot))
        offsets = {name: np.broadcast_to(x, self.shape).ravel() for name, x in self.closure.offsets.items()}
        closure = replace(self.closure, offsets=offsets) if offsets else self.closure
        rows = None if self.rows is None else self.rows.ravel()
        q = self.q.reshape(-1, self.q.shape[-1])
        return Placement(closure=closure, q=q, qdot=qdot, qddot=qddot, rows=rows, among=self.among)

    def chosen(self, poses: Any) -> "Placement":
        """Return the chosen poses alone.

        Parameters
        ----------
        poses : int, slice or mask (n,)
            Which of the n poses.

        Returns
        -------
        Placement
            At these.
        """
        names = ("qdot", "qddot", "rows")
        own = {name: None if (value := getattr(self, name)) is None else value[poses] for name in names}
        return Placement(closure=self.closure.chosen(poses), q=self.q[poses], among=self.whole.q, **own)

    def _of(self, values: Real | Complex | None, link: str) -> Any:
        """Values of a link from those of the moving links; none for the ground and at rest."""
        if values is None or link == self.linkage.ground:
            return np.zeros(self.shape)
        return values[..., self.linkage.moving.index(link)]

    def angle(self, link: str) -> Real:
        """Direction (...) of a link's x axis [rad].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        array (...)
            [rad]
        """
        return np.asarray(self._of(self.q, link))

    def spin(self, link: str) -> Real:
        """Angular speed (...) of a link [rad/s].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        array (...)
            [rad/s]
        """
        return np.asarray(self._of(self.qdot, link))

    def spin_rate(self, link: str) -> Real:
        """Angular acceleration (...) of a link [rad/s²].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        array (...)
            [rad/s²]
        """
        return np.asarray(self._of(self.qddot, link))

    @cached_property
    def _directions(self) -> Complex:
        return np.asarray(np.exp(1j * self.q[..., : len(self.linkage.moving)]))

    def direction(self, link: str) -> Complex:
        """Direction (...) of a link's x axis, as a unit vector.

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        complex array (...)
            x + iy.
        """
        return np.ones(self.shape, dtype=complex) if link == self.linkage.ground else self._of(self._directions, link)

    @cached_property
    def _origins(self) -> Complex:
        return self.closure.origins(self.q)

    @cached_property
    def _velocities(self) -> Complex | None:
        return None if self.qdot is None else self.closure.origin_velocities(self.q, self.qdot)

    @cached_property
    def _accelerations(self) -> Complex | None:
        if self.qdot is None or self.qddot is None:
            return None
        return self.closure.origin_accelerations(self.q, self.qdot, self.qddot)

    def origin(self, link: str) -> Complex:
        """Position (...) of the origin of a link's frame [mm].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        complex array (...)
            x + iy [mm].
        """
        return np.asarray(self._of(self._origins, link))

    def velocity(self, link: str) -> Complex:
        """Velocity (...) of the origin of a link's frame [mm/s].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        complex array (...)
            x + iy [mm/s].
        """
        return np.asarray(self._of(self._velocities, link))

    def acceleration(self, link: str) -> Complex:
        """Acceleration (...) of the origin of a link's frame [mm/s²].

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        complex array (...)
            x + iy [mm/s²].
        """
        return np.asarray(self._of(self._accelerations, link))

    def instant_centre(self, link: str, against: str) -> Complex:
        """Point (...) about which a link turns against another, where both have the same velocity; it needs rates.

        Parameters
        ----------
        link, against : str
            Their names.

        Returns
        -------
        complex array (...)
            x + iy [mm], NaN where it lies at infinity: the links do not turn against each other, or it is so far that
            the turning is rounding.

        References
        ----------
        Derived: v + i w (z - o) of both links are equal at z, for their velocities v, spins w and origins o.
        """
        (v, w, o), (other_v, other_w, other_o) = (
            (self.velocity(name), self.spin(name), self.origin(name)) for name in (link, against)
        )
        spin, moved = w - other_w, 1j * (v - other_v) + other_w * (o - other_o)
        far = np.abs(moved) >= _INFINITE * self.linkage.longest * np.abs(spin)
        return np.asarray(o + moved * (1.0 / np.where(far, np.nan, spin)))

    def arm(self, link: str, point: str) -> Complex:
        """Arm (...) from the origin of a link's frame to one of its points, global axes [mm].

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex array (...)
            x + iy [mm].
        """
        return np.asarray(self.direction(link) * complex(*self.linkage.links[link].points[point]))

    def position(self, link: str, point: str) -> Complex:
        """Position (...) of a link's point [mm].

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex array (...)
            x + iy [mm].
        """
        return np.asarray(self.origin(link) + self.arm(link, point))

    def along(self, joint: str) -> Complex:
        """Direction (...) of a joint's slot or guide, global axes.

        Parameters
        ----------
        joint : str
            Its name.

        Returns
        -------
        complex array (...)
            Unit vector; x for a joint that does not slide.
        """
        record = self.linkage.joints[joint]
        if record.carrier is None:
            return np.ones(self.shape, dtype=complex)
        return np.asarray(self.direction(record.carrier) * np.exp(1j * record.direction))

    def axes(self, link: str) -> Real:
        """The link's x, y and z as columns (..., 3, 3) in global axes.

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        array (..., 3, 3)
            A rotation about z.
        """
        turn, found = self.direction(link), np.zeros((*self.shape, 3, 3))
        found[..., 0, 0] = found[..., 1, 1] = turn.real
        found[..., 1, 0], found[..., 0, 1], found[..., 2, 2] = turn.imag, -turn.imag, 1.0
        return found


def vector(planar: Complex) -> Real:
    """Return complex vectors x + iy (...) as (..., 3).

    Parameters
    ----------
    planar : complex array (...)
        x + iy.

    Returns
    -------
    array (..., 3)
        x, y and 0.
    """
    return np.stack([planar.real, planar.imag, np.zeros(planar.shape)], axis=-1)
