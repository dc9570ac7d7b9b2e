"""From a motion to verdicts: links and their fatigue, pins, bearing and buckling, each at its worst pose."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.scatter import load_scatter, strength_scatter
from fea.common.verdict import BUCKLING_FACTOR, PIN, SAFETY_FACTOR, CheckOutcome, Verdict, at_least
from fea.frame.large_displacement import LEAST_FACTOR
from fea.motion.buckling_history import factors_over_motion
from fea.motion.envelope_result import LinkEnvelope
from fea.motion.fatigue import LIFE_FACTOR, STRESS_FACTOR
from fea.motion.link_history import LinkHistory
from fea.outcomes.bearing import weakest_eye
from fea.outcomes.buckling import NAME as BUCKLING
from fea.outcomes.buckling import factor_band, grown
from fea.outcomes.judge import least_safety_factor, reason_for
from fea.outcomes.pins import stress_of
from geometry.parts.material import Material
from loads.records.check_spec import BearingCheck, PinCheck, SafetyFactorCheck
from loads.states.case_motion import CaseMotion

FATIGUE_STRESS = "fatigue, stress"
FATIGUE_LIFE = "fatigue, life"
"""Fatigue strength over stress, and life over the repetitions that are wanted."""
BEYOND_CARD = "the material's card ends below the repetitions that are wanted"
FOLLOWED = (SafetyFactorCheck, PinCheck, BearingCheck)
"""Checks of the case that are decided over the motion."""


def envelope_outcomes(
    moved: CaseMotion, links: Mapping[str, LinkEnvelope], evaluated: NDArray[np.bool_]
) -> list[CheckOutcome]:
    """Return the outcomes of links, pins, bearing and fatigue; no link or joint passes where poses were left out.

    Raises ``CaseError`` where neither check nor material states a limit, or a pin has no diameter.
    """
    case, complete = moved.case, bool(evaluated.all())
    found = []
    for name, check in case.all_checks.items():
        if isinstance(check, SafetyFactorCheck):
            for link in (x for x in check.links or case.checked_links if x in links):
                limit = least_safety_factor(name, check.minimum, case.material_of(link), link)
                for title, load_case in links[link].load_cases.items():
                    outcome = _outcome(
                        name, link, title, SAFETY_FACTOR, load_case.safety_factor, limit, complete=complete
                    )
                    if not load_case.known and load_case.discretisation is not None:
                        outcome = replace(outcome, reason=load_case.discretisation.sentence)
                    found.append(outcome)
        elif isinstance(check, PinCheck | BearingCheck):
            found += _joints(moved, name, check, evaluated)
    for link, envelope in links.items():
        for title, load_case in envelope.load_cases.items():
            fatigue = load_case.fatigue
            if fatigue is None:
                continue
            if fatigue.strength is None and fatigue.repetitions is None:
                found.append(_beyond_card(case.material_of(link), link, title, fatigue.wanted))
            if fatigue.strength is not None:
                factor = fatigue.stress.inverse(fatigue.strength)
                found.append(_outcome("fatigue", link, title, FATIGUE_STRESS, factor, STRESS_FACTOR))
            if fatigue.repetitions is not None:
                share = _scaled(fatigue.repetitions, 1.0 / fatigue.wanted)
                found.append(_outcome("fatigue", link, title, FATIGUE_LIFE, share, LIFE_FACTOR))
    return found


def _beyond_card(material: Material, link: str, title: str, wanted: float) -> CheckOutcome:
    """Outcome of fatigue where the card knows neither a strength at the wanted repetitions nor a life."""
    assert material.fatigue is not None
    outcome = _outcome("fatigue", link, title, FATIGUE_STRESS, Band.unknown(BEYOND_CARD), STRESS_FACTOR)
    return replace(
        outcome,
        reason=(
            f"the material's card ends at {material.fatigue.cycles:g} cycles and states no exponent, so its strength "
            f"for {wanted:g} repetitions is not known; ask for at most as many, or add an exponent to the card"
        ),
    )


def _joints(
    moved: CaseMotion, name: str, check: PinCheck | BearingCheck, evaluated: NDArray[np.bool_]
) -> Iterator[CheckOutcome]:
    """Outcome of every joint at the pose of its largest force: all its stresses are in proportion to that force."""
    case, complete = moved.case, bool(evaluated.all())
    asked = case.bearing_joints if isinstance(check, BearingCheck) else case.pinned_joints
    for joint in check.joints or asked:
        for title, solved in moved.forces.items():
            size = np.where(evaluated, np.linalg.norm(solved.forces[joint], axis=1), -np.inf)
            pose = _first_largest(size)
            force = float(size[pose])
            if isinstance(check, BearingCheck):
                eye, factor = weakest_eye(case, name, joint, force, load_scatter(case, title))
                limit, where = check.limit, f"bearing on the eye of {eye} under {force:.3g} N"
            else:
                material = case.pin_material(joint)
                stress = load_scatter(case, title).on(stress_of(case, joint, force).equivalent)
                factor = strength_scatter(material).on(stress.inverse(material.allowable))
                limit = least_safety_factor(name, check.minimum, material, f"{PIN}{joint}")
                where = f"under {force:.3g} N"
            outcome = _outcome(name, f"{PIN}{joint}", title, SAFETY_FACTOR, factor, limit, complete=complete)
            yield replace(outcome, reason=f"{where} at {_when(moved, pose)}: {outcome.reason}")


def _first_largest(values: NDArray[np.float64]) -> int:
    """Number of the first of the largest values: both ends of a turn are one pose, whatever rounding says."""
    return int(np.argmax(values >= values.max() * (1.0 - 1e-9)))


def column_outcomes(
    moved: CaseMotion, loaded: Mapping[str, Sequence[LinkHistory]], evaluated: NDArray[np.bool_]
) -> Iterator[CheckOutcome]:
    """Yield the least buckling factor of every link that is compressed at some pose, and where it is."""
    case, complete = moved.case, bool(evaluated.all())
    for link, histories in loaded.items():
        for history in histories:
            found = factors_over_motion(case, link, history)
            pose = _first_largest(np.where(evaluated, 1.0 / found.value, -np.inf))
            factor, least, most = (float(f[evaluated].min()) for f in (found.value, found.least, found.most))
            if math.isinf(factor):
                continue
            band = factor_band(case.material_of(link), factor, least, most)
            band = load_scatter(case, history.load_case).inverse.on(band)
            outcome = _outcome(BUCKLING, link, history.load_case, BUCKLING_FACTOR, band, 1.0, complete=complete)
            reason = f"{factor:.3g} times the compression at {_when(moved, pose)} buckles it"
            if outcome.verdict is Verdict.UNDECIDED:
                reason += f"; {outcome.reason}"
            elif factor < LEAST_FACTOR and outcome.verdict is Verdict.PASS:
                reason += f"; {grown(factor)}"
            yield replace(outcome, reason=reason)


def _when(moved: CaseMotion, pose: int) -> str:
    return f"{moved.motion.coordinate} = {math.degrees(float(moved.motion.angles[pose])):.5g} deg"


def _scaled(band: Band, factor: float) -> Band:
    return replace(band, value=factor * band.value, low=factor * band.low, high=factor * band.high)


def _outcome(
    name: str, link: str, load_case: str, quantity: str, value: Band, limit: float, *, complete: bool = True
) -> CheckOutcome:
    verdict = at_least(value, limit)
    reason = reason_for(value, limit, verdict)
    if verdict is Verdict.PASS and not complete:
        verdict = Verdict.UNDECIDED
        reason = "poses near a dead point of the driven link were left out, where its torque grows without bound"
    return CheckOutcome(
        name=name,
        link=link,
        load_case=load_case,
        quantity=quantity,
        unit="",
        value=value,
        limit=limit,
        verdict=verdict,
        reason=reason,
    )
