"""Equilibrium of pinned links: three equations per moving link, assembled for one pose or for n of them.

Each link is cut free. With r the arm from the origin of the link's frame to a joint,

    sum F_x = 0,    sum F_y = 0,    sum (r x F)_z + M_z = 0

over joint forces, applied loads and the drive torque (Norton, Design of Machinery, 5th ed., chapter 11; inertia is
among the loads, after D'Alembert). The unknown of a revolute joint is the force that the joint's first link exerts on
its second; a pin in a slot carries a normal force, a slider a normal force and a moment. Joints have no friction.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CaseError
from geometry.linkage.linkage import Linkage
from geometry.linkage.placement import Complex, Placement, vector
from geometry.linkage.pose import Pose
from loads.records.applied import Load, shifted

Real = NDArray[np.float64]

NEARLY_SINGULAR = 1e-6
"""Smallest singular value of the scaled matrix below which a pose is refused."""


ROUNDING = 1e-13
"""Share of the largest force below which a value is rounding."""


@dataclass(frozen=True, kw_only=True)
class Drive:
    """The drive: it turns ``link`` about ``joint`` against the other link there (often the ground).

    Where the joint is a slider it pushes the link along the guide instead.
    """

    link: str
    joint: str

    def pushes(self, linkage: Linkage) -> bool:
        """Whether the drive is a force along a guide, and no torque."""
        return linkage.joints[self.joint].type == "slider"

    def dead_point_distance(self, pose: Pose) -> float:
        """How far a pose is from a dead point of the driven link or slider (``Pose.dead_point_distance``)."""
        slides = self.pushes(pose.linkage)
        return pose.dead_point_distance(self.joint if slides else self.link, slides=slides)

    def sign(self, linkage: Linkage) -> float:
        """Return 1 where the driven link is the joint's second, so that its motion is that of the joint; else -1."""
        return 1.0 if linkage.joints[self.joint].links[1] == self.link else -1.0


@dataclass(frozen=True, kw_only=True)
class JointReaction:
    """What one link does to the other at a joint, at one pose or at n.

    Attributes
    ----------
    joint, on, by : str
        The joint, its second link and its first.
    wrench : array (..., 6)
        What ``by`` does to ``on``, about the pin, global axes [N, N mm].
    arm : array (..., 3)
        From the point of link ``by`` to the pin, which has travelled in a slot or along a guide [mm].
    """

    joint: str
    on: str
    by: str
    wrench: Real
    arm: Real = field(default_factory=lambda: np.zeros(3))

    @property
    def force(self) -> Real:
        """Force (..., 3) [N]."""
        return self.wrench[..., :3]

    @property
    def magnitude(self) -> float:
        """Size of the force at one pose [N]."""
        return float(np.linalg.norm(self.wrench[:3]))


@dataclass(frozen=True, kw_only=True)
class System:
    """The equilibrium equations [A][R] = [b], with a name for every row and column.

    Attributes
    ----------
    matrix : array (..., 3 links, unknowns)
        Force rows in N, moment rows in N mm.
    rhs : array (..., 3 links)
        The loads, with their sign turned.
    rows : tuple of (link, "Fx" | "Fy" | "Mz")
        Names of the rows.
    columns : tuple of str
        Names of the unknowns: RAx, RAy, ..., T.
    scale : float
        Length by which moments are divided before singular values are taken [mm].
    """

    matrix: Real
    rhs: Real
    rows: tuple[tuple[str, str], ...]
    columns: tuple[str, ...]
    scale: float

    @cached_property
    def row_scale(self) -> Real:
        """By what each row is divided (rows,)."""
        return np.array([self.scale if kind == "Mz" else 1.0 for _, kind in self.rows])

    @cached_property
    def column_scale(self) -> Real:
        """By what each unknown without dimension is multiplied (unknowns,)."""
        return np.array([self.scale if name == "T" or name.startswith("M:") else 1.0 for name in self.columns])

    @cached_property
    def scaled(self) -> Real:
        """The matrix without dimensions: moments and the torque divided by ``scale``."""
        return np.asarray(self.matrix * (self.column_scale / self.row_scale[:, None]))

    @cached_property
    def singular_values(self) -> Real:
        """Singular values (..., unknowns) of the scaled matrix, falling."""
        return np.asarray(np.linalg.svd(self.scaled, compute_uv=False), dtype=float)

    @property
    def condition(self) -> float:
        """Condition number of the scaled matrix (2-norm)."""
        smallest = float(self.singular_values[-1])
        return float(self.singular_values[0]) / smallest if smallest > 0.0 else math.inf

    def solved(self) -> tuple[Real, Real]:
        """Return the unknowns (..., unknowns) and the residual (...): the largest one, as a share of the load.

        Unknowns that are but rounding beside the largest are zero; as loads on a link these would not balance.
        """
        right = self.rhs / self.row_scale
        unknowns = np.linalg.solve(self.scaled, right[..., None])[..., 0]
        largest = np.abs(unknowns).max(axis=-1, keepdims=True, initial=0.0)
        unknowns = np.where(np.abs(unknowns) <= ROUNDING * largest, 0.0, unknowns)
        left = (self.scaled @ unknowns[..., None])[..., 0] - right
        size = np.maximum(np.abs(right).max(axis=-1, initial=0.0), 1e-300)
        return unknowns * self.column_scale, np.abs(left).max(axis=-1) / size


