"""Equilibrium of pinned links: three equations per moving link, assembled and solved for one state or for n of them.

Each link is cut free. With r the arm from the origin of the link's frame to a joint,

    sum F_x = 0,    sum F_y = 0,    sum (r x F)_z + M_z = 0

over joint forces, applied loads and the drive torque (Norton, Design of Machinery, 5th ed., chapter 11; inertia is
among the loads, after D'Alembert). The unknown of a revolute joint is the force that the joint's first link exerts on
its second, and where the joint is bonded a moment. A pin in a slot carries a normal force, and a slider a normal force
and a moment. Friction is among the loads (``friction``).

A state is a pose of a linkage with what acts on it: poses of a motion, samples, or a linkage at offsets of its pins.
``balance`` solves n of them at once, and a state without solution leaves the others their numbers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Coordinate, Measure
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.placement import Complex, Placement
from alula.geometry.linkage.pose import Pose, held_motion, turning
from alula.loads.records.applied import Load, shifted
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.joint_reaction import JointReaction, travelled
from alula.loads.statics.system import System, require_determinate

Real = NDArray[np.float64]

NEARLY_SINGULAR = 1e-6
"""Smallest singular value of the scaled matrix below which a pose is refused."""


@dataclass(frozen=True, kw_only=True)
class Drive:
    """The drive: a torque about a joint, or a force along the guide of a slider.

    Attributes
    ----------
    link : str
        The driven link.
    joint : str
        Where it is driven against the other link of the joint, often the ground.
    stop : str
        The stop that bears in place of the drive; "" for the drive itself.
    idle : bool
        True where the pose balances by itself, so that nothing needs to hold it.
    """

    link: str
    joint: str
    stop: str = ""
    idle: bool = False

    @property
    def held(self) -> str:
        """The link that it holds, for people."""
        return f"link '{self.link}' held by stop '{self.stop}'" if self.stop else f"driven link {self.link}"

    def effort(self, linkage: Linkage) -> DriveEffort:
        """Return what the drive exerts.

        Parameters
        ----------
        linkage : Linkage

        Returns
        -------
        DriveEffort
            A force at a slider, along its guide; else a torque.
        """
        return DriveEffort.FORCE if linkage.joints[self.joint].kind.guided else DriveEffort.TORQUE

    def coordinate(self, linkage: Linkage) -> Coordinate:
        """Return what the drive holds.

        Parameters
        ----------
        linkage : Linkage

        Returns
        -------
        Coordinate
            The angle of the driven link, or the travel of the driven slider.
        """
        if self.effort(linkage) is DriveEffort.FORCE:
            return Coordinate(self.joint, Measure.TRAVEL)
        return Coordinate(self.link)

    def held_motion(self, pose: Pose) -> Real:
        """Return the motion that the drive holds: of the driven link against the other link of its joint, or a travel.

        Parameters
        ----------
        pose : Pose

        Returns
        -------
        array (coordinates,)
            As a row of ``constraint_jacobian``.
        """
        if self.effort(pose.linkage) is DriveEffort.FORCE:
            return held_motion(pose, self.coordinate(pose.linkage))
        return turning(pose, self.joint)

    def dead_point_distance(self, pose: Pose) -> float:
        """Return how far a pose is from a dead point of the drive.

        Parameters
        ----------
        pose : Pose

        Returns
        -------
        float
            As ``Pose.dead_point_distance`` counts it.
        """
        return pose.distance_holding(self.held_motion(pose))

    def sign(self, linkage: Linkage) -> float:
        """Return the sign of the driven link's motion in the joint's, which is that of its second link.

        Parameters
        ----------
        linkage : Linkage

        Returns
        -------
        float
            1 where the driven link is the joint's second, else -1.
        """
        return 1.0 if linkage.joints[self.joint].links[1] == self.link else -1.0


@dataclass(frozen=True, kw_only=True)
class Equilibrium:
    """Joint reactions and the drive's torque or force under one set of loads, at one pose or at n.

    Attributes
    ----------
    drive : Drive, optional
        None where nothing is driven.
    joints : mapping of str to JointReaction
        What the joints carry.
    drive_torque : float or array (n,)
        On the driven link, counter-clockwise positive [N mm]; 0 without drive and where it pushes.
    drive_force : float or array (n,)
        On the driven link along the guide's direction [N]; 0 unless the drive pushes. It is part of the reaction
        of the driven slider.
    residual : float or array (n,)
        Largest unbalanced force or moment over the longest link, as a share of the load.
    """

    drive: Drive | None
    joints: Mapping[str, JointReaction]
    drive_torque: Any
    drive_force: Any = 0.0
    residual: Any

    @property
    def placement(self) -> Placement:
        """Where the links stand."""
        raise NotImplementedError

    @property
    def effort(self) -> Any:
        """The drive's torque [N mm] or force [N], as its kind is; 0 without drive."""
        force = self.drive is not None and self.drive.effort(self.placement.linkage) is DriveEffort.FORCE
        return self.drive_force if force else self.drive_torque

    @property
    def driving(self) -> tuple[Any, Any]:
        """Torque [N mm] and force [N] of the drive: none where a stop or the balance of the pose takes its place."""
        drive = self.drive
        return (0.0, 0.0) if drive and (drive.stop or drive.idle) else (self.drive_torque, self.drive_force)

    def on_link(self, link: str) -> tuple[tuple[str, Real], ...]:
        """Return every joint reaction that acts on a link; the drive torque is not among them.

        Parameters
        ----------
        link : str

        Returns
        -------
        tuple of (str, array (..., 6))
            Point of the link, and wrench about it in global axes [N, N mm].
        """
        found = []
        for name, reaction in self.joints.items():
            if link in (reaction.on, reaction.by):
                sign = 1.0 if reaction.on == link else -1.0
                wrench = sign * reaction.wrench
                if link == reaction.by:
                    wrench = shifted(wrench, reaction.arm)
                found.append((self.placement.linkage.point_of(name, link), wrench))
        return tuple(found)

    def torque_on(self, link: str) -> Any:
        """Return the torque that the drive exerts on a link.

        Parameters
        ----------
        link : str

        Returns
        -------
        float or array (n,)
            The drive torque on the driven link, its reaction on the other, 0 elsewhere [N mm].
        """
        linkage = self.placement.linkage
        if self.drive is None or self.drive.effort(linkage) is DriveEffort.FORCE:
            return 0.0
        if link == self.drive.link:
            return self.drive_torque
        return -self.drive_torque if link in linkage.joints[self.drive.joint].links else 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Balance(Equilibrium):
    """Equilibrium of n states; NaN where there is none.

    Attributes
    ----------
    place : Placement
    system : System
        The equations.
    sound : bool array (...)
        Which states have a solution: those that are not at, or next to, a dead point of the drive.
    unknowns : array (..., columns)
        The solution [R] [N, N mm].
    """

    place: Placement
    system: System
    sound: NDArray[np.bool_]
    unknowns: Real

    @property
    def placement(self) -> Placement:
        """Where the links stand."""
        return self.place


