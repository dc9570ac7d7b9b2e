"""What the ground must hold: force and moment that the linkage exerts on it at each of its joints, and in all."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import LoadCaseResult
from alula.geometry.linkage.linkage import Linkage
from alula.loads.acting.acting import loads_of
from alula.loads.records.applied import Load, PointLoad, shifted
from alula.loads.states.actions import lasting
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.joint_reaction import JointReaction
from alula.loads.statics.rounding import rounded, size_of
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class AnchorLoads:
    """What the linkage does to the ground; components within rounding are zero.

    Attributes
    ----------
    joints : mapping of str to ndarray, shape (6,)
        Joint on the ground -> wrench on the ground about the joint, in the ground's mid-plane [N, N mm], global axes.
        Where the drive's torque reacts on the ground, that reaction is in the moment about z at the drive's joint.
        Springs and tendons that are fastened to a point of the ground, in the undeformed pose, stand there as "springs
        at" that point.
    about : str
        The joint about which ``total`` is taken.
    total : ndarray, shape (6,)
        Wrench of all joints together about that joint [N, N mm].
    deformed : bool
        True where the forces are those on the deformed shape.
    unstable : bool
        True where they are those of the undeformed pose, since the deformed shape has no stable equilibrium.
    """

    joints: Mapping[str, Real]
    about: str
    total: Real
    deformed: bool
    unstable: bool


def anchor_loads(case: LoadCaseResult) -> AnchorLoads:
    """Return what a load case asks of the ground, on the deformed shape where equilibrium was found there.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    AnchorLoads
    """
    moved = case.large_displacement.reactions
    reactions = moved or case.reactions
    joints = wrenches_on_ground(reactions, case.loads)
    pose = reactions.pose
    ground = pose.linkage.ground
    places = {}
    for name in joints:
        point = pose.position(ground, pose.linkage.point_of(name, ground))
        # A pin has travelled from the ground's point along its slot; the wrench is about where it stands.
        reaction = reactions.joints[name]
        travelled = reaction.arm - _lever(reaction, pose.linkage) if reaction.by == ground else np.zeros(3)
        places[name] = np.array([*point, 0.0]) + travelled
    about = next(iter(joints))
    for load in loads_of(lasting(case.standing.case), pose.placement):
        if isinstance(load, PointLoad) and load.link == ground:
            name = f"springs at {load.point}"
            joints[name] = joints.get(name, np.zeros(6)) + load.wrench
            places[name] = np.array([*pose.position(ground, load.point), 0.0])
    total = np.zeros(6)
    for name, wrench in joints.items():
        total += shifted(wrench, places[name] - places[about])
    size = size_of(reactions)
    return AnchorLoads(
        joints={name: rounded(wrench, size) for name, wrench in joints.items()},
        about=about,
        total=rounded(total, size),
        deformed=moved is not None,
        unstable=case.large_displacement.gives_way,
    )


def _lever(reaction: JointReaction, linkage: Linkage) -> Real:
    """Vector (3,) to the pin at a joint's second link from where it stands in the mid-plane of the first [mm]."""
    return reaction.arm * [0.0, 0.0, 1.0] if linkage.joints[reaction.joint].slides else reaction.arm


def wrenches_on_ground(reactions: Reactions, loads: Sequence[Load] = ()) -> dict[str, Real]:
    """Return what acts on the ground at each of its joints, the drive torque's reaction and friction included.

    Parameters
    ----------
    reactions : Reactions
    loads : sequence of Load, optional
        All else that acts on the links, with friction among them.

    Returns
    -------
    dict of str to ndarray, shape (6,)
        Joint -> wrench about it in the ground's mid-plane [N, N mm].
    """
    rubbed = friction_wrenches(loads)
    linkage, drive = reactions.pose.linkage, reactions.drive
    found = {}
    for name, reaction in reactions.joints.items():
        if linkage.ground in (reaction.on, reaction.by):
            wrench = reaction.wrench + rubbed.get(name, np.zeros(6))
            wrench = wrench if reaction.on == linkage.ground else -shifted(wrench, _lever(reaction, linkage))
            if drive is not None and name == drive.joint:
                wrench = wrench + np.array([0.0, 0.0, 0.0, 0.0, 0.0, reactions.torque_on(linkage.ground)])
            found[name] = wrench
    return found
