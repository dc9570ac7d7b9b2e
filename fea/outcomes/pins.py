"""Pins in shear and bending under their joint force.

Two eyes t1 and t2 thick lie side by side on the pin, g apart, so that it is in single shear: bearing along one eye
brings the force F, bearing along the other takes it. The forces' middles are a = t1/2 + g + t2/2 apart, and the couple
F a is taken by bearing that is not even: m1 in one eye and m2 in the other, m1 + m2 = F a. How they share it depends on
how the pin sits and how the links are held, so that the moment is a band, from statics alone:

* largest: one eye takes the whole couple and bears linearly along its thickness t (a stiff pin; a soft one has less
  moment), the other, of t', evenly. From the face inwards V = F (1 - η)(1 - c η) with η = x/t and c = 6 a/t, hence
  M = F (t'/2 + g + t²/(12 a) - t³/(216 a²)) at η = 1/c, and V = -F (c - 1)²/(4 c) at most. (A soft pin bears more shear
  in that eye, but is so thin that its bending decides.) An eye of several walls, such as those of a tube, bears
  q = F/A - F a (x - x0)/I on them, with their length A, its middle x0 and its second moment I about that. (Beside a
  tube, a pin that is not quite stiff has up to 0.7 % more moment.)
* least: the force crosses the gap, where M changes by F g, so that |M| is F g/2 or more, whatever the bearing. Without
  a gap statics leaves nothing but shear. Both eyes bearing linearly alike, t thick without a gap, make 4/27 F t.

An eye of thickness h in the gap of a fork with cheeks t1 thick, or between a pair of plates, is in double shear: each
cheek, or plate, takes F/2.

* largest: all bear evenly along the pin, as on a stiff one. The bending moment is that of F/2 from the middle of a
  cheek to the middle of half the eye, M = F/2 (t1/2 + g + h/4), with g free on either side (Melcon & Hoblit, Product
  Engineering 24, June 1953, 160-170). A moment that the joint carries besides is linear along the walls
  (``alula.fea.beam.pin_between``).
* least: F/2 or more crosses one of the two gaps, where M changes by F g/2, so that |M| is F g/4 or more.

Between layers the couple of each eye is known (``alula.fea.beam.pin_between``), and which eye takes it is open only as
far as where pins stand in their holes is (``alula.fea.pins``).

Moments M about x and y that the joint carries besides (loads out of the plane) add to the largest, and to the shear
what an eye bears of them linearly, 3 M/(2 t); from the least they may take off what the eyes' couple can make in the
gap's middle, F (t + g)/2. Bending stress 32 M/(π d³); largest shear
stress of a solid circle (3 + 2ν)/(2 + 2ν) V/A, in the middle, where nothing bends (Love, Mathematical Theory of
Elasticity, 4th ed., section 230).

A torque that goes through the pin twists it, by 16 T/(π d³) at its surface: the drive's where it enters by
"bore-shear", and the moment of a bonded joint, of which faces that are glued or screwed may take any part. There it
adds to the shear where nothing bends, and at the extreme fibre to the bending by von Mises.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.beam.pin_between import largest_between
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, load_scatter, of_sum, strength_scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import COUPLES, UNKNOWN, Source, SourceKind, distinct
from alula.fea.common.verdict import CheckOutcome
from alula.fea.standing.joint_forces import JointForces
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.eyes import ROUNDING
from alula.geometry.bodies.features import Ring
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import connected_joints, turned_by_drive
from alula.loads.case.eyes import other_link
from alula.loads.case.forks import eye_of, eyes, outer_link
from alula.loads.case.layers import Eye, joints_of_pin, pin_stretches, pins
from alula.loads.records.applied import shifted
from alula.loads.statics.joint_reaction import JointReaction
from alula.loads.text.caveat import Caveat, Topic

Real = NDArray[np.float64]

SOURCES = (Source(kind=SourceKind.EYE_SHARING),)
NO_TORSION = Band.exact(0.0)
TWIST = (Source(kind=SourceKind.TORQUE_TRANSFER, detail=reason("torque_by_pin_or_faces")),)


@dataclass(frozen=True, kw_only=True)
class PinStress:
    """Stresses of a pin.

    Attributes
    ----------
    lever : float
        Distance between the middles of the two eyes [mm].
    moment : Band
        Largest bending moment, by how the eyes take the couple [N mm].
    bending : Band
        Extreme-fibre stress of that moment [MPa].
    shear : float
        Largest shear stress, at the neutral axis, where nothing bends [MPa].
    equivalent : Band
        Von Mises stress [MPa]: the bending at the extreme fibre, or √3 times the shear at the neutral axis.
    torsion : Band
        Shear stress at the surface by a torque through the pin [MPa].
    """

    lever: float
    moment: Band
    bending: Band
    shear: float
    equivalent: Band
    torsion: Band = NO_TORSION


def twist_of(case: Case, joint: str, moment: float, torque: float) -> Band:
    """Return the torque that goes through a joint's pin.

    Parameters
    ----------
    case : Case
    joint : str
    moment : float
        Of the joint about its pin [N mm].
    torque : float
        Of the drive [N mm].

    Returns
    -------
    Band
        [N mm]; of a bonded joint from 0, since nothing states what its faces take.
    """
    most = float(torque_through(case, joint, moment, torque))
    return Band(value=most, low=0.0, high=most, sources=TWIST) if _fixed(case, joint) else Band.exact(most)


def torque_through(case: Case, joint: str, moment: Any, torque: Any) -> Any:
    """Return the largest torque that may go through a joint's pin.

    Parameters
    ----------
    case : Case
    joint : str
    moment : float or ndarray, shape (n,)
        Of the joint about its pin [N mm].
    torque : float or ndarray, shape (n,)
        Of the drive [N mm].

    Returns
    -------
    float or ndarray, shape (n,)
        [N mm]
    """
    if _fixed(case, joint):
        return abs(moment)
    return abs(torque) * (turned_by_drive(case, joint) and case.torque_transfer == "bore-shear")


def _fixed(case: Case, joint: str) -> bool:
    return case.linkage.joints[joint].fixed


def shaft_caveats(case: Case) -> Iterator[Caveat]:
    """Yield the shaft that passes the drive's torque beside the pin, where there is one.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    drive = case.pinned_drive
    if drive is None or case.pose.equilibrium or not turned_by_drive(case, drive.joint):
        return
    judged = drive.joint in connected_joints(case, on_shaft=True)
    if not judged and case.torque_transfer != "bore-shear" and not case.linkage.joints[drive.joint].fixed:
        why = reason("torque_by_flat_faces")
        yield Caveat(topic=Topic.SHAFT, what=reason("drive_shaft", joint=drive.joint), why=why)


