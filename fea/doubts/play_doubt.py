"""What play makes of the numbers of a check: links through changed forces, and how much load the linkage holds."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind, play_source
from alula.fea.doubts.force_doubt import borne, measures, measures_and_column
from alula.fea.doubts.load_growth import LEAST, Growths
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine
from alula.fea.standing.joint_forces import JointForces, joint_forces
from alula.fea.superposition.link_answers import LinkAnswers
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.bodies.body import Body
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.states.play import Displaced, Play, Span
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]

OUT_OF_PLANE = [2, 3, 4]
"""Components of a wrench that equilibrium in the plane does not give."""
COLUMN = 2
"""Number of the buckling factor's inverse among what hand calculation tells of a link."""


def play_doubt(
    case: Case, load_case: str, forces: JointForces, loads: Sequence[Load], links: Sequence[str] | None = None
) -> Growths:
    """Return by how much stress, displacement of links and joint forces may differ by the play of pins.

    A link's stress by hand is calculated with every joint with play at its end in x and in y. The sizes of these
    slopes add up; it is calculated once more at the worst combination either way, and the outer of both counts. So are
    its displacement and the inverse of its buckling factor.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    loads : sequence of Load
        That act on the links without play.
    links : sequence of str, optional
        Which ones; by default all that have a part.

    Returns
    -------
    Growths
        Empty without play.
    """
    play = forces.play
    if play is None:
        return Growths()
    links, source = case.checked_links if links is None else links, play_source(play.clearances)
    joints = {name: _scatter(span, source) for name, span in play.forces.items()}
    if play.through_dead_point or play.nominal is None:
        lost = dict.fromkeys(links, Scatter(low=0.0, high=np.inf, sources=(source,)))
        return Growths(stress=lost, displacement=lost, joints=joints, columns=lost)
    ends = {name: _ends(play, forces, name) for name in play.loose.radii}
    nominal = _reactions(play, forces, play.nominal), play.nominal
    stress: dict[str, Scatter] = {}
    displacement: dict[str, Scatter] = {}
    columns: dict[str, Scatter] = {}
    for link in links:
        body = case.body(link)
        acting = link_loads(load_case, link, body, forces.reactions, loads)
        told = partial(_told, case, load_case, link, body, acting)
        plain = told(*nominal)
        tried = {name: [told(*end) for end in each] for name, each in ends.items()}
        for i, found in enumerate((stress, displacement, columns)):
            slopes = {name: np.array([end[i] - plain[i] for end in each]) for name, each in tried.items()}
            for name, slope in slopes.items() if i == COLUMN else ():
                # Where nothing presses the link any more, the other end tells how compression changes.
                idle = [k for k, end in enumerate(tried[name]) if end[COLUMN] == 0.0 < plain[COLUMN]]
                others = _ends(play, forces, name, -1.0) if idle else []
                slope[idle] = [plain[COLUMN] - told(*others[k])[COLUMN] for k in idle if k < len(others)]
            slack = sum(float(np.linalg.norm(slope)) for slope in slopes.values())
            telling = 2.0 * slack > LEAST * plain[i]
            worst = [told(*end)[i] for end in _worst(play, forces, slopes)] if telling else []
            low, high = min(plain[i] - slack, *worst, plain[i]), max(plain[i] + slack, *worst, plain[i])
            found[link] = _scatter(Span(value=plain[i], low=max(low, 0.0), high=high), source)
            if case.layered and i != COLUMN:  # couples between layers go with the forces of the link's pins
                held = [joints[name] for name in case.linkage.joints_of(link)]
                least, most = min(one.low for one in held), max(one.high for one in held)
                found[link] = replace(found[link], low=min(found[link].low, least), high=max(found[link].high, most))
    return Growths(stress=_open(stress), displacement=_open(displacement), joints=_open(joints), columns=_open(columns))


