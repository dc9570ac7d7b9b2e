"""From a motion to verdicts: links and their fatigue, pins, bearing and buckling, each at its worst pose."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked, asked
from alula.fea.buckling.buckling import column_outcome, worst_column
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import reason, together
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.doubts.other_case import widened
from alula.fea.judging.bearing import bearing_outcome, pressing
from alula.fea.judging.connections import connection_factors, connection_outcome, least_factor, transmitted
from alula.fea.judging.eyes import eye_factors, eye_outcome, eyes_of, with_sharing, worst_pose
from alula.fea.judging.fatigue import asked_fatigue, fatigue_outcomes, link_fatigue_outcomes, unasked
from alula.fea.judging.judge import link_outcome
from alula.fea.judging.layers import CHECK as LAYERS
from alula.fea.judging.layers import asked_of_layers, layers_judged, no_strength, without_shear
from alula.fea.judging.line_contact import contact_of, contact_outcome, line_load
from alula.fea.judging.plastic_collapse import above_first_yield, as_elastic
from alula.fea.judging.solid_buckling import undecided_buckling
from alula.fea.judging.walls import wall_factors, wall_outcome
from alula.fea.links.link_by_hand import link_by_hand
from alula.fea.modes.connection_modes import Transmitted
from alula.fea.modes.wall_modes import WallFactor
from alula.fea.motion.buckling_history import axial_compression, factors_over_motion
from alula.fea.motion.envelope_result import LayerEnvelope, LinkEnvelope
from alula.fea.motion.layered import forces_at
from alula.fea.motion.linkage_history import when
from alula.fea.motion.loosened import column_growth, connection_growth, joint_growth
from alula.fea.outcomes.pins import pin_outcome, shared_stress, stress_at, stress_of, twist_of, twisted
from alula.geometry.base.model import CaseModel
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.records.check_spec import (
    BearingCheck,
    ConnectionCheck,
    EyeCheck,
    FatigueCheck,
    LimitLoadCheck,
    LineContactCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    WallCheck,
)
from alula.loads.states.case_motion import CaseMotion
from alula.loads.statics.joint_reaction import JointReaction

LEFT_OUT = reason("left_out_near_dead_point")
NOT_FOLLOWED = reason("buckling_not_followed")
COLLAPSE_NOT_FOLLOWED = reason("collapse_not_followed")
OF_JOINTS = (PinCheck, BearingCheck, LineContactCheck, ConnectionCheck)
FOLLOWED = (*(SafetyFactorCheck, *OF_JOINTS, EyeCheck, WallCheck, PlasticCollapseCheck, FatigueCheck, LimitLoadCheck),)
"""Checks of the case that are decided over the motion, besides those of the linkage as a whole."""


def envelope_outcomes(
    moved: CaseMotion,
    links: Mapping[str, LinkEnvelope],
    evaluated: NDArray[np.bool_],
    grown: Mapping[str, Growths] | None = None,
    *,
    lasting: bool = False,
) -> list[CheckOutcome]:
    """Return the outcomes of links, pins, bearing and fatigue; no link or joint passes where poses were left out.

    Parameters
    ----------
    moved : CaseMotion
    links : mapping of str to LinkEnvelope
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    grown : mapping of str to Growths, optional
        Load case -> what the deformed shape makes of joint forces; nothing when left out.
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
    for one in asked(case, SafetyFactorCheck, PlasticCollapseCheck, *OF_JOINTS):
        if isinstance(one.check, OF_JOINTS):
            found += _joint(moved, one, evaluated, grown or {})
        elif one.subject.name in links:
            elastic = as_elastic(one)
            for load_case, over in links[one.subject.name].load_cases.items():
                outcome = link_outcome(case, load_case, elastic, over.safety_factor, over.discretisation)
                outcome = _complete(outcome, evaluated)
                found.append(outcome if one == elastic else _above_first_yield(case, one, outcome))
    for link, envelope in links.items():
        found += [_complete(outcome, evaluated) for outcome in layer_outcomes(moved, link, envelope)]
        for load_case, over in envelope.load_cases.items():
            if over.fatigue is not None:
                found += link_fatigue_outcomes(case, link, load_case, over.fatigue)
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


def _joint(
    moved: CaseMotion, one: Asked, evaluated: NDArray[np.bool_], grown: Mapping[str, Growths]
) -> Iterator[CheckOutcome]:
    """Outcome of a joint under every load case, at the pose where its pin, its eyes or its connection bear most."""
    joint = one.subject.name
    for load_case, solved in moved.forces.items():
        growth = _growth(moved, load_case, joint, evaluated, grown, one.check)
        assert one.check is not None
        pose, outcome = _WORST[type(one.check)](moved, one, load_case, evaluated, growth)
        force = float(np.linalg.norm(solved.forces[joint][pose]))
        outcome = _complete(outcome, evaluated)
        yield outcome.because(reason("under_force", force=force, when=when(moved, pose), why=outcome.reason))