def shared_pin_caveats(case: Case, judged: AbstractSet[str]) -> Iterator[Caveat]:
    """Yield the pins of several joints whose links have no order along them: each joint is judged as if by itself.

    Parameters
    ----------
    case : Case
    judged : set of str
        Joints whose pins a check judges.

    Yields
    ------
    Caveat
    """
    for names in pins(case):
        if len(names) > 1 and not judged.isdisjoint(names) and not between_layers(case, names[0]):
            what = reason("bending_of_shared_pin", joints=list(names))
            yield Caveat(topic=Topic.PINS, what=what, why=reason("no_order_along_pin"))


def twisted(case: Case, joint: str, stress: PinStress, twist: Band) -> PinStress:
    """Return the stresses of a joint's pin with a torque that goes through it.

    Parameters
    ----------
    case : Case
    joint : str
    stress : PinStress
        Without it.
    twist : Band
        The torque [N mm].

    Returns
    -------
    PinStress
    """
    if twist.high == 0.0:
        return stress
    torsion = twist.times(16.0 / (math.pi * _pin_of(case, joint)[0] ** 3))

    def both(alone: float, bending: float, sheared: float) -> float:
        by_torque, beside = math.sqrt(3.0) * sheared, min(math.sqrt(3.0) * stress.shear, alone)
        return max(alone, math.hypot(bending, by_torque), beside + by_torque)

    found, bent = stress.equivalent, stress.bending
    equivalent = Band(
        value=both(found.value, bent.value, torsion.value),
        low=both(found.low, bent.low, torsion.low),
        high=both(found.high, bent.high, torsion.high),
        sources=(*found.sources, *twist.sources),
    )
    return replace(stress, equivalent=equivalent, torsion=torsion)


