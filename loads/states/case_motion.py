"""The motion of a case: poses, joint forces and drive torque over its range, for every load case."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import Instants, Motion, refuse_slot_ends, solve_motion, still_motion
from alula.geometry.linkage.pose import Pose
from alula.loads.acting.acting import loads_of
from alula.loads.acting.weight import Weight
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import Load, PartMass
from alula.loads.records.cycle_spec import CycleMotion
from alula.loads.records.load_case import LoadCase
from alula.loads.states.actions import acting_loads, acting_on, needs_masses, refuse_turning_bonds
from alula.loads.states.drive_work import DriveWork, drive_work
from alula.loads.states.kinetostatics import (
    Kinetostatics,
    Power,
    dead_points,
    energies,
    is_determinate,
    relative_motion,
    solve_kinetostatics,
    structure_over,
    torque_by_virtual_work,
)
from alula.loads.states.masses import laden_masses, part_masses
from alula.loads.states.rubbing import Rubbing, each_direction, lock_sentence, motion_friction
from alula.loads.states.standing import refuse_stops
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.friction import Presses
from alula.loads.statics.momentum import LinkageMomentum, linkage_momentum
from alula.loads.statics.statics import Drive
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import reason

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseMotion:
    """A case over its motion.

    Attributes
    ----------
    case : Case
    motion : Motion
        The n poses of its linkage.
    held : Drive or None
        None for a structure, which stays where it is under the loads of a cycle.
    moved : mapping of str to Motion
        Load case -> the same poses at its own speed, where it states one.
    masses : mapping of str to PartMass
        Of the parts, by link; empty where weight and inertia are left out.
    loads : mapping of str to tuple of Load
        Load case -> all that acts on the links at every pose, inertia included.
    power : mapping of str to Power
        Load case -> energies and powers; kinetic energy is left out where inertia is.
    forces : mapping of str to Kinetostatics
        Load case -> joint forces; empty where they do not follow from equilibrium (redundant linkages).
    torque : mapping of str to array (n,)
        Load case -> drive torque [N mm], or force along the guide [N] where the drive exerts one; NaN at dead points
        of the driven link.
    dead_points : tuple of float
        Values of the coordinate [rad, mm] at which the driven link turns back.
    rubbing : mapping of str to Rubbing
        Load case -> friction; empty where no joint has any.
    frictionless : mapping of str to array (n,)
        Load case -> drive torque or force without friction; empty where no joint has any.
    """

    case: Case
    motion: Motion
    held: Drive | None
    moved: Mapping[str, Motion]
    masses: Mapping[str, PartMass]
    loads: Mapping[str, tuple[Load, ...]]
    power: Mapping[str, Power]
    forces: Mapping[str, Kinetostatics]
    torque: Mapping[str, Real]
    dead_points: tuple[float, ...]
    rubbing: Mapping[str, Rubbing]
    frictionless: Mapping[str, Real]

    @property
    def drive(self) -> Drive:
        """What drives the linkage; raises ``CaseError`` for a structure."""
        if self.held is None:
            raise CaseError("motion: the linkage cannot move, so nothing is to be told of it; look at its envelope")
        return self.held

    def work(self, load_case: str) -> DriveWork:
        """Return what the drive does with and without friction.

        Parameters
        ----------
        load_case : str
            One with friction.

        Returns
        -------
        DriveWork
        """
        rubbing, without = self.rubbing[load_case], self.frictionless[load_case]
        return drive_work(self.motion, self.drive, (rubbing.way, rubbing.sense), without, self.torque[load_case])

    def drive_power(self, load_case: str) -> Real:
        """Return the power of the drive.

        Parameters
        ----------
        load_case : str

        Returns
        -------
        array (n,)
            [N mm/s]; NaN at dead points.
        """
        moved = self.moved[load_case]
        return np.asarray(self.torque[load_case] * relative_motion(moved, self.drive) * moved.speed)

    def momentum(self, load_case: str | None = None) -> LinkageMomentum | None:
        """Return momentum, kinetic energy and shaking of the linkage at the speed of a load case.

        Parameters
        ----------
        load_case : str, optional
            The speed of the motion, and all masses, unless given.

        Returns
        -------
        LinkageMomentum or None
            None without a speed, and where nothing was weighed since no load case asks for weight or inertia.
        """
        moved = self.motion if load_case is None else self.moved[load_case]
        stated = load_case is None or self.case.load_cases[load_case].carried
        if not moved.moves or not _weighed(self.case):
            return None
        masses = laden_masses(self.case, self.masses, stated=stated)
        return linkage_momentum(moved.placement, masses, self.moment_point[1])

    @property
    def moment_point(self) -> tuple[str | None, complex]:
        """The fixed point about which moments are taken, its name and place x + iy [mm].

        The drive's joint, where the ground is one of its links, else the global origin, which has no name.
        """
        if self.held is None:
            return None, 0j
        ground, name = self.case.linkage.ground, self.drive.joint
        if ground not in self.case.linkage.joints[name].links:
            return None, 0j
        return name, complex(*self.case.linkage.links[ground].points[self.case.linkage.point_of(name, ground)])

    @property
    def locks(self) -> tuple[str, ...]:
        """A sentence for every load case under which friction locks the linkage."""
        told = (lock_sentence(name, found, self.motion) for name, found in self.rubbing.items())
        return tuple(filter(None, told))

    @property
    def effort(self) -> DriveEffort:
        """What the drive exerts."""
        return self.drive.effort(self.case.linkage)


@dataclass(frozen=True, kw_only=True, eq=False)
class AirRange:
    """A motion in air, and what it is without and at either end of the range of C_N.

    Attributes
    ----------
    stated : CaseMotion
        With the stated C_N.
    without : CaseMotion
        Without the air.
    least, largest : CaseMotion
        With the least and with the largest C_N of each load case.
    """

    stated: CaseMotion
    without: CaseMotion
    least: CaseMotion
    largest: CaseMotion

    def at(self, load_case: str) -> tuple[CaseMotion, ...]:
        """Return the motions at the ends of the range; none of a load case without air or with a C_N without range.

        Parameters
        ----------
        load_case : str
            Its name.

        Returns
        -------
        tuple of CaseMotion
        """
        least, largest = (moved.case.load_cases.get(load_case) for moved in (self.least, self.largest))
        return () if least == largest else (self.least, self.largest)


def solve_case_motion(case: Case, presses: Mapping[str, Presses] | None = None) -> CaseMotion:
    """Move the case's linkage as its table [motion] says and solve every load case at every pose.

    A load case with a speed of its own moves over the same poses at that speed of the pose's coordinate, with inertia.

    Parameters
    ----------
    case : Case
    presses : mapping of str to mapping of str to array (n,), optional
        Load case -> joint -> what presses on the wall of its bore over its force (``solve_friction``).

    Returns
    -------
    CaseMotion

    Raises
    ------
    CaseError
        Where the motion meets a dead point, or the case states no motion, drive or masses.
    """
    case = each_direction(case, moving=True)
    spec, drive = case.motion, case.pinned_drive
    if spec is not None and spec.states is not None and case.pose.coordinate is None:
        return _standing(case, spec.states)
    coordinate = case.motion_coordinate
    assert spec is not None
    if drive is None:
        raise CaseError("drive: the linkage moves, but nothing drives it; add a [drive] with its link and joint")
    pose = case.solve_pose()
    angles = drive_angles(case, pose)
    speed, acceleration = drive_speeds(case, angles)
    refuse_slot_ends(pose, angles, coordinate=coordinate)
    motion = solve_motion(pose, angles, speed=speed, acceleration=acceleration, coordinate=coordinate)
    if (states := spec.states) is not None:
        motion = replace(motion, instants=Instants(percent=states.percent, times=states.times))
    refuse_turning_bonds(motion.virtual)
    refuse_stops(case, motion)
    masses = part_masses(case) if _weighed(case) else {}
    for name, load_case in case.load_cases.items():
        if load_case.speed != 0.0 and (coordinate.slides or coordinate.name != case.pose.coordinate):
            raise CaseError(
                f"load_cases.{name}.speed: it is the speed of the pose's coordinate '{case.pose.coordinate}', but the "
                f"motion prescribes '{coordinate}'; use one link for both, or leave this speed out"
            )
    moved = {name: _at_speed_of(motion, load_case) for name, load_case in case.load_cases.items()}
    loads, rubbing, frictionless = {}, {}, {}
    for name, load_case in case.load_cases.items():
        place = moved[name].placement
        loads[name] = acting_loads(case, load_case, place if with_inertia(case, name) else place.at_rest, masses)
        if rubbing_joints(case):
            rubbing[name] = motion_friction(case, name, moved[name], drive, loads[name], (presses or {}).get(name, {}))
            frictionless[name] = torque_by_virtual_work(moved[name], drive, loads[name])
            loads[name] += rubbing[name].loads
    power = {n: _energies(case, n, moved[n], masses, rubbing[n].loads if rubbing else ()) for n in loads}
    forces: dict[str, Kinetostatics] = {}
    if is_determinate(case.linkage):
        forces = {n: solve_kinetostatics(moved[n], drive, acting, power[n]) for n, acting in loads.items()}
    torque = {
        n: np.asarray(forces[n].effort) if forces else torque_by_virtual_work(moved[n], drive, acting)
        for n, acting in loads.items()
    }
    return CaseMotion(
        case=case,
        motion=motion,
        held=drive,
        moved=moved,
        masses=masses,
        loads=loads,
        power=power,
        forces=forces,
        torque=torque,
        dead_points=dead_points(motion, drive),
        rubbing=rubbing,
        frictionless=frictionless,
    )


def _standing(case: Case, states: CycleMotion) -> CaseMotion:
    """Return a structure over a cycle of loads: the same pose at every instant, and no drive."""
    pose, instants = case.solve_pose(), Instants(percent=states.percent, times=states.times)
    motion, none = still_motion(pose, instants), np.zeros(len(states.percent))
    masses, place = part_masses(case) if needs_masses(case) else {}, motion.placement.at_rest
    loads = {name: acting_loads(case, one, place, masses) for name, one in case.load_cases.items()}
    power = Power(kinetic=none, kinetic_rate=none, potential=none, potential_rate=none, applied=none)
    if case.linkage.borne != 3 * len(case.linkage.moving):
        remedy = (
            "check single instants by cycle.instant"
            if case.level is None or case.level.test is None
            else "take a constraint away, or state the cycles as a step with least and force"
        )
        raise CaseError(
            "cycle: the structure is redundant, so that its joint forces do not follow from equilibrium alone; "
            + remedy
        )
    return CaseMotion(
        case=case,
        motion=motion,
        held=None,
        moved=dict.fromkeys(loads, motion),
        masses=masses,
        loads=loads,
        power=dict.fromkeys(loads, power),
        forces={name: structure_over(motion, acting, power) for name, acting in loads.items()},
        torque=dict.fromkeys(loads, none),
        dead_points=(),
        rubbing={},
        frictionless={},
    )


def _weighed(case: Case) -> bool:
    """Return True where the parts of a motion are weighed: where weight or inertia acts."""
    return needs_masses(case) or case.inert


def _energies(case: Case, name: str, motion: Motion, masses: Mapping[str, PartMass], friction: Sequence[Load]) -> Power:
    """Return the energies of a load case, where each link's part and what it carries move as one mass."""
    load_case, place = case.load_cases[name], motion.placement
    acting, moves = acting_on(case, load_case, masses, inert=False), with_inertia(case, name)
    weights = [one for one in acting if isinstance(one, Weight)]
    others = loads_of((one for one in acting if not isinstance(one, Weight)), place if moves else place.at_rest)
    laden = laden_masses(case, masses, stated=load_case.carried) if moves else {}
    return energies(place, weights, (*others, *friction), laden)


