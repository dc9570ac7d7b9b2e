"""What the play of pins does to a linkage under a load case: to its pose, joint forces, drive and dead point.

A pin bears on the side of its hole at which its force pushes it. So at rest the second link's point stands off the
first's by half of the play against the force F of the first link on the second, -c/2 F/|F|; as links move, forces
turn, and both are repeated until they agree. In motion, or where loads reverse, each joint may stand anywhere in its
play. The extremes are the sums over the joints of c/2 times the size of the gradient by the joint's offset, at their
worst together; at one pose the linkage is then solved at that worst combination, and the outer of both counts.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.play import LooseJoints
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import clearances, rubbing_joints
from alula.loads.records.applied import Load, PartMass, chosen
from alula.loads.states.actions import acting_loads
from alula.loads.states.kinetostatics import is_determinate
from alula.loads.states.rubbing import friction_at, sense_of
from alula.loads.statics.friction import NOTHING_MORE, Presses
from alula.loads.statics.statics import Balance, Drive, balance

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

STEP = 1e-5
"""Offset, over the longest link, by which gradients are taken, to either side."""
ROUNDS = 100
"""In which the directions of forces are found."""
SETTLED = 1e-9
"""Change of the offsets, over half of the play, below which they agree with the forces."""
NO_FORCE = 1e-9
"""Share of the largest joint force below which a joint bears none, so that its pin rests nowhere in particular."""


@dataclass(frozen=True, kw_only=True)
class Span:
    """A number and the ends between which play may bring it.

    Attributes
    ----------
    value, low, high : float or array (n,)
        Without play, and the ends.
    """

    value: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Displaced(Balance):
    """The equilibrium of the linkage with its joints at stated offsets, in one state or in n.

    Attributes
    ----------
    loads : tuple of Load
        All that acts on the links there.
    """

    loads: tuple[Load, ...]

    @property
    def offsets(self) -> Mapping[str, Any]:
        """Joint -> its offset (...), as ``LoopClosure`` has it [mm]."""
        return self.place.closure.offsets

    def chosen(self, states: Any) -> "Displaced":
        """Return the chosen states alone.

        Parameters
        ----------
        states : int, slice or mask (n,)
            Which of the n states.

        Returns
        -------
        Displaced
        """
        names = ("drive_torque", "drive_force", "residual", "sound", "unknowns")
        return replace(
            self,
            place=self.place.chosen(states),
            system=replace(self.system, matrix=self.system.matrix[states], rhs=self.system.rhs[states]),
            joints={name: chosen(joint, states) for name, joint in self.joints.items()},
            loads=tuple(chosen(load, states) for load in self.loads),
            **{name: getattr(self, name)[states] for name in names},
        )

    @cached_property
    def distance(self) -> Real:
        """From a dead point (...): the smallest singular value of the scaled equations."""
        return np.asarray(self.system.singular_values[..., -1])

    def force(self, joint: str) -> Complex:
        """Return the force of a joint's first link on its second.

        Parameters
        ----------
        joint : str

        Returns
        -------
        complex array (...)
            Global axes [N].
        """
        wrench = self.joints[joint].wrench
        return np.asarray(wrench[..., 0] + 1j * wrench[..., 1])


@dataclass(frozen=True, kw_only=True, eq=False)
class Play:
    """The play of a linkage's joints under a load case, at one pose or at n poses of a motion.

    Attributes
    ----------
    case : Case
    load_case : str
        Its name.
    loose : LooseJoints
        At the poses without play.
    masses : mapping of str to PartMass
        Of the parts.
    rates : callable
        Returns a placement with the rates that the load case gives it.
    friction : callable
        Returns a placement's friction under loads, besides these, and where it locks the linkage.
    """

    case: Case
    load_case: str
    loose: LooseJoints
    masses: Mapping[str, PartMass]
    rates: Callable[[Placement], Placement]
    friction: Callable[[Placement, Sequence[Load]], tuple[tuple[Load, ...], NDArray[np.bool_]]]

    @property
    def clearances(self) -> dict[str, float]:
        """Joint -> its play [mm]."""
        return {name: 2.0 * radius for name, radius in self.loose.radii.items()}

    @property
    def drive(self) -> Drive | None:
        """What holds the linkage."""
        return self.case.pinned_drive

    def at(self, offsets: Mapping[str, complex | Complex]) -> Displaced | None:
        """Solve the linkage with its joints at offsets.

        Parameters
        ----------
        offsets : mapping of str to complex
            As ``LoopClosure.offsets`` [mm].

        Returns
        -------
        Displaced or None
            None where a dead point lies on the way, or friction locks the linkage.
        """
        here = self.solved(offsets)
        return here if np.all(here.sound) else None

    def solved(self, offsets: Mapping[str, complex | Complex]) -> Displaced:
        """Solve the linkage with its joints at offsets, as far as it goes.

        Parameters
        ----------
        offsets : mapping of str to complex or complex array (...)
            As of ``LooseJoints.moved`` [mm].

        Returns
        -------
        Displaced
            Not sound in states where a dead point lies on the way, or friction locks the linkage: numbers mean nothing
            there.
        """
        place, closed = self.loose.moved(offsets)
        place = self.rates(replace(place, q=np.where(closed[..., None], place.q, self.loose.place.q)))
        loads = acting_loads(self.case, self.case.load_cases[self.load_case], place, self.masses)
        rubbed, locked = self.friction(place, loads)
        loads += rubbed
        found = balance(place, self.drive, loads)
        sound = closed & found.sound & ~locked
        return Displaced(**{**vars(found), "sound": sound}, loads=loads)

    @cached_property
    def plain(self) -> Displaced:
        """The linkage without play, as of ``solved``."""
        return self.solved({})

    @cached_property
    def nominal(self) -> Displaced | None:
        """The linkage without play; None at a dead point."""
        return self.plain if np.all(self.plain.sound) else None

    @cached_property
    def ends(self) -> Displaced:
        """The linkage without play, then with one joint at a time at an end of it (``LooseJoints.one_by_one``).

        Of one pose.
        """
        apart = self.loose.one_by_one(self.loose.radii)
        return self.solved({name: np.append(0.0, offsets) for name, offsets in apart.items()})

    @cached_property
    def settled(self) -> Displaced | None:
        """The linkage at rest under its load, every pin on the side of its force; of one pose.

        None where forces and offsets do not agree, since a joint's force turns round as its pin changes sides.
        """
        here = self.nominal
        for _ in range(ROUNDS):
            if here is None:
                return None
            offsets = self._against_forces(here)
            after = self.at(offsets)
            if all(abs(offsets[n] - here.offsets.get(n, 0.0)) <= SETTLED * r for n, r in self.loose.radii.items()):
                return after
            here = after
        return None

    def _against_forces(self, here: Displaced) -> dict[str, complex]:
        """Offsets of joints whose pins rest where their forces push them."""
        found, least = {}, NO_FORCE * max(joint.magnitude for joint in here.joints.values())
        for name, radius in self.loose.radii.items():
            along, force = self.loose.directions(name), complex(here.force(name))
            if len(along) == 1:  # across the slot, which turns with its link
                across = along[0] * complex(here.place.direction(self.case.joints[name].links[0]))
                force = along[0] * float((np.conj(across) * force).real)
            found[name] = -radius * force / abs(force) if abs(force) > least else 0.0
        return found

    @cached_property
    def gradients(self) -> Mapping[str, tuple[Mapping[str, Real | Complex], ...]]:
        """Joint -> derivatives, by each of its offsets, of every joint's force, the effort and the distance.

        The effort is at "effort", the distance at "distance"; by central differences. Infinite at a dead point. The
        smallest singular value σ changes by uᵀ dA v with its singular vectors, A v = σ u (Golub and Van Loan, Matrix
        Computations, 4th ed., section 8.6.1).
        """
        step, poses = STEP * self.loose.place.linkage.longest, self.loose.place.shape
        left, _, right = np.linalg.svd(self.plain.system.scaled)
        steps = self.loose.one_by_one(dict.fromkeys(self.loose.radii, step))
        there = self.solved({name: offset.reshape(-1, *[1] * len(poses)) for name, offset in steps.items()})
        numbers = {f"force {name}": there.force(name) for name in self.case.joints} | {"effort": there.effort}
        by = {key: (x[0::2] - x[1::2]) / (2.0 * step) for key, x in {**numbers, "": there.system.scaled}.items()}
        by["distance"] = np.einsum("...i,...ij,...j->...", left[..., -1], by.pop(""), right[..., -1, :])
        sound = there.sound[0::2] & there.sound[1::2]
        by = {key: np.where(sound, change, np.inf) for key, change in by.items()}
        each = [(name, {key: change[k] for key, change in by.items()}) for k, (name, _) in enumerate(self.loose.ways)]
        return {name: tuple(one for at, one in each if at == name) for name in self.loose.radii}

    def slack(self, key: str) -> Real:
        """Return how far a real number of ``gradients`` may go to either side, to first order.

        Parameters
        ----------
        key : str

        Returns
        -------
        array (...)
            Infinite at a dead point.
        """
        sizes = (
            radius * np.sqrt(sum(np.abs(by[key]) ** 2 for by in self.gradients[name]))
            for name, radius in self.loose.radii.items()
        )
        return np.asarray(sum(sizes, np.zeros(self.loose.place.shape)))

    @cached_property
    def _worst(self) -> Mapping[tuple[str, float], Displaced | None]:
        """The linkage where distance and effort are largest and least, to first order; of one pose."""
        ends = list(itertools.product(("distance", "effort"), (1.0, -1.0)))
        slopes = {
            name: np.array([[sign * float(one[key].real) for one in by] for key, sign in ends])
            for name, by in self.gradients.items()
        }
        found = self.solved(self.loose.at_rims(slopes))
        return {end: found.chosen(i) if found.sound[i] else None for i, end in enumerate(ends)}

    @cached_property
    def through_dead_point(self) -> bool:
        """True where play may take the linkage through a dead point, or to where it does not close; of one pose."""
        if self.nominal is None:
            return True
        near = float(self.nominal.distance) <= float(self.slack("distance"))
        return near or any(end is None for end in self._worst.values())

    @cached_property
    def nearest(self) -> Displaced | None:
        """The linkage where play brings it nearest to a dead point; None where it goes through one; of one pose."""
        return None if self.through_dead_point else self._worst["distance", -1.0]

    @cached_property
    def furthest(self) -> Displaced | None:
        """The linkage where play brings it furthest from a dead point; None where it goes through one; of one pose."""
        return None if self.through_dead_point else self._worst["distance", 1.0]

    @cached_property
    def effort(self) -> Span:
        """The drive's torque or force; of one pose. Without bounds where a dead point may be passed."""
        return self._span("effort")

    @cached_property
    def distance(self) -> Span:
        """The distance to a dead point; of one pose."""
        return self._span("distance")

    def _of(self, here: Displaced, key: str) -> float:
        return float(here.distance if key == "distance" else here.effort)

    def _span(self, key: str) -> Span:
        value = np.nan if self.nominal is None else self._of(self.nominal, key)
        if self.through_dead_point:
            low, high = (0.0, np.inf) if key == "distance" else (-np.inf, np.inf)
            return Span(value=value, low=low, high=high)
        slack = float(self.slack(key))
        solved = [self._of(end, key) for s in (1.0, -1.0) if (end := self._worst[key, s]) is not None]
        low, high = min(value - slack, *solved), max(value + slack, *solved)
        return Span(value=value, low=max(low, 0.0) if key == "distance" else low, high=high)

    @cached_property
    def forces(self) -> Mapping[str, Span]:
        """Joint -> size of its force [N]; of one pose."""
        if self.nominal is None or self.through_dead_point:
            sizes = {n: np.nan if self.nominal is None else abs(self.nominal.force(n)) for n in self.case.joints}
            return {name: Span(value=float(size), low=0.0, high=np.inf) for name, size in sizes.items()}
        forces, reaches = {name: complex(self.nominal.force(name)) for name in self.case.joints}, {}
        for name in forces:
            rates = {
                n: tuple(np.asarray(one[f"force {name}"], dtype=np.complex128) for one in by)
                for n, by in self.gradients.items()
            }
            reaches[name] = self.loose.reach_of(rates)
        shares = [reaches[name].shares(force) for name, force in forces.items()]
        worst = self.solved(self.loose.offsets({n: np.array([one[n] for one in shares]) for n in self.loose.radii}))
        found = {}
        for i, (name, force) in enumerate(forces.items()):
            value, reach = abs(force), reaches[name]
            solved = abs(complex(worst.force(name)[i])) if worst.sound[i] else np.inf
            high = max(value, reach.largest(force), solved)
            found[name] = Span(value=value, low=min(value, reach.least(force)), high=high)
        return found

    def shift(self, link: str, point: str) -> Complex:
        """Return how far a point stands off its place without play as the linkage rests under its load.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex
            Global axes [mm]; zero where it rests in no single place.
        """
        if self.settled is None:
            return np.asarray(0j)
        return self.settled.place.position(link, point) - self.loose.place.position(link, point)

    def free_motion(self, link: str, point: str) -> float:
        """Return how far a point may go to either side with the drive held; of one pose.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        float
            [mm]
        """
        return self.loose.spread(link, point)[1]

    def pose(self, here: Displaced, nominal: Pose) -> Pose:
        """Return the pose of the linkage at offsets.

        Parameters
        ----------
        here : Displaced
        nominal : Pose
            Without play.

        Returns
        -------
        Pose
        """
        return replace(nominal, q=here.place.q, offsets=here.offsets)