def pin_stress(
    force: float,
    diameter: float,
    eyes: tuple[Ring, Ring],
    gap: float = 0.0,
    *,
    moment: float = 0.0,
    poisson: float = 0.3,
) -> PinStress:
    """Return the stresses of a pin.

    Parameters
    ----------
    force : float
        Of the joint, across the pin [N].
    diameter : float
        [mm]
    eyes : tuple of (Ring, Ring)
        The two eyes' holes, either with its lower rim at the gap.
    gap : float
        Between the eyes [mm].
    moment : float
        About x or y [N mm].
    poisson : float

    Returns
    -------
    PinStress

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    if not diameter > 0.0:
        raise CaseError(f"a pin needs a diameter above zero, not {diameter:g} mm; state its pin_diameter")
    lever = sum(eye.middle - eye.low for eye in eyes) + gap
    most, shear_force = 0.0, force
    for taking, other in (eyes, eyes[::-1]):
        arm, shear, by_couple = _taken(taking, lever)
        most = max(most, force * (other.middle - other.low + gap + arm) + moment)
        shear_force = max(shear_force, force * shear + moment * by_couple)
    least = max(force * gap / 2.0, moment - force * (max(eye.height for eye in eyes) + gap) / 2.0)
    borne = Band(value=most, low=least, high=most, sources=SOURCES)
    return _stressed(lever, borne, (force, shear_force), diameter, poisson)


def fork_pin_stress(
    force: float, diameter: float, fork: Ring, eye: Ring, *, moment: float = 0.0, poisson: float = 0.3
) -> PinStress:
    """Return the stresses of a pin that holds an eye in the middle of a fork's gap.

    Parameters
    ----------
    force : float
        Of the joint, across the pin [N].
    diameter : float
        [mm]
    fork, eye : Ring
        The hole of the fork, with its gap, and that in between.
    moment : float
        About x or y [N mm].
    poisson : float

    Returns
    -------
    PinStress
        Its lever is that of half the force.
    """
    up = fork.middle - eye.middle
    gaps = tuple((low + up, high + up) for low, high in eye.gaps)
    eye = replace(eye, low=eye.low + up, high=eye.high + up, gaps=gaps)
    cheek, (start, end) = fork.thickness / 2.0, fork.gaps[0]
    free = (end - start - eye.height) / 2.0
    wrench = np.array([force, 0.0, 0.0, 0.0, moment, 0.0])
    wrench[4] += force * fork.middle
    most, shear = map(float, largest_between((fork, eye), (0.0, 0.0), (-wrench, wrench)))
    borne = Band(value=most, low=force * free / 4.0, high=most, sources=SOURCES)
    return _stressed(cheek / 2.0 + free + eye.height / 4.0, borne, (force / 2.0, shear), diameter, poisson)


def _stressed(lever: float, moment: Band, shears: tuple[float, float], diameter: float, poisson: float) -> PinStress:
    """Stresses of a pin under a moment and, at the least and at the most, these shear forces."""
    bent, sheared = 32.0 / (math.pi * diameter**3), _shear_stress(1.0, diameter, poisson)
    ends = zip((moment.low, moment.high), shears, strict=True)
    low, high = (max(bending * bent, math.sqrt(3.0) * shear * sheared) for bending, shear in ends)
    return PinStress(
        lever=lever,
        moment=moment,
        bending=moment.times(bent),
        shear=shears[1] * sheared,
        equivalent=replace(moment, value=high, low=low, high=high),
    )


@cache
def _taken(eye: Ring, lever: float) -> tuple[float, float, float]:
    """Return the moment that a pin gains at the most in an eye that takes the couple of a unit force, and its shear.

    The force enters at the eye's lower rim with the moment of its lever [mm] less the eye's middle, which is left out.
    The third is the shear by a unit couple alone [1/mm], which the eye bears linearly.
    """
    slope = lever / eye.second
    pressure = Polynomial([1.0 / eye.thickness + slope * eye.middle, -slope])
    couple = Polynomial([-eye.middle, 1.0]) / eye.second
    shear, moment, before = 1.0, 0.0, eye.low
    shears, moments, by_couple, coupled = [shear], [moment], 0.0, [0.0]
    for low, high in eye.walls:
        moment += shear * (low - before)
        left = shear - pressure.integ(lbnd=low)
        gained = moment + left.integ(lbnd=low)
        places = [low, high, *left.roots().real, *pressure.roots().real]
        places = [z for z in places if low <= z <= high]
        shears += [float(abs(left(z))) for z in places]
        moments += [float(gained(z)) for z in places]
        beyond = by_couple - couple.integ(lbnd=low)
        coupled += [float(abs(beyond(z))) for z in (low, min(max(eye.middle, low), high), high)]
        shear, moment, before, by_couple = float(left(high)), float(gained(high)), high, float(beyond(high))
    return max(moments), max(shears), max(coupled)


def stress_at(case: Case, joint: str, reactions: Mapping[str, JointReaction]) -> PinStress:
    """Return the stresses of a joint's pin.

    Parameters
    ----------
    case : Case
    joint : str
    reactions : mapping of str to JointReaction
        Of all joints, in one state.

    Returns
    -------
    PinStress

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    own = joints_of_pin(case, joint)
    (found,) = stresses(case, joint, {name: reactions[name].wrench[None] for name in own})
    return found