def with_inertia(case: Case, load_case: str) -> bool:
    """Return True where inertia acts in a load case of a motion.

    Parameters
    ----------
    case : Case
        Whose table [motion] may ask for inertia.
    load_case : str
        Its name; one with a speed of its own has inertia.

    Returns
    -------
    bool
    """
    stated = case.load_cases[load_case]
    return stated.speed != 0.0 if "speed" in stated.model_fields_set else case.inert


def _at_speed_of(motion: Motion, load_case: LoadCase) -> Motion:
    """Return the motion at the load case's own constant speed, where it states one."""
    if load_case.speed == 0.0:
        return motion
    still = np.zeros_like(motion.acceleration)
    return replace(motion, speed=np.full_like(motion.speed, load_case.speed), acceleration=still)


def drive_angles(case: Case, pose: Pose) -> Real:
    """Return the values of the motion's coordinate: of a cycle, over its range, or a full turn from the stated pose.

    Parameters
    ----------
    case : Case
    pose : Pose
        The stated one.

    Returns
    -------
    array (poses,)
        Angles [rad] or travels [mm].
    """
    spec = case.motion
    assert spec is not None
    if spec.states is not None:
        return spec.states.values
    if spec.ends is not None:
        return np.linspace(*spec.ends, spec.poses)
    start = pose.angles[case.motion_coordinate.name]
    return np.linspace(start, start + math.copysign(2.0 * math.pi, spec.speed), spec.poses)


