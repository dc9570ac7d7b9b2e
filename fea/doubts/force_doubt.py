"""What doubt about the links' stiffness, and about their pins, makes of joint forces and of the stress that follows.

Each cause changes a joint force, and a link's stress by hand calculation, by some share of it. To first order the
shares of stiffnesses add up, each upwards or downwards; all causes are taken at their worst together. How pins share
the couples between layers is one cause, with several answers: the least and the greatest of them count. A link in
compression on pins that tilt bends out of the plane from the first newton, by the couples of its layers, and more than
in the frame, whose pins keep its angles: the answers of sharing hold that growth (``alula.fea.links.second_order``).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, Plates
from alula.fea.common.scatter import Scatter, load_over_modulus
from alula.fea.common.source import COUPLES, Source
from alula.fea.doubts.load_growth import NOTHING, Growths, telling
from alula.fea.links.link_by_hand import HandStates, acting_on, on_plates
from alula.fea.links.second_order import on_tilting_pins
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.nonlinear.rim_growth import rim_growth
from alula.fea.standing.joint_forces import JointForces
from alula.fea.superposition.link_answers import LinkAnswers, Rule, on_band, widest
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.statics.statics import Reactions

ForceRule = Callable[[NDArray[np.float64], NDArray[np.float64]], Scatter]
"""From a joint's force as stated, and in n other answers (n, ...), to the factors on its size."""
FLAT = 1e-4
"""Extent of points in a direction, over their largest, below which they have none."""
MOST_DIRECTIONS = 6
"""Beyond so many nearly all points are corners of their convex hull, and finding it takes long."""


def stiffness_doubt(case: Case, load_case: str, forces: JointForces, loads: Sequence[Load]) -> Growths:
    """Return by how much stress, displacement and joint forces may differ since the links' stiffness is in doubt.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    loads : sequence of Load
        That act on the links.

    Returns
    -------
    Growths
        Empty where no link's stiffness is in doubt since none is a solid.
    """
    if not forces.open_by:
        return Growths()
    answers = {link: stiffness_answers(case, load_case, link, forces, loads) for link in case.checked_links}
    changed = [one.reactions for one in forces.open_by]
    return growths_by_hand(case, forces.on_tight_pins, changed, _steps(forces.sources), answers)


def stiffness_answers(case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]) -> LinkAnswers:
    """Return what acts on a link as each link by itself is softer or stiffer, where joint forces depend on it.

    Parameters
    ----------
    case, load_case, forces, loads
        As of ``stiffness_doubt``.
    link : str

    Returns
    -------
    LinkAnswers
    """
    rule = _summed(forces.sources)
    stated, *others = (
        on_plates(case, link, acting_on(case, load_case, link, reactions, loads))
        for reactions in (forces.on_tight_pins, *(one.reactions for one in forces.open_by))
    )
    return LinkAnswers(stated=stated, others=tuple(others), stress=rule, displacement=rule)


def sharing_doubt(
    case: Case,
    load_case: str,
    forces: JointForces,
    loads: Sequence[Load],
    *,
    grown: bool = False,
    links: Sequence[str] | None = None,
) -> Growths:
    """Return by how much stress, displacement and joint forces may differ since pins may tilt, by hand.

    Parameters
    ----------
    case, load_case, forces, loads
        As of ``stiffness_doubt``.
    grown : bool, optional
        As of ``sharing_answers``.
    links : sequence of str or None, optional
        Links that are looked at; None for every one.

    Returns
    -------
    Growths
        Empty where nothing is shared.
    """
    if not forces.sharings:
        return Growths()
    links = case.checked_links if links is None else links
    answers = {link: sharing_answers(case, load_case, link, forces, loads, grown=grown) for link in links}
    return growths_by_hand(case, forces.reactions, forces.sharings, of_sizes(widest(COUPLES)), answers)