def stresses(case: Case, joint: str, wrenches: Mapping[str, Real]) -> list[PinStress]:
    """Return the stresses of a joint's pin in n states.

    Parameters
    ----------
    case : Case
    joint : str
    wrenches : mapping of str to ndarray, shape (n, 6)
        Of all joints that are on the pin, on their second links [N, N mm].

    Returns
    -------
    list of PinStress

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    if between_layers(case, joint):
        return stresses_between(case, joint, wrenches)
    force, moment = (np.linalg.norm(wrenches[joint][:, part], axis=1) for part in (slice(2), slice(3, 5)))
    return [stress_of(case, joint, *map(float, of)) for of in zip(force, moment, strict=True)]


def between_layers(case: Case, joint: str) -> bool:
    """Return whether the eyes on a joint's pin, of all joints that it is of, lie at different heights.

    Parameters
    ----------
    case : Case
    joint : str

    Returns
    -------
    bool
    """
    return any(case.linkage.rise(name) != 0.0 for name in joints_of_pin(case, joint))


def on_links(case: Case, joint: str, wrench: Real) -> dict[str, Real]:
    """Return what a joint's pin does to each of its links.

    Parameters
    ----------
    case : Case
    joint : str
    wrench : ndarray, shape (..., 6)
        What the first link does to the second, about the point of the second [N, N mm].

    Returns
    -------
    dict of str to ndarray
        Link -> wrench (..., 6) about its own point.
    """
    first, second = case.joints[joint].links
    return {first: shifted(-wrench, np.array([0.0, 0.0, case.linkage.rise(joint)])), second: wrench}


def in_eyes(case: Case, joint: str, wrenches: Mapping[str, Real]) -> dict[Eye, Real]:
    """Return what a joint's pin does to all eyes in which it stands, of all joints that it is of.

    Parameters
    ----------
    case : Case
    joint : str
    wrenches : mapping of str to ndarray, shape (..., 6)
        Of all joints that are on the pin, on their second links [N, N mm].

    Returns
    -------
    dict of tuple of str to ndarray
        Link and point -> wrench (..., 6) about that point; of a slot that of its own pin.
    """
    found: dict[Eye, Real] = {}
    for name in joints_of_pin(case, joint):
        for link, wrench in on_links(case, name, wrenches[name]).items():
            eye = link, case.linkage.point_of(name, link)
            found[eye] = found.get(eye, 0.0) + wrench
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class _EyesOnPin:
    """The eyes of all links on a pin, with what presses in them in n states.

    Attributes
    ----------
    rings : tuple of Ring
    levels : tuple of float
        Heights of the links' mid-planes [mm].
    wrenches : tuple of ndarray, shape (n, 6)
        What the pin does to each link, about its point [N, N mm].
    within : tuple of 2 float
        Heights between which the eyes lie that one joint's pin runs between [mm].
    lever : float
        How far apart the mid-planes of these two links lie [mm].
    """

    rings: tuple[Ring, ...]
    levels: tuple[float, ...]
    wrenches: tuple[Real, ...]
    within: tuple[float, float]
    lever: float

    @classmethod
    def of(cls, case: Case, joint: str, wrenches: Mapping[str, Real]) -> "_EyesOnPin":
        linkage, rings = case.linkage, dict[Eye, Ring]()
        for name in joints_of_pin(case, joint):
            for link, ring in zip(case.joints[name].links, eyes(case, name), strict=True):
                eye = link, linkage.point_of(name, link)
                if eye not in rings or ring.height < rings[eye].height:  # without a part: like the shortest there
                    rings[eye] = ring
        borne = in_eyes(case, joint, wrenches)
        levels = {eye: linkage.heights.get(eye[0], 0.0) for eye in rings}
        ends = pin_stretches(case)[joint]
        rims = [levels[eye] + rim for eye in ends for rim in (rings[eye].low, rings[eye].high)]
        return cls(
            rings=tuple(rings.values()),
            levels=tuple(levels.values()),
            wrenches=tuple(borne[eye] for eye in rings),
            within=(min(rims), max(rims)),
            lever=abs(levels[ends[1]] - levels[ends[0]]),
        )


def stresses_between(case: Case, joint: str, wrenches: Mapping[str, Real]) -> list[PinStress]:
    """Return the stresses of a pin between layers.

    Parameters
    ----------
    case : Case
    joint : str
        Where several are on one pin, it is that part of it that runs from the link before on to this joint's.
    wrenches : mapping of str to ndarray, shape (n, 6)
        Of all joints that are on the pin, on their second links [N, N mm].

    Returns
    -------
    list of PinStress
        In each state.

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    diameter, poisson = _pin_of(case, joint)
    on = _EyesOnPin.of(case, joint, wrenches)
    return [
        _stressed(on.lever, Band.exact(float(moment)), (float(shear), float(shear)), diameter, poisson)
        for moment, shear in zip(*largest_between(on.rings, on.levels, on.wrenches, on.within), strict=True)
    ]


