"""Outcome of the check of eyes: every mode of every round eye of a link, under the force of its pin."""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, load_scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind, distinct, play_source
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.judging.bearing import grown, in_own_eyes, most_grown, sharing
from alula.fea.judging.loading import ByHand, Judged, Loading, OverMotion
from alula.fea.modes.eye_modes import STRAIGHT, EyeFactors, EyeMode, EyeStrength, RoundEye, asme_bth_1, en_1993_1_8
from alula.fea.modes.eye_scatter import eye_scatter
from alula.geometry.bodies.body import Body, extent
from alula.geometry.bodies.features import Pin
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.straight import Straight
from alula.loads.case.case import Case
from alula.loads.records.check_spec import BTH_1, EyeCheck

RULE = reason("eyes_by_a_rule")
DISHING = reason("dishing_not_drawn")
FORMULAS = Source(kind=SourceKind.EYE_FORMULAS)
NO_FORCE = reason("no_force_on_eyes")


def eyes_of(case: Case, link: str) -> dict[str, tuple[str, ...]]:
    """Return the points at which pins turn in a link, with the joints at each.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    dict of str to tuple of str
    """
    found: dict[str, tuple[str, ...]] = {}
    for joint in case.pinned_joints:
        if link in case.joints[joint].links:
            point = case.linkage.point_of(joint, link)
            found[point] = (*found.get(point, ()), joint)
    return found


def strengths(case: Case, link: str, check: EyeCheck) -> tuple[EyeStrength, ...]:
    """Return what the eyes of a link bear.

    Parameters
    ----------
    case : Case
    link : str
        Of a ductile metal, with round eyes (``alula.loads.case.break_rules``).
    check : EyeCheck

    Returns
    -------
    tuple of EyeStrength
        Forces on one plate, where the link is a pair of them.
    """
    body, found = case.body(link), []
    for point, joints in eyes_of(case, link).items():
        modes, eyes = _modes(case, link, body.pin(point), joints, check)
        without, outside = dict.fromkeys(modes, RULE), None
        if check.standard == BTH_1:
            width = _shank_width(body, point)
            outside = next((why for eye in eyes if (why := eye_scatter().outside(eye, width)) is not None), None)
            without = dict.fromkeys((EyeMode.DISHING,) if outside is None else modes, outside or DISHING)
            modes = {mode: _scattered(mode, band) for mode, band in modes.items()}
        found.append(
            EyeStrength(
                name=point,
                modes=modes,
                shanks=_shanks(body, point),
                across=eye_scatter().across,
                without=without,
                relieved=isinstance(body.part, Straight),
                undrawn=outside,
            )
        )
    return tuple(found)


def _scattered(mode: EyeMode, band: Band) -> Band:
    """Return what an eye bears in a mode, with how far its formula may be off; the value stays the formula's.

    An eye unlike those that were drawn has at least as much doubt; nothing was drawn of dishing.
    """
    if mode is EyeMode.DISHING:
        return band
    low, high = eye_scatter().modes[mode]
    return Scatter(low=min(low, 1.0), high=max(high, 1.0), sources=(FORMULAS,)).on(band)


def _modes(
    case: Case, link: str, pin: Pin, joints: Sequence[str], check: EyeCheck
) -> tuple[dict[EyeMode, Band], list[RoundEye]]:
    """Return what an eye bears in each mode for all that its clearance and yield strength may be, and those eyes."""
    material, body = case.material_of(link), case.body(link)
    ring, eyes = body.ring(pin), []
    own, clearances = strength_scatter(material), _clearances(case, link, joints)
    pin_yield = min(case.pin_material(joint).yield_strength or math.inf for joint in joints)
    assert material.yield_strength is not None
    play = (play_source(dict.fromkeys(joints, clearances[2])),) if clearances[1] < clearances[2] else ()
    found = []
    for clearance, share in itertools.product(clearances, (1.0, own.low, own.high)):
        eye = RoundEye(
            radius=body.part.wall(body, pin),
            hole=pin.pin_diameter + clearance,
            pin=pin.pin_diameter,
            thickness=ring.thickness,
            wall=min(high - low for low, high in ring.walls),
        )
        eyes.append(eye)
        strength = share * material.yield_strength
        if check.standard == BTH_1:
            assert material.ultimate_strength is not None
            found.append(asme_bth_1(eye, strength, material.ultimate_strength))
        else:
            found.append(en_1993_1_8(eye, strength, pin_yield))
    bands = {mode: Band.around(found[0][mode], tuple(x[mode] for x in found), *own.told, *play) for mode in found[0]}
    return bands, eyes