def drive_speeds(case: Case, angles: Real) -> tuple[Real, Real]:
    """Return speed and acceleration of the motion's coordinate.

    Those of a cycle are in its states. Else the acceleration is constant:
    speed² = first speed² + 2 acceleration (angle - first angle).

    Parameters
    ----------
    case : Case
    angles : array (poses,)
        Angles [rad] or travels [mm].

    Returns
    -------
    tuple of 2 array (poses,)
        Speed [rad/s, mm/s] and acceleration [rad/s², mm/s²].

    Raises
    ------
    CaseError
        Where the drive slows down to a stop before the motion ends.
    """
    spec = case.motion
    assert spec is not None
    if spec.states is not None:
        return spec.states.speed, spec.states.acceleration
    sense, first, rate = math.copysign(1.0, angles[-1] - angles[0]), abs(spec.rate[0]), spec.rate[1]
    square = first**2 + 2.0 * rate * np.abs(angles - angles[0])
    if square.min() < 0.0:
        stop = angles[0] + sense * first**2 / (-2.0 * rate)
        where = case.motion_coordinate.measure.in_words(stop)
        raise CaseError(
            f"motion.acceleration: the drive slows down to a stop at {where}, before the motion ends; "
            "state a smaller deceleration, a higher speed or a shorter range"
        )
    return sense * np.sqrt(square), np.full(len(angles), sense * rate)