def play_at_joint(play: Play | None, joint: str, *, driven: bool) -> Scatter:
    """Return what play makes of all that goes through a joint: of its force and, where that drives, of the torque.

    Parameters
    ----------
    play : Play or None
    joint : str
    driven : bool
        Whether the drive's torque goes through it.

    Returns
    -------
    Scatter
    """
    if play is None:
        return Scatter()
    source = play_source(play.clearances)
    force = _scatter(play.forces[joint], source)
    if not driven:
        return force
    effort = play.effort
    low, high = sorted((abs(effort.low), abs(effort.high)))
    least = 0.0 if effort.low <= 0.0 <= effort.high else low
    return force.either(_scatter(Span(value=abs(effort.value), low=least, high=high), source))


def play_answers(
    case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]
) -> LinkAnswers | None:
    """Return what acts on a link as pins stand otherwise in their holes.

    Every joint with play stands at its ends in x and in y, then all joints stand where the link's stress and its
    displacement by hand are largest and least. The sizes of what the single joints make add up; what all make together
    counts as well.

    Parameters
    ----------
    case, load_case, forces, loads
        As of ``play_doubt``.
    link : str

    Returns
    -------
    LinkAnswers or None
        None without play.
    """
    play, body = forces.play, case.body(link)
    if play is None:
        return None
    source, acting = play_source(play.clearances), link_loads(load_case, link, body, forces.reactions, loads)
    if play.through_dead_point or play.nominal is None:

        def endless(_value: float, _others: Sequence[float]) -> Scatter:
            return Scatter(low=0.0, high=np.inf, sources=(source,))

        return LinkAnswers(stated=borne(case, link, acting), others=(), stress=endless, displacement=endless)
    at = partial(_at, load_case, link, body, acting)
    stated = at(_reactions(play, forces, play.nominal), play.nominal)
    others, places = list[LinkLoads](), list[tuple[str, int]]()
    for name in play.loose.radii:
        for i, share in enumerate(np.eye(2)[: len(play.loose.directions(name))]):
            for sign in (1.0, -1.0):
                here = play.at(play.loose.offsets({name: sign * share}))
                if here is not None:
                    others.append(at(_reactions(play, forces, here), here))
                    places.append((name, i))
    plain, *tried = (measures(case, link, one) for one in (stated, *others))
    for k in (0, 1):
        slopes = {name: np.zeros(2) for name in play.loose.radii}
        for (name, i), one in reversed(list(zip(places, tried, strict=True))):  # that at the end in x or y rules
            slopes[name][i] = one[k] - plain[k]
        others += [at(*end) for end in _worst(play, forces, slopes)]
    held = [_scatter(play.forces[name], source) for name in case.linkage.joints_of(link)] if case.layered else []

    def rule(value: float, found: Sequence[float]) -> Scatter:
        if not value > 0.0:
            return Scatter()
        steps = {name: np.zeros(2) for name in play.loose.radii}
        for (name, i), one in zip(places, found, strict=False):
            steps[name][i] = max(steps[name][i], abs(one - value))
        slack = sum(float(np.linalg.norm(step)) for step in steps.values())
        low, high = (end / value for end in (min(value - slack, *found), max(value + slack, *found)))
        # Couples between layers go with the forces of the link's pins.
        return Scatter(
            low=max(min(low, *(one.low for one in held)), 0.0) if held else max(low, 0.0),
            high=max(high, *(one.high for one in held)) if held else high,
            sources=(source,),
        )

    return LinkAnswers(
        stated=borne(case, link, stated),
        others=tuple(borne(case, link, one) for one in others),
        stress=rule,
        displacement=rule,
    )


def _told(
    case: Case, load_case: str, link: str, body: Body, plain: LinkLoads, here: Reactions, at: Displaced
) -> tuple[float, float, float]:
    """Stress, displacement and inverse of the buckling factor of a link by hand, with its joints at offsets."""
    return measures_and_column(case, link, _at(load_case, link, body, plain, here, at))


def _at(load_case: str, link: str, body: Body, plain: LinkLoads, here: Reactions, at: Displaced) -> LinkLoads:
    """What acts on a link with its joints at offsets.

    Components out of the plane are those of the link ``plain``, in its own axes, since play changes none of them.
    """
    found = link_loads(load_case, link, body, here, at.loads)
    pins = [
        replace(pin, wrench=_across(pin.wrench, was.wrench)) for pin, was in zip(found.pins, plain.pins, strict=True)
    ]
    ends = [
        replace(end, wrench=_across(end.wrench, was.wrench)) for end, was in zip(found.ends, plain.ends, strict=True)
    ]
    return replace(found, pins=tuple(pins), ends=tuple(ends))