def play_of(
    case: Case, load_case: str, pose: Pose, masses: Mapping[str, PartMass], presses: Presses = NOTHING_MORE
) -> Play | None:
    """Return what play does under a load case.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    pose : Pose
        Without play.
    masses : mapping of str to PartMass
        Of the parts.
    presses : mapping of str to array (1,), optional
        As for ``solve_friction``.

    Returns
    -------
    Play or None
        None where no joint has play.
    """
    speed = case.load_cases[load_case].speed
    coordinate = pose.coordinate if speed != 0.0 else None
    return play_at(case, load_case, pose.placement, masses, coordinate, speed, presses=presses)


def play_at(
    case: Case,
    load_case: str,
    place: Placement,
    masses: Mapping[str, PartMass],
    coordinate: Coordinate | None,
    speed: float | Real,
    acceleration: float | Real = 0.0,
    *,
    presses: Presses = NOTHING_MORE,
) -> Play | None:
    """Return what play does under a load case at poses.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    place : Placement
        Without play.
    masses : mapping of str to PartMass
        Of the parts.
    coordinate : Coordinate or None
        What moves; None for that of the pose, at rest.
    speed, acceleration : float or array (n,)
        Of the coordinate.
    presses : mapping of str to array (1,), optional
        As for ``solve_friction``.

    Returns
    -------
    Play or None
        None where no joint has play.
    """
    radii = {name: play / 2.0 for name, play in clearances(case).items()}
    if not radii:
        return None
    rates = partial(_with_rates, coordinate, speed, acceleration)
    friction = partial(_rubbed, case, load_case, coordinate, presses)
    loose = LooseJoints(place=place.at_rest, radii=radii, held=held_rows(place, case.pinned_drive))
    return Play(case=case, load_case=load_case, loose=loose, masses=masses, rates=rates, friction=friction)