def shared_stress(case: Case, joint: str, reactions: Mapping[str, JointReaction], forces: JointForces) -> PinStress:
    """Return the stresses of a joint's pin, with all ways in which pins may share the couples between layers.

    Parameters
    ----------
    case : Case
    joint : str
    reactions : mapping of str to JointReaction
        Of all joints, on the shape that counts.
    forces : JointForces
        In the undeformed pose, where the shares are known; they scale what ``reactions`` give.

    Returns
    -------
    PinStress
        Without layers, that of ``stress_at``.

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    found = stress_at(case, joint, reactions)
    if not forces.sharings:
        return found
    every = [one.joints for one in (forces.reactions, *forces.sharings)]
    names = joints_of_pin(case, joint)
    plain, *others = stresses(case, joint, {name: np.array([one[name].wrench for one in every]) for name in names})

    def widened(name: str, least: float = 0.0) -> Band:
        own, known = getattr(found, name), [getattr(one, name) for one in (plain, *others)]
        value, first = own.value, known[0].value

        def ends_of(lows: list[float], highs: list[float]) -> tuple[float, float]:
            # Shares first: the least is then 1 at most, and the largest 1 at least, in spite of rounding.
            low, high = (
                [value, *(value * (size / first) if first > 0.0 else size for size in each)] for each in (lows, highs)
            )
            return max(sought(low)[0], min(least, value)), sought(high)[1]

        low, high = ends_of([one.value for one in known], [one.value for one in known])
        width, ends = high / low if low > 0.0 else math.inf, (low / value, high / value) if value > 0.0 else UNKNOWN
        low, high = ends_of([one.low for one in known], [one.high for one in known])
        sources = distinct(own.sources, (replace(COUPLES[0], width=width, ends=ends),))
        return Band(value=value, low=low, high=high, sources=sources)

    _, most = sought([one.shear / (plain.shear or math.inf) for one in (plain, *others)])
    shear = found.shear * most
    equivalent = widened("equivalent", crossing(case, joint, [reactions, *every[1:]]))
    return replace(found, moment=widened("moment"), bending=widened("bending"), shear=shear, equivalent=equivalent)


def crossing(case: Case, joint: str, states: Sequence[Mapping[str, JointReaction]]) -> float:
    """Return the least stress of a pin between layers: that of its force in shear, which crosses between the eyes.

    Between two eyes that lie side by side all crosses that the eyes on one side bear. Else, as of a bar between the
    plates of a pair, the parts of a force cross at several places, at one of them an equal part or more.

    Parameters
    ----------
    case : Case
    joint : str
    states : sequence of mapping of str to JointReaction
        Of all joints, in all states of the pins.

    Returns
    -------
    float
        Von Mises stress at the neutral axis [MPa], however the pin stands in its holes; 0 where eyes lie in each other.

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    diameter, poisson = _pin_of(case, joint)
    names = joints_of_pin(case, joint)
    on = _EyesOnPin.of(case, joint, {name: np.array([one[name].wrench for one in states]) for name in names})
    numbered = enumerate(zip(on.rings, on.levels, strict=True))
    walls = sorted((level + low, level + high, k) for k, (ring, level) in numbered for low, high in ring.walls)
    if any(one[1] > other[0] + ROUNDING * on.rings[0].height for one, other in pairwise(walls)):
        return 0.0
    between, forces = [one for one in pairwise(walls) if one[0][2] != one[1][2]], [0.0]
    for one, other in between:
        below = {k for _, high, k in walls if high <= one[1]}
        if below.isdisjoint(k for low, _, k in walls if low >= other[0]):
            if on.within[0] <= one[1] and other[0] <= on.within[1]:
                sums = np.sum([on.wrenches[k][:, :2] for k in below], axis=0)
                forces.append(float(np.linalg.norm(sums, axis=1).min()))
        elif len(on.rings) == 2:
            forces.append(float(np.linalg.norm(on.wrenches[0][:, :2], axis=1).min()) / len(between))
    return math.sqrt(3.0) * _shear_stress(max(forces), diameter, poisson)