def _growth(
    moved: CaseMotion,
    load_case: str,
    joint: str,
    evaluated: NDArray[np.bool_],
    grown: Mapping[str, Growths],
    check: CaseModel | None = None,
) -> Scatter:
    """Return what may become of a joint's greatest force, or of what a connection bears, besides scattered loads."""

    def demand(other: CaseMotion) -> NDArray[np.float64]:
        assert isinstance(check, ConnectionCheck)
        return 1.0 / least_factor(other.case, check, _through(other, load_case, check))

    if isinstance(check, ConnectionCheck):
        growth = connection_growth(moved, load_case, joint, evaluated, demand)
    else:
        growth = joint_growth(moved, load_case, joint, evaluated)
    if load_case not in grown:
        return growth
    own = grown[load_case]
    return growth.times(own.through(joint) if isinstance(check, ConnectionCheck) else own.joints.get(joint, Scatter()))


def eye_outcomes(
    moved: CaseMotion,
    loaded: Mapping[str, Sequence[LinkLoads]],
    evaluated: NDArray[np.bool_],
    grown: Mapping[str, Growths] | None = None,
) -> Iterator[CheckOutcome]:
    """Yield the outcome of the eyes of every link that a check asks for, at the pose where they bear least.

    Parameters
    ----------
    moved : CaseMotion
    loaded : mapping of str to sequence of LinkLoads
        Link -> what acts on it, one record per load case and plate.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    grown : mapping of str to Growths, optional
        Load case -> what the deformed shape makes of joint forces; nothing when left out.

    Yields
    ------
    CheckOutcome
    """
    case = moved.case
    for one, load_case, plates in _plates_asked(moved, loaded, EyeCheck):
        link, pose = one.subject.name, worst_pose(case, one, plates, evaluated)
        joints = [joint for every in eyes_of(case, link).values() for joint in every]
        growth = {joint: _growth(moved, load_case, joint, evaluated, grown or {}) for joint in joints}
        if case.links[link].count == 2:
            forces = forces_at(moved, load_case, pose)
            growth = with_sharing(case, link, growth, (forces.reactions, *forces.sharings))
        here = [loads.chosen(pose) for loads in plates]
        found = tuple(eye_factors(case, load_case, one, here, growth))
        outcome = _complete(eye_outcome(load_case, one, found), evaluated)
        yield outcome.because(reason("eyes_over_motion", when=when(moved, pose), why=outcome.reason))


def wall_outcomes(
    moved: CaseMotion,
    loaded: Mapping[str, Sequence[LinkLoads]],
    evaluated: NDArray[np.bool_],
    growth: Callable[[str, str], Scatter],
) -> Iterator[CheckOutcome]:
    """Yield the outcome of the thin walls of every link that a check asks for, at the pose where they bear least.

    Parameters
    ----------
    moved : CaseMotion
    loaded : mapping of str to sequence of LinkLoads
        Link -> what acts on it, one record per load case and plate.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    growth : callable
        Of load case and link, to what else than the scatter of loads makes of its stress.

    Yields
    ------
    CheckOutcome
    """
    case = moved.case
    for one, load_case, plates in _plates_asked(moved, loaded, WallCheck):
        link, found = one.subject.name, dict[int, tuple[WallFactor, ...]]()
        spread = growth(load_case, link)
        for pose in np.flatnonzero(evaluated).tolist():
            beams = [link_by_hand(case, link, loads.chosen(pose)).check for loads in plates]
            found[pose] = tuple(wall_factors(case, load_case, one, beams, spread))
        worst = min(found, key=lambda pose: min((mode.factor.low for mode in found[pose]), default=math.inf))
        outcome = _complete(wall_outcome(load_case, one, found[worst]), evaluated)
        yield outcome.because(reason("walls_over_motion", when=when(moved, worst), why=outcome.reason))


def _plates_asked(
    moved: CaseMotion, loaded: Mapping[str, Sequence[LinkLoads]], kind: type[CaseModel]
) -> Iterator[tuple[Asked, str, list[LinkLoads]]]:
    """Yield every link that a kind of check asks for, with a load case and what acts on its plates there."""
    for one in asked(moved.case, kind):
        for load_case in moved.forces:
            if plates := [loads for loads in loaded.get(one.subject.name, ()) if loads.name == load_case]:
                yield one, load_case, plates


def _worst_bearing(
    moved: CaseMotion, one: Asked, load_case: str, evaluated: NDArray[np.bool_], growth: Scatter
) -> tuple[int, CheckOutcome]:
    """Return the pose where either eye is pressed most, and the outcome there."""
    case, joint = moved.case, one.subject.name
    wrenches = moved.forces[load_case].joints[joint].wrench
    pressed = np.max([*pressing(case, joint, wrenches).values()], axis=0)
    pose = first_largest(np.where(evaluated, pressed, -np.inf))
    every = [wrenches[pose]]
    if case.linkage.rise(joint) != 0.0 and any(case.links[x].count == 2 for x in case.joints[joint].links):
        every += [way.joints[joint].wrench for way in forces_at(moved, load_case, pose).sharings]
    return pose, bearing_outcome(case, load_case, one, every, growth)


