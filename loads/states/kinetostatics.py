"""Joint forces and drive torque over a motion, with the links' inertia after D'Alembert.

At every pose each link is cut free, and

    sum F = m a_G,      sum (r x F)_z + M_z = (r_G x m a_G)_z + I_G alpha

about the origin of its frame, over joint forces, applied loads and the drive torque (Norton, Design
of Machinery, 5th ed., chapter 11): the equations of ``loads/statics/statics.py`` for all poses at
once. Joints have no friction.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CaseError
from geometry.linkage.linkage import Linkage
from geometry.linkage.motion import Motion
from loads.records.applied import BodyForce, PointLoad
from loads.states.actions import PartMass, StatedLoad
from loads.statics.statics import NEARLY_SINGULAR, Drive, check_drive

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_BLOCK = 1024
"""Poses solved at once, so that the matrices stay in the processor's cache."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Kinetostatics:
    """Joint forces, drive torque and power at the n poses of a motion under one set of loads.

    forces    joint -> (n, 2) force of the joint's first link on its second, global axes [N]
    moments   slider -> (n,) moment of its first link on its second about the joint's point [N mm]
    torque    (n,) drive torque on the driven link, counter-clockwise positive [N mm]; zero where the drive pushes
    push      (n,) drive force on the driven link along its guide [N]; zero where the drive turns. The slider's force
              holds it
    leverage  (n,) speed of the driven angle, times the longest link, over the size of all speeds of the
              linkage (of the driven travel, over it): 0 at a dead point of the driven link, at most 1
    residual  (n,) largest unbalanced force or moment over the longest link, as a share of the load
    power     the terms of the energy balance

    Where the leverage is below ``loads.statics.statics.NEARLY_SINGULAR`` forces and torque grow without bound:
    they are NaN there.
    """

    motion: Motion
    drive: Drive
    forces: Mapping[str, Real]
    moments: Mapping[str, Real]
    torque: Real
    push: Real
    leverage: Real
    residual: Real
    power: "Power"

    @cached_property
    def dead_points(self) -> tuple[float, ...]:
        """Values of the motion's coordinate [rad, mm] at which the driven link turns back, so that it cannot drive."""
        return dead_points(self.motion, self.drive)

    @cached_property
    def drive_power(self) -> Real:
        """Power of the drive (n,) [N mm/s]."""
        linkage = self.motion.linkage
        if self.drive.pushes(linkage):
            return np.asarray(self.push * self.drive.sign(linkage) * self.motion.travel_rate(self.drive.joint))
        other = _counterpart(linkage, self.drive)
        relative = self.motion.angular_speed(self.drive.link) - self.motion.angular_speed(other)
        return np.asarray(self.torque * relative)

    @cached_property
    def imbalance(self) -> Real:
        """What the energy balance lacks (n,) [N mm/s]: drive and load power less the rates of both energies."""
        return np.asarray(self.drive_power + self.power.applied - self.power.kinetic_rate - self.power.potential_rate)


@dataclass(frozen=True, kw_only=True, eq=False)
class Power:
    """Energies [N mm] and powers [N mm/s] at the n poses.

    kinetic         (n,) kinetic energy of the links; zero where inertia is left out
    kinetic_rate    (n,) its rate
    potential       (n,) potential energy of the weights that are proportional to mass
    potential_rate  (n,) its rate
    applied         (n,) power of all other applied loads
    """

    kinetic: Real
    kinetic_rate: Real
    potential: Real
    potential_rate: Real
    applied: Real