@dataclass(frozen=True, kw_only=True)
class Reactions(Equilibrium):
    """Joint reactions and drive torque of one pose, with the equations that they solve.

    Attributes
    ----------
    pose : Pose
    system : System
        The equations.
    unknowns : array (columns,)
        The solution vector [R] [N, N mm].
    """

    pose: Pose
    system: System
    unknowns: Real

    @property
    def placement(self) -> Placement:
        """Where the links stand."""
        return self.pose.placement


def assemble(place: Placement, drive: Drive | None, loads: Sequence[Load]) -> System:
    """Write the three equilibrium equations in the plane of every moving link, at one pose or at n.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    drive : Drive, optional
    loads : sequence of Load
        All that acts on the links, inertia included, at these poses; components out of the plane are left out.

    Returns
    -------
    System
    """
    linkage = place.linkage
    unknowns = _unknowns(place, drive)
    matrix = np.zeros((*place.shape, 3 * len(linkage.moving), len(unknowns)))
    for c, unit in enumerate(unknowns.values()):
        matrix[..., c] = joint_column(place, *unit)
    rhs = np.zeros(matrix.shape[:-1])
    for load in loads:
        if load.link != linkage.ground:
            k = 3 * linkage.moving.index(load.link)
            rhs[..., k : k + 3] -= load.resultant(place)[..., [0, 1, 5]]
    return System(
        matrix=matrix,
        rhs=rhs,
        rows=tuple((link, kind) for link in linkage.moving for kind in ("Fx", "Fy", "Mz")),
        columns=tuple(unknowns),
        scale=linkage.longest,
    )


