"""Where a linkage stands under a load case and what holds it: the drive, a stop, or the balance of all that acts.

The work of all loads per unit of the pose's coordinate s is Q(s): less the derivative of the total potential energy
wherever there is one. A linkage that is let go moves the way Q pushes it, to the first place where Q has gone, which
is then stable, or to the first stop. A stop with the gap g(s) bears c = -Q/(dg/ds) where this pushes (virtual work);
it then takes the place of the drive.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import DeadPointError, Track
from alula.geometry.linkage.coordinate import Measure
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.motion import Motion, refuse_beyond_slots, solve_motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.acting.acting import loads_of
from alula.loads.acting.sprung import SpringState
from alula.loads.case.case import Case
from alula.loads.records.applied import PartMass
from alula.loads.records.check_spec import FrequencyCheck
from alula.loads.records.load_case import LoadCase
from alula.loads.records.settings import DriveSpec
from alula.loads.states.actions import acting_on, bounds, lasting
from alula.loads.states.kinetostatics import work
from alula.loads.statics.statics import Drive
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.loads.text.reason import reason

Real = NDArray[np.float64]

_POSES = 721
"""Poses over the way on which balance is sought: half a degree apart over a turn."""
_TURN = 2.0 * math.pi * (1.0 - 1e-6)
_TRAVEL = 2.0
"""How far a slider is let go, over the links' lengths together."""
_SHORT = 1e-6
"""By which the way ends before a dead point of the coordinate [rad], or over the longest link."""
_STEP = 1e-4
"""Of the coordinate [rad], or over the longest link, by which the stiffness of the balance is measured."""
_NOTHING = 1e-12
"""Share of the works of all loads below which their sum is none."""
_NEUTRAL = 1e-9
"""Stiffness over the works of all loads per radian, or longest link, below which a balance is indifferent."""
_NARROWED, _ROUNDS = 17, 9
"""Places to which an interval is narrowed at a time, and how often: to 16^-9 of half a degree."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Standing:
    """Where a linkage stands under a load case, and what holds it there.

    Attributes
    ----------
    case : Case
        The case as it stands: its pose is the one found, its drive what holds it there.
    pose : Pose
    stop : str
        The stop that bears in place of the drive; "" where none does.
    contact : float
        What it does to its joint's second link [N mm], or along the guide [N].
    stiffness : float or None
        Of a pose that balances by itself: what brings it back, per unit of the coordinate [N mm/rad, N/mm].
    springs : tuple of SpringState
        Springs and tendons in that pose.
    stops : mapping of str to float
        Stop -> angle [rad] or travel [mm] of its joint.
    """

    case: Case
    pose: Pose
    stop: str = ""
    contact: float = 0.0
    stiffness: float | None = None
    springs: tuple[SpringState, ...] = ()
    stops: Mapping[str, float] = field(default_factory=dict)


def stand(case: Case, load_case: str, masses: Mapping[str, PartMass]) -> Standing:
    """Return where the linkage of a case stands under a load case, and what holds it.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    masses : mapping of str to PartMass
        Of the parts, by link.

    Returns
    -------
    Standing
        With the case itself where its drive holds it.

    Raises
    ------
    CaseError
        For a stated pose beyond a stop, for one in which a pin stands beyond an end of its slot, and for a linkage that
        is let go and finds no stable balance.
    """
    pose = case.stated_pose
    _refuse_beyond(case, pose)
    if case.pose.equilibrium:
        found = _let_go(_Way(case, case.load_cases[load_case], masses), load_case)
        refuse_beyond_slots(found.pose)
        return found
    refuse_beyond_slots(pose)
    place, stops = pose.placement, bounds(case)
    springs = tuple(one.state(place) for one in lasting(case))
    values = {name: float(stop.value(place)) for name, stop in stops.items()}
    found = Standing(case=case, pose=pose, springs=springs, stops=values)
    reached = [name for name, stop in stops.items() if stop.gap(place) <= stop.touching]
    keeps = any(joint.as_posed for joint in case.linkage.joints.values())
    if not reached or pose.coordinate is None or keeps:
        return found
    way = _Way(case, case.load_cases[load_case], masses)
    held = way.held_by(reached, pose.held)
    if held is None:
        return found
    stop, contact = held
    return replace(found, case=_with_pose(_held(case, stop), pose), stop=stop, contact=contact)


def _refuse_beyond(case: Case, pose: Pose) -> None:
    """Refuse a stated pose beyond a stop."""
    for name, stop in bounds(case).items():
        if stop.gap(pose.placement) < -stop.touching:
            value = float(stop.value(pose.placement))
            raise CaseError(
                f"stops.{name}: in the stated pose {_told(case, name, value)}, beyond this stop, which lets it be "
                f"{_rule(case, name)}; change the pose or the stop"
            )


def _told(case: Case, name: str, value: float) -> str:
    """Return the angle or travel of a stop's joint for people."""
    stop = case.stops[name]
    first, second = case.joints[stop.joint].links
    if stop.limit.measure is Measure.TRAVEL:
        return f"the travel of joint '{stop.joint}' is {stop.limit.measure.in_words(value)}"
    return f"the angle of {second} to {first} at joint '{stop.joint}' is {stop.limit.measure.in_words(value)}"