def pin_growth(
    case: Case, joint: str, reactions: Mapping[str, JointReaction], growth: Callable[[str], Scatter]
) -> Scatter:
    """Return by which the stress of a joint's pin grows beside scattered loads.

    Parameters
    ----------
    case : Case
    joint : str
    reactions : mapping of str to JointReaction
        Of all joints.
    growth : callable
        Of a joint, to how its force grows.

    Returns
    -------
    Scatter
        Where several joints are on one pin, of the sum of what each makes of it.
    """
    names = joints_of_pin(case, joint)
    if len(names) == 1 or not between_layers(case, joint):
        return growth(joint)
    wrenches = {name: reactions[name].wrench for name in names}
    alone = [{name: wrenches[name] * (name in own) for name in names} for own in (names, *((one,) for one in names))]
    whole, *parts = stresses_between(case, joint, {name: np.array([one[name] for one in alone]) for name in names})
    if not whole.equivalent.value > 0.0:
        return growth(joint)
    sizes = (one.equivalent.value for one in parts)
    return of_sum(zip(sizes, map(growth, names), strict=True), whole.equivalent.value)


def with_torque(
    joint: str, stress: PinStress, growth: Scatter, through: Callable[[str, Callable[[Case, Any, Any], Any]], Scatter]
) -> Scatter:
    """Return by which the stress of a joint's pin grows where a torque may go through it.

    Parameters
    ----------
    joint : str
    stress : PinStress
    growth : Scatter
        With what its eyes bear.
    through : callable
        Of a joint and of what goes through it, by case, wrench and torque of the drive, to how that grows.

    Returns
    -------
    Scatter
        Stress is no more than in proportion to the larger of both.
    """
    if not stress.torsion.high > 0.0:
        return growth

    def torque(case: Case, wrench: Any, driving: Any) -> Any:
        return torque_through(case, joint, wrench[..., 5], driving)

    return growth.either(through(joint, torque))


