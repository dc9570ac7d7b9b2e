"""From results to verdicts: every check that the case asks for, decided on its band."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from fea.beam.theory import BeamCheck
from fea.common.band import Band
from fea.common.scatter import Scatter, compliance_scatter, load_scatter, strength_scatter
from fea.common.verdict import LINKAGE, LOAD_SHARE, PIN, POINT, SAFETY_FACTOR, CheckOutcome, Verdict, at_least, at_most
from fea.frame.displacement_band import point_bounds
from fea.frame.large_displacement import LARGE, LargeDisplacement, displaced
from fea.frame.toggle import SNAP, growth
from fea.outcomes.buckling import beyond_strength, linkage_outcome
from fea.outcomes.pins import PinStress
from fea.outcomes.result import LinkResult
from geometry.base.errors import CaseError
from geometry.parts.material import Material
from loads.case.case import Case
from loads.records.check_spec import (
    BearingCheck,
    DisplacementCheck,
    MotorCheck,
    PinCheck,
    SafetyFactorCheck,
    SustainedCheck,
)

LARGE_DISPLACEMENT = "large displacement"
DEFLECTION = "deflection from its pins"
"""Of a link by itself: displacement from the line through its own pins, as if these stayed."""
DISPLACEMENT = "displacement"
"""Of a point, with the whole linkage."""


def outcomes(
    case: Case,
    title: str,
    links: Mapping[str, LinkResult],
    pins: Mapping[str, PinStress],
    moved: LargeDisplacement,
    uneven: Mapping[str, Scatter] | None = None,
) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of a load case called ``title``, but for motors, bearing and links' buckling.

    uneven  joint -> how its force grows beside scattered loads (``fea.check.load_growth``)

    These are in ``fea.outcomes.motor``, ``fea.outcomes.bearing`` and ``fea.outcomes.buckling``.

    Raises ``CaseError`` where neither check nor material states a limit.
    """
    found: list[CheckOutcome] = []
    for name, check in case.all_checks.items():
        if isinstance(check, PinCheck):
            found += _pins(case, name, check, title, pins, uneven or {})
        elif isinstance(check, DisplacementCheck) and check.at is not None:
            found.append(_point(case, name, check, title, moved))
        elif not isinstance(check, MotorCheck | BearingCheck):
            found += [_link(case, name, check, title, links[link]) for link in check.links or case.checked_links]
    beams = {link: result.beam for link, result in links.items()}
    found += _large_displacement(title, moved, beams)
    found += linkage_outcome(case, title, moved, beams)
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
        quantity, unit, value = DEFLECTION, "mm", result.displacement_max
        verdict = at_most(value, limit)
    forced = result.fidelity == "beam" and not result.decided_by
    if forced and verdict is not Verdict.UNDECIDED and result.beam.worst.equivalent > 0.0:
        verdict = Verdict.UNDECIDED
        reason = result.why
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


def _point(case: Case, name: str, check: DisplacementCheck, title: str, moved: LargeDisplacement) -> CheckOutcome:
    """Outcome of how far a point of the linkage moves, by the frame: linear, or on the deformed shape where that rules.

    Its band is that of ``_point_band``.
    """
    link, point = case.displaced_point(name, check)
    displacement, factor = moved.points.get((link, point)), moved.factor
    value, limit = Band.unknown(), check.maximum
    why = f"the frame does not tell how far it moves: {moved.sentence}"
    if displacement is not None and moved.state in ("small", "deformed", "off"):
        size = float(np.linalg.norm(displacement))
        near = factor is not None and factor < SNAP
        if moved.followed or not (near or size > LARGE * moved.span):
            value = _point_band(case, title, moved, link, point, size)
            shape = "on its deformed shape" if moved.followed else "by linear theory"
            why = f"by the frame of the linkage, {shape}: {reason_for(value, limit, at_most(value, limit))}"
            why += "".join(f"; {note}" for note in ([] if moved.frame is None else moved.frame.notes))
        else:
            far = f"moves it by {size:.3g} mm, above {100.0 * LARGE:g} % of the span"
            what = f"may give way at {factor:.3g} times the load or less, below {SNAP:.3g}" if near else far
            why = f"the linear frame {what}, so it does not hold; take large_displacement = off out of the case"
    return CheckOutcome(
        name=name,
        link=f"{POINT}{point} of {link}",
        load_case=title,
        quantity=DISPLACEMENT,
        unit="mm",
        value=value,
        limit=limit,
        verdict=at_most(value, limit),
        reason=why,
    )