@dataclass(frozen=True, kw_only=True)
class Equilibrium:
    """Joint forces and what the drive exerts, at one pose or at n, under one set of loads.

    Attributes
    ----------
    drive : Drive, optional
        None where nothing is driven.
    joints : mapping of str to JointReaction
        What the joints carry.
    drive_torque : float or array (n,)
        On the driven link, counter-clockwise positive [N mm]; 0 without drive and where it pushes.
    drive_force : float or array (n,)
        On the driven link along the guide's direction [N]; 0 unless the drive pushes. The slider's own reaction
        holds it.
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

    def on_link(self, link: str) -> tuple[tuple[str, Real], ...]:
        """Return (point, wrench (..., 6) about it in global axes) of every joint reaction that acts on a link.

        The drive torque is not among them: see ``drive_torque``.
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
        """Drive torque that acts on a link [N mm]: on the driven link, and its reaction on the other."""
        linkage = self.placement.linkage
        if self.drive is None or self.drive.pushes(linkage):
            return 0.0
        if link == self.drive.link:
            return self.drive_torque
        return -self.drive_torque if link in linkage.joints[self.drive.joint].links else 0.0


@dataclass(frozen=True, kw_only=True)
class Reactions(Equilibrium):
    """Joint reactions and drive torque of one pose, with the equations that have them.

    Attributes
    ----------
    pose, system
        The pose, and its equations.
    unknowns : array (columns,)
        The solution vector [R].
    """

    pose: Pose
    system: System
    unknowns: Real

    @property
    def placement(self) -> Placement:
        """Where the links stand."""
        return self.pose.placement


def assemble(place: Placement, drive: Drive | None, loads: Sequence[Load]) -> System:
    """Write the equilibrium equations of every moving link, at one pose or at n.

    The plane's three equations alone: out-of-plane components do not enter.

    Parameters
    ----------
    place, drive
        Where the links stand, and what is driven.
    loads : sequence of Load
        All that acts on the links, inertia included, at these poses.
    """
    linkage = place.linkage
    unknowns = [(column, name, *unit) for name in linkage.joints for column, unit in _units(place, name).items()]
    if drive is not None and drive.pushes(linkage):
        unknowns.append(("P", drive.joint, drive.sign(linkage) * _along(place, drive.joint), 0.0))
    columns = tuple(column for column, *_ in unknowns)
    turned = () if drive is None or drive.pushes(linkage) else linkage.joints[drive.joint].links
    columns += ("T",) if turned else ()
    matrix = np.zeros((*place.shape, 3 * len(linkage.moving), len(columns)))
    for c, (_, name, force, moment) in enumerate(unknowns):
        first, second = linkage.joints[name].links
        at = place.position(second, linkage.joint_points(name)[1])
        for link, sign in ((first, -1.0), (second, 1.0)):
            if link != linkage.ground:
                k = 3 * linkage.moving.index(link)
                matrix[..., k, c], matrix[..., k + 1, c] = sign * force.real, sign * force.imag
                matrix[..., k + 2, c] = sign * ((np.conj(at - place.origin(link)) * force).imag + moment)
    for link in turned:
        if link != linkage.ground:
            assert drive is not None
            matrix[..., 3 * linkage.moving.index(link) + 2, -1] = 1.0 if link == drive.link else -1.0
    rhs = np.zeros(matrix.shape[:-1])
    for load in loads:
        if load.link != linkage.ground:
            k = 3 * linkage.moving.index(load.link)
            rhs[..., k : k + 3] -= load.resultant(place)[..., [0, 1, 5]]
    return System(
        matrix=matrix,
        rhs=rhs,
        rows=tuple((link, kind) for link in linkage.moving for kind in ("Fx", "Fy", "Mz")),
        columns=columns,
        scale=linkage.longest,
    )


def _units(place: Placement, name: str) -> dict[str, tuple[Complex, float]]:
    """Force (...) and moment of a joint's first link on its second at the pin for a unit of each of its unknowns."""
    along, kind = _along(place, name), place.linkage.joints[name].type
    if kind == "revolute":
        return {f"R{name}x": (along, 0.0), f"R{name}y": (1j * along, 0.0)}
    units = {f"N{name}": (1j * along, 0.0)}
    return units | {f"M:{name}": (0.0 * along, 1.0)} if kind == "slider" else units