def stress_of(case: Case, joint: str, force: float, moment: float = 0.0) -> PinStress:
    """Return the stresses of a joint's pin.

    Parameters
    ----------
    case : Case
    joint : str
    force : float
        Across the pin [N].
    moment : float
        About x or y [N mm].

    Returns
    -------
    PinStress

    Raises
    ------
    CaseError
        For a pin without diameter.
    """
    diameter, poisson = _pin_of(case, joint)
    gap, fork = case.joints[joint].pin_gap, outer_link(case, joint)
    if fork is not None:
        outer, mate = eye_of(case, joint, fork), other_link(case.linkage, joint, fork)
        if case.links[mate].part is not None:
            inner = eye_of(case, joint, mate)
        else:
            (low, high), *_ = outer.gaps
            half = min((high - low) / 2.0 - gap, (case.links[mate].thickness or math.inf) / 2.0)
            inner = Ring(diameter=0.0, low=outer.middle - half, high=outer.middle + half)
        return fork_pin_stress(force, diameter, outer, inner, moment=moment, poisson=poisson)
    return pin_stress(force, diameter, eyes(case, joint), gap, moment=moment, poisson=poisson)


def _pin_of(case: Case, joint: str) -> tuple[float, float]:
    """Return the diameter of a joint's pin and Poisson's ratio of its material."""
    record = case.joints[joint]
    if record.pin_diameter is None:
        raise CaseError(f'joints.{joint}.pin_diameter: the check of its pin needs it; state it, for example "1.5 mm"')
    return record.pin_diameter, case.all_materials[record.pin_material].poissons_ratio


def _shear_stress(force: float, diameter: float, poisson: float) -> float:
    """Return the largest shear stress of a solid circle (Love, section 230)."""
    return force * (3.0 + 2.0 * poisson) / (2.0 + 2.0 * poisson) * 4.0 / (math.pi * diameter**2)


def pin_outcome(
    case: Case, load_case: str, one: Asked, stress: PinStress, growth: Scatter | None = None
) -> CheckOutcome:
    """Return the outcome of a joint's pin.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of the pin.
    stress : PinStress
        Of it.
    growth : Scatter, optional
        By which the joint's force grows beside scattered loads (``alula.fea.doubts.load_growth``).

    Returns
    -------
    CheckOutcome
    """
    material = case.pin_material(one.subject.name)
    equivalent = load_scatter(case, load_case).times(growth or Scatter()).on(stress.equivalent)
    return one.outcome(load_case, strength_scatter(material).on(equivalent.inverse(material.allowable)))