def _point_band(case: Case, title: str, moved: LargeDisplacement, link: str, point: str, size: float) -> Band:
    """Band of how far a point moves: eyes, bores and holes (``fea.frame.displacement_band``), the moduli, and the load.

    The linear answer may grow as a toggle does (``fea.frame.toggle``); on the deformed shape equilibrium is sought
    again with the ends of load over stiffness.
    """
    assert moved.frame is not None
    assert moved.solution is not None
    load, frame = load_scatter(case, title), moved.frame
    materials = [case.material_of(other) for other in case.checked_links]
    ratios = [m.youngs_modulus / e for m in materials for e in (m.youngs_modulus_range or ())]
    linear = float(np.linalg.norm(moved.solution.displacements[frame.points[link, point], :3]))
    least, largest = point_bounds(case, frame, moved.solution, link, point)
    low, high = (least / linear, largest / linear) if linear > 0.0 else (1.0, 1.0)
    low, high = low * min((*ratios, 1.0)) * load.low, high * max((*ratios, 1.0)) * load.high
    holds = ("eyes, bores and holes", "the modulus", *load.holds)
    if moved.followed:
        ends = [displaced(frame, link, point, factor) for factor in (low, high) if factor > 0.0]
        return Band(value=size, low=min(size, *ends) if low > 0.0 else 0.0, high=max(size, *ends), holds=holds)
    near_by = 0.0 if moved.factor is None else high / moved.factor
    grown = growth(1.0 / near_by) if near_by > 0.0 else 1.0
    most = high * grown * size if size > 0.0 else 0.0
    return Band(value=size, low=low * size, high=most, holds=(*holds, "growth towards buckling or a dead point"))


def _pins(
    case: Case,
    name: str,
    check: PinCheck,
    title: str,
    pins: Mapping[str, PinStress],
    uneven: Mapping[str, Scatter],
) -> Iterator[CheckOutcome]:
    for joint in check.joints or case.pinned_joints:
        material = case.pin_material(joint)
        limit = least_safety_factor(name, check.minimum, material, f"{PIN}{joint}")
        stress = load_scatter(case, title).times(uneven.get(joint, Scatter())).on(pins[joint].equivalent)
        value = strength_scatter(material).on(stress.inverse(material.allowable))
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


def _large_displacement(title: str, moved: LargeDisplacement, beams: Mapping[str, BeamCheck]) -> Iterator[CheckOutcome]:
    """Outcome of the linkage where its equilibrium was followed on the deformed shape: its one limit load."""
    if not moved.followed:
        return
    value = moved.held_band
    verdict = at_least(value, 1.0)
    open_end = f"; {reason_for(value, 1.0, verdict)}" if verdict is Verdict.UNDECIDED else ""
    linear = moved.buckling is not None and math.isfinite(moved.buckling)
    informs = f"; for information, its buckling factor by linear theory is {moved.buckling:.3g}" if linear else ""
    yield CheckOutcome(
        name=LARGE_DISPLACEMENT,
        link=LINKAGE,
        load_case=title,
        quantity=LOAD_SHARE,
        unit="",
        value=value,
        limit=1.0,
        verdict=verdict,
        reason=moved.sentence + open_end + informs + beyond_strength(beams),
    )


def least_safety_factor(name: str, stated: float | None, material: Material, what: str) -> float:
    """Return the limit that a check states, else the material's; raises ``CaseError`` where neither is there."""
    limit = stated or material.minimum_safety_factor
    if limit is None:
        raise CaseError(f"checks.{name}.minimum: the material of '{what}' has no default; state the limit")
    return limit


def stress_limits(case: Case, link: str) -> tuple[tuple[float, float], ...]:
    """Limits [MPa] on a link's deciding stress, of all checks, each from the least to the largest by stated scatter.

    Raises ``CaseError`` where one is not stated.
    """
    material, load, found = case.material_of(link), _widest_load(case), []
    for name, check in case.all_checks.items():
        if isinstance(check, SafetyFactorCheck | SustainedCheck) and link in (check.links or case.checked_links):
            if isinstance(check, SafetyFactorCheck):
                limit = material.allowable / least_safety_factor(name, check.minimum, material, link)
                found.append(_spread(limit, strength_scatter(material).times(load.inverse)))
            elif material.sustained_stress is not None:
                found.append(_spread(material.sustained_stress, load.inverse))
    return tuple(found)


def displacement_limits(case: Case, link: str) -> tuple[tuple[float, float], ...]:
    """Limits [mm] on a link's displacement from the line through its pins, of all checks, as ``stress_limits``."""
    scatter = compliance_scatter(case.material_of(link)).times(_widest_load(case))
    return tuple(
        _spread(check.maximum, scatter.inverse)
        for check in case.all_checks.values()
        if isinstance(check, DisplacementCheck) and check.at is None and link in (check.links or case.checked_links)
    )


def _widest_load(case: Case) -> Scatter:
    """Return the widest scatter of any load case: a link's meshes serve all of them."""
    every = [load_scatter(case, title) for title in case.load_cases]
    return Scatter(low=min(one.low for one in every), high=max(one.high for one in every))


def _spread(limit: float, scatter: Scatter) -> tuple[float, float]:
    return limit * scatter.low, limit * scatter.high


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