def _worst_contact(
    moved: CaseMotion, one: Asked, load_case: str, evaluated: NDArray[np.bool_], growth: Scatter
) -> tuple[int, CheckOutcome]:
    """Return the pose where a pin presses most on the flank of its slot, and the outcome there."""
    case, joint = moved.case, one.subject.name
    wrenches = moved.forces[load_case].joints[joint].wrench
    pose = first_largest(np.where(evaluated, line_load(case, joint, wrenches), -np.inf))
    every = [wrenches[pose]]
    if case.linkage.rise(joint) != 0.0:
        every += [way.joints[joint].wrench for way in forces_at(moved, load_case, pose).sharings]
    return pose, contact_outcome(load_case, one, contact_of(case, load_case, one, every, growth))


def _worst_connection(
    moved: CaseMotion, one: Asked, load_case: str, evaluated: NDArray[np.bool_], growth: Scatter
) -> tuple[int, CheckOutcome]:
    """Return the pose where a connection bears least beyond what goes through it, and the outcome there."""
    case, check = moved.case, one.check
    assert isinstance(check, ConnectionCheck)
    load = _through(moved, load_case, check)
    pose = int(np.argmin(np.where(evaluated, least_factor(case, check, load), np.inf)))
    every = [Transmitted(**{name: of[pose] for name, of in vars(load).items()})]
    if case.linkage.rise(check.joint) != 0.0:
        ways = forces_at(moved, load_case, pose).sharings
        every += [transmitted(case, check, way.joints[check.joint].wrench, way.driving[0]) for way in ways]
    return pose, connection_outcome(load_case, one, connection_factors(case, load_case, one, every, growth))


def _worst_pin(
    moved: CaseMotion, one: Asked, load_case: str, evaluated: NDArray[np.bool_], growth: Scatter
) -> tuple[int, CheckOutcome]:
    """Return the pose where a pin is stressed most, and the outcome there.

    That is the pose of the largest force, to which in a plane all stresses are in proportion. Between layers, and where
    a torque goes through the pin, it is that of its own largest stress.
    """
    case, joint, solved = moved.case, one.subject.name, moved.forces[load_case]
    reaction, sizes = solved.joints[joint], np.linalg.norm(solved.forces[joint], axis=1)
    turning = np.broadcast_to(np.asarray(solved.drive_torque, dtype=float), evaluated.shape)
    twists = [twist_of(case, joint, *of) for of in zip(reaction.wrench[:, 5], turning, strict=True)]
    if case.linkage.rise(joint) == 0.0 and not any(twist.high > 0.0 for twist in twists):
        pose = first_largest(np.where(evaluated, sizes, -np.inf))
        return pose, pin_outcome(case, load_case, one, stress_of(case, joint, float(sizes[pose])), growth)
    at_poses = [_at(reaction, i) for i in range(len(evaluated))]
    bent = [
        twisted(case, joint, stress_at(case, joint, r), twist).equivalent.high if counts else -np.inf
        for r, twist, counts in zip(at_poses, twists, evaluated, strict=True)
    ]
    pose = first_largest(np.array(bent))
    shared = shared_stress(case, joint, at_poses[pose], forces_at(moved, load_case, pose))
    return pose, pin_outcome(case, load_case, one, twisted(case, joint, shared, twists[pose]), growth)


def _through(moved: CaseMotion, load_case: str, check: ConnectionCheck) -> Transmitted:
    """Return what goes through a connection at all poses."""
    solved = moved.forces[load_case]
    return transmitted(moved.case, check, solved.joints[check.joint].wrench, solved.driving[0])


Worst = Callable[[CaseMotion, Asked, str, NDArray[np.bool_], Scatter], tuple[int, CheckOutcome]]
_WORST: dict[type[CaseModel], Worst] = {
    PinCheck: _worst_pin,
    BearingCheck: _worst_bearing,
    LineContactCheck: _worst_contact,
    ConnectionCheck: _worst_connection,
}


def _at(reaction: JointReaction, pose: int) -> JointReaction:
    """Return a reaction at one pose."""
    return replace(reaction, wrench=reaction.wrench[pose], arm=reaction.arm[pose])


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
            found = []
            for history in histories:  # of both plates of a pair
                if history.name == load_case:
                    factors = factors_over_motion(moved.case, link, history)
                    compression, _ = axial_compression(moved.case, link, history)
                    found.append(worst_column(moved.case, link, compression, factors, evaluated))
            columns = [column for column in found if column is not None]
            if columns:
                column = min(columns, key=lambda one: one.value)
                outcome = column_outcome(moved.case, load_case, link, column, where=when(moved, column.pose))
                spread = column_growth(moved, load_case, link, evaluated)
                if grown and link in grown[load_case].columns:
                    spread = spread.times(grown[load_case].columns[link])
                yield _complete(widened(outcome, spread), evaluated)


def _complete(outcome: CheckOutcome, evaluated: NDArray[np.bool_]) -> CheckOutcome:
    """Return an outcome over a motion, which does not pass where poses were left out."""
    return outcome.left_open(LEFT_OUT) if outcome.verdict is Verdict.PASS and not evaluated.all() else outcome
