"""Pose and joint forces of every load case, and a published system beside them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from alula.fea.pins.states import refuse_slight
from alula.fea.standing.joint_forces import JointForces, joint_forces
from alula.fea.standing.rubbing import ENDS, End, at_end, presses_of, with_friction
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import refuse_slot_ends
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_companion
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import Load, PartMass
from alula.loads.sources.published_statics import StaticsAudit, audit
from alula.loads.states.actions import acting_loads, needs_masses, placed
from alula.loads.states.case_motion import drive_angles
from alula.loads.states.drive_work import DriveWork, pose_work
from alula.loads.states.masses import part_masses
from alula.loads.states.play import play_of
from alula.loads.states.rubbing import each_direction
from alula.loads.states.standing import Standing, stand
from alula.loads.statics.friction import NOTHING_MORE
from alula.loads.statics.statics import Reactions


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseStatics:
    """Pose, loads and reactions of every load case of a case.

    Attributes
    ----------
    case : Case
    pose : Pose
        Undeformed; the same for all load cases.
    standing : mapping of str to Standing
        Load case -> what holds that pose.
    loads : mapping of str to tuple of Load
        Load case -> what acts.
    forces : mapping of str to JointForces
        Load case -> joint forces.
    masses : mapping of str to PartMass
        Link -> its mass; empty where no load case needs them.
    audit : StaticsAudit or None
        Comparison with published statics, where the case names some.
    work : mapping of str to DriveWork
        Load case -> the drive with and without friction, at the one pose; none where no joint has any or a stop bears.
    """

    case: Case
    pose: Pose
    standing: Mapping[str, Standing]
    loads: Mapping[str, tuple[Load, ...]]
    forces: Mapping[str, JointForces]
    masses: Mapping[str, PartMass]
    audit: StaticsAudit | None
    work: Mapping[str, DriveWork]

    @property
    def reactions(self) -> Mapping[str, Reactions]:
        """Joint reactions of every load case, in the undeformed pose."""
        return {load_case: forces.reactions for load_case, forces in self.forces.items()}


def solve_case_statics(case: Case, name: str = "", end: End = "stated") -> CaseStatics:
    """Solve pose and statics of every load case.

    Parameters
    ----------
    case : Case
    name : str, optional
        Path or built-in name of the case, for companion files.
    end : {"least", "stated", "largest"}, optional
        Of what friction may be.

    Returns
    -------
    CaseStatics

    Raises
    ------
    CaseError
        For a pose that cannot be assembled or has no single equilibrium.
    """
    case = at_end(each_direction(case), end)
    if case.sweeps:
        stated = case.solve_pose()
        refuse_slot_ends(stated, drive_angles(case, stated), coordinate=case.motion_coordinate)
    masses = part_masses(case) if needs_masses(case) else {}
    standing = {load_case: stand(case, load_case, masses) for load_case in case.load_cases}
    pose = next(iter(standing.values())).pose  # one that balances by itself has one load case
    loads = {
        load_case: acting_loads(standing[load_case].case, stated, placed(pose, stated.speed), masses)
        for load_case, stated in case.load_cases.items()
    }
    forces = {load_case: joint_forces(standing[load_case].case, pose, loads[load_case]) for load_case in loads}
    for one in forces.values():
        if one.pins is not None:
            refuse_slight(one.pins)
    work, presses = {}, {}
    if rubbing_joints(case):
        for load_case, plain in forces.items():
            own = standing[load_case].case
            loads[load_case], forces[load_case] = with_friction(own, load_case, pose, loads[load_case], plain, end)
            presses[load_case] = presses_of(own, forces[load_case], end)
            if standing[load_case].stop:
                standing[load_case] = _rubbed(standing[load_case], load_case, forces[load_case].reactions)
            else:
                work[load_case] = pose_work(own, load_case, pose, plain.reactions, forces[load_case].reactions)
    if not case.pose.equilibrium:
        played = {x: play_of(standing[x].case, x, pose, masses, presses.get(x, NOTHING_MORE)) for x in loads}
        forces = {x: replace(found, play=played[x]) for x, found in forces.items()}
    found = None
    if case.published_statics is not None:
        published = case.published_statics
        found = audit(
            published,
            read_companion(name, published.exact),
            read_companion(name, published.printed),
            pose,
            next(iter(loads.values())),
        )
    return CaseStatics(
        case=case, pose=pose, standing=standing, loads=loads, forces=forces, masses=masses, audit=found, work=work
    )


@lru_cache(maxsize=64)
def at_friction_ends(statics: CaseStatics, load_case: str) -> tuple[CaseStatics | None, ...]:
    """Return a load case with the least and with the largest friction that may be.

    Parameters
    ----------
    statics : CaseStatics
    load_case : str
        Its name.

    Returns
    -------
    tuple of CaseStatics or None
        None where the linkage then locks itself; empty where no joint rubs.
    """
    if not rubbing_joints(statics.case):
        return ()
    found: list[CaseStatics | None] = []
    for end in ENDS:
        try:
            found.append(solve_case_statics(alone(statics.case, load_case), end=end))
        except CaseError:
            found.append(None)
    return tuple(found)


def locks_on_tight_pins(case: Case, load_case: str) -> bool:
    """Return whether the largest coefficients lock a linkage whose pins are tight in both of their links.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.

    Returns
    -------
    bool
        False, too, where they lock it by the couples of pins that tilt alone.
    """
    try:
        solve_case_statics(at_end(alone(case, load_case), "largest"))
    except CaseError:
        return True
    return False


def alone(case: Case, load_case: str) -> Case:
    """Return a case with one of its load cases alone, and without published statics.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.

    Returns
    -------
    Case
    """
    return case.model_copy(update={"load_cases": {load_case: case.load_cases[load_case]}, "published_statics": None})


def with_ends(statics: CaseStatics, load_case: str) -> DriveWork | None:
    """Return what the drive does in a load case, with the ends of what friction may be.

    Parameters
    ----------
    statics : CaseStatics
    load_case : str
        Its name.

    Returns
    -------
    DriveWork or None
        None where no joint rubs, or a stop bears.
    """
    work = statics.work.get(load_case)
    if work is None:
        return None
    solved = [None if one is None else one.reactions[load_case] for one in at_friction_ends(statics, load_case)]
    return work.between([np.nan if one is None else one.drive_torque + one.drive_force for one in solved])


def _rubbed(standing: Standing, load_case: str, reactions: Reactions) -> Standing:
    """Return what holds a pose with what its stop bears as joints rub."""
    drive = standing.case.pinned_drive
    assert drive is not None
    contact = drive.sign(standing.case.linkage) * float(reactions.drive_torque + reactions.drive_force)
    if contact * standing.contact <= 0.0:
        raise CaseError(
            f"stops.{standing.stop}: under load case {load_case} friction alone holds the linkage there, so what the "
            "stop bears is not known; leave the stop out, or state less friction"
        )
    return replace(standing, contact=contact)