def sharing_answers(
    case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load], *, grown: bool = False
) -> LinkAnswers:
    """Return what acts on a link, or on each plate of a pair, with tight pins and in the ways of sharing that count.

    In the plane all ways have the same forces, and stress is a convex function of what acts across it: it is largest at
    a corner of the hull of all ways. These count, and the one in which its plain sections bear least.

    Parameters
    ----------
    case, load_case, link, forces, loads
        As of ``stiffness_doubt``; the link is one of the case's.
    grown : bool, optional
        True where what acts with tight pins holds the growth on free pins already.

    Returns
    -------
    LinkAnswers
    """
    tight, *others = _ways(case, load_case, link, forces, loads)
    stated, *tilted = _on_tilting_pins(case, link, [tight, *others])
    rule = widest(COUPLES)
    stated = stated if grown else on_plates(case, link, tight)
    return LinkAnswers(stated=stated, others=tuple(tilted), stress=rule, displacement=rule)


def _ways(case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]) -> tuple[LinkLoads, ...]:
    """What acts on a link with tight pins, and in the ways of sharing that count."""
    tight, *others = (
        acting_on(case, load_case, link, reactions, loads) for reactions in (forces.reactions, *forces.sharings)
    )
    longest = case.linkage.longest
    across = np.array([[pin.wrench[2:5] / (1.0, longest, longest) for pin in way.pins] for way in others])
    across = across.reshape(len(others), -1)
    least = forces.pins.least(link) if forces.pins is not None else None
    least = int(np.argmin(np.linalg.norm(across, axis=1))) if least is None else least
    return tight, *(others[i] for i in sorted({*outermost(across).tolist(), least}))


def rim_doubt(
    case: Case,
    load_case: str,
    moved: LargeDisplacement,
    forces: JointForces,
    loads: Sequence[Load],
    links: Sequence[str] | None = None,
) -> Growths:
    """Return what pins in their holes make of growth on the deformed shape, beside what ``sharing_answers`` hold of it.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    moved : LargeDisplacement
        The frame's answer, whose growth is that of tight pins.
    forces : JointForces
        As of ``sharing_doubt``.
    loads : sequence of Load
        That act on the links.
    links : sequence of str, optional
        Whose numbers are wanted; all when left out.

    Returns
    -------
    Growths
        Of stresses of links and pins, where that is looked for.
    """
    if moved.pins is None or moved.state not in ("small", "deformed") or not forces.sharings:
        return Growths()
    found = rim_growth(moved.pins, load_over_modulus(case, load_case, case.checked_links)[1])
    stress = dict[str, Scatter]()
    for link, one in telling(found.links).items():
        if links is None or link in links:
            own = _by_itself(case, load_case, link, forces, loads)
            stress[link] = replace(one, low=min(one.low / own.low, 1.0), high=max(one.high / own.high, 1.0))
    return Growths(stress=telling(stress), pins=telling(found.pins))


def _by_itself(case: Case, load_case: str, link: str, forces: JointForces, loads: Sequence[Load]) -> Scatter:
    """Growth of a link's ends of stress, by hand, that bends by itself on pins that tilt."""
    _, *ways = _ways(case, load_case, link, forces, loads)
    plain, tilted = [on_plates(case, link, way) for way in ways], _on_tilting_pins(case, link, ways)
    numbers = HandStates(case, link, [*plain, *tilted]).stress
    before, after = numbers[: len(ways)], numbers[len(ways) :]
    if not before.min() > 0.0:
        return Scatter()
    return Scatter(low=float(after.min() / before.min()), high=float(after.max() / before.max()))


def growths_by_hand(
    case: Case, stated: Reactions, changes: Sequence[Reactions], rule: ForceRule, answers: Mapping[str, LinkAnswers]
) -> Growths:
    """Return what a cause makes of links by hand, and of joint forces.

    Parameters
    ----------
    case : Case
    stated : Reactions
    changes : sequence of Reactions
        In the other answers.
    rule : ForceRule
    answers : mapping of str to LinkAnswers
        By link.

    Returns
    -------
    Growths
    """
    stress, displacement = {}, {}
    for link, one in answers.items():
        hand = HandStates(case, link, one.every)
        stress[link] = on_band(one.stress, *hand.peaks.tolist())
        plain, *others = hand.displacement.tolist()
        displacement[link] = one.displacement(plain, others)
    return Growths(
        stress=telling(stress), displacement=telling(displacement), joints=telling(_joints(stated, changes, rule))
    )


