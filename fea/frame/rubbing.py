"""Joint forces with friction at one pose, in turns with what presses in the bores and with redundant joints.

Friction and the forces in the plane balance at once where equilibrium gives these. What couples press in bores beside
the forces (``fea.frame.bore_pressing``) follows from the frame, and so do the forces of a redundant linkage: there the
frame and friction are solved in turn.
"""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from fea.frame.bore_pressing import bore_presses, largest
from fea.frame.joint_forces import JointForces, joint_forces
from geometry.base.errors import CaseError
from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.case.joint_rules import rubbing_joints
from loads.records.applied import Load, chosen
from loads.states.kinetostatics import is_determinate
from loads.states.rubbing import WAYS, at_one_pose, pose_friction
from loads.statics.friction import NOTHING_MORE, Presses, friction_under

ROUNDS = 60
SETTLED = 1e-10
"""Change of friction from one round to the next, as a share of it, at which it has settled."""

End = Literal["least", "stated", "largest"]
"""Of what friction may be: the least coefficients, and bores pressed by forces alone; the stated coefficients, with the
couples of pins that are tight in both links; the largest, with the largest couples of any way in which pins share them.
"""


def at_end(case: Case, end: End) -> Case:
    """Return a case with its coefficients of friction at an end of their ranges.

    Parameters
    ----------
    case : Case
    end : {"least", "stated", "largest"}

    Returns
    -------
    Case
        Without ranges, but for the stated coefficients.
    """
    if end == "stated":
        return case
    joints = dict(case.joints)
    for name in rubbing_joints(case):
        mu = joints[name].friction_ends[end == "largest"]
        joints[name] = joints[name].model_copy(update={"friction": mu, "friction_range": (mu, mu)})
    return case.model_copy(update={"joints": joints})


def presses_of(case: Case, found: JointForces, end: End = "stated") -> Presses:
    """Return what presses on the walls of bores over their forces, under joint forces.

    Parameters
    ----------
    case : Case
    found : JointForces
    end : {"least", "stated", "largest"}, optional

    Returns
    -------
    mapping of str to array (1,)
    """
    if end == "least" or found.frame is None:
        return NOTHING_MORE
    every = (found, *(found.sharings if end == "largest" else ()))
    return largest(
        bore_presses(case, {name: joint.wrench[None] for name, joint in one.reactions.joints.items()}) for one in every
    )


def with_friction(
    case: Case, load_case: str, pose: Pose, loads: Sequence[Load], plain: JointForces, end: End = "stated"
) -> tuple[tuple[Load, ...], JointForces]:
    """Return the loads on the links with friction among them, and the joint forces.

    Parameters
    ----------
    case : Case
        With the coefficients of that end.
    load_case : str
        Its name; it states its direction.
    pose : Pose
    loads : sequence of Load
        All else that acts.
    plain : JointForces
        Under these, without friction.
    end : {"least", "stated", "largest"}, optional
        Of what couples press in bores.

    Returns
    -------
    tuple of (tuple of Load, JointForces)

    Raises
    ------
    CaseError
        Where the linkage locks itself, or the rounds do not settle.
    """
    determinate, place = is_determinate(case.linkage), at_one_pose(pose).virtual
    way, found, before = case.load_cases[load_case].direction, plain, np.zeros(0)
    presses = NOTHING_MORE if determinate else presses_of(case, found, end)
    for _ in range(ROUNDS):
        if determinate:
            friction = pose_friction(case, load_case, pose, loads, presses)
        else:
            joints = {name: joint.wrench[None] for name, joint in found.reactions.joints.items()}
            rubbed = friction_under(place, case.pinned_drive, WAYS[way], joints, presses)
            friction = tuple(chosen(load, 0) for load in rubbed)
        now = np.concatenate([load.wrench for load in friction])
        if len(before) and np.abs(now - before).max() <= SETTLED * np.abs(now).max():
            return (*loads, *friction), found
        before = now
        found = joint_forces(case, pose, (*loads, *friction))
        presses = presses_of(case, found, end)
        if determinate and not presses:
            return (*loads, *friction), found
    raise CaseError(
        f"load_cases.{load_case}: the joint forces of this linkage do not settle with their friction, driven {way}, so "
        "it may lock itself; state less friction, or remove redundant joints"
    )