def _clearances(case: Case, link: str, joints: Sequence[str]) -> tuple[float, float, float]:
    """Return how much wider than its pin an eye's hole is in the middle, at least and at most [mm].

    It is one hole: of joints that state it differently each end is that of the loosest.
    """
    every = [case.linkage.pin_holes(joint)[link] for joint in joints]
    holes = [hole for hole in every if hole.stated] or every
    ends = [(hole.nominal, hole.low, hole.high if math.isfinite(hole.high) else hole.nominal) for hole in holes]
    middle, least, most = map(max, zip(*ends, strict=True))
    return middle, least, most


def _shank_width(body: Body, point: str) -> float:
    """Return how wide what holds an eye is [mm]: a disc at least as wide as the eye."""
    part, pin = body.part, body.pin(point)
    if pin.foot is not None:
        return part.arm_section.width
    return part.section.width if isinstance(part, Straight) else part.frame_section(body).width


def _shanks(body: Body, point: str) -> tuple[tuple[float, float], ...]:
    """Return unit vectors from an eye's hole to what holds it: the bar to either side of it, and arms.

    That of a hole in a plate or disc is towards the middle of its pins, or the disc's; it has none just there.
    """
    pin, (first, last) = body.pin(point), extent(body)
    if not isinstance(body.part, Straight):
        pins = body.pins if isinstance(body.part, Plate) else ()
        middle = sum(one.x for one in pins) / max(len(pins), 1), sum(one.y for one in pins) / max(len(pins), 1)
        return () if math.dist(middle, (pin.x, pin.y)) < pin.diameter else (_towards(pin, middle),)
    if pin.foot is not None:
        return (_towards(pin, pin.foot),)
    along = [(side, 0.0) for side, end in ((-1.0, first), (1.0, last)) if pin.x != end]
    arms = [_towards(pin, (arm.x, arm.y)) for arm in body.pins if arm.foot == (pin.x, pin.y)]
    return (*along, *arms)


def _towards(pin: Pin, place: tuple[float, float]) -> tuple[float, float]:
    x, y = place[0] - pin.x, place[1] - pin.y
    return x / math.hypot(x, y), y / math.hypot(x, y)


def eye_factors(
    case: Case, load_case: str, one: Asked, plates: Sequence[LinkLoads], growth: Mapping[str, Scatter]
) -> Iterator[EyeFactors]:
    """Yield by what every eye of a link bears more than its pin's force; of a pair, on its worse plate.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of a link.
    plates : sequence of LinkLoads
        What acts on the link at one pose, or on each plate of a pair.
    growth : mapping of str to Scatter
        Point -> how the force in the eye there grows beside scattered loads.

    Yields
    ------
    EyeFactors
    """
    check, link = one.check, one.subject.name
    assert isinstance(check, EyeCheck)
    for strength in strengths(case, link, check):
        yield worse_of(strength, plates, load_scatter(case, load_case).times(growth[strength.name]))


def judge_eyes(here: Loading, one: Asked) -> Judged:
    """Return what the eyes of a link bear.

    Parameters
    ----------
    here : Loading
    one : Asked
        Of a link.

    Returns
    -------
    Judged
    """
    case, link = here.case, one.subject.name
    ways, growth = [way.joints for way in here.ways()], {}
    for point, (joint, *_) in eyes_of(case, link).items():
        pressing = [in_own_eyes(case, joint, way)[link] for way in ways]
        growth[point] = grown(case, joint, link, ways[0], here.joint_growth).times(sharing(case, link, pressing))
    found = tuple(eye_factors(case, here.load_case, one, here.loads(link), growth))
    return Judged(outcome=eye_outcome(here.load_case, one, found), numbers=found)