@dataclass(frozen=True)
class _Bodies:
    """Complex positions, velocities and accelerations of the moving links' frames, all (n, links)."""

    motion: Motion

    @cached_property
    def direction(self) -> Complex:
        return np.asarray(np.exp(1j * self.motion.q[:, : len(self.motion.linkage.moving)]))

    @cached_property
    def spin(self) -> Real:
        return self.motion.qdot[:, : len(self.motion.linkage.moving)]

    @cached_property
    def spin_rate(self) -> Real:
        return self.motion.qddot[:, : len(self.motion.linkage.moving)]

    @cached_property
    def _local(self) -> Complex:
        """The first point of every moving link in the link's frame, by which the frame's origin is found."""
        links = self.motion.linkage.links
        return np.array([complex(*next(iter(links[n].points.values()))) for n in self.motion.linkage.moving])

    @cached_property
    def _columns(self) -> list[int]:
        links = self.motion.linkage.links
        return [self.motion.column(n, next(iter(links[n].points))) for n in self.motion.linkage.moving]

    @cached_property
    def origin(self) -> Complex:
        return np.asarray(self.motion.points[:, self._columns] - self.direction * self._local)

    @cached_property
    def velocity(self) -> Complex:
        return np.asarray(
            self.motion.point_velocities[:, self._columns] - 1j * self.spin * self.direction * self._local
        )

    @cached_property
    def acceleration(self) -> Complex:
        turning = (1j * self.spin_rate - self.spin**2) * self.direction * self._local
        return np.asarray(self.motion.point_accelerations[:, self._columns] - turning)

    @cached_property
    def virtual_turn(self) -> Real:
        """Derivatives of the links' angles by the coordinate's angle."""
        return self.motion.first[:, : len(self.motion.linkage.moving)]

    @cached_property
    def virtual_shift(self) -> Complex:
        """Derivatives of the frames' origins by the coordinate's angle [mm]."""
        return np.asarray(
            self.motion.points_first[:, self._columns] - 1j * self.virtual_turn * self.direction * self._local
        )


@dataclass(frozen=True, eq=False)
class _Wrenches:
    """Forces (n, links) and moments about the frames' origins (n, links)."""

    force: Complex
    moment: Real


def solve_kinetostatics(
    motion: Motion,
    drive: Drive | None,
    loads: Sequence[StatedLoad],
    masses: Mapping[str, PartMass] | None = None,
) -> Kinetostatics:
    """Solve joint forces and drive torque at every pose of a motion.

    drive   the driven link and the joint about which it is driven
    loads   constant in global axes, or in the axes of their link; weights too
    masses  the links whose inertia counts; without it the motion is quasi-static

    Raises ``CaseError`` where equilibrium alone does not give the joint forces, or where the driven
    link does not turn during the whole motion.
    """
    linkage = motion.linkage
    check_drive(linkage, drive)
    if drive is None:
        raise CaseError("drive: the linkage moves, but nothing drives it; add a [drive] with its link and joint")
    bodies = _Bodies(motion)
    leverage = _leverage(bodies, drive)
    held = leverage >= NEARLY_SINGULAR
    if not np.any(held):
        raise CaseError(
            f"drive.link: '{drive.link}' does not move at joint '{drive.joint}' during this motion, "
            "so nothing there can drive it; drive a link that moves"
        )
    weights = [load.load for load in loads if isinstance(load.load, BodyForce)]
    others = [load for load in loads if not isinstance(load.load, BodyForce)]
    weight, applied = _weight(bodies, weights), _applied(bodies, others)
    inertia = _inertia(bodies, masses or {})
    demand = _Wrenches(inertia.force - weight.force - applied.force, inertia.moment - weight.moment - applied.moment)
    equations = _Equations(bodies, drive)
    unknowns, residual = equations.solve(demand, held)
    forces, moments = equations.joints(unknowns)
    driven, still = unknowns[:, -1], np.where(held, 0.0, np.nan)
    pushes = drive.pushes(linkage)
    if pushes:
        forces[drive.joint] = forces[drive.joint] + drive.sign(linkage) * equations.along(driven)
    return Kinetostatics(
        motion=motion,
        drive=drive,
        forces=forces,
        moments=moments,
        torque=still if pushes else driven * linkage.longest,
        push=driven if pushes else still,
        leverage=leverage,
        residual=residual,
        power=_power(bodies, weights, applied, masses or {}),
    )