def _rule(case: Case, name: str) -> str:
    limit, least = case.stops[name].limit, case.stops[name].at_least is not None
    return f"{limit.measure.in_words(limit.value)} at {'least' if least else 'most'}"


class _Way:
    """The way of a linkage from its stated pose along its coordinate, as far as it is followed."""

    def __init__(self, case: Case, load_case: LoadCase, masses: Mapping[str, PartMass]) -> None:
        self.case, self.pose, self.stops = case, case.stated_pose, bounds(case)
        self.acting = acting_on(case, load_case, masses, inert=False)
        assert self.pose.coordinate is not None
        self.driven = DrivenClosure(self.pose.closure, self.pose.coordinate)
        self.size = self.driven.size
        self.track: Track | None = None
        self.ended: DeadPointError | None = None
        self.follow(-3.0 * _STEP * self.size, 3.0 * _STEP * self.size)

    def follow(self, low: float, high: float) -> None:
        """Follow the branch so far below and above the stated value of the coordinate."""
        at = self.pose.held
        self.track = solve_motion(self.pose, [at + low, at + high]).track

    def far(self, sense: float) -> float:
        """Follow the branch in one sense as far as it goes, and return to where [rad, mm]."""
        linkage, near = self.case.linkage, 3.0 * _STEP * self.size
        most = _TRAVEL * len(linkage.moving) * linkage.longest if self.driven.coordinate.slides else _TURN
        for _ in range(2):
            try:
                self.follow(*sorted((-sense * near, sense * most)))
                return self.pose.held + sense * (most - near)
            except DeadPointError as error:
                self.ended = error
                most = sense * (error.angle - self.pose.held) - _SHORT * self.size
                if most <= 2.0 * near:
                    break
        return self.pose.held

    def place(self, values: Real) -> tuple[Placement, Real]:
        """Return the stated pose and those at values (n,) of the coordinate, with their first-order coefficients."""
        assert self.track is not None
        q = self.track.at(np.array([self.pose.held, *values]))
        return Placement(closure=self.pose.closure, q=q), self.driven.coefficients(q)[0]

    def push(self, values: Real) -> tuple[Real, Real]:
        """Return the work (n,) of all loads per unit of the coordinate, and the sum of its sizes load by load."""
        place, first = self.place(values)
        moved = replace(place, qdot=first)
        works = [work([load], place, moved)[1:] for load in loads_of(self.acting, place)]
        return np.sum([np.zeros(len(values)), *works], axis=0), np.sum(np.abs([np.zeros(len(values)), *works]), axis=0)

    def gaps(self, values: Real) -> dict[str, Real]:
        """Return the gap (n,) of every stop."""
        place, _ = self.place(values)
        return {name: stop.gap(place)[1:] for name, stop in self.stops.items()}

    def gap(self, name: str, values: Real) -> Real:
        """Return the gap (n,) of one stop."""
        return self.gaps(values)[name]

    def held_by(self, reached: list[str], at: float) -> tuple[str, float] | None:
        """Return the first of some stops that bears at a value of the coordinate, and what it does; None for none."""
        [push], [size] = self.push(np.array([at]))
        step = _STEP * self.size
        for name in reached:
            low, high = self.gaps(np.array([at - step, at + step]))[name]
            rate = (high - low) / (2.0 * step)
            if abs(rate) > _NEUTRAL * self.stops[name].touching / self.size:
                bears = -push / rate
                if bears * abs(rate) > _NOTHING * size:
                    return name, self.case.stops[name].sense * bears
        return None

    def stiffness(self, at: float) -> tuple[float, float]:
        """Return the lesser stiffness of the balance on both sides of a value, and what counts as none."""
        step = _STEP * self.size
        push, sizes = self.push(at + step * np.arange(-2.0, 3.0))
        before, after = push[0] - 4.0 * push[1] + 3.0 * push[2], -3.0 * push[2] + 4.0 * push[3] - push[4]
        return -max(before, after) / (2.0 * step), _NEUTRAL * float(sizes.max()) / self.size


