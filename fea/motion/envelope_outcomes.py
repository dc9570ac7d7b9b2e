"""From a motion to verdicts: links and their fatigue, pins, bearing and buckling, each at its worst pose."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked, asked
from alula.fea.buckling.buckling import StraightColumn, column_outcome, worst_column
from alula.fea.check.kinds import BY_HAND
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import reason, together
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.doubts.other_case import widened
from alula.fea.judging.fatigue import asked_fatigue, fatigue_outcomes, link_fatigue_outcomes, unasked
from alula.fea.judging.judge import link_outcome
from alula.fea.judging.layers import CHECK as LAYERS
from alula.fea.judging.layers import asked_of_layers, layers_judged, no_strength, without_shear
from alula.fea.judging.loading import OverMotion
from alula.fea.judging.plastic_collapse import above_first_yield, as_elastic
from alula.fea.judging.solid_buckling import undecided_buckling
from alula.fea.motion.buckling_history import axial_compression, factors_over_motion
from alula.fea.motion.envelope_result import LayerEnvelope, LinkEnvelope
from alula.fea.motion.layered import forces_at
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import causes_over, when
from alula.fea.motion.loading import loading_over
from alula.fea.motion.loosened import column_growth
from alula.fea.outcomes.pins import (
    between_layers,
    pin_growth,
    pin_outcome,
    shared_stress,
    stress_of,
    stresses,
    twist_of,
    twisted,
    with_torque,
)
from alula.fea.whole.permanent_set import NOTHING, WITHOUT_YIELD, first_yield
from alula.geometry.base.model import CaseModel
from alula.geometry.base.ties import first_largest, first_least
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.case.layers import joints_of_pin
from alula.loads.records.check_spec import (
    FatigueCheck,
    LimitLoadCheck,
    PermanentSetCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
)
from alula.loads.states.case_motion import CaseMotion

LEFT_OUT = reason("left_out_near_dead_point")
NOT_FOLLOWED = reason("buckling_not_followed")
COLLAPSE_NOT_FOLLOWED = reason("collapse_not_followed")
OF_LINKS: tuple[type[CaseModel], ...] = (SafetyFactorCheck, PlasticCollapseCheck, PermanentSetCheck, FatigueCheck)
FOLLOWED: tuple[type[CaseModel], ...] = (*OF_LINKS, PinCheck, *BY_HAND, LimitLoadCheck)
"""Checks of the case that are decided over the motion, besides those of the linkage as a whole."""


def envelope_outcomes(
    moved: CaseMotion,
    links: Mapping[str, LinkEnvelope],
    evaluated: NDArray[np.bool_],
    grown: Mapping[str, Growths] | None = None,
    *,
    loaded: Mapping[str, Sequence[LinkLoads]] | None = None,
    stressed: Callable[[str, str], Scatter] | None = None,
    pins: Mapping[tuple[str, str], int] = MappingProxyType({}),
    lasting: bool = False,
) -> list[CheckOutcome]:
    """Return the outcomes of links and joints; no link or joint passes where poses were left out.

    Parameters
    ----------
    moved : CaseMotion
    links : mapping of str to LinkEnvelope
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    grown : mapping of str to Growths, optional
        Load case -> what the deformed shape makes of joint forces; nothing when left out.
    loaded : mapping of str to sequence of LinkLoads, optional
        Link -> what acts on it, one record per load case and plate, for checks by hand of links.
    stressed : callable, optional
        Of load case and link, to what else than the scatter of loads makes of its stress by hand.
    pins : mapping of tuple of 2 str to int, optional
        (load case, joint) -> number of the pose in which its pin may bear most, of all ways of sharing couples.
    lasting : bool, optional
        Whether repetitions of the motion are asked for, so that fatigue that is not known leaves a link undecided.

    Returns
    -------
    list of CheckOutcome

    Raises
    ------
    CaseError
        Where neither check nor material states a limit, or a pin has no diameter.
    """
    case, found = moved.case, list[CheckOutcome]()
    every = [
        loading_over(moved, x, evaluated, loaded or {}, (grown or {}).get(x, Growths()), stressed) for x in moved.forces
    ]
    for one in asked(case, SafetyFactorCheck, PlasticCollapseCheck, PinCheck, *BY_HAND):
        if not isinstance(one.check, SafetyFactorCheck | PlasticCollapseCheck):
            acting = [over for over in every if one.subject.kind != "link" or over.loads(one.subject.name)]
            found += [_at_worst_pose(moved, over, one, pins) for over in acting]
        elif one.subject.name in links:
            elastic = as_elastic(one)
            for load_case, over in links[one.subject.name].load_cases.items():
                outcome = link_outcome(case, load_case, elastic, over.safety_factor, over.discretisation)
                outcome = _complete(outcome, evaluated)
                found.append(outcome if one == elastic else _above_first_yield(case, one, outcome))
    found += _sets(case, links, evaluated)
    for link, envelope in links.items():
        found += [_complete(outcome, evaluated) for outcome in layer_outcomes(moved, link, envelope)]
        for load_case, over in envelope.load_cases.items():
            if over.fatigue is not None:
                found += link_fatigue_outcomes(case, asked_fatigue(case, link), load_case, over.fatigue)
            elif lasting:
                one = asked_fatigue(case, link)[0]
                why = envelope.no_fatigue or reason("peak_not_known")
                found.append(one.outcome(load_case, Band.unknown(why)))
        for load_case, layers in envelope.layers.items():
            found += layer_fatigue_outcomes(case.material_of(link), link, load_case, layers)
    return found


def _above_first_yield(case: Case, one: Asked, elastic: CheckOutcome) -> CheckOutcome:
    """Outcome of plastic collapse over the motion, where no path is followed: by its first yield alone."""
    why = COLLAPSE_NOT_FOLLOWED
    return above_first_yield(case, one, elastic) or one.outcome(elastic.load_case, Band.unknown(why), why)


def _sets(case: Case, links: Mapping[str, LinkEnvelope], evaluated: NDArray[np.bool_]) -> Iterator[CheckOutcome]:
    """Yield the permanent set over the motion, where no path is followed: none where nothing yields at any pose."""
    for one in asked(case, PermanentSetCheck):
        for load_case in dict.fromkeys(x for envelope in links.values() for x in envelope.load_cases):
            elastic = []
            for link, envelope in links.items():
                if load_case in envelope.load_cases:
                    over, own = envelope.load_cases[load_case], as_elastic(first_yield(link))
                    factor = link_outcome(case, load_case, own, over.safety_factor, over.discretisation)
                    elastic.append(above_first_yield(case, first_yield(link), factor) is not None)
            if all(elastic):
                yield _complete(one.outcome(load_case, NOTHING, WITHOUT_YIELD), evaluated)
            else:
                yield one.outcome(load_case, Band.unknown(COLLAPSE_NOT_FOLLOWED), COLLAPSE_NOT_FOLLOWED)


def layer_outcomes(moved: CaseMotion, link: str, envelope: LinkEnvelope) -> Iterator[CheckOutcome]:
    """Yield the outcome of the layers of a printed link under every load case.

    Parameters
    ----------
    moved : CaseMotion
    link : str
    envelope : LinkEnvelope

    Yields
    ------
    CheckOutcome
        None for a link whose layers are not checked.
    """
    case, one = moved.case, asked_of_layers(moved.case, link)
    if one is None:
        return
    material = case.material_of(link)
    for load_case, over in envelope.load_cases.items():
        found = envelope.layers.get(load_case)
        if found is not None:
            where = reason("at_pose_and_place", pose=when(moved, found.pose), place=tuple(map(float, found.location)))
            yield layers_judged(case, load_case, one, found.safety_factor, where)
        elif material.strength_across_layers is None:
            yield one.outcome(load_case, Band.unknown(), no_strength(material.title))
        else:
            why = over.discretisation.reason if over.discretisation else reason("peak_not_known")
            yield one.outcome(load_case, Band.unknown(), why)


def layer_fatigue_outcomes(
    material: Material, link: str, load_case: str, layers: LayerEnvelope
) -> Iterator[CheckOutcome]:
    """Yield the outcomes of the fatigue of a printed link's layers, as ``fatigue_outcomes``.

    Parameters
    ----------
    material : Material
    link : str
    load_case : str
    layers : LayerEnvelope

    Yields
    ------
    CheckOutcome
        None where no fatigue is asked for.
    """
    fatigue, name = layers.fatigue, f"fatigue of {LAYERS}"
    if fatigue is None:
        if layers.no_fatigue:
            yield unasked(link, name)[0].outcome(load_case, Band.unknown(layers.no_fatigue))
        return
    data = material.fatigue_across_layers
    assert data is not None
    place = tuple(map(float, fatigue.location))
    where = reason("fatigue_of_layers", tension=fatigue.tension, shear=fatigue.shear, place=place)
    for outcome in fatigue_outcomes(unasked(link, name), load_case, fatigue, data):
        told = outcome.because(together(outcome.reason, where))
        yield told if material.shear_strength_between_layers else without_shear(told, material.title)


def _at_worst_pose(
    moved: CaseMotion, over: OverMotion, one: Asked, pins: Mapping[tuple[str, str], int] = MappingProxyType({})
) -> CheckOutcome:
    """Return what a check by hand makes of its subject: at the pose where that bears least, which is told."""
    evaluated, subject = over.evaluated, one.subject
    if isinstance(one.check, PinCheck):
        pose, found = _worst_pin(moved, over, one, pins.get((over.load_case, subject.name)))
    else:
        assert one.check is not None
        how = BY_HAND[type(one.check)]
        pose = first_least(np.where(evaluated, how.least(over, one), np.nan))
        found = how.judge(over.at(pose), one).outcome
    outcome = _complete(found, evaluated)
    if subject.kind == "link":
        return outcome.because(reason("at_pose_of_motion", when=when(moved, pose), why=outcome.reason))
    force = float(np.linalg.norm(moved.forces[over.load_case].forces[subject.name][pose]))
    return outcome.because(reason("under_force", force=force, when=when(moved, pose), why=outcome.reason))


def _worst_pin(moved: CaseMotion, over: OverMotion, one: Asked, most: int | None) -> tuple[int, CheckOutcome]:
    """Return the pose where a pin is stressed most, and the outcome there.

    That is the pose of the largest force, to which in a plane all stresses are in proportion. Between layers, and where
    a torque goes through the pin, it is that of its own largest stress; where it may bear ``most`` counts beside it.
    """
    case, load_case, evaluated, joint = over.case, over.load_case, over.evaluated, one.subject.name
    solved = moved.forces[load_case]
    reaction, sizes = solved.joints[joint], np.linalg.norm(solved.forces[joint], axis=1)
    turning = np.broadcast_to(np.asarray(solved.drive_torque, dtype=float), evaluated.shape)
    twists = [twist_of(case, joint, *of) for of in zip(reaction.wrench[:, 5], turning, strict=True)]
    spatial = between_layers(case, joint) or bool(reaction.wrench[evaluated][:, 2:5].any())
    if not spatial and not any(twist.high > 0.0 for twist in twists):
        pose = first_largest(np.where(evaluated, sizes, -np.inf))
        stress = stress_of(case, joint, float(sizes[pose]))
        return pose, pin_outcome(case, load_case, one, stress, over.pin_growth(joint))
    wrenches = {name: solved.joints[name].wrench for name in joints_of_pin(case, joint)}
    bent = [
        twisted(case, joint, stress, twist).equivalent.high if counts else -np.inf
        for stress, twist, counts in zip(stresses(case, joint, wrenches), twists, evaluated, strict=True)
    ]

    def at(pose: int) -> CheckOutcome:
        reactions = solved.at(pose).joints
        shared = shared_stress(case, joint, reactions, forces_at(moved, load_case, pose))
        stress = twisted(case, joint, shared, twists[pose])
        growth = pin_growth(case, joint, reactions, over.at(pose).pin_growth)
        return pin_outcome(case, load_case, one, stress, with_torque(joint, stress, growth, over.growth_through))

    pose = first_largest(np.array(bent))
    found = {i: at(i) for i in dict.fromkeys((pose, pose if most is None else most))}
    worst = min(found, key=lambda i: found[i].value.low)
    return worst, one.outcome(load_case, Band.least([outcome.value for outcome in found.values()]))


def column_outcomes(
    moved: CaseMotion,
    loaded: Mapping[str, Sequence[LinkLoads]],
    evaluated: NDArray[np.bool_],
    grown: Mapping[str, Growths] | None = None,
) -> Iterator[CheckOutcome]:
    """Yield the least buckling factor of every link that is compressed at some pose, and where it is.

    Parameters
    ----------
    moved : CaseMotion
    loaded : mapping of str to sequence of LinkLoads
        Link -> what acts on it, one record per load case.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    grown : mapping of str to Growths, optional
        Load case -> what the deformed shape makes of columns; nothing when left out.

    Yields
    ------
    CheckOutcome
    """
    for link, histories in loaded.items():
        for load_case in dict.fromkeys(history.name for history in histories):
            if not moved.case.part_of(link).is_beam:
                yield undecided_buckling(load_case, link, NOT_FOLLOWED)
                continue
            columns, sources = _columns(moved.case, load_case, link, histories, evaluated), tuple[Source, ...]()
            for cause in () if columns else tuple(causes_over(moved, load_case, evaluated)):
                pressed = [
                    column
                    for other in cause.others
                    for column in _columns(other.case, load_case, link, link_histories(other, link), evaluated)
                ]
                columns, sources = [*columns, *pressed], (*sources, *((cause.source,) if pressed else ()))
            if columns:
                column = min(columns, key=lambda one: one.value)
                outcome = column_outcome(moved.case, load_case, link, column, where=when(moved, column.pose))
                # Where it is pressed in another answer alone, it may bear without end as well.
                endless = Scatter(low=0.0, sources=sources)
                spread = endless if sources else column_growth(moved, load_case, link, evaluated)
                if grown and link in grown[load_case].columns:
                    spread = spread.times(grown[load_case].columns[link])
                yield _complete(widened(outcome, spread), evaluated)


def _columns(
    case: Case, load_case: str, link: str, histories: Sequence[LinkLoads], evaluated: NDArray[np.bool_]
) -> list[StraightColumn]:
    """The worst column of a link, or of each plate of a pair, that is compressed at a pose."""
    found = []
    for history in histories:
        if history.name == load_case:
            factors = factors_over_motion(case, link, history)
            compression, _ = axial_compression(case, link, history)
            found.append(worst_column(case, link, compression, factors, evaluated))
    return [column for column in found if column is not None]


def _complete(outcome: CheckOutcome, evaluated: NDArray[np.bool_]) -> CheckOutcome:
    """Return an outcome over a motion, which does not pass where poses were left out."""
    return outcome.left_open(LEFT_OUT) if outcome.verdict is Verdict.PASS and not evaluated.all() else outcome
