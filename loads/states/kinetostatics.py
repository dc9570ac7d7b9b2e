"""Joint forces and drive torque over a motion: the equilibrium of ``loads/statics/statics.py`` at all poses at once.

Inertia is among the loads, after D'Alembert (Norton, Design of Machinery, 5th ed., chapter 11).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import Motion
from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import loads_of
from alula.loads.acting.weight import Weight
from alula.loads.records.applied import Load, PartMass
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.momentum import centroid_motion
from alula.loads.statics.statics import NEARLY_SINGULAR, Drive, Equilibrium, balance, check_drive

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Power:
    """Energies [N mm], their rates and powers [N mm/s] at the n poses.

    Attributes
    ----------
    kinetic, kinetic_rate : array (n,)
        Kinetic energy of the links and its rate; zero where inertia is left out.
    potential, potential_rate : array (n,)
        Potential energy of the weights and its rate.
    applied : array (n,)
        Power of all other applied loads.
    """

    kinetic: Real
    kinetic_rate: Real
    potential: Real
    potential_rate: Real
    applied: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class Kinetostatics(Equilibrium):
    """Joint forces, drive torque and power at the n poses of a motion under one set of loads.

    Forces and torque grow without bound at a dead point, and are NaN there (``balance``).

    Attributes
    ----------
    motion : Motion
    leverage : array (n,)
        How well the driven link moves the others: 0 at its dead points, at most 1. The ratio of its angular speed
        times the longest link, or of its speed along the guide, to the norm of all links' speeds.
    power : Power
        The terms of the energy balance.
    """

    motion: Motion
    leverage: Real
    power: Power

    @property
    def placement(self) -> Placement:
        """Where the links stand."""
        return self.motion.placement

    @cached_property
    def forces(self) -> Mapping[str, Real]:
        """Joint -> force (n, 2) of its first link on its second in the plane, global axes [N]."""
        return {name: joint.wrench[:, :2] for name, joint in self.joints.items()}

    @cached_property
    def moments(self) -> Mapping[str, Real]:
        """Slider or bonded joint -> moment (n,) of its first link on its second about the joint's point [N mm]."""
        bearing = (name for name, joint in self.motion.linkage.joints.items() if joint.bears_moment)
        return {name: self.joints[name].wrench[:, 5] for name in bearing}

    def at(self, pose: int) -> Equilibrium:
        """Return joint forces and drive torque of one pose.

        Parameters
        ----------
        pose : int
            Its number.

        Returns
        -------
        Equilibrium
        """
        poses = self.leverage.shape
        joints = {
            name: replace(one, wrench=one.wrench[pose], arm=np.broadcast_to(one.arm, (*poses, 3))[pose])
            for name, one in self.joints.items()
        }
        torque, force, residual = (
            np.broadcast_to(of, poses)[pose] for of in (self.drive_torque, self.drive_force, self.residual)
        )
        return Equilibrium(drive=self.drive, joints=joints, drive_torque=torque, drive_force=force, residual=residual)

    @cached_property
    def dead_points(self) -> tuple[float, ...]:
        """Values of the motion's coordinate [rad, mm] at which the driven link turns back, so that it cannot drive."""
        assert self.drive is not None
        return dead_points(self.motion, self.drive)

    @cached_property
    def drive_power(self) -> Real:
        """Power of the drive (n,) [N mm/s]."""
        assert self.drive is not None
        return np.asarray(self.effort * relative_motion(self.motion, self.drive) * self.motion.speed)

    @cached_property
    def imbalance(self) -> Real:
        """What the energy balance lacks (n,) [N mm/s]: drive and load power less the rates of both energies."""
        return np.asarray(self.drive_power + self.power.applied - self.power.kinetic_rate - self.power.potential_rate)


def solve_kinetostatics(motion: Motion, drive: Drive | None, loads: Sequence[Load], power: Power) -> Kinetostatics:
    """Solve joint forces and drive torque at every pose of a motion.

    Parameters
    ----------
    motion : Motion
        The n poses.
    drive : Drive
    loads : sequence of Load
        All that acts on the links, inertia included.
    power : Power
        From ``energies``; it goes into the result unchanged.

    Returns
    -------
    Kinetostatics

    Raises
    ------
    CaseError
        Where equilibrium alone does not give the joint forces, or where the driven link does not turn during the
        whole motion.
    """
    check_drive(motion.linkage, drive)
    if drive is None:
        raise CaseError("drive: the linkage moves, but nothing drives it; add a [drive] with its link and joint")
    moving = leverage(motion, drive)
    if not np.any(moving >= NEARLY_SINGULAR):
        raise CaseError(
            f"drive.link: '{drive.link}' does not move at joint '{drive.joint}' during this motion, "
            "so nothing there can drive it; drive a link that moves"
        )
    found = balance(motion.placement, drive, loads)
    return Kinetostatics(
        motion=motion,
        drive=drive,
        joints=found.joints,
        drive_torque=found.drive_torque,
        drive_force=found.drive_force,
        leverage=moving,
        residual=found.residual,
        power=power,
    )


def structure_over(motion: Motion, loads: Sequence[Load], power: Power) -> Kinetostatics:
    """Solve joint forces of a structure at every instant of a cycle of loads.

    Parameters
    ----------
    motion : Motion
        That stands still.
    loads : sequence of Load
    power : Power

    Returns
    -------
    Kinetostatics
        Its leverage is 1: there is no drive that could lose it.
    """
    found = balance(motion.placement, None, loads)
    return Kinetostatics(
        motion=motion,
        drive=None,
        joints=found.joints,
        drive_torque=found.drive_torque,
        drive_force=found.drive_force,
        leverage=np.ones(len(motion.angles)),
        residual=found.residual,
        power=power,
    )


