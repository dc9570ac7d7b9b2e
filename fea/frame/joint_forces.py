"""Joint forces of a case: from equilibrium alone where it gives them, from the spatial frame where it does not."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fea.frame.linkage_frame import out_of_plane
from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.records.applied import Load
from loads.statics.statics import Drive, Reactions, assemble, refuse_dead_point, solve_statics

if TYPE_CHECKING:
    from fea.frame.linear import FrameSolution
    from fea.frame.linkage_frame import LinkageFrame

Real = NDArray[np.float64]

PINNED_STATICS = "equilibrium of pinned links"
PINNED_FRAME = "spatial frame with pins free about their own axis"
BONDED_FRAME = "spatial frame with bonded joints"


@dataclass(frozen=True, kw_only=True, eq=False)
class JointForces:
    """Joint forces of one load case in the pose as it stands.

    Attributes
    ----------
    reactions : Reactions
        Joint forces and drive torque.
    model : str
        Which one gave them.
    reason : str
        Why, for people.
    frame : LinkageFrame or None
        Of the linkage where the model is a frame; None for equilibrium alone.
    solution : FrameSolution or None
        Of that frame; None for equilibrium alone.
    """

    reactions: Reactions
    model: str
    reason: str
    frame: "LinkageFrame | None" = None
    solution: "FrameSolution | None" = None

    @property
    def condition(self) -> float:
        """Condition number of the scaled equations that gave the forces (2-norm; of a frame, 1-norm)."""
        return self.reactions.system.condition if self.solution is None else self.solution.condition


def joint_forces(case: Case, pose: Pose, loads: Sequence[Load]) -> JointForces:
    """Return the joint forces under loads, by the simplest model that has them.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.

    Returns
    -------
    JointForces
        With the model that gave them.

    Raises
    ------
    CaseError
        Where no model has them, such as at a dead point of the driven link.
    """
    bonded = case.joint_model == "bonded"
    if bonded:
        model, reason = BONDED_FRAME, "the case says that its joints are bonded"
    elif out_of_plane(loads):
        model, reason = PINNED_FRAME, "a load acts out of the linkage's plane, where pins carry moments"
    elif _redundant(case, pose):
        model, reason = PINNED_FRAME, "the linkage has more constraints than equilibrium has equations"
    else:
        return JointForces(
            reactions=solve_statics(pose, case.pinned_drive, loads),
            model=PINNED_STATICS,
            reason="all loads act in the linkage's plane, where equilibrium alone gives the forces",
        )
    if not bonded:
        refuse_dead_point(assemble(pose.placement, case.pinned_drive, ()), case.pinned_drive)
    frame, solution = _solved(case, pose, loads, case.pinned_drive, bonded=bonded)
    return JointForces(
        reactions=frame.reactions(solution.joint_wrenches, solution.residual),
        model=model,
        reason="; ".join([reason, *frame.notes]),
        frame=frame,
        solution=solution,
    )


def _solved(
    case: Case, pose: Pose, loads: Sequence[Load], held: Drive | None, *, bonded: bool
) -> "tuple[LinkageFrame, FrameSolution]":
    """Return the frame of the linkage and its solution; most linkages need none, and do not import it."""
    from fea.frame.build import build_frame
    from fea.frame.linear import solve_frame

    frame = build_frame(case, pose, loads, held=held, bonded=bonded)
    return frame, solve_frame(frame.model)


def _redundant(case: Case, pose: Pose) -> bool:
    rows, columns = assemble(pose.placement, case.pinned_drive, ()).matrix.shape
    return bool(columns > rows)


@dataclass(frozen=True, kw_only=True)
class WayToHold:
    """How far a point moves with the linkage held in one way.

    Attributes
    ----------
    name : str
        Of the way, for people.
    displacement : ndarray, shape (3,)
        Global axes [mm].
    """

    name: str
    displacement: Real

    @property
    def size(self) -> float:
        """Length of the displacement [mm]."""
        return float(np.linalg.norm(self.displacement))


def ways_to_hold(case: Case, pose: Pose, loads: Sequence[Load]) -> tuple[WayToHold, ...]:
    """Return how far the point that the case names moves: held at each link on the ground, and bonded all over.

    Linear frames in the pose as it stands.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.

    Returns
    -------
    tuple of WayToHold
        One per way; none where the case does not ask.
    """
    asked = case.ways_to_hold
    if asked is None:
        return ()
    found = []
    ground = case.linkage.ground
    drives: Mapping[str, Drive] = {
        link: Drive(link=link, joint=name)
        for name, joint in case.joints.items()
        if joint.type == "revolute" and ground in joint.links
        for link in joint.links
        if link != ground
    }
    names = ", ".join(drive.joint for drive in drives.values())
    ways = [(f"pinned, held at {link}", drive, False) for link, drive in drives.items()]
    ways.append((f"bonded, {names} built in", next(iter(drives.values())), True))
    for name, drive, bonded in ways:
        frame, solution = _solved(case, pose, loads, drive, bonded=bonded)
        moved = frame.at_points(solution.displacements)
        found.append(WayToHold(name=name, displacement=moved[asked.link, asked.at]))
    return tuple(found)