def outermost(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the corners of the convex hull of points: at one of them a convex function is largest.

    Parameters
    ----------
    points : ndarray, shape (n, d)

    Returns
    -------
    ndarray of int
        Their numbers, rising; of points in more than ``MOST_DIRECTIONS`` directions, and where no hull is found, all.
    """
    place, extent, _ = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    place = place[:, extent > FLAT * extent[0]]  # the hull has the same corners however it is stretched
    count, directions = place.shape
    if directions == 0:
        return np.array([0])
    if directions == 1:
        return np.unique([place.argmin(), place.argmax()])
    if directions > MOST_DIRECTIONS or count <= directions + 1:
        return np.arange(count)
    from scipy.spatial import ConvexHull, QhullError

    try:
        return np.sort(ConvexHull(place).vertices).astype(np.int64)
    except QhullError:  # points that are corners but for rounding
        return np.arange(count)


def _joints(stated: Reactions, changes: Sequence[Reactions], rule: ForceRule) -> dict[str, Scatter]:
    largest, found = max((joint.magnitude for joint in stated.joints.values()), default=0.0), dict[str, Scatter]()
    for name, joint in stated.joints.items():
        others = np.array([one.joints[name].force for one in changes]).reshape(len(changes), -1)
        others[np.linalg.norm(others, axis=1) < NOTHING * largest] = 0.0  # but for rounding
        found[name] = rule(np.asarray(joint.force), others)
    return found


def of_sizes(rule: Rule) -> ForceRule:
    """Return the rule of joint forces in alternatives: the largest of their sizes, and the least along the stated one.

    Parameters
    ----------
    rule : callable
        Of numbers.

    Returns
    -------
    callable
    """

    def of_forces(force: NDArray[np.float64], others: NDArray[np.float64]) -> Scatter:
        size = float(np.linalg.norm(force))
        along = others @ force / (size or 1.0)
        return rule(size, [*along.tolist(), *np.linalg.norm(others, axis=1).tolist()])

    return of_forces


def _steps(sources: tuple[Source, ...]) -> ForceRule:
    """The rule of what adds up: steps along the stated force by their sign, and those across it at their worst."""

    def rule(force: NDArray[np.float64], others: NDArray[np.float64]) -> Scatter:
        size = float(np.linalg.norm(force))
        if not size > 0.0:
            return Scatter.from_zero(np.linalg.norm(others, axis=1).tolist(), sources)
        steps, along = (others - force) / size, force / size
        parts = steps @ along
        across = float(np.linalg.norm(steps - parts[:, None] * along, axis=1).sum())
        low, high = 1.0 + float(np.minimum(parts, 0.0).sum()), 1.0 + float(np.maximum(parts, 0.0).sum())
        return Scatter(low=max(low, 0.0), high=math.hypot(max(-low, high), across), sources=sources)

    return rule


def _on_tilting_pins(case: Case, link: str, states: Sequence[LinkLoads]) -> list[Plates]:
    """What acts on a link, or on each plate of a pair, in each state, grown as ``on_tilting_pins`` says."""
    each = [on_plates(case, link, loads) for loads in states]
    grown = iter(on_tilting_pins(case, link, [plate for found in each for plate in found]))
    return [tuple(next(grown) for _ in found) for found in each]


def _summed(sources: tuple[Source, ...]) -> Rule:
    def around(value: float, changed: Sequence[float]) -> Scatter:
        if not value > 0.0:
            return Scatter.from_zero(changed, sources)
        steps = np.array([one - value for one in changed]) / value
        low, high = float(np.minimum(steps, 0.0).sum()), float(np.maximum(steps, 0.0).sum())
        return Scatter(low=max(1.0 + low, 0.0), high=1.0 + high, sources=sources)

    return around
