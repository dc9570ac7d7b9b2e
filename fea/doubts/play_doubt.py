"""What play makes of the numbers of a check: links through changed forces, and how much load the linkage holds."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.link_loads import LinkLoads, Plates
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind, play_source
from alula.fea.doubts.load_growth import LEAST, Growths, telling
from alula.fea.links.link_by_hand import HandStates, acting_on, on_plates
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine
from alula.fea.outcomes.unloaded import without_rounding
from alula.fea.standing.joint_forces import JointForces, joint_forces
from alula.fea.superposition.link_answers import LinkAnswers, Rule, on_band
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.case import Case
from alula.loads.records.applied import Load, load_size
from alula.loads.states.play import Displaced, Play, Span

Real = NDArray[np.float64]

IN_PLANE = np.array([True, True, False, False, False, True])
"""Components of a wrench that equilibrium in the plane gives."""


def play_doubt(
    case: Case, load_case: str, forces: JointForces, loads: Sequence[Load], links: Sequence[str] | None = None
) -> Growths:
    """Return by how much stress, displacement and columns of links, and joint forces, may differ by play, by hand.

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
    kinds: tuple[dict[str, Scatter], ...] = ({}, {}, {})
    for link in links:
        told = _play_on_link(case, load_case, link, forces, loads)
        kinds[0][link] = on_band(told.rules[0], *told.peaks.tolist())
        for kind, rule, numbers in zip(kinds[1:], told.rules[1:], told.by_hand.tolist(), strict=True):
            kind[link] = rule(numbers[0], numbers[1:])
    stress, displacement, columns = map(telling, kinds)
    return Growths(stress=stress, displacement=displacement, joints=telling(joints), columns=columns)


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


def play_answers(case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]) -> LinkAnswers:
    """Return what acts on a link as pins stand otherwise in their holes.

    Every joint with play stands at its ends in x and in y, then all joints stand where the link's stress, displacement
    and buckling factor by hand are largest and least. The sizes of what the single joints make add up; what all make
    together counts as well.

    Parameters
    ----------
    case, load_case, forces, loads
        As of ``play_doubt``; with play.
    link : str

    Returns
    -------
    LinkAnswers
    """
    told = _play_on_link(case, load_case, link, forces, loads)
    stated, *others = told.answers
    return LinkAnswers(stated=stated, others=tuple(others), stress=told.rules[0], displacement=told.rules[1])


@dataclass(frozen=True, kw_only=True, eq=False)
class _OnLink:
    """What play makes of a link: answers, as stated first, their numbers by hand, and the rule of each number.

    Numbers are both ends of the stress (2, n), and displacement and inverse of the buckling factor (2, n).
    """

    answers: Sequence[Plates]
    peaks: Real
    by_hand: Real
    rules: tuple[Rule, Rule, Rule]


def _play_on_link(case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]) -> _OnLink:
    play = forces.play
    assert play is not None
    source = play_source(play.clearances)
    acting, size = acting_on(case, load_case, link, forces.reactions, loads), load_size(loads, case.linkage.longest)
    if play.through_dead_point:
        lost = Scatter(low=0.0, high=np.inf, sources=(source,))
        without = [on_plates(case, link, acting)]
        nothing = np.zeros((2, 1))
        return _OnLink(answers=without, peaks=nothing, by_hand=nothing, rules=(lambda *_: lost,) * 3)
    each = [way for way in play.loose.ways for _ in range(2)]
    ends = [way for way, sound in zip(each, play.ends.sound[1:], strict=True) if sound]
    answers = _answers(case, acting, play.ends, size)
    numbers = _numbers(case, link, answers)
    worst = list[Mapping[str, Real]]()
    for plain, *tried in numbers.tolist():
        slopes = {name: np.zeros(2) for name in play.loose.radii}
        for (name, i), one in reversed(list(zip(ends, tried, strict=True))):  # that at the end in x or y rules
            slopes[name][i] = one - plain
        if 2.0 * sum(float(np.linalg.norm(slope)) for slope in slopes.values()) > LEAST * plain:
            worst += [slopes, {name: -slope for name, slope in slopes.items()}]
    if worst:
        furthest = {name: np.array([slopes[name] for slopes in worst]) for name in play.loose.radii}
        others = _answers(case, acting, play.solved(play.loose.at_rims(furthest)), size)
        answers = [*answers, *others]
        numbers = np.hstack([numbers, _numbers(case, link, others)]) if others else numbers
    held = [_scatter(play.forces[name], source) for name in case.linkage.joints_of(link)] if case.layered else []

    def alone(value: float, found: Sequence[float]) -> Scatter:
        if not value > 0.0:
            return Scatter.from_zero(found, (source,))
        steps = {name: np.zeros(2) for name in play.loose.radii}
        for (name, i), one in zip(ends, found, strict=False):
            steps[name][i] = max(steps[name][i], abs(one - value))
        slack = sum(float(np.linalg.norm(step)) for step in steps.values())
        low, high = min(value - slack, *found, value), max(value + slack, *found, value)
        return _scatter(Span(value=value, low=max(low, 0.0), high=high), source)

    def with_couples(value: float, found: Sequence[float]) -> Scatter:
        """Couples between layers go with the forces of the link's pins."""
        one = alone(value, found)
        if not held or not value > 0.0:
            return one
        low, high = min(one.low, *(pin.low for pin in held)), max(one.high, *(pin.high for pin in held))
        return Scatter(low=max(low, 0.0), high=high, sources=(source,))

    def as_column(value: float, found: Sequence[float]) -> Scatter:
        """What play makes of a link that nothing presses as stated is left out."""
        return alone(value, found) if value > 0.0 else Scatter()

    rules = (with_couples, with_couples, as_column)
    return _OnLink(answers=answers, peaks=numbers[:2], by_hand=numbers[2:], rules=rules)


def _numbers(case: Case, link: str, answers: Sequence[Plates]) -> Real:
    """Both ends of the stress by hand, displacement and inverse of the buckling factor (4, n)."""
    hand = HandStates(case, link, answers)
    return np.vstack([hand.peaks, hand.displacement, hand.inverse_buckling])


def _answers(case: Case, plain: LinkLoads, here: Displaced, size: float) -> list[Plates]:
    """What acts on a link with its joints at offsets, in each of n states that are sound; ``size`` is of all loads.

    Components out of the plane are those of the link ``plain``, in its own axes, since play changes none of them.
    """
    if not np.any(here.sound):
        return []
    here = here.chosen(here.sound)
    found = link_loads(plain.name, plain.link, case.body(plain.link), here, here.loads)
    wrenches = [np.where(IN_PLANE, new, old) for (_, new), (_, old) in zip(found.wrenches, plain.wrenches, strict=True)]
    states, longest = found.with_wrenches(wrenches), case.linkage.longest
    every = (without_rounding(states.chosen(i), size, longest) for i in range(len(here.sound)))
    return [on_plates(case, plain.link, one) for one in every]


def _scatter(span: Span, source: Source) -> Scatter:
    if not span.value > 0.0:
        return Scatter()
    return Scatter(low=span.low / span.value, high=span.high / span.value, sources=(source,))


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