def _let_go(way: _Way, load_case: str) -> Standing:
    """Return where a linkage goes that is let go in its stated pose."""
    start = way.pose.held
    [push], [size] = way.push(np.array([start]))
    touched = [name for name, [gap] in way.gaps(np.array([start])).items() if gap <= way.stops[name].touching]
    if (held := way.held_by(touched, start)) is not None:
        return _stopped(way, start, held)
    if abs(push) <= _NOTHING * size:
        return _balanced(way, start, load_case)
    sense = math.copysign(1.0, push)
    values = np.linspace(start, way.far(sense), _POSES)
    pushes, _ = way.push(values)
    ends = {"": _first(values, sense * pushes, lambda x: sense * way.push(x)[0])}
    for name, gaps in way.gaps(values).items():
        ends[name] = _first(values, np.where(values == start, np.inf, gaps), partial(way.gap, name))
    name, at = min(ends.items(), key=lambda end: sense * end[1])
    if math.isinf(at):
        raise CaseError(_unbalanced(way, load_case, values[-1]))
    if not name:
        return _balanced(way, at, load_case)
    held = way.held_by([name], at)
    assert held is not None  # the load pushes there, since it has not changed its sense before
    return _stopped(way, at, held)


def _first(values: Real, found: Real, function: Callable[[Real], Real]) -> float:
    """Return where a function first is not positive any more, behind the first value; infinite the way on for never.

    Halving by ``_NARROWED`` places at a time, and the chord at last.
    """
    [past] = [np.flatnonzero(found[1:] <= 0.0)[:1] + 1]
    if not len(past):
        return math.inf * (1.0 if values[-1] >= values[0] else -1.0)
    low, high = float(values[past[0] - 1]), float(values[past[0]])
    for _ in range(_ROUNDS):
        places = np.linspace(low, high, _NARROWED)
        inner = int(np.flatnonzero(np.append(function(places[1:-1]) <= 0.0, True))[0]) + 1
        low, high = float(places[inner - 1]), float(places[inner])
    one, two = function(np.array([low, high]))
    return high if one == two else low + (high - low) * float(np.clip(one / (one - two), 0.0, 1.0))


def _unbalanced(way: _Way, load_case: str, end: float) -> str:
    to, other = "", "state another start"
    if way.ended is not None:
        to, other = ", where it comes to a dead point of its coordinate", "fix the pose by another link"
    return (
        f"pose.equilibrium: let go at {way.pose.coordinate} = {way.driven.told(way.pose.held)} under load case "
        f"'{load_case}', the linkage finds no balance and no stop as far as {way.driven.told(float(end))}{to}; add a "
        f"spring or a stop that holds it, or {other}"
    )


def _at(way: _Way, value: float) -> tuple[Pose, Placement]:
    """Return the pose at a value of the coordinate, and the stated pose with it as a placement of two."""
    place, _ = way.place(np.array([value]))
    residual = float(np.max(np.abs(way.pose.closure.residual(place.q[1])), initial=0.0)) / way.case.linkage.longest
    return replace(way.pose, q=place.q[1], residual=residual), place


def _balanced(way: _Way, at: float, load_case: str) -> Standing:
    stiffness, none = way.stiffness(at)
    if stiffness <= none:
        unit = way.driven.coordinate.measure.stiffness_unit
        kind = (
            "but is indifferent there" if stiffness >= -none else f"but not stably (stiffness {stiffness:.4g} {unit})"
        )
        raise CaseError(
            f"pose.equilibrium: at {way.pose.coordinate} = {way.driven.told(at)} the linkage balances under load case "
            f"'{load_case}', {kind}; state a start beside it, or change springs and loads"
        )
    found = _standing(way, at)
    holder = _holder(way.case, found.pose)
    drive = found.case.drive or DriveSpec(link=holder.link, joint=holder.joint)
    case = found.case.model_copy(update={"drive": drive.in_place(link=holder.link, joint=holder.joint)})
    return replace(found, case=_with_pose(case, found.pose), stiffness=stiffness)


