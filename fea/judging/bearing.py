"""Bearing of pins on the eyes: the joint force over the projected area d t, apart from any peak stress.

The nominal bearing stress F/(d t) (Budynas & Nisbett, Shigley's Mechanical Engineering Design, 10th ed., chapter 8)
is set against the ultimate strength of the softer eye, 3.33 times at least as 14 CFR 23.693 asks of joints that
turn, 6.67 times as 14 CFR 23.657 asks of hinges that flight depends on. Both mean the ultimate strength in bearing,
for which the ultimate tensile strength of the card stands; that in bearing is rarely below it.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.beam.cut_free import seat
from alula.fea.beam.pin_between import first_moment
from alula.fea.common.band import Band
from alula.fea.common.plates import ALIKE
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, load_scatter, of_sum, strength_scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import COUPLES
from alula.fea.common.verdict import CheckOutcome
from alula.fea.judging.loading import ByHand, Judged, Loading, OverMotion
from alula.fea.outcomes.pins import in_eyes
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.forks import apart, eye_of
from alula.loads.case.layers import joints_of_pin
from alula.loads.records.bearing import bearing_stress
from alula.loads.records.contact import half_angle, pressure
from alula.loads.statics.joint_reaction import JointReaction

Real = NDArray[np.float64]

WITHOUT = reason("evenly_over_projected_area")


def in_own_eyes(case: Case, joint: str, joints: Mapping[str, JointReaction]) -> dict[str, Real]:
    """Return what presses in the eyes of a joint's links: all joints that are on its pin together.

    Parameters
    ----------
    case : Case
    joint : str
    joints : mapping of str to JointReaction
        Of all joints.

    Returns
    -------
    dict of str to ndarray
        Link -> wrench (..., 6) about its point [N, N mm]; of a slot that of its own pin alone.
    """
    found = in_eyes(case, joint, {name: one.wrench for name, one in joints.items()})
    return {link: found[link, case.linkage.point_of(joint, link)] for link in case.joints[joint].links}


def pressing(case: Case, link: str, wrench: Real) -> Real:
    """Return the force that, spread evenly along an eye of a link, presses as hard as its pin does.

    Parameters
    ----------
    case : Case
    link : str
    wrench : ndarray, shape (..., 6)
        What the pin does to the link about its point [N, N mm].

    Returns
    -------
    ndarray, shape (...)
        That of the wrench, but of a pair of plates twice what its worse plate bears by the lever law [N].
    """
    force, distance = wrench[..., :2], apart(case, link)
    if distance is None:
        return np.asarray(np.linalg.norm(force, axis=-1))
    aside = 2.0 * first_moment(wrench) / distance
    return np.asarray(np.maximum(*(np.linalg.norm(force + side * aside, axis=-1) for side in (1.0, -1.0))))


def sharing(case: Case, link: str, wrenches: Sequence[Real]) -> Scatter:
    """Return what other ways in which pins may share couples make of the force that presses a link's eye most.

    Parameters
    ----------
    case : Case
    link : str
    wrenches : sequence of ndarray, shape (6,)
        What presses in the eye, as ``in_own_eyes`` has it, first that which stands [N, N mm].

    Returns
    -------
    Scatter
        More than 1 where pins, plates of a pair or joints of one pin bear couples.
    """
    stands, *others = (float(pressing(case, link, wrench)) for wrench in wrenches)
    _, most = sought([stands, *others])
    return Scatter(high=most / stands, sources=COUPLES) if most > stands > 0.0 else Scatter()


def weakest_eye(
    case: Case, name: str, joint: str, ways: Sequence[Mapping[str, Real]], load: Mapping[str, Scatter]
) -> tuple[str, Band]:
    """Return the link whose eye or slot a joint's pin loads worst, and its safety factor.

    Parameters
    ----------
    case : Case
    name : str
        Of the check.
    joint : str
    ways : sequence of mapping of str to ndarray
        Link -> wrench (6,) in its eye, as ``in_own_eyes`` has it, in all ways in which pins may share couples.
    load : mapping of str to Scatter
        Link -> what that force may be over what it is. The band holds it and, where the strength is that of the safety
        factor, the strength's.

    Returns
    -------
    tuple of (str, Band)
        The link, and its safety factor.

    Raises
    ------
    CaseError
        For a joint without pin diameter.
    """
    factors = {}
    for link, (bears, own) in eyes_bear(case, name, joint).items():
        force, most = _pressed(case, link, ways)
        known = replace(Band.exact(force, WITHOUT), high=most, sources=COUPLES if most > force * (1.0 + ALIKE) else ())
        factors[link] = own.on(load[link].on(known).inverse(bears))
    weakest = min(factors, key=lambda link: factors[link].low)
    return weakest, factors[weakest]


def _pressed(case: Case, link: str, ways: Sequence[Mapping[str, Real]]) -> tuple[float, float]:
    """Largest force in an eye of all ways, and what may lie beyond these, which were sought."""
    forces = [float(pressing(case, link, way[link])) for way in ways]
    return max(forces), sought(forces)[1]


def eyes_bear(case: Case, name: str, joint: str) -> dict[str, tuple[float, Scatter]]:
    """Return what the eyes or the slot of a joint's links bear of its pin.

    Parameters
    ----------
    case : Case
    name : str
        Of the check.
    joint : str

    Returns
    -------
    dict of str to tuple of (float, Scatter)
        Link -> force [N], and what that scatters by.

    Raises
    ------
    CaseError
        For a joint without pin diameter.
    """
    record = case.joints[joint]
    if record.pin_diameter is None:
        raise CaseError(
            f'joints.{joint}.pin_diameter: checks.{name} needs it for bearing; state it, for example "1.5 mm"'
        )
    found = {}
    # A pin in a slot shares its hole in the second link with others: that slot's force is not all that bears there.
    for link in (record.slotted,) if record.slotted else record.links:
        if link in case.checked_links:
            material, thickness = case.material_of(link), eye_of(case, joint, link).thickness
            strength = material.ultimate_strength or material.allowable
            own = strength_scatter(material) if strength == material.allowable else Scatter()
            of_one = bearing_stress(force=1.0, diameter=record.pin_diameter, thickness=thickness)
            found[link] = strength / of_one, own
    return found


def contact_pressure(case: Case, joint: str, link: str, force: float) -> tuple[float, float] | None:
    """Return the largest pressure under a joint's pin where the case states its clearance.

    It is that of contact in a plate (``alula.loads.records.contact``): Hertz's in a loose hole, 1.2 times the nominal
    bearing stress in a neat one. A thin eye that closes about its pin has less.

    Parameters
    ----------
    case : Case
    joint, link : str
        The link has a part.
    force : float
        Of the joint [N].

    Returns
    -------
    tuple of (float, float) or None
        At the least and at the largest clearance [MPa]; None where none is stated, in a slot, and without a force.
    """
    record, linkage = case.joints[joint], case.linkage
    body = case.body(link)
    sits = seat(linkage, link, body, body.pin(linkage.point_of(joint, link)))
    if sits is None or sits.clearance is None or record.pin_diameter is None or not force > 0.0:
        return None
    reduced = 2.0 * sits.pin_young * sits.young / (sits.young + sits.pin_young)
    angles = half_angle(reduced * np.array(sits.clearance) * sits.length / force)
    nominal = bearing_stress(force=force, diameter=record.pin_diameter, thickness=sits.length)
    low, high = (float(p) for p in nominal * pressure(0.0, angles))
    return low, high


def bearing_outcome(
    case: Case,
    load_case: str,
    one: Asked,
    ways: Sequence[Mapping[str, JointReaction]],
    growth: Callable[[str], Scatter] = lambda joint: Scatter(),
) -> CheckOutcome:
    """Return the outcome of one joint: that of its softer or thinner eye.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of its pin.
    ways : sequence of mapping of str to JointReaction
        Of all joints, in all ways in which pins may share couples, first those that stand.
    growth : callable
        Of a joint, to how its force grows beside scattered loads (``alula.fea.doubts.load_growth``).

    Returns
    -------
    CheckOutcome

    Raises
    ------
    CaseError
        For a joint without pin diameter.
    """
    joint, load = one.subject.name, load_scatter(case, load_case)
    every = [in_own_eyes(case, joint, way) for way in ways]
    spread = {link: load.times(grown(case, joint, link, ways[0], growth)) for link in every[0]}
    eye, factor = weakest_eye(case, one.name, joint, every, spread)
    found = one.outcome(load_case, factor)
    _, most = _pressed(case, eye, every)
    contact = contact_pressure(case, joint, eye, most * max(spread[eye].high, 1.0))
    why = reason("bearing_on_eye", link=eye, why=found.reason)
    if contact is None:
        return found.because(why)
    yields = case.material_of(eye).yield_strength or math.inf
    low, high = contact
    return found.because(
        reason("bearing_in_contact", why=why, low=low, high=high, yields=high > yields, strength=yields)
    )


def grown(
    case: Case, joint: str, link: str, joints: Mapping[str, JointReaction], growth: Callable[[str], Scatter]
) -> Scatter:
    """Return by what the force in an eye grows; where several joints press there, that of all of them.

    Parameters
    ----------
    case : Case
    joint, link : str
        The link has the eye, in which the joint's pin stands.
    joints : mapping of str to JointReaction
        Of all joints.
    growth : callable
        Of a joint, to how its force grows beside scattered loads (``alula.fea.doubts.load_growth``).

    Returns
    -------
    Scatter
        That of the joint where nothing presses in the eye.
    """
    parts, whole = _parts(case, joint, link, joints)
    sizes = [(float(size), growth(name)) for name, size in parts.items()]
    return of_sum(sizes, float(whole)) if whole > 0.0 else growth(joint)


def most_grown(case: Case, joint: str, link: str, joints: Mapping[str, JointReaction], over: OverMotion) -> Real:
    """Return the high end of ``grown`` at each pose.

    Parameters
    ----------
    case, joint, link
        As of ``grown``.
    joints : mapping of str to JointReaction
        Of all joints, with wrenches (n, 6).
    over : OverMotion
        Whose forces may grow.

    Returns
    -------
    ndarray, shape (n,)
    """
    parts, whole = _parts(case, joint, link, joints)
    of_one = np.broadcast_to(over.most_growth(joint), whole.shape)
    if len(parts) == 1:
        return of_one
    slack = sum(
        size * np.maximum(over.most_growth(name) - 1.0, 1.0 - over.joint_growth(name).low)
        for name, size in parts.items()
    )
    return np.asarray(1.0 + np.divide(slack, whole, out=of_one - 1.0, where=whole > 0.0))


def _parts(case: Case, joint: str, link: str, joints: Mapping[str, JointReaction]) -> tuple[dict[str, Real], Real]:
    """Return the size of each joint's force in an eye, and that of their sum (...)."""
    eye = link, case.linkage.point_of(joint, link)
    names = set(case.linkage.joints_at(*eye)).intersection(joints_of_pin(case, joint))
    parts = {name: np.asarray(np.linalg.norm(joints[name].wrench[..., :2], axis=-1)) for name in sorted(names)}
    return parts, np.asarray(np.linalg.norm(in_own_eyes(case, joint, joints)[link][..., :2], axis=-1))


def judge_bearing(here: Loading, one: Asked) -> Judged:
    """Return what the eyes of a joint bear of its pin.

    Parameters
    ----------
    here : Loading
    one : Asked
        Of the pin.

    Returns
    -------
    Judged
    """
    ways = [way.joints for way in here.ways()]
    return Judged(outcome=bearing_outcome(here.case, here.load_case, one, ways, here.joint_growth))


def least_of_bearing(over: OverMotion, one: Asked) -> Real:
    """Return by what the weaker eye of a joint bears more than what presses it at each pose.

    Parameters
    ----------
    over : OverMotion
    one : Asked
        Of the pin.

    Returns
    -------
    ndarray, shape (n,)
    """
    case, joint = over.case, one.subject.name
    [way] = over.ways()
    borne = in_own_eyes(case, joint, way.joints)
    with np.errstate(divide="ignore"):  # without a force there is no end
        every = [
            own.low * bears / (pressing(case, link, borne[link]) * most_grown(case, joint, link, way.joints, over))
            for link, (bears, own) in eyes_bear(case, one.name, joint).items()
        ]
    return np.asarray(np.min(every, axis=0))


BEARING = ByHand(judge=judge_bearing, least=least_of_bearing)
