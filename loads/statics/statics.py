"""Pinned-frame statics: three equilibrium equations per moving link, assembled from the pose.

Each link is cut free. With r the arm from the origin of the link's frame to a joint,

    sum F_x = 0,    sum F_y = 0,    sum (r x F)_z + M_z = 0

over joint forces, applied loads and the drive torque (Norton, Design of Machinery, 5th ed.,
chapter 11, with accelerations zero). The unknown of a revolute joint is the force that the
joint's first link exerts on its second; a pin in a slot carries a normal force, a slider a normal
force and a moment.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CaseError
from geometry.linkage.linkage import Linkage
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
    """What link ``by`` does to link ``on`` at a joint: wrench (6,) about the pin, global axes [N, N mm].

    arm  (3,) from the point of link ``by`` to the pin, which has travelled in a slot or along a guide [mm]
    """

    joint: str
    on: str
    by: str
    wrench: Real
    arm: Real = field(default_factory=lambda: np.zeros(3))

    @property
    def force(self) -> Real:
        """Force (3,) [N]."""
        return self.wrench[:3]

    @property
    def magnitude(self) -> float:
        """Size of the force [N]."""
        return float(np.linalg.norm(self.wrench[:3]))


@dataclass(frozen=True, kw_only=True)
class System:
    """The equilibrium equations [A][R] = [b], with a name for every row and column.

    matrix   (3 links, unknowns); force rows in N, moment rows in N mm
    rhs      (3 links,)
    rows     (link, "Fx" | "Fy" | "Mz") of every row
    columns  name of every unknown: RAx, RAy, ..., T
    scale    length by which moments are divided before singular values are taken [mm]
    """

    matrix: Real
    rhs: Real
    rows: tuple[tuple[str, str], ...]
    columns: tuple[str, ...]
    scale: float

    @cached_property
    def scaled(self) -> Real:
        """The matrix without dimensions: moments and the torque divided by ``scale``."""
        row = np.array([1.0 / self.scale if kind == "Mz" else 1.0 for _, kind in self.rows])
        column = np.array([self.scale if self._is_moment(name) else 1.0 for name in self.columns])
        return np.asarray(row[:, None] * self.matrix * column)

    @staticmethod
    def _is_moment(column: str) -> bool:
        return column == "T" or column.startswith("M:")

    @cached_property
    def singular_values(self) -> Real:
        """Singular values of the scaled matrix, falling."""
        return np.asarray(np.linalg.svd(self.scaled, compute_uv=False), dtype=float)

    @property
    def condition(self) -> float:
        """Condition number of the scaled matrix (2-norm)."""
        smallest = float(self.singular_values[-1])
        return float(self.singular_values[0]) / smallest if smallest > 0.0 else math.inf


@dataclass(frozen=True, kw_only=True)
class Reactions:
    """Joint reactions and drive torque of one pose under one set of loads.

    drive_torque  N mm, counter-clockwise positive, on the driven link; 0 without drive and where it pushes
    drive_force   N, along the guide's direction, on the driven link; 0 unless the drive pushes. The slider's own
                  reaction holds it
    residual      largest unbalanced force or moment over the longest link, as a share of the load
    unknowns      (columns,) the solution vector [R]
    """

    pose: Pose
    drive: Drive | None
    system: System
    unknowns: Real
    joints: Mapping[str, JointReaction]
    drive_torque: float
    residual: float
    drive_force: float = 0.0

    def on_link(self, link: str) -> tuple[tuple[str, Real], ...]:
        """(point, wrench (6,) about it in global axes) of every joint reaction that acts on a link.

        The drive torque is not among them: see ``drive_torque``.
        """
        found = []
        for name, reaction in self.joints.items():
            if link in (reaction.on, reaction.by):
                sign = 1.0 if reaction.on == link else -1.0
                point = self.pose.linkage.point_of(name, link)
                wrench = sign * reaction.wrench
                if link == reaction.by:
                    wrench = shifted(wrench, reaction.arm)
                found.append((point, wrench))
        return tuple(found)

    def torque_on(self, link: str) -> float:
        """Drive torque that acts on a link [N mm]: on the driven link, and its reaction on the other."""
        if self.drive is None or self.drive.pushes(self.pose.linkage):
            return 0.0
        if link == self.drive.link:
            return self.drive_torque
        return -self.drive_torque if link in self.pose.linkage.joints[self.drive.joint].links else 0.0


def assemble(pose: Pose, drive: Drive | None, loads: Sequence[Load]) -> System:
    """Write the equilibrium equations of every moving link at this pose.

    The plane's three equations alone: see ``loads/records/applied.py`` for the loads; out-of-plane
    components do not enter.
    """
    linkage = pose.linkage
    entries: list[tuple[str, Real]] = []
    for name in linkage.joints:
        entries.extend(_columns(pose, name))
    if drive is not None and drive.pushes(linkage):
        entries.append(("P", _column(pose, drive.joint, drive.sign(linkage) * _directions(pose, drive.joint)[0], 0.0)))
    elif drive is not None:
        torque = np.zeros(3 * len(linkage.moving))
        for link in linkage.joints[drive.joint].links:
            if link != linkage.ground:
                torque[3 * linkage.moving.index(link) + 2] = 1.0 if link == drive.link else -1.0
        entries.append(("T", torque))
    rhs = np.zeros(3 * len(linkage.moving))
    for load in loads:
        if load.link != linkage.ground:
            k = 3 * linkage.moving.index(load.link)
            rhs[k : k + 3] -= load.resultant(pose)[[0, 1, 5]]
    return System(
        matrix=np.array([column for _, column in entries]).T,
        rhs=rhs,
        rows=tuple((link, kind) for link in linkage.moving for kind in ("Fx", "Fy", "Mz")),
        columns=tuple(name for name, _ in entries),
        scale=linkage.longest,
    )


def _columns(pose: Pose, name: str) -> list[tuple[str, Real]]:
    """Columns of a joint's unknowns: what each unit of it does to the rows of both links."""
    along, across = _directions(pose, name)
    if pose.linkage.joints[name].type == "revolute":
        return [(f"R{name}x", _column(pose, name, along, 0.0)), (f"R{name}y", _column(pose, name, across, 0.0))]
    columns = [(f"N{name}", _column(pose, name, across, 0.0))]
    if pose.linkage.joints[name].type == "slider":
        columns.append((f"M:{name}", _column(pose, name, np.zeros(2), 1.0)))
    return columns


