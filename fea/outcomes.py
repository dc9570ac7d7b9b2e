"""From results to verdicts: every check that the case asks for, decided on its band."""

from collections.abc import Iterator, Mapping

from fea.band import Band
from fea.buckling_check import linkage_outcome
from fea.large_displacement import LargeDisplacement
from fea.pins import PinStress
from fea.result import LinkResult
from fea.verdict import LINKAGE, LOAD_SHARE, PIN, SAFETY_FACTOR, CheckOutcome, Verdict, at_least, at_most
from geometry.errors import CaseError
from geometry.material import Material
from loads.case import Case
from loads.check_spec import BearingCheck, DisplacementCheck, MotorCheck, PinCheck, SafetyFactorCheck, SustainedCheck

LARGE_DISPLACEMENT = "large displacement"


def outcomes(
    case: Case,
    title: str,
    links: Mapping[str, LinkResult],
    pins: Mapping[str, PinStress],
    moved: LargeDisplacement,
) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of a load case called ``title``, but for motors, bearing and links' buckling.

    These are in ``fea.motor_check``, ``fea.bearing_check`` and ``fea.buckling_check``.

    Raises ``CaseError`` where neither check nor material states a limit.
    """
    found: list[CheckOutcome] = []
    for name, check in case.all_checks.items():
        if isinstance(check, PinCheck):
            found += _pins(case, name, check, title, pins)
        elif not isinstance(check, MotorCheck | BearingCheck):
            found += [_link(case, name, check, title, links[link]) for link in check.links or case.checked_links]
    found += _large_displacement(title, moved)
    found += linkage_outcome(case, title, moved)
    return tuple(found)


def _link(
    case: Case, name: str, check: SafetyFactorCheck | DisplacementCheck | SustainedCheck, title: str, result: LinkResult
) -> CheckOutcome:
    material = case.material_of(result.link)
    if isinstance(check, SafetyFactorCheck):
        limit = least_safety_factor(name, check.minimum, material, result.link)
        quantity, unit, value = SAFETY_FACTOR, "", result.safety_factor
        verdict = at_least(value, limit)
    elif isinstance(check, SustainedCheck):
        assert material.sustained_stress is not None
        limit = material.sustained_stress
        quantity, unit = "sustained stress", "MPa"
        value = result.principal_max if material.brittle else result.von_mises_max
        verdict = at_most(value, limit)
    else:
        limit = check.maximum
        quantity, unit, value = "displacement", "mm", result.displacement_max
        verdict = at_most(value, limit)
    forced = result.fidelity == "beam" and not result.decided_by
    if forced and verdict is Verdict.PASS and result.beam.worst.equivalent > 0.0:
        verdict = Verdict.UNDECIDED
        reason = "beam theory leaves stress concentration out, so it cannot pass a link; run the solid model"
    else:
        reason = _why(result, value, limit, verdict)
    return CheckOutcome(
        name=name,
        link=result.link,
        load_case=title,
        quantity=quantity,
        unit=unit,
        value=value,
        limit=limit,
        verdict=verdict,
        reason=reason,
    )


def _pins(case: Case, name: str, check: PinCheck, title: str, pins: Mapping[str, PinStress]) -> Iterator[CheckOutcome]:
    for joint in check.joints or case.pinned_joints:
        material = case.pin_material(joint)
        limit = least_safety_factor(name, check.minimum, material, f"{PIN}{joint}")
        value = pins[joint].equivalent.inverse(material.allowable)
        verdict = at_least(value, limit)
        yield CheckOutcome(
            name=name,
            link=f"{PIN}{joint}",
            load_case=title,
            quantity=SAFETY_FACTOR,
            unit="",
            value=value,
            limit=limit,
            verdict=verdict,
            reason=reason_for(value, limit, verdict),
        )


def _large_displacement(title: str, moved: LargeDisplacement) -> Iterator[CheckOutcome]:
    if not moved.followed:
        return
    yield CheckOutcome(
        name=LARGE_DISPLACEMENT,
        link=LINKAGE,
        load_case=title,
        quantity=LOAD_SHARE,
        unit="",
        value=Band.exact(moved.held, "equilibrium on the deformed shape, followed from no load"),
        limit=1.0,
        verdict=Verdict.PASS if moved.state == "deformed" else Verdict.FAIL,
        reason=moved.sentence,
    )


def least_safety_factor(name: str, stated: float | None, material: Material, what: str) -> float:
    """Return the limit that a check states, else the material's; raises ``CaseError`` where neither is there."""
    limit = stated or material.minimum_safety_factor
    if limit is None:
        raise CaseError(f"checks.{name}.minimum: the material of '{what}' has no default; state the limit")
    return limit


def stress_limits(case: Case, link: str) -> tuple[float, ...]:
    """Limits [MPa] on a link's deciding stress, of all checks; raises ``CaseError`` where one is not stated."""
    material, found = case.material_of(link), []
    for name, check in case.all_checks.items():
        if isinstance(check, SafetyFactorCheck | SustainedCheck) and link in (check.links or case.checked_links):
            if isinstance(check, SafetyFactorCheck):
                found.append(material.allowable / least_safety_factor(name, check.minimum, material, link))
            elif material.sustained_stress is not None:
                found.append(material.sustained_stress)
    return tuple(found)


def displacement_limits(case: Case, link: str) -> tuple[float, ...]:
    """Limits [mm] on a link's displacement, of all checks."""
    return tuple(
        check.maximum
        for check in case.all_checks.values()
        if isinstance(check, DisplacementCheck) and link in (check.links or case.checked_links)
    )


def _why(result: LinkResult, value: Band, limit: float, verdict: Verdict) -> str:
    """Reason of a verdict on a link, with what its meshes have to do with it where it is open."""
    meshes = result.discretisation
    if value.unknowable and meshes is not None:
        return meshes.sentence
    reason = reason_for(value, limit, verdict)
    if verdict is Verdict.UNDECIDED and meshes is not None and meshes.stopped:
        return f"{reason}; the meshes were refined no further since {meshes.stopped}"
    return reason


def reason_for(value: Band, limit: float, verdict: Verdict) -> str:
    """Say in a few words why a band gives its verdict."""
    band = f"its band {value.low:.3g} to {value.high:.3g}"
    if verdict is Verdict.UNDECIDED:
        return f"{band} straddles the limit {limit:g}"
    side = "on the safe side" if verdict is Verdict.PASS else "on the wrong side"
    return f"{band} lies wholly {side} of the limit {limit:g}"
