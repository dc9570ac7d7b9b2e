"""Motions with friction in bores that couples press beside the joint forces, and with all friction that may be.

What couples press follows from the frame of a pose. It changes slowly along a motion, so that frames of some poses do,
with straight lines between them.
"""

from functools import lru_cache

import numpy as np

from alula.fea.standing.joint_forces import joint_forces
from alula.fea.standing.rubbing import End, at_end, largest, presses_of
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import chosen
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.loads.states.drive_work import DriveWork
from alula.loads.statics.friction import Presses

POSES = {"stated": 73, "largest": 25}
"""Poses of a motion whose frames are solved, spread evenly. Of the slider-crank to start from, 181 in place of 73
change its greatest drive torque by 8e-6, and no drive torque by more than 2e-5 of that."""
ROUNDS = 2
"""Of frames and friction in turn; a third changes no drive torque of that case by more than 4e-7 of the greatest."""


def rubbed_motion(case: Case, end: End = "stated") -> CaseMotion:
    """Move a case as ``solve_case_motion`` does, with what couples press in bores.

    Parameters
    ----------
    case : Case
    end : {"least", "stated", "largest"}, optional
        Of what friction may be.

    Returns
    -------
    CaseMotion

    Raises
    ------
    CaseError
        As of ``solve_case_motion``.
    CannotRunError
        Where the frame of a pose moves without strain.
    """
    case = at_end(case, end)
    moved = solve_case_motion(case)
    if end == "least" or not moved.forces or not rubbing_joints(case):
        return moved
    for _ in range(ROUNDS if end == "stated" else 1):
        presses = {name: _presses(moved, name, end) for name in moved.rubbing}
        if not any(presses.values()):
            return moved
        moved = solve_case_motion(case, presses)
    return moved


def _presses(moved: CaseMotion, load_case: str, end: End) -> Presses:
    """Return what presses in bores over their forces at all poses."""
    case, known = moved.case, np.flatnonzero(np.isfinite(moved.torque[load_case]))
    spread = np.linspace(0, len(known) - 1, min(len(known), POSES[end])).round().astype(int)
    poses, found = known[spread], []
    for i in map(int, poses):
        loads = [chosen(load, i) for load in moved.loads[load_case]]
        forces = joint_forces(case, moved.motion.pose(i), loads)
        if forces.frame is None:
            return {}
        found.append(presses_of(case, forces, end))
    every = np.arange(len(moved.motion.angles))
    return {
        name: np.interp(every, poses, [float(np.max(one.get(name, 1.0))) for one in found]) for name in largest(found)
    }


@lru_cache(maxsize=4)
def friction_range(moved: CaseMotion) -> tuple[CaseMotion, ...]:
    """Return a motion with the least and with the largest friction that may be.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    tuple of CaseMotion
        Empty where no joint rubs.
    """
    return tuple(rubbed_motion(moved.case, end) for end in ("least", "largest")) if moved.rubbing else ()


def work_between(moved: CaseMotion, load_case: str) -> DriveWork:
    """Return what the drive does over a motion, with the ends of what friction may be.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
        One with friction.

    Returns
    -------
    DriveWork
    """
    return moved.work(load_case).between([one.torque[load_case] for one in friction_range(moved)])