def _across(wrench: Real, plain: Real) -> Real:
    found = wrench.copy()
    found[OUT_OF_PLANE] = plain[OUT_OF_PLANE]
    return found


def _ends(play: Play, forces: JointForces, name: str, sign: float = 1.0) -> list[tuple[Reactions, Displaced]]:
    """Forces with a joint at the end of its play, in each of its directions, or against it."""
    shares = sign * np.eye(2)[: len(play.loose.directions(name))]
    ends = [play.at(play.loose.offsets({name: share})) for share in shares]
    return [(_reactions(play, forces, end), end) for end in ends if end is not None]


def _worst(play: Play, forces: JointForces, slopes: Mapping[str, Real]) -> Iterator[tuple[Reactions, Displaced]]:
    """Forces where a number is largest and least, from what each joint makes of it in x and in y."""
    for sign in (1.0, -1.0):
        shares = {name: sign * slope / (float(np.linalg.norm(slope)) or 1.0) for name, slope in slopes.items()}
        here = play.at(play.loose.offsets(shares))
        if here is not None:
            yield _reactions(play, forces, here), here


def _reactions(play: Play, forces: JointForces, here: Displaced) -> Reactions:
    """Return the joint reactions at offsets, in the plane."""
    plain = forces.reactions
    effort = DriveEffort.TORQUE if plain.drive is None else plain.drive.effort(play.case.linkage)
    return replace(
        plain,
        pose=play.pose(here, plain.pose),
        joints=here.joints,
        **effort.alone(float(here.effort), 0.0),
    )


def _scatter(span: Span, source: Source) -> Scatter:
    if not span.value > 0.0:
        return Scatter()
    return Scatter(low=span.low / span.value, high=span.high / span.value, sources=(source,))


def _open(found: Mapping[str, Scatter]) -> dict[str, Scatter]:
    return {name: one for name, one in found.items() if one.high - one.low > LEAST}


def shaken(case: Case, load_case: str, forces: JointForces, moved: LargeDisplacement) -> LargeDisplacement:
    """Return what became of a load case, with what does where play brings it nearest to a dead point and furthest off.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
        Without play.
    moved : LargeDisplacement
        Without play.

    Returns
    -------
    LargeDisplacement
        The same where no joint has play.
    """
    play = forces.play
    if play is None:
        return moved
    found = []
    for here in () if moved.state in ("off", "unknown") else (play.nearest, play.furthest):
        if here is not None:
            pose = play.pose(here, forces.reactions.pose)
            with suppress(CaseError, CannotRunError):
                there = joint_forces(case, pose, here.loads, like=forces.pins)
                found.append(examine(case, load_case, there, here.loads))
    source, passes = play_source(play.clearances), play.through_dead_point
    cause = Alternatives(source=source, others=tuple(found), endless=passes)
    return replace(moved, causes=(*moved.causes, cause))


def play_warnings(
    moved: Mapping[str, LargeDisplacement],
    forces: Mapping[str, JointForces],
) -> list[Reason]:
    """Return what the reader must know about play.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> from ``shaken``.
    forces : mapping of str to JointForces

    Returns
    -------
    list of Reason
    """
    found = []
    for load_case, one in forces.items():
        play = one.play
        if play is None:
            continue
        if play.through_dead_point:
            driven = None if play.drive is None else play.drive.link
            found.append(under_load_cases([load_case], reason("through_dead_point_by_play", driven=driven)))
        elif play.settled is None:
            found.append(under_load_cases([load_case], reason("rests_nowhere_with_play")))
        loose = moved[load_case].by(SourceKind.PLAY)
        others = () if loose is None or moved[load_case].gives_way else loose.others
        worse = [other for other in others if other.gives_way]
        if worse:
            found.append(under_load_cases([load_case], reason("nearest_to_dead_point", why=worse[0].reason)))
    return found
