"""Joint forces with friction at one pose, in turns with what presses in the bores and with redundant joints.

Friction and the forces in the plane balance at once where equilibrium gives these. What couples press in bores beside
the forces follows from the frame, and so do the forces of a redundant linkage: there the
frame and friction are solved in turn. Where friction swings about what it settles at, bores are pressed by the mean of
two rounds: else it takes hundreds of rounds, which would pass for a linkage that locks itself.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import seat
from alula.fea.standing.joint_forces import JointForces, joint_forces
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import Ring
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.forks import apart, eyes
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import Load, chosen, shifted
from alula.loads.states.kinetostatics import is_determinate
from alula.loads.states.rubbing import WAYS, at_one_pose, pose_friction
from alula.loads.statics.foundation import Foundation
from alula.loads.statics.friction import NOTHING_MORE, Presses, friction_under, friction_wrenches
from alula.loads.statics.pressing import pressing

Real = NDArray[np.float64]

ROUNDS = 60
SETTLED = 1e-10
"""Change of friction from one round to the next, as a share of it, at which it has settled."""

End = Literal["least", "stated", "largest"]
"""Of what friction may be: the least coefficients, and bores pressed by forces alone; the stated coefficients, with the
couples of pins that stand as the values of their clearances say; the largest, with the largest couples of all states.
"""
ENDS: tuple[End, End] = ("least", "largest")
NOTHING = 1e-9
"""Force of a joint, over the largest, below which its bore counts as pressed by nothing."""


def bore_presses(case: Case, wrenches: Mapping[str, Real]) -> dict[str, Real]:
    """Return what presses on the walls of bores over their forces.

    A pin turns in the link in which it is not tight. Where that is not one of them, the bore counts on which more
    presses.

    Parameters
    ----------
    case : Case
    wrenches : mapping of str to array (n, 6)
        Joint -> what its first link does to its second, about the second's point [N, N mm].

    Returns
    -------
    dict of str to array (n,)
        Joint -> that ratio, at least 1; without joints whose pins bear no couple, and those of links without parts.
    """
    found: dict[str, Real] = {}
    least = NOTHING * max(float(np.abs(wrench[:, :2]).max(initial=0.0)) for wrench in wrenches.values())
    for name in rubbing_joints(case):
        joint = case.joints[name]
        if joint.slides:
            continue
        try:
            rings = eyes(case, name)
        except CaseError:
            continue
        second = wrenches[name]
        first = shifted(second, np.array([0.0, 0.0, case.linkage.rise(name)]))
        size = np.hypot(second[:, 0], second[:, 1])
        ratios = [
            _pressing(wrench, ring, _foundation(case, name, link)) / np.where(size > least, size, np.inf)
            for link, ring, wrench in zip(joint.links, rings, (first, second), strict=True)
            if len(joint.tight_in) != 1 or link not in joint.tight_in
        ]
        ratio = np.where(size > least, np.max(ratios, axis=0), 1.0)
        if np.any(ratio > 1.0):
            found[name] = ratio
    return found


def _pressing(wrench: Real, ring: Ring, foundation: Foundation | None) -> Real:
    """Return what presses on a bore (n,) under wrenches (n, 6) of its pin [N]."""
    return pressing(wrench[:, 0] + 1j * wrench[:, 1], wrench[:, 3] + 1j * wrench[:, 4], ring, foundation)


def _foundation(case: Case, joint: str, link: str) -> Foundation | None:
    """Return that of a pin that bends in its hole in a link; None for a stiff one, and in a pair of plates."""
    if case.links[link].part is None or apart(case, link) is not None:
        return None
    body = case.body(link)
    return Foundation.of(seat(case.linkage, link, body, body.pin(case.linkage.point_of(joint, link))))


def largest(every: Iterable[Presses]) -> dict[str, Real]:
    """Return the largest ratio of every bore.

    Parameters
    ----------
    every : iterable of mapping of str to array (n,)
        From ``bore_presses``.

    Returns
    -------
    dict of str to array (n,)
    """
    found: dict[str, Real] = {}
    for one in every:
        for name, ratio in one.items():
            found[name] = np.maximum(ratio, found.get(name, 1.0))
    return found


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
    every = [found.reactions, *(found.sharings if end == "largest" else ())]
    wrenches = {name: np.array([one.joints[name].wrench for one in every]) for name in found.reactions.joints}
    return {name: ratio.max(keepdims=True) for name, ratio in bore_presses(case, wrenches).items()}


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
    way, found, before, step = case.load_cases[load_case].direction, plain, np.zeros(0), np.zeros(0)
    presses = NOTHING_MORE if determinate else presses_of(case, found, end)
    for _ in range(ROUNDS):
        if determinate:
            friction = pose_friction(case, load_case, pose, loads, presses)
        else:
            joints = {name: joint.wrench[None] for name, joint in found.reactions.joints.items()}
            rubbed = friction_under(place, case.pinned_drive, WAYS[way], joints, presses)
            friction = tuple(chosen(load, 0) for load in rubbed)
        now = np.concatenate(list(friction_wrenches(friction).values()))
        if len(before) and np.abs(now - before).max() <= SETTLED * np.abs(now).max():
            return (*loads, *friction), found
        last, step = step, now - before if len(before) else step
        before = now
        found = joint_forces(case, pose, (*loads, *friction))
        pressed, swings = presses_of(case, found, end), len(last) > 0 and float(step @ last) < 0.0
        if determinate and not pressed:
            return (*loads, *friction), found
        presses = {x: (one + presses.get(x, 1.0)) / 2.0 for x, one in pressed.items()} if swings else pressed
    raise CaseError(
        f"load_cases.{load_case}: the joint forces of this linkage do not settle with their friction, driven {way}, so "
        "it may lock itself; state less friction, or remove redundant joints"
    )