def torque_by_virtual_work(motion: Motion, drive: Drive, loads: Sequence[Load]) -> Real:
    """Return the drive torque or force by virtual work.

    It needs no joint forces, so that it serves redundant linkages too.

    Parameters
    ----------
    motion : Motion
        The n poses.
    drive : Drive
    loads : sequence of Load
        All that acts on the links, inertia included.

    Returns
    -------
    array (n,)
        Torque [N mm], or force [N] where the drive pushes; NaN at dead points.

    References
    ----------
    Norton, Design of Machinery, 5th ed., chapter 10.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        torque = -work(loads, motion.placement, motion.virtual) / relative_motion(motion, drive)
    return np.where(leverage(motion, drive) >= NEARLY_SINGULAR, torque, np.nan)


def is_determinate(linkage: Linkage) -> bool:
    """Return True where the driven linkage has as many equations of equilibrium as unknowns.

    Parameters
    ----------
    linkage : Linkage

    Returns
    -------
    bool
    """
    return linkage.borne + 1 == 3 * len(linkage.moving)


def _counterpart(linkage: Linkage, drive: Drive) -> str:
    """Return the link that carries the reaction of the drive torque."""
    first, second = linkage.joints[drive.joint].links
    return second if first == drive.link else first


def dead_points(motion: Motion, drive: Drive) -> tuple[float, ...]:
    """Return where in a motion the driven link turns back.

    Parameters
    ----------
    motion : Motion
    drive : Drive

    Returns
    -------
    tuple of float
        Values of the motion's coordinate [rad, mm].
    """
    if drive.effort(motion.linkage) is DriveEffort.FORCE:
        return motion.stopping_points(drive.joint)
    return motion.turning_points(drive.link, _counterpart(motion.linkage, drive))


def relative_motion(motion: Motion, drive: Drive) -> Real:
    """Return the derivative by the coordinate of the driven link's angle or travel against the other link.

    Parameters
    ----------
    motion : Motion
        The n poses.
    drive : Drive

    Returns
    -------
    array (n,)
        Of an angle by an angle without unit, of a travel by an angle [mm].
    """
    held = drive.coordinate(motion.linkage)
    if held.slides:
        return drive.sign(motion.linkage) * motion.first[:, held.column(motion.closure)]
    return motion.virtual.spin(drive.link) - motion.virtual.spin(_counterpart(motion.linkage, drive))


def leverage(motion: Motion, drive: Drive) -> Real:
    """Return the leverage of the driven link: see ``Kinetostatics``.

    Joint forces do no virtual work, so their columns of the scaled equilibrium matrix are normal to the scaled virtual
    velocities. Hence the leverage is an upper bound of the matrix's smallest singular value.

    Parameters
    ----------
    motion : Motion
        The n poses.
    drive : Drive

    Returns
    -------
    array (n,)
        From 0, at a dead point, to 1.
    """
    longest, moved = motion.linkage.longest, motion.virtual
    unit = 1.0 if drive.coordinate(motion.linkage).slides else longest
    squares = [np.abs(moved.velocity(n)) ** 2 + (longest * moved.spin(n)) ** 2 for n in motion.linkage.moving]
    return np.asarray(unit * np.abs(relative_motion(motion, drive)) / np.sqrt(np.sum(squares, axis=0)))


def work(loads: Sequence[Load], place: Placement, moved: Placement) -> Real:
    """Return the power of loads at the velocities of ``moved``, or their virtual work at virtual ones.

    Parameters
    ----------
    loads : sequence of Load
    place : Placement
        The n poses.
    moved : Placement
        The same with rates.

    Returns
    -------
    array (n,)
        [N mm/s], or [N mm] per unit of the coordinate.
    """
    total = np.zeros(place.shape)
    for load in loads:
        if load.link != place.linkage.ground:
            wrench, velocity = load.resultant(place), moved.velocity(load.link)
            total += wrench[..., 0] * velocity.real + wrench[..., 1] * velocity.imag
            total += wrench[..., 5] * moved.spin(load.link)
    return total


def energies(
    place: Placement, weights: Sequence[Weight], applied: Sequence[Load], masses: Mapping[str, PartMass]
) -> Power:
    """Return the energies of moving masses and the power of the loads on them.

    Parameters
    ----------
    place : Placement
        The n poses with their rates.
    weights : sequence of Weight
    applied : sequence of Load
        All others.
    masses : mapping of str to PartMass
        Of the links with inertia.

    Returns
    -------
    Power
    """
    kinetic, kinetic_rate = np.zeros(place.shape), np.zeros(place.shape)
    for link, own in masses.items():
        spin, rate = place.spin(link), place.spin_rate(link)
        _, velocity, acceleration = centroid_motion(place, link, own)
        kinetic += 0.5 * own.mass * np.abs(velocity) ** 2 + 0.5 * own.inertia * spin**2
        kinetic_rate += own.mass * (np.conj(velocity) * acceleration).real + own.inertia * spin * rate
    return Power(
        kinetic=kinetic,
        kinetic_rate=kinetic_rate,
        potential=sum((one.potential(place) for one in weights), np.zeros(place.shape)),
        potential_rate=-work(loads_of(weights, place.at_rest), place, place),
        applied=work(applied, place, place),
    )