def _stopped(way: _Way, at: float, held: tuple[str, float]) -> Standing:
    found, (stop, contact) = _standing(way, at), held
    case = _with_pose(_held(found.case, stop), found.pose)
    return replace(found, case=case, stop=stop, contact=contact)


def _standing(way: _Way, at: float) -> Standing:
    """Return the case at a value of the coordinate; springs are told by what they do there."""
    pose, both = _at(way, at)
    states = tuple(
        replace(state, size=state.size[1], effort=state.effort[1])
        for state in (one.state(both) for one in lasting(way.case))
    )
    efforts = {(state.kind, state.name): float(state.effort) for state in states}
    springs = {name: spring.standing(efforts["spring", name]) for name, spring in way.case.springs.items()}
    coordinate = way.driven.coordinate
    moving = way.case.linkage.moving
    near = {link: angle for link, angle in pose.angles.items() if link in moving and link != coordinate.name}
    stated = way.case.pose.model_copy(update={"near": near, "equilibrium": False, coordinate.measure.word: pose.held})
    case = way.case.model_copy(update={"pose": stated, "springs": springs})
    stops = {name: float(stop.value(both)[1]) for name, stop in way.stops.items()}
    return Standing(case=case, pose=pose, springs=states, stops=stops)


def _with_pose(case: Case, pose: Pose) -> Case:
    """Return the case with its pose as it was found, which assembling it anew would give but for rounding."""
    case.__dict__["stated_pose"] = pose
    return case


def _held(case: Case, stop: str) -> Case:
    """Return the case with a stop in place of its drive."""
    joint = case.stops[stop].joint
    first, second = case.joints[joint].links
    link = first if second == case.linkage.ground else second
    drive = case.drive or DriveSpec(link=link, joint=joint)
    return case.model_copy(update={"drive": drive.in_place(link=link, joint=joint, stop=stop)})


def _holder(case: Case, pose: Pose) -> Drive:
    """Return where a pose that balances by itself is held against deformation.

    It is the drive's place, that of the coordinate on the ground, or the one on the ground with the best leverage.
    """
    if case.drive is not None:
        return Drive(link=case.drive.link, joint=case.drive.joint)
    ground = case.linkage.ground
    places = [
        Drive(link=link, joint=name)
        for name, joint in case.joints.items()
        if (joint.kind.guided or not joint.slides) and ground in joint.links
        for link in joint.links
        if link != ground
    ]
    own = [place for place in places if place.coordinate(case.linkage) == pose.coordinate]
    return max(own or places, key=lambda place: place.dead_point_distance(pose))


def refuse_stops(case: Case, motion: Motion) -> None:
    """Refuse a motion that goes beyond a stop.

    Parameters
    ----------
    case : Case
    motion : Motion
        The n poses of its linkage.

    Raises
    ------
    CaseError
        With the pose at which the stop is reached.
    """
    for name, stop in bounds(case).items():
        gaps, slack = stop.gap(motion.placement), stop.touching
        if not np.any(gaps < -slack):
            continue
        before = gaps[0] < -slack
        i = 1 if before else int(np.flatnonzero(gaps < -slack)[0])
        at = motion.angles[0]
        if not before:
            share = np.clip(gaps[i - 1] / (gaps[i - 1] - gaps[i]), 0.0, 1.0)
            at = motion.angles[i - 1] + share * (motion.angles[i] - motion.angles[i - 1])
        told = motion.track.driven.told(float(at))
        how = (
            f"starts beyond it at {motion.coordinate} = {told}"
            if before
            else (f"comes to it at {motion.coordinate} = {told}, before its end")
        )
        raise CaseError(
            f"stops.{name}: the motion {how}, but this stop lets joint '{case.stops[name].joint}' be "
            f"{_rule(case, name)}; end the motion there, or change the stop"
        )


def drive_caveats(case: Case) -> Iterator[Caveat]:
    """Yield that the drive holds its link without giving, where that matters.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    if case.drive is not None and case.drive.stiffness is not None:
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.DRIVE,
            what=reason("rigid_drive"),
            why=reason("stiffness_for_frequencies"),
        )
    elif case.drive is not None and any(isinstance(check, FrequencyCheck) for check in case.checks.values()):
        usual = "20 N/mm" if case.joints[case.drive.joint].kind.guided else "2 N*m/rad"
        yield Caveat(
            heading=Heading.ASSUMED,
            topic=Topic.DRIVE,
            what=reason("rigid_drive"),
            why=reason("no_drive_stiffness", usual=usual),
        )