def _with_rates(
    coordinate: Coordinate | None, speed: float | Real, acceleration: float | Real, place: Placement
) -> Placement:
    """Return a placement with the rates that those of a coordinate give it."""
    if coordinate is None or not (np.any(speed) or np.any(acceleration)):
        return place
    first, second = DrivenClosure(place.closure, coordinate).coefficients(place.q)
    rate, change = (np.asarray(x)[..., None] for x in (speed, acceleration))
    return replace(place, qdot=rate * first, qddot=rate**2 * second + change * first)


def _rubbed(
    case: Case,
    load_case: str,
    coordinate: Coordinate | None,
    presses: Presses,
    place: Placement,
    loads: Sequence[Load],
) -> tuple[tuple[Load, ...], NDArray[np.bool_]]:
    """Return what friction adds to the loads, and where it finds no balance."""
    moves, sense = coordinate or case.pose_coordinate, sense_of(case, load_case, place.rows)
    if not rubbing_joints(case) or moves is None or sense is None or not is_determinate(case.linkage):
        return (), np.zeros(place.shape, dtype=np.bool_)
    return friction_at(DrivenClosure(place.closure, moves), place, case.pinned_drive, loads, sense, presses)


def held_rows(place: Placement, drive: Drive | None) -> Real:
    """Return what stays: the driven link's angle to the other link of its joint, or a slider's travel; bonded angles.

    Parameters
    ----------
    place : Placement
    drive : Drive or None

    Returns
    -------
    array (k, unknowns)
        Factors of the unknowns, a travel's over the longest link.
    """
    closure, linkage = place.closure, place.linkage
    rows = [_turning(place, *j.links) for j in linkage.joints.values() if j.as_posed]
    if drive is not None and (held := drive.coordinate(linkage)).slides:
        row = np.zeros(closure.unknowns)
        row[held.column(closure)] = 1.0 / linkage.longest
        rows.append(row)
    elif drive is not None:
        rows.append(_turning(place, *linkage.joints[drive.joint].links))
    return np.array(rows).reshape(-1, closure.unknowns)


def _turning(place: Placement, first: str, second: str) -> Real:
    """Row of the angle of one link to another."""
    row, moving = np.zeros(place.closure.unknowns), place.linkage.moving
    for link, sign in ((first, -1.0), (second, 1.0)):
        if link in moving:
            row[moving.index(link)] = sign
    return row


def free_motion(case: Case, place: Placement, drive: Drive | None, link: str, point: str) -> float:
    """Return how far play lets a point go to either side with a drive held; of one pose.

    Parameters
    ----------
    case : Case
    place : Placement
        Without play.
    drive : Drive or None
        What is held.
    link, point : str
        Their names.

    Returns
    -------
    float
        [mm]; 0 where no joint has play.
    """
    radii = {name: play / 2.0 for name, play in clearances(case).items()}
    held = held_rows(place, drive)
    return LooseJoints(place=place, radii=radii, held=held).spread(link, point)[1] if radii else 0.0
