"""Links in layers over a motion: the couples between layers at every pose, and how pins may share them.

Equilibrium in the plane gives the joint forces of all poses at once. What acts out of it, F_z, M_x and M_y of every
joint, is that of the spatial frame of each pose, on pins that stand in their holes (``alula.fea.pins``). How they may
stand otherwise is sought where a link bears most, and where a few other states say that it may: this need not be the
same pose. It widens the link's bands by what it makes of its solid.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.doubts.force_doubt import sharing_answers
from alula.fea.frame.linkage_frame import out_of_plane
from alula.fea.links.link_by_hand import HandStates
from alula.fea.standing.joint_forces import JointForces, joint_forces, solved_frame, stood
from alula.fea.superposition.link_answers import LinkAnswers
from alula.geometry.base.ties import first_largest
from alula.loads.records.applied import Load, chosen
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.kinetostatics import Kinetostatics
from alula.loads.statics.statics import Equilibrium

SOUGHT = 3
"""Poses at which it is sought how pins may stand, first and last among them. These states are tried at others: of two
linkages, a four-bar over half a turn and a six-bar, they name the pose of seven in which each pin may bear most."""
TRIED = 73
"""Poses at which they are tried at most, spread evenly."""


@dataclass(frozen=True, kw_only=True)
class LayeredMotion:
    """A case over its motion, with the couples between layers.

    Attributes
    ----------
    moved : CaseMotion
        With all six components of the joint forces at the poses that count; as it was without layers.
    ways : mapping of tuple of 2 str to LinkAnswers
        (load case, link) -> what acts on it with pins as they may stand (``sharing_answers``), where it bears most and
        where it may; empty without layers.
    pins : mapping of tuple of 2 str to int
        (load case, joint) -> number of the pose in which its pin may bear most.
    """

    moved: CaseMotion
    ways: Mapping[tuple[str, str], LinkAnswers] = field(default_factory=dict)
    pins: Mapping[tuple[str, str], int] = field(default_factory=dict)


def has_couples(moved: CaseMotion) -> bool:
    """Return whether joint forces make couples across the plane.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    bool
        Of links in layers, and of a structure that is loaded out of its plane.
    """
    return moved.case.layered or (moved.held is None and any(map(out_of_plane, moved.loads.values())))


def with_couples(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> LayeredMotion:
    """Return a motion with the couples between layers, or a structure with what loads out of its plane make.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    LayeredMotion

    Raises
    ------
    CannotRunError
        Where the frame of a pose moves without strain.
    """
    case = moved.case
    if not has_couples(moved) or not moved.forces:
        return LayeredMotion(moved=moved)
    forces: dict[str, Kinetostatics] = {}
    ways: dict[tuple[str, str], LinkAnswers] = {}
    wrenches = {
        name: {joint: reaction.wrench.copy() for joint, reaction in solved.joints.items()}
        for name, solved in moved.forces.items()
    }
    tried: dict[tuple[str, str, str], dict[int, float]] = {}
    counted = np.flatnonzero(evaluated)
    shares = {name: _sought(moved, name, counted) for name in moved.forces}
    few = set(_spread(counted, TRIED))
    for i in map(int, counted):
        stands = moved.motion.pose(i)
        for name in moved.forces:  # pose by pose: all load cases have one factorisation
            frame, solution = solved_frame(case, stands, _loads_at(moved, name, i), moved.held)
            found, pins = stood(case, frame, solution)
            sought = shares[name] if i in few else None
            for owner, stress in pins.tried(sought).items() if pins is not None and sought is not None else ():
                tried.setdefault((name, *owner), {})[i] = stress
            for joint, wrench in wrenches[name].items():
                wrench[i, 2:5] = found.joints[joint].wrench[2:5]
    most = {key: max(stresses, key=stresses.__getitem__) for key, stresses in tried.items()}
    for name, solved in moved.forces.items():
        own = wrenches[name]
        joints = {joint: replace(reaction, wrench=own[joint]) for joint, reaction in solved.joints.items()}
        forces[name] = replace(solved, joints=joints)
        poses = _worst_poses(moved, name, forces[name], evaluated)
        for link, pose in poses.items():
            answers = _answers(moved, name, link, pose, most.get((name, "link", link), pose))
            if answers is not None:
                ways[name, link] = answers
    of_pins = {(name, joint): pose for (name, kind, joint), pose in most.items() if kind == "pin"}
    return LayeredMotion(moved=replace(moved, forces=forces), ways=ways, pins=of_pins)


def _sought(moved: CaseMotion, load_case: str, counted: NDArray[np.int64]) -> NDArray[np.float64] | None:
    """Shares of what is open of the pins' holes in which links and pins bear most in some poses; None without holes."""
    every = [forces_at(moved, load_case, i).pins for i in _spread(counted, SOUGHT)]
    found = [pins.extremes for pins in every if pins is not None]
    return np.vstack(found) if found else None


def _spread(counted: NDArray[np.int64], most: int) -> list[int]:
    """Numbers of at most so many of the poses that count, spread evenly."""
    return [int(counted[k]) for k in np.linspace(0, len(counted) - 1, min(len(counted), most)).round().astype(int)]


def _answers(moved: CaseMotion, load_case: str, link: str, pose: int, most: int) -> LinkAnswers | None:
    """What acts on a link where it bears most with pins as stated, and the worst of where it may bear most."""

    def there(number: int) -> LinkAnswers:
        forces, loads = forces_at(moved, load_case, number), _loads_at(moved, load_case, number)
        return sharing_answers(moved.case, load_case, link, forces, loads, grown=True)

    if not forces_at(moved, load_case, pose).sharings:
        return None
    stated = there(pose)
    if most == pose:
        return stated
    every = there(most).every
    worst = every[int(np.argmax(HandStates(moved.case, link, every).stress))]
    return replace(stated, others=(*stated.others, worst))


@lru_cache(maxsize=64)
def forces_at(moved: CaseMotion, load_case: str, pose: int) -> JointForces:
    """Return the joint forces of one pose with all ways in which pins may share couples.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
    pose : int
        Its number.

    Returns
    -------
    JointForces
    """
    return joint_forces(moved.case, moved.motion.pose(pose), _loads_at(moved, load_case, pose))


def _loads_at(moved: CaseMotion, load_case: str, pose: int) -> list[Load]:
    return [chosen(load, pose) for load in moved.loads[load_case]]


def _worst_poses(
    moved: CaseMotion, load_case: str, forces: Equilibrium, evaluated: NDArray[np.bool_]
) -> dict[str, int]:
    """Link -> number of the pose in which the sum of all that acts on it is largest."""
    case, found = moved.case, {}
    for link in case.checked_links:
        loads = link_loads(load_case, link, case.body(link), forces, moved.loads[load_case])
        size = np.where(evaluated, loads.size(case.linkage.longest), -np.inf)
        found[link] = first_largest(size)
    return found