def _along(place: Placement, name: str) -> Complex:
    """Direction (...) of a joint's slot, global axes; x for a revolute joint."""
    joint = place.linkage.joints[name]
    if joint.type == "revolute":
        return np.ones(place.shape, dtype=complex)
    return np.asarray(place.direction(joint.links[0]) * np.exp(1j * joint.direction))


def check_drive(linkage: Linkage, drive: Drive | None) -> None:
    """Raise ``CaseError`` if the drive names a link or joint that does not fit."""
    if drive is None:
        return
    if drive.link not in linkage.moving:
        raise CaseError(f"drive.link: '{drive.link}' is not a moving link; choose one of {', '.join(linkage.moving)}")
    if drive.joint not in linkage.joints_of(drive.link):
        raise CaseError(
            f"drive.joint: '{drive.joint}' is no joint of link '{drive.link}'; "
            f"choose one of {', '.join(linkage.joints_of(drive.link))}"
        )


def require_determinate(linkage: Linkage, system: System) -> None:
    """Raise ``CaseError`` where equilibrium alone does not give the joint forces."""
    rows, columns = system.matrix.shape[-2:]
    if rows != columns:
        raise CaseError(
            f"drive: statics has {rows} equilibrium equations for {columns} unknowns, so joint forces do not follow "
            "from equilibrium; remove redundant joints or links, or drive as many links as the linkage has degrees of "
            f"freedom (mobility {linkage.mobility})"
        )


def solve_statics(pose: Pose, drive: Drive | None, loads: Sequence[Load]) -> Reactions:
    """Solve the equilibrium of all links at one pose for the joint reactions and the drive torque.

    Parameters
    ----------
    pose, drive
        The pose, and what is driven.
    loads : sequence of Load
        All that acts on the links, inertia included.

    Raises
    ------
    CaseError
        Where the equations have no single solution: more or fewer unknowns than equations, or a pose at or next to a
        dead point of the driven link.
    """
    check_drive(pose.linkage, drive)
    system = assemble(pose.placement, drive, loads)
    require_determinate(pose.linkage, system)
    refuse_dead_point(system, drive)
    unknowns, residual = system.solved()
    value = dict(zip(system.columns, unknowns.tolist(), strict=True))
    return Reactions(
        pose=pose,
        drive=drive,
        system=system,
        unknowns=unknowns,
        joints=joint_reactions(pose.placement, drive, value),
        drive_torque=value.get("T", 0.0),
        drive_force=value.get("P", 0.0),
        residual=float(residual),
    )


def refuse_dead_point(system: System, drive: Drive | None) -> None:
    """Raise ``CaseError`` where the equations, square or redundant, leave a motion that hardly anything holds."""
    smallest = float(system.singular_values[-1])
    if smallest < NEARLY_SINGULAR:
        who = f"driven link '{drive.link}'" if drive else "structure"
        raise CaseError(
            f"pose: it is at, or next to, a dead point of the {who}: the smallest singular value of "
            f"the scaled equilibrium matrix is {smallest:.2g}, below {NEARLY_SINGULAR:g}, so joint forces would grow "
            "without bound; change the pose or drive another link"
        )


def joint_reactions(place: Placement, drive: Drive | None, value: Mapping[str, Any]) -> dict[str, JointReaction]:
    """Return what every joint carries.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    drive : Drive, optional
        What is driven.
    value : mapping of str to float or array (n,)
        The unknowns of ``System.columns``, by name.
    """
    found = {}
    for name, joint in place.linkage.joints.items():
        wrench, along = np.zeros((*place.shape, 6)), _along(place, name)
        if joint.type == "revolute":
            wrench[..., 0], wrench[..., 1] = value[f"R{name}x"], value[f"R{name}y"]
        else:
            force = value[f"N{name}"] * 1j * along
            if drive is not None and drive.joint == name:
                force = force + drive.sign(place.linkage) * value.get("P", 0.0) * along
            wrench[..., 0], wrench[..., 1], wrench[..., 5] = force.real, force.imag, value.get(f"M:{name}", 0.0)
        arm = travelled(place, name)
        found[name] = JointReaction(joint=name, on=joint.links[1], by=joint.links[0], wrench=wrench, arm=arm)
    return found


def travelled(place: Placement, name: str) -> Real:
    """Return the way (..., 3) from the point of a joint's first link to its pin [mm]: zero at revolute joints."""
    joint = place.linkage.joints[name]
    if joint.type == "revolute":
        return np.zeros((*place.shape, 3))
    first, second = (place.position(*at) for at in zip(joint.links, place.linkage.joint_points(name), strict=True))
    return vector(second - first)