def joint_column(place: Placement, name: str, force: Complex, moment: Real | float) -> Real:
    """Return what a joint's force and moment put into the equations of equilibrium.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    name : str
        The joint.
    force : complex array (...)
        Of its first link on its second, x + iy, at the pin.
    moment : float or array (...)
        About the pin.

    Returns
    -------
    array (..., 3 links)
        In the order of ``System.rows``.
    """
    linkage = place.linkage
    column = np.zeros((*place.shape, 3 * len(linkage.moving)))
    first, second = linkage.joints[name].links
    at = place.position(second, linkage.joint_points(name)[1])
    for link, sign in ((first, -1.0), (second, 1.0)):
        if link != linkage.ground:
            k = 3 * linkage.moving.index(link)
            column[..., k], column[..., k + 1] = sign * force.real, sign * force.imag
            column[..., k + 2] = sign * ((np.conj(at - place.origin(link)) * force).imag + moment)
    return column


def _unknowns(place: Placement, drive: Drive | None) -> dict[str, tuple[str, Complex, float]]:
    """Return the unknowns by their columns, each a force or a moment.

    Each has its joint, and for one unit the force (...) or the moment of that joint's first link on its second.
    """
    found: dict[str, tuple[str, Complex, float]] = {}
    for name, joint in place.linkage.joints.items():
        along = place.along(name)
        if joint.slides:
            found[f"N{name}"] = name, 1j * along, 0.0
        else:
            found |= {f"R{name}x": (name, along, 0.0), f"R{name}y": (name, 1j * along, 0.0)}
        if joint.bears_moment:
            found[f"M:{name}"] = name, 0.0 * along, 1.0
    if drive is not None:
        name, sign, along = drive.joint, drive.sign(place.linkage), place.along(drive.joint)
        if drive.effort(place.linkage) is DriveEffort.FORCE:
            return found | {"P": (name, sign * along, 0.0)}
        found.pop(f"M:{name}", None)  # the drive's torque is the moment of its joint
        found["T"] = name, 0.0 * along, sign
    return found


def unknowns_of(place: Placement, drive: Drive | None, wrenches: Mapping[str, Real]) -> dict[str, Any]:
    """Return the unknowns that joints' wrenches stand for; ``joint_reactions`` goes the other way.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    drive : Drive, optional
    wrenches : mapping of str to array (..., 6)
        Joint -> what its first link exerts on its second about the second's point, global axes, with what the drive
        exerts there [N, N mm].

    Returns
    -------
    dict of str to array (...)
        By ``System.columns`` [N, N mm].
    """
    return {
        column: moment * wrenches[name][..., 5]
        if moment
        else (np.conj(force) * (wrenches[name][..., 0] + 1j * wrenches[name][..., 1])).real
        for column, (name, force, moment) in _unknowns(place, drive).items()
    }


def check_drive(linkage: Linkage, drive: Drive | None) -> None:
    """Require that the drive names a moving link and one of its joints.

    Parameters
    ----------
    linkage : Linkage
    drive : Drive, optional

    Raises
    ------
    CaseError
        Where it does not.
    """
    if drive is None:
        return
    if drive.link not in linkage.moving:
        raise CaseError(f"drive.link: '{drive.link}' is not a moving link; choose one of {', '.join(linkage.moving)}")
    if drive.joint not in linkage.joints_of(drive.link):
        raise CaseError(
            f"drive.joint: '{drive.joint}' is no joint of link '{drive.link}'; "
            f"choose one of {', '.join(linkage.joints_of(drive.link))}"
        )