def torque_by_virtual_work(
    motion: Motion, drive: Drive, loads: Sequence[StatedLoad], masses: Mapping[str, PartMass] | None = None
) -> Real:
    """Drive torque (n,) [N mm], or force [N], by the principle of virtual work alone; NaN at dead points.

    It needs the motion alone, hence serves redundant linkages too, whose joint forces do not follow
    from equilibrium (Norton, 5th ed., chapter 10).
    """
    bodies = _Bodies(motion)
    weights = [load.load for load in loads if isinstance(load.load, BodyForce)]
    others = [load for load in loads if not isinstance(load.load, BodyForce)]
    weight, applied, inertia = _weight(bodies, weights), _applied(bodies, others), _inertia(bodies, masses or {})
    force = inertia.force - weight.force - applied.force
    moment = inertia.moment - weight.moment - applied.moment
    work = np.sum((np.conj(force) * bodies.virtual_shift).real + moment * bodies.virtual_turn, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        torque = work / _relative_motion(motion, drive)
    return np.where(_leverage(bodies, drive) >= NEARLY_SINGULAR, torque, np.nan)


def is_determinate(linkage: Linkage) -> bool:
    """Return True where equilibrium gives all joint forces of the driven linkage: as many equations as unknowns."""
    return _unknowns(linkage) == 3 * len(linkage.moving)


def _unknowns(linkage: Linkage) -> int:
    """Force components of all joints, and the drive's torque or force."""
    return sum(1 if joint.type == "pin-in-slot" else 2 for joint in linkage.joints.values()) + 1


def _counterpart(linkage: Linkage, drive: Drive) -> str:
    """The link that carries the reaction of the drive torque."""
    first, second = linkage.joints[drive.joint].links
    return second if first == drive.link else first


def dead_points(motion: Motion, drive: Drive) -> tuple[float, ...]:
    """Return the values of a motion's coordinate [rad, mm] at which the driven link turns back."""
    if drive.pushes(motion.linkage):
        return motion.stopping_points(drive.joint)
    return motion.turning_points(drive.link, _counterpart(motion.linkage, drive))


def _relative_motion(motion: Motion, drive: Drive) -> Real:
    """Turn of the driven link against its counterpart, or its way along the guide [mm], by the coordinate."""
    if drive.pushes(motion.linkage):
        column = len(motion.linkage.moving) + motion.closure.slots.index(drive.joint)
        return drive.sign(motion.linkage) * motion.first[:, column]
    turn = motion.first[:, motion.linkage.moving.index(drive.link)]
    other = _counterpart(motion.linkage, drive)
    if other != motion.linkage.ground:
        turn = turn - motion.first[:, motion.linkage.moving.index(other)]
    return turn


def _leverage(bodies: _Bodies, drive: Drive) -> Real:
    """How well the driven link moves the others (n,).

    The scaled virtual velocities are a vector that the joint forces' columns of the scaled
    equilibrium matrix are normal to, so that this is an upper bound of its smallest singular value.
    """
    longest = bodies.motion.linkage.longest
    unit = 1.0 if drive.pushes(bodies.motion.linkage) else longest
    size = np.sqrt(np.sum(np.abs(bodies.virtual_shift) ** 2 + (longest * bodies.virtual_turn) ** 2, axis=-1))
    return np.asarray(unit * np.abs(_relative_motion(bodies.motion, drive)) / size)


def _weight(bodies: _Bodies, weights: Sequence[BodyForce]) -> _Wrenches:
    out = _nothing(bodies)
    for load in weights:
        if load.link in bodies.motion.linkage.moving:
            k = bodies.motion.linkage.moving.index(load.link)
            pull = load.mass * complex(*load.acceleration[:2])
            out.force[:, k] += pull
            out.moment[:, k] += (np.conj(bodies.direction[:, k] * complex(*load.centroid)) * pull).imag
    return out


def _applied(bodies: _Bodies, loads: Sequence[StatedLoad]) -> _Wrenches:
    """Point and line loads: force F, static moment S = sum conj(station) F in the link's frame, couple C.

    The moment about the origin is Im(e^{-i phi} S) + C for components in global axes, Im(S) + C for
    components in the link's.
    """
    out = _nothing(bodies)
    links = bodies.motion.linkage.links
    for stated in loads:
        load = stated.load
        if isinstance(load, BodyForce) or load.link not in bodies.motion.linkage.moving:
            continue
        if isinstance(load, PointLoad):
            force, couple = complex(*load.wrench[:2]), float(load.wrench[5])
            static = np.conj(complex(*links[load.link].points[load.point])) * force
        else:
            length, couple = load.end - load.start, 0.0
            first, last = complex(*load.at_start[:2]), complex(*load.at_end[:2])
            force = 0.5 * length * (first + last)
            static = length * (load.start * (first + last) / 2.0 + length * (first + 2.0 * last) / 6.0)
        k = bodies.motion.linkage.moving.index(load.link)
        turn = bodies.direction[:, k]
        if stated.axes == "link":
            out.force[:, k] += force * turn
            out.moment[:, k] += static.imag + couple
        else:
            out.force[:, k] += force
            out.moment[:, k] += (np.conj(turn) * static).imag + couple
    return out


def _inertia(bodies: _Bodies, masses: Mapping[str, PartMass]) -> _Wrenches:
    """Rates of momentum m a_G and of angular momentum about the frames' origins."""
    out = _nothing(bodies)
    for link, own in masses.items():
        if link in bodies.motion.linkage.moving:
            k = bodies.motion.linkage.moving.index(link)
            arm = bodies.direction[:, k] * complex(*own.centroid)
            spin, rate = bodies.spin[:, k], bodies.spin_rate[:, k]
            momentum = own.mass * (bodies.acceleration[:, k] + (1j * rate - spin**2) * arm)
            out.force[:, k] += momentum
            out.moment[:, k] += (np.conj(arm) * momentum).imag + own.inertia * rate
    return out


def _nothing(bodies: _Bodies) -> _Wrenches:
    shape = bodies.direction.shape
    return _Wrenches(np.zeros(shape, dtype=complex), np.zeros(shape))


def _power(bodies: _Bodies, weights: Sequence[BodyForce], applied: _Wrenches, masses: Mapping[str, PartMass]) -> Power:
    count, moving = len(bodies.direction), bodies.motion.linkage.moving
    kinetic, kinetic_rate, potential, potential_rate = (np.zeros(count) for _ in range(4))
    for link, own in masses.items():
        if link in moving:
            k = moving.index(link)
            arm = bodies.direction[:, k] * complex(*own.centroid)
            spin, rate = bodies.spin[:, k], bodies.spin_rate[:, k]
            velocity = bodies.velocity[:, k] + 1j * spin * arm
            acceleration = bodies.acceleration[:, k] + (1j * rate - spin**2) * arm
            kinetic += 0.5 * own.mass * np.abs(velocity) ** 2 + 0.5 * own.inertia * spin**2
            kinetic_rate += own.mass * (np.conj(velocity) * acceleration).real + own.inertia * spin * rate
    for load in weights:
        if load.link in moving:
            k = moving.index(load.link)
            arm = bodies.direction[:, k] * complex(*load.centroid)
            pull = load.mass * complex(*load.acceleration[:2])
            potential -= (np.conj(pull) * (bodies.origin[:, k] + arm)).real
            potential_rate -= (np.conj(pull) * (bodies.velocity[:, k] + 1j * bodies.spin[:, k] * arm)).real
    power = np.sum((np.conj(applied.force) * bodies.velocity).real + applied.moment * bodies.spin, axis=-1)
    return Power(
        kinetic=kinetic,
        kinetic_rate=kinetic_rate,
        potential=potential,
        potential_rate=potential_rate,
        applied=power,
    )


class _Equations:
    """The scaled equilibrium equations of all moving links: moments and torque over the longest link.

    Rows are Fx, Fy, Mz of each link; columns two per revolute joint (x, y), one per pin in slot
    (normal), two per slider (normal, moment), and the drive's torque or force.
    """

    def __init__(self, bodies: _Bodies, drive: Drive) -> None:
        self.bodies, self.drive = bodies, drive
        self.motion, self.linkage = bodies.motion, bodies.motion.linkage
        self.links = len(self.linkage.moving)
        self.start: dict[str, int] = {}
        columns = 0
        for name, joint in self.linkage.joints.items():
            self.start[name] = columns
            columns += 1 if joint.type == "pin-in-slot" else 2
        self.columns = _unknowns(self.linkage)
        if not is_determinate(self.linkage):
            raise CaseError(
                f"drive: statics has {3 * self.links} equilibrium equations for {self.columns} unknowns, so joint "
                "forces do not follow from equilibrium; remove redundant joints or links, or drive as many links "
                f"as the linkage has degrees of freedom (mobility {self.linkage.mobility})"
            )

    def _normal(self, joint: str, block: slice) -> Complex:
        record = self.linkage.joints[joint]
        return np.asarray(1j * np.exp(1j * (self.motion.angle(record.links[0])[block] + record.direction)))

    def _matrix(self, block: slice) -> Real:
        count = len(self.bodies.direction[block])
        matrix = np.zeros((count, 3 * self.links, self.columns))
        longest = self.linkage.longest
        for name, joint in self.linkage.joints.items():
            c = self.start[name]
            at = self.motion.points[block, self.motion.column(joint.links[1], self.linkage.joint_points(name)[1])]
            normal = None if joint.type == "revolute" else self._normal(name, block)
            for link, sign in zip(joint.links, (-1.0, 1.0), strict=True):
                if link == self.linkage.ground:
                    continue
                k = self.linkage.moving.index(link)
                arm = (at - self.bodies.origin[block, k]) / longest
                x, y = arm.real, arm.imag
                if normal is None:
                    matrix[:, 3 * k, c] = matrix[:, 3 * k + 1, c + 1] = sign
                    matrix[:, 3 * k + 2, c] = -sign * y
                    matrix[:, 3 * k + 2, c + 1] = sign * x
                    continue
                matrix[:, 3 * k, c] = sign * normal.real
                matrix[:, 3 * k + 1, c] = sign * normal.imag
                matrix[:, 3 * k + 2, c] = sign * (x * normal.imag - y * normal.real)
                if joint.type == "slider":
                    matrix[:, 3 * k + 2, c + 1] = sign
        driven = self.linkage.joints[self.drive.joint]
        if self.drive.pushes(self.linkage):
            along = self.drive.sign(self.linkage) * -1j * self._normal(self.drive.joint, block)
            at = self.motion.points[
                block, self.motion.column(driven.links[1], self.linkage.joint_points(self.drive.joint)[1])
            ]
            for link, sign in zip(driven.links, (-1.0, 1.0), strict=True):
                if link != self.linkage.ground:
                    k = self.linkage.moving.index(link)
                    arm = (at - self.bodies.origin[block, k]) / longest
                    matrix[:, 3 * k, -1] = sign * along.real
                    matrix[:, 3 * k + 1, -1] = sign * along.imag
                    matrix[:, 3 * k + 2, -1] = sign * (np.conj(arm) * along).imag
            return matrix
        for link in driven.links:
            if link != self.linkage.ground:
                sign = 1.0 if link == self.drive.link else -1.0
                matrix[:, 3 * self.linkage.moving.index(link) + 2, -1] = sign
        return matrix

    def solve(self, demand: _Wrenches, held: NDArray[np.bool_]) -> tuple[Real, Real]:
        """Unknowns (n, columns), moments over the longest link, and the residual as a share of the load (n,)."""
        count = len(held)
        rhs = np.empty((count, 3 * self.links))
        rhs[:, 0::3], rhs[:, 1::3] = demand.force.real, demand.force.imag
        rhs[:, 2::3] = demand.moment / self.linkage.longest
        unknowns, residual = np.full((count, self.columns), np.nan), np.full(count, np.nan)
        for i in range(0, count, _BLOCK):
            block = slice(i, i + _BLOCK)
            good = held[block]
            matrix, right = self._matrix(block)[good], rhs[block][good]
            found = np.linalg.solve(matrix, right[..., None])[..., 0]
            left = np.abs((matrix @ found[..., None])[..., 0] - right)
            size = np.maximum(np.max(np.abs(right), axis=-1), math.ulp(0.0))
            unknowns[block][good] = found
            residual[block][good] = np.max(left, axis=-1) / size
        return unknowns, residual

    def along(self, force: Real) -> Real:
        """Force (n, 2) of a size (n,) along the guide of the drive's joint, global axes."""
        along = -1j * self._normal(self.drive.joint, slice(None))
        return np.asarray(force[:, None] * np.stack([along.real, along.imag], axis=-1))

    def joints(self, unknowns: Real) -> tuple[dict[str, Real], dict[str, Real]]:
        """Force of each joint (n, 2) and moment of each slider (n,)."""
        forces, moments = {}, {}
        everything = slice(None)
        for name, joint in self.linkage.joints.items():
            c = self.start[name]
            if joint.type == "revolute":
                forces[name] = unknowns[:, c : c + 2]
                continue
            normal = self._normal(name, everything)
            forces[name] = unknowns[:, c, None] * np.stack([normal.real, normal.imag], axis=-1)
            if joint.type == "slider":
                moments[name] = unknowns[:, c + 1] * self.linkage.longest
        return forces, moments