def worse_of(strength: EyeStrength, plates: Sequence[LinkLoads], spread: Scatter) -> EyeFactors:
    """Return by what an eye bears more than its pin's force on the worse of its plates.

    Parameters
    ----------
    strength : EyeStrength
    plates : sequence of LinkLoads
        As of ``eye_factors``.
    spread : Scatter
        Of the force.

    Returns
    -------
    EyeFactors
    """
    found = [_factors(strength, plate, spread) for plate in plates]
    return min(found, key=lambda of: math.inf if of.worst is None else of.worst[1].low)


def _factors(strength: EyeStrength, plate: LinkLoads, spread: Scatter) -> EyeFactors:
    force = next(pin.wrench[..., :2] for pin in plate.pins if pin.name == strength.name)
    every, angle = strength.factors(force)
    bands = {}
    for mode, (value, low, high) in every.items():
        if value < math.inf:
            sources = strength.modes[mode].sources
            if mode is not EyeMode.BEARING and math.sin(angle) > STRAIGHT:
                oblique = reason("across_its_shank", share=strength.across)
                sources = distinct(sources, (Source(kind=SourceKind.DIRECTION, detail=oblique),))
            why = strength.without.get(mode, "")
            own = Band(value=float(value), low=float(low), high=float(high), sources=sources, without=why)
            bands[mode] = spread.inverse.on(own)
    return EyeFactors(
        eye=strength.name,
        force=float(np.linalg.norm(force)),
        angle=math.degrees(float(angle)),
        factors=bands,
        undrawn=strength.undrawn,
    )


def least_of_eyes(over: OverMotion, one: Asked) -> NDArray[np.float64]:
    """Return by what the eyes of a link bear more than their pins' forces, as far as these may grow, at each pose.

    Parameters
    ----------
    over : OverMotion
    one : Asked
        Of a link.

    Returns
    -------
    ndarray, shape (n,)
    """
    assert isinstance(one.check, EyeCheck)
    link, least = one.subject.name, np.full(len(over.evaluated), np.inf)
    [way], eyes = over.ways(), eyes_of(over.case, link)
    for strength in strengths(over.case, link, one.check):
        most = most_grown(over.case, eyes[strength.name][0], link, way.joints, over.joint_growth)
        for plate in over.loads(link):
            force = next(pin.wrench[..., :2] for pin in plate.pins if pin.name == strength.name)
            for _, low, _ in strength.factors(np.broadcast_to(force, (*least.shape, 2)))[0].values():
                least = np.minimum(least, low / most)
    return least


def eye_outcome(load_case: str, one: Asked, found: Sequence[EyeFactors]) -> CheckOutcome:
    """Return the outcome of a link: the least factor of all modes of all of its eyes.

    Parameters
    ----------
    load_case : str
        Its name.
    one : Asked
        Of a link.
    found : sequence of EyeFactors
        Of its eyes.

    Returns
    -------
    CheckOutcome
        The reason names the eye and the mode whose least factor is the least. It has no band where that one has none,
        or the one with the least value. With an eye unlike those that were drawn it does not pass.
    """
    loaded = [(eye, *eye.worst) for eye in found if eye.worst is not None]
    if not loaded:
        return one.outcome(load_case, Band.exact(math.inf, NO_FORCE), NO_FORCE)
    eye, mode, _ = min(loaded, key=lambda of: of[2].low)
    worst = Band.least([band for _, _, band in loaded])
    least = min((band for one in found for band in one.factors.values()), key=lambda band: band.value)
    outcome = one.outcome(load_case, replace(worst, without=eye.factors[mode].without or least.without))
    unlike = [of for of in loaded if of[0].undrawn is not None]
    if unlike and outcome.verdict is Verdict.PASS:
        eye, mode, _ = min(unlike, key=lambda of: of[2].low)
        outcome = outcome.left_open(eye.undrawn or "")
    return outcome.because(mode_of_eye(eye, mode, outcome.reason))


def mode_of_eye(eye: EyeFactors, mode: EyeMode, why: Reason | str) -> Reason:
    """Return the eye and the mode that decide, with why.

    Parameters
    ----------
    eye : EyeFactors
    mode : EyeMode
    why : Reason or str

    Returns
    -------
    Reason
    """
    return reason("mode_of_eye", eye=eye.eye, mode=str(mode), force=eye.force, angle=eye.angle, why=why)


EYES = ByHand(judge=judge_eyes, least=least_of_eyes)
