"""Joint forces with friction at one pose: by equilibrium where it gives them, else by rounds of the frame."""

from collections.abc import Sequence

import numpy as np

from fea.frame.joint_forces import JointForces, joint_forces
from geometry.base.errors import CaseError
from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.records.applied import Load, chosen
from loads.states.kinetostatics import is_determinate
from loads.states.rubbing import WAYS, at_one_pose, pose_friction
from loads.statics.friction import friction_under

ROUNDS = 60
SETTLED = 1e-10
"""Change of friction from one round to the next, as a share of it, at which it has settled."""


def with_friction(
    case: Case, load_case: str, pose: Pose, loads: Sequence[Load], plain: JointForces
) -> tuple[tuple[Load, ...], JointForces]:
    """Return the loads on the links with friction among them, and the joint forces.

    Friction follows from the forces in the plane. Where equilibrium gives these, it is solved with them, whatever acts
    out of the plane. In a redundant linkage the frame and its friction are solved in turn until neither changes.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name; it states its direction.
    pose : Pose
    loads : sequence of Load
        All else that acts.
    plain : JointForces
        Under these, without friction.

    Returns
    -------
    tuple of (tuple of Load, JointForces)

    Raises
    ------
    CaseError
        Where the linkage locks itself, or the rounds do not settle.
    """
    if is_determinate(case.linkage):
        acting = (*loads, *pose_friction(case, load_case, pose, loads))
        return acting, joint_forces(case, pose, acting)
    place, found, before = at_one_pose(pose).virtual, plain, np.zeros(0)
    way = case.load_cases[load_case].direction
    for _ in range(ROUNDS):
        joints = {name: joint.wrench[None] for name, joint in found.reactions.joints.items()}
        friction = [chosen(load, 0) for load in friction_under(place, case.pinned_drive, WAYS[way], joints)]
        now = np.concatenate([load.wrench for load in friction])
        if len(before) and np.abs(now - before).max() <= SETTLED * np.abs(now).max():
            return (*loads, *friction), found
        before = now
        found = joint_forces(case, pose, (*loads, *friction))
    raise CaseError(
        f"load_cases.{load_case}: the joint forces of this redundant linkage do not settle with their friction, driven "
        f"{way}, so it may lock itself; state less friction, or remove redundant joints"
    )