def balance(place: Placement, drive: Drive | None, loads: Sequence[Load]) -> Balance:
    """Solve the equilibrium of one state or of n for the joint reactions and the drive.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    drive : Drive, optional
    loads : sequence of Load
        All that acts on the links, inertia and friction included: the same in all states, or n of each.

    Returns
    -------
    Balance

    Raises
    ------
    CaseError
        Where equilibrium alone does not give the joint forces.
    """
    system = assemble(place, drive, loads)
    require_determinate(place.linkage, system)
    sound = system.regular(NEARLY_SINGULAR)
    unknowns, residual = system.solved(sound)
    value = dict(zip(system.columns, np.moveaxis(unknowns, -1, 0), strict=True))
    none = np.where(sound, 0.0, np.nan)
    return Balance(
        place=place,
        drive=drive,
        system=system,
        sound=sound,
        unknowns=unknowns,
        joints=joint_reactions(place, drive, value),
        drive_torque=value.get("T", none),
        drive_force=value.get("P", none),
        residual=residual,
    )


def solve_statics(pose: Pose, drive: Drive | None, loads: Sequence[Load]) -> Reactions:
    """Solve the equilibrium of all links at one pose for the joint reactions and the drive torque.

    Parameters
    ----------
    pose : Pose
    drive : Drive, optional
    loads : sequence of Load
        All that acts on the links, inertia included.

    Returns
    -------
    Reactions

    Raises
    ------
    CaseError
        Where the equations have no single solution: more or fewer unknowns than equations, or a pose at or next to a
        dead point of the driven link.
    """
    check_drive(pose.linkage, drive)
    found = balance(pose.placement, drive, loads)
    if not found.sound:
        refuse_dead_point(found.system, drive)
    return Reactions(
        pose=pose,
        drive=drive,
        system=found.system,
        unknowns=found.unknowns,
        joints=found.joints,
        drive_torque=float(found.drive_torque),
        drive_force=float(found.drive_force),
        residual=float(found.residual),
    )


def refuse_dead_point(system: System, drive: Drive | None) -> None:
    """Refuse a pose at or next to a dead point, where the equations are nearly singular.

    Parameters
    ----------
    system : System
        The equations of a determinate or of a redundant linkage.
    drive : Drive, optional

    Raises
    ------
    CaseError
        Where the smallest singular value is below ``NEARLY_SINGULAR``.
    """
    smallest = float(system.singular_values[-1])
    if smallest < NEARLY_SINGULAR:
        who = "structure" if drive is None else drive.held if drive.stop else f"driven link '{drive.link}'"
        raise CaseError(
            f"pose: it is at, or next to, a dead point of the {who}: the smallest singular value of "
            f"the scaled equilibrium matrix is {smallest:.2g}, below {NEARLY_SINGULAR:g}, so joint forces would grow "
            "without bound; change the pose or drive another link"
        )


def joint_reactions(place: Placement, drive: Drive | None, value: Mapping[str, Any]) -> dict[str, JointReaction]:
    """Return the reaction at every joint.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    drive : Drive, optional
    value : mapping of str to float or array (n,)
        The unknowns of ``System.columns``, by name [N, N mm].

    Returns
    -------
    dict of str to JointReaction
        By joint.
    """
    joints = place.linkage.joints
    wrenches = {name: np.zeros((*place.shape, 6)) for name in joints}
    for column, (name, force, moment) in _unknowns(place, drive).items():
        if not moment:
            acting = value[column] * force
            wrenches[name][..., 0] += acting.real
            wrenches[name][..., 1] += acting.imag
        elif column != "T":
            wrenches[name][..., 5] = value[column]
    return {
        name: JointReaction(
            joint=name, on=joint.links[1], by=joint.links[0], wrench=wrenches[name], arm=travelled(place, name)
        )
        for name, joint in joints.items()
    }