COARSE = math.radians(5.0)
"""Step between poses beyond which a peak between them may be missed: of a fourth harmonic, 1.5 % of its amplitude."""


def step_caveats(case: Case) -> Iterator[Caveat]:
    """Yield that poses of the motion lie so far apart that a peak between them may be missed.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    motion = case.motion
    if motion is None or motion.travel is not None:
        return
    first, last = motion.range or (0.0, math.tau)
    step = abs(last - first) / (motion.poses - 1)
    if motion.states is not None:
        step = float(np.abs(np.diff(motion.states.values)).max())
    if step > COARSE:
        yield Caveat(
            topic=Topic.MOTION,
            what=reason("between_poses", poses=motion.poses),
            why=reason("poses_apart", degrees=math.degrees(step)),
        )


def cycle_caveats(case: Case) -> Iterator[Caveat]:
    """Yield that a check of one instant leaves out the rest of its cycle.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    if case.cycle is not None:
        what = reason("rest_of_cycle", percent=case.cycle.instant)
        yield Caveat(topic=Topic.MOTION, what=what, why=reason("envelope_has_cycle"))


def inertia_caveats(case: Case, *, over_motion: bool) -> Iterator[Caveat]:
    """Yield inertia that a stated speed would give, and that the case leaves out or no single pose has.

    Parameters
    ----------
    case : Case
    over_motion : bool
        True for a verdict on the motion, False for one on the stated pose.

    Yields
    ------
    Caveat
    """
    motion = case.motion
    if motion is None or not motion.moves:
        return
    if motion.inertia is False:
        yield Caveat(topic=Topic.INERTIA, what=reason("inertia"), why=reason("inertia_is_false"))
    elif case.pose.equilibrium:
        yield Caveat(topic=Topic.INERTIA, what=reason("inertia"), why=reason("pose_at_rest"))
    elif case.inert and not case.turns_steadily and not over_motion:
        yield Caveat(topic=Topic.INERTIA, what=reason("inertia_in_pose"), why=reason("envelope_has_inertia"))
    elif case.inert and case.turns_steadily and all(one.speed == 0.0 for one in case.load_cases.values()):
        yield Caveat(topic=Topic.INERTIA, what=reason("inertia"), why=reason("all_stand_still"))