def _directions(pose: Pose, name: str) -> tuple[Real, Real]:
    """Directions (2,) along and across a joint's slot, global axes; x and y for a revolute joint."""
    joint = pose.linkage.joints[name]
    along = 0.0 if joint.type == "revolute" else pose.angles[joint.links[0]] + joint.direction
    c, s = math.cos(along), math.sin(along)
    return np.array([c, s]), np.array([-s, c])


def _column(pose: Pose, name: str, force: Real, moment: float) -> Real:
    """What a force (2,) and a moment of a joint's first link on its second at the pin do to the rows of both links."""
    linkage = pose.linkage
    joint = linkage.joints[name]
    at = pose.position(joint.links[1], linkage.joint_points(name)[1])
    out = np.zeros(3 * len(linkage.moving))
    for link, sign in zip(joint.links, (-1.0, 1.0), strict=True):
        if link != linkage.ground:
            k = 3 * linkage.moving.index(link)
            arm = at - pose.origins[link]
            out[k : k + 2] = sign * force
            out[k + 2] = sign * (arm[0] * force[1] - arm[1] * force[0] + moment)
    return out


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


def solve_statics(pose: Pose, drive: Drive | None, loads: Sequence[Load]) -> Reactions:
    """Solve the equilibrium of all links for the joint reactions and the drive torque.

    Raises ``CaseError`` where the equations have no single solution: more or fewer unknowns than
    equations, or a pose at or next to a dead point of the driven link.
    """
    linkage = pose.linkage
    check_drive(linkage, drive)
    system = assemble(pose, drive, loads)
    rows, columns = system.matrix.shape
    if rows != columns:
        raise CaseError(
            f"drive: statics has {rows} equilibrium equations for {columns} unknowns, so joint forces do not follow "
            "from equilibrium; drive as many links as the linkage has degrees of freedom "
            f"(mobility {linkage.mobility})"
        )
    refuse_dead_point(system, drive)
    unknowns = np.linalg.solve(system.scaled, _scaled_rhs(system))
    # What is but rounding would stand as unbalanced loads on a link on which nothing acts.
    unknowns[np.abs(unknowns) <= ROUNDING * np.abs(unknowns).max(initial=0.0)] = 0.0
    unknowns = unknowns * np.array([system.scale if system._is_moment(c) else 1.0 for c in system.columns])
    leftover = system.matrix @ unknowns - system.rhs
    row_scale = np.array([system.scale if kind == "Mz" else 1.0 for _, kind in system.rows])
    load_size = max(float(np.max(np.abs(_scaled_rhs(system)), initial=0.0)), 1e-300)
    return Reactions(
        pose=pose,
        drive=drive,
        system=system,
        unknowns=unknowns,
        joints={name: _reaction(pose, name, system, unknowns, drive) for name in linkage.joints},
        drive_torque=float(unknowns[system.columns.index("T")]) if "T" in system.columns else 0.0,
        drive_force=float(unknowns[system.columns.index("P")]) if "P" in system.columns else 0.0,
        residual=float(np.max(np.abs(leftover / row_scale))) / load_size,
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


def _scaled_rhs(system: System) -> Real:
    return np.asarray(system.rhs / np.array([system.scale if kind == "Mz" else 1.0 for _, kind in system.rows]))


def _reaction(pose: Pose, name: str, system: System, unknowns: Real, drive: Drive | None) -> JointReaction:
    joint = pose.linkage.joints[name]
    value = dict(zip(system.columns, unknowns, strict=True))
    wrench = np.zeros(6)
    if joint.type == "revolute":
        wrench[:2] = value[f"R{name}x"], value[f"R{name}y"]
    else:
        along, across = _directions(pose, name)
        wrench[:2] = value[f"N{name}"] * across
        if drive is not None and drive.joint == name:
            wrench[:2] += drive.sign(pose.linkage) * value.get("P", 0.0) * along
        wrench[5] = value.get(f"M:{name}", 0.0)
    return JointReaction(joint=name, on=joint.links[1], by=joint.links[0], wrench=wrench, arm=travelled(pose, name))


def travelled(pose: Pose, name: str) -> Real:
    """Return the way (3,) from the point of a joint's first link to its pin [mm]: zero at revolute joints."""
    joint = pose.linkage.joints[name]
    if joint.type == "revolute":
        return np.zeros(3)
    first, second = (pose.position(*at) for at in zip(joint.links, pose.linkage.joint_points(name), strict=True))
    return np.array([*(second - first), 0.0])
