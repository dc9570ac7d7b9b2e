"""Loop closure of a planar linkage as one complex vector equation per loop.

With every direction as a complex number, a point P of the linkage stands at

    P = sum_l C[P, l] e^{i phi_l} + sum_j D[P, j] s_j e^{i phi_a(j)}

where phi_l is the angle of link l, s_j the travel in slot j and a(j) the link that carries the slot. The offset by
which play sets the points of a joint apart is one more s_j, which is complex and given.
C and D follow once from a spanning tree over the joints; each joint outside the tree closes one
loop, and its closure vector is a row of the same form (Norton, Design of Machinery, 5th ed.,
chapter 4, with the loops of any number of links). Jacobian and accelerations are exact.

All functions take angles of shape (..., links) and slides (..., slots), so that many poses are
handled at once.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.linkage import Linkage

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]


@dataclass(frozen=True)
class LoopClosure:
    """The closure equations of a linkage.

    Unknowns are ``[angles of the moving links, travels in the slots]`` in the order of
    ``linkage.moving`` and ``slots``; equations are real and imaginary parts of each loop, then one
    fixed angle per slider and bonded joint.

    Attributes
    ----------
    linkage : Linkage
        The linkage.
    offsets : mapping of str to complex or complex array (...)
        Joint -> where its second link's point stands off its first link's [mm], by play: in global axes at a revolute
        joint, in the frame of the first link across a slot. Zero at the joints that are left out.
    """

    linkage: Linkage
    offsets: Mapping[str, complex | Complex] = field(default_factory=dict, kw_only=True)

    def chosen(self, poses: Any) -> "LoopClosure":
        """Return the closure at the chosen poses alone.

        Parameters
        ----------
        poses : int, slice or mask (n,)
            Which of the n poses.

        Returns
        -------
        LoopClosure
        """
        own = {name: offset[poses] for name, offset in self.offsets.items() if isinstance(offset, np.ndarray)}
        return replace(self, offsets={**self.offsets, **own}) if own else self

    @cached_property
    def slots(self) -> tuple[str, ...]:
        """Names of the joints with a slot."""
        return tuple(n for n, j in self.linkage.joints.items() if j.slides)

    @cached_property
    def angles_fixed(self) -> tuple[str, ...]:
        """Names of the joints that fix a relative angle: sliders, and bonded joints with a stated angle."""
        return tuple(n for n, j in self.linkage.joints.items() if j.fixes_angle)

    @cached_property
    def unknowns(self) -> int:
        """Number of unknowns: moving links and slots."""
        return len(self.linkage.moving) + len(self.slots)

    @cached_property
    def _index(self) -> dict[str, int]:
        """Column of every link; the ground comes last."""
        return {name: i for i, name in enumerate((*self.linkage.moving, self.linkage.ground))}

    @cached_property
    def slot_links(self) -> tuple[int, ...]:
        """Column of the link that carries each slot."""
        return tuple(self._index[self.linkage.joints[n].links[0]] for n in self.slots)

    @cached_property
    def _carriers(self) -> tuple[int, ...]:
        """Column of the link in whose frame each travel and offset is."""
        first = (self.linkage.joints[n].links[0] if n in self.slots else self.linkage.ground for n in self.offsets)
        return (*self.slot_links, *(self._index[link] for link in first))

    @cached_property
    def _columns(self) -> int:
        return len(self._index) + len(self._carriers)

    def _local(self, link: str, point: str) -> complex:
        return complex(*self.linkage.links[link].points[point])

    @cached_property
    def _origins(self) -> dict[str, Complex]:
        """Row [C | D] of every link's origin."""
        rows: dict[str, Complex] = {self.linkage.ground: np.zeros(self._columns, dtype=complex)}
        for link, name in self.linkage.tree.items():
            joint = self.linkage.joints[name]
            here = joint.links.index(link)
            parent = joint.links[1 - here]
            points = self.linkage.joint_points(name)
            row = rows[parent].copy()
            row[self._index[parent]] += self._local(parent, points[1 - here])
            row[self._index[link]] -= self._local(link, points[here])
            rows[link] = row + (self._apart(name) if here == 1 else -self._apart(name))
        return rows

    def _apart(self, name: str) -> Complex:
        """Row from a joint's point on its first link to that on its second: travel along a slot, and an offset."""
        row, links = np.zeros(self._columns, dtype=complex), len(self._index)
        if name in self.slots:
            row[links + self.slots.index(name)] = np.exp(1j * self.linkage.joints[name].direction)
        if name in self.offsets:
            row[links + len(self.slots) + list(self.offsets).index(name)] = 1.0
        return row

    def _row(self, link: str, point: str) -> Complex:
        row = self._origins[link].copy()
        row[self._index[link]] += self._local(link, point)
        return row

    @cached_property
    def loops(self) -> tuple[str, ...]:
        """Joint that closes each loop."""
        return tuple(n for n in self.linkage.joints if n not in self.linkage.tree.values())

    def loop_path(self, closing: str) -> tuple[str, ...]:
        """Names of the joints round the loop that a joint closes.

        Parameters
        ----------
        closing : str
            Name of the joint that closes the loop.

        Returns
        -------
        tuple of str
            Names of joints.
        """

        def to_ground(link: str) -> list[str]:
            path = []
            while link != self.linkage.ground:
                joint = self.linkage.tree[link]
                path.append(joint)
                link = next(x for x in self.linkage.joints[joint].links if x != link)
            return path

        first, second = (to_ground(link) for link in self.linkage.joints[closing].links)
        while first and second and first[-1] == second[-1]:
            first.pop()
            second.pop()
        return (*reversed(first), closing, *second)

    @cached_property
    def _loop_rows(self) -> Complex:
        rows = np.zeros((len(self.loops), self._columns), dtype=complex)
        for i, name in enumerate(self.loops):
            joint = self.linkage.joints[name]
            first, second = self.linkage.joint_points(name)
            rows[i] = self._row(joint.links[0], first) + self._apart(name) - self._row(joint.links[1], second)
        return rows

    @cached_property
    def point_names(self) -> tuple[tuple[str, str], ...]:
        """(link, point) of every row that ``positions`` returns."""
        return tuple((link, p) for link, record in self.linkage.links.items() for p in record.points)

    @cached_property
    def _point_rows(self) -> Complex:
        return np.array([self._row(link, point) for link, point in self.point_names])

    def _directions(self, q: Real) -> tuple[Complex, Complex]:
        """e^{i phi} of all links (the ground's is 1) and of the links that carry travels and offsets."""
        moving = len(self.linkage.moving)
        e = np.ones((*q.shape[:-1], moving + 1), dtype=complex)
        np.exp(1j * q[..., :moving], out=e[..., :moving])
        return e, e[..., self._carriers]

    def _travels(self, q: Real) -> Real | Complex:
        """Travels and offsets (..., slots + offsets)."""
        slides = q[..., len(self.linkage.moving) :]
        return np.concatenate([slides, self._apart_by(q)], axis=-1) if self.offsets else slides

    def _apart_by(self, q: Real) -> Complex:
        """Offsets (..., offsets)."""
        return np.stack([np.broadcast_to(offset, q.shape[:-1]) for offset in self.offsets.values()], axis=-1)

    def _evaluate(self, rows: Complex, q: Real) -> Complex:
        links = len(self._index)
        e, along = self._directions(q)
        return np.asarray(e @ rows[:, :links].T + (self._travels(q) * along) @ rows[:, links:].T)

    def _derivative(self, rows: Complex, q: Real) -> Complex:
        """Derivative of ``_evaluate`` by the unknowns: (..., rows, unknowns)."""
        moving, links = len(self.linkage.moving), len(self._index)
        e, along = self._directions(q)
        out = np.empty((*q.shape[:-1], len(rows), self.unknowns), dtype=complex)
        out[..., :moving] = 1j * rows[:, :moving] * e[..., None, :moving]
        travels = self._travels(q)
        for k, link in enumerate(self._carriers):
            column = rows[:, links + k] * along[..., None, k]
            if k < len(self.slots):
                out[..., moving + k] = column
            if link < moving:
                out[..., link] += 1j * travels[..., None, k] * column
        return out

    def _quadratic(self, rows: Complex, q: Real, qdot: Real) -> Complex:
        """The part of the second time derivative that is quadratic in the speeds."""
        moving, links = len(self.linkage.moving), len(self._index)
        e, along = self._directions(q)
        spin = np.zeros_like(e, dtype=float)
        spin[..., :moving] = qdot[..., :moving]
        out = -(spin**2 * e) @ rows[:, :links].T
        if self._carriers:
            turn, rate = spin[..., self._carriers], np.zeros(along.shape)
            rate[..., : len(self.slots)] = qdot[..., moving:]
            out = out + ((2j * rate * turn - self._travels(q) * turn**2) * along) @ rows[:, links:].T
        return np.asarray(out)

    def positions(self, q: Real) -> Complex:
        """Every point of ``point_names`` in global axes [mm], as x + iy.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            x + iy of the points (..., points) [mm].
        """
        return self._evaluate(self._point_rows, q)

    def velocities(self, q: Real, qdot: Real) -> Complex:
        """Velocity of every point [mm/s].

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        qdot : ndarray
            Rates of the unknowns (..., unknowns) [rad/s, mm/s].

        Returns
        -------
        ndarray
            Velocities (..., points) [mm/s].
        """
        return np.asarray((self.point_rates(q) @ qdot[..., None])[..., 0])

    def accelerations(self, q: Real, qdot: Real, qddot: Real) -> Complex:
        """Acceleration of every point [mm/s²].

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        qdot : ndarray
            Rates of the unknowns (..., unknowns) [rad/s, mm/s].
        qddot : ndarray
            Second rates of the unknowns (..., unknowns) [rad/s², mm/s²].

        Returns
        -------
        ndarray
            Accelerations (..., points) [mm/s²].
        """
        linear = (self.point_rates(q) @ qddot[..., None])[..., 0]
        return np.asarray(linear + self._quadratic(self._point_rows, q, qdot))

    @cached_property
    def _origin_rows(self) -> Complex:
        return np.array([self._origins[n] for n in self.linkage.moving])

    def origins(self, q: Real) -> Complex:
        """Origin of every moving link's frame in global axes [mm].

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            x + iy of the origins (..., moving links) [mm].
        """
        return self._evaluate(self._origin_rows, q)

    def origin_velocities(self, q: Real, qdot: Real) -> Complex:
        """Velocity of every moving link's origin.

        Parameters
        ----------
        q, qdot : ndarray
            Unknowns (..., unknowns) and their rates [1/s].

        Returns
        -------
        ndarray
            Velocities of the origins (..., moving links) [mm/s].
        """
        return np.asarray((self._derivative(self._origin_rows, q) @ qdot[..., None])[..., 0])

    def origin_accelerations(self, q: Real, qdot: Real, qddot: Real) -> Complex:
        """Acceleration of every moving link's origin.

        Parameters
        ----------
        q, qdot, qddot : ndarray
            Unknowns (..., unknowns), their rates [1/s] and second rates [1/s²].

        Returns
        -------
        ndarray
            Accelerations of the origins (..., moving links) [mm/s²].
        """
        return self.origin_velocities(q, qddot) + self._quadratic(self._origin_rows, q, qdot)

    def loosened(self, q: Real, name: str, offset: complex) -> tuple[Real, Complex]:
        """Derivatives of ``residual`` and ``positions`` by a joint's offset, with the unknowns as they are.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        name : str
            Name of the joint.
        offset : complex
            Direction of its offset, as in ``offsets``.

        Returns
        -------
        tuple of ndarray
            By mm of offset (..., equations), (..., points).
        """
        other = replace(self, offsets={name: offset})
        by = other._apart_by(q) * other._directions(q)[1][..., -1:]
        loops, points = by * other._loop_rows[:, -1], by * other._point_rows[:, -1]
        fixed = np.zeros((*q.shape[:-1], len(self.angles_fixed)))
        return np.concatenate([_split(loops), fixed], axis=-1), points

    def point_rates(self, q: Real) -> Complex:
        """Derivative of ``positions`` by the unknowns.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            (..., points, unknowns).
        """
        return self._derivative(self._point_rows, q)

    def residual(self, q: Real) -> Real:
        """Closure equations (..., equations): mm for loops, longest link times rad for fixed angles.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            Residuals (..., equations) [mm].
        """
        return np.concatenate([_split(self._evaluate(self._loop_rows, q)), self._angle_errors(q)], axis=-1)

    def jacobian(self, q: Real) -> Real:
        """Exact derivative of ``residual`` by the unknowns: (..., equations, unknowns).

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            Matrices (..., equations, unknowns).
        """
        loops = self._derivative(self._loop_rows, q)
        rows = np.concatenate([loops.real, loops.imag], axis=-2)
        angles = np.zeros((*q.shape[:-1], len(self.angles_fixed), self.unknowns))
        angles[...] = self._angle_rows
        return np.concatenate([rows, angles], axis=-2)

    def quadratic(self, q: Real, qdot: Real) -> Real:
        """The part of the residual's second time derivative that is quadratic in the speeds.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        qdot : ndarray
            Rates of the unknowns (..., unknowns) [rad/s, mm/s].

        Returns
        -------
        ndarray
            Terms (..., equations).
        """
        loops = _split(self._quadratic(self._loop_rows, q, qdot))
        return np.concatenate([loops, np.zeros((*q.shape[:-1], len(self.angles_fixed)))], axis=-1)

    @cached_property
    def _angle_rows(self) -> Real:
        rows = np.zeros((len(self.angles_fixed), self.unknowns))
        moving = len(self.linkage.moving)
        for i, name in enumerate(self.angles_fixed):
            for link, sign in zip(self.linkage.joints[name].links, (-1.0, 1.0), strict=True):
                if self._index[link] < moving:
                    rows[i, self._index[link]] = sign * self.linkage.longest
        return rows

    def _angle_errors(self, q: Real) -> Real:
        fixed = np.array([self.linkage.joints[n].angle for n in self.angles_fixed]) * self.linkage.longest
        error = (q @ self._angle_rows.T - fixed) / self.linkage.longest
        return np.asarray(np.arctan2(np.sin(error), np.cos(error)) * self.linkage.longest)


def _split(values: Complex) -> Real:
    return np.concatenate([values.real, values.imag], axis=-1)
