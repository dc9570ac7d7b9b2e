"""From results to verdicts: every check that the case asks for, decided on its band."""

from collections.abc import Mapping

import numpy as np

from fea.common.band import Band
from fea.common.scatter import Scatter, compliance_scatter, load_scatter
from fea.common.source import Source, SourceKind, distinct
from fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from fea.frame.displacement_band import point_bounds
from fea.frame.large_displacement import LARGE, LargeDisplacement, displaced
from fea.frame.stability import SNAP, growth
from fea.outcomes.layers import layer_outcomes
from fea.outcomes.limits import least_safety_factor
from fea.outcomes.linkage import linkage_outcomes
from fea.outcomes.pins import PinStress, pin_outcome
from fea.outcomes.result import LinkResult, SolidResult
from fea.refine.discretisation import Discretisation
from loads.case.case import Case
from loads.records.check_spec import (
    BearingCheck,
    DisplacementCheck,
    MotorCheck,
    PinCheck,
    SafetyFactorCheck,
    SustainedCheck,
)


def outcomes(
    case: Case,
    load_case: str,
    links: Mapping[str, LinkResult],
    pins: Mapping[str, PinStress],
    moved: LargeDisplacement,
    uneven: Mapping[str, Scatter] | None = None,
) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of a load case, but for motors, bearing and links' buckling.

    These are in ``fea.outcomes.motor``, ``fea.outcomes.bearing`` and ``fea.outcomes.buckling``.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    links : mapping of str to LinkResult
    pins : mapping of str to PinStress
        Of every joint whose pin a check asks for.
    moved : LargeDisplacement
    uneven : mapping of str to Scatter, optional
        Joint -> how its force grows beside scattered loads (``fea.check.load_growth``).

    Returns
    -------
    tuple of CheckOutcome

    Raises
    ------
    CaseError
        Where neither check nor material states a limit.
    """
    found: list[CheckOutcome] = []
    for name, check in case.all_checks.items():
        if isinstance(check, PinCheck):
            found += [
                pin_outcome(case, load_case, name, check, joint, pins[joint], (uneven or {}).get(joint))
                for joint in check.joints or case.pinned_joints
            ]
        elif isinstance(check, DisplacementCheck) and check.at is not None:
            found.append(_point(case, name, check, load_case, moved))
        elif not isinstance(check, MotorCheck | BearingCheck):
            found += [_link(case, name, check, load_case, links[link]) for link in check.links or case.checked_links]
    beams = {link: result.beam for link, result in links.items()}
    found += layer_outcomes(case, load_case, links)
    return (*found, *linkage_outcomes(case, load_case, moved, beams))


def _link(
    case: Case,
    name: str,
    check: SafetyFactorCheck | DisplacementCheck | SustainedCheck,
    load_case: str,
    result: LinkResult,
) -> CheckOutcome:
    material, meshes = case.material_of(result.link), result.discretisation if isinstance(result, SolidResult) else None
    if isinstance(check, SafetyFactorCheck):
        outcome = safety_factor_outcome(case, name, check, load_case, result.link, result.safety_factor, meshes)
    else:
        quantity, limit, value = Quantity.DEFLECTION, 0.0, result.displacement_max
        if isinstance(check, SustainedCheck):
            assert material.sustained_stress is not None
            quantity, limit, value = Quantity.SUSTAINED_STRESS, material.sustained_stress, result.decisive
        else:
            limit = check.maximum
        outcome = CheckOutcome.of(name, Subject.link(result.link), load_case, quantity, value, limit)
        outcome = _with_meshes(outcome, meshes)
    if not result.decided_by and outcome.verdict is not Verdict.UNDECIDED and result.beam.worst.equivalent > 0.0:
        return outcome.left_open(result.why)
    return outcome


def safety_factor_outcome(
    case: Case,
    name: str,
    check: SafetyFactorCheck,
    load_case: str,
    link: str,
    factor: Band,
    meshes: Discretisation | None,
) -> CheckOutcome:
    """Return the outcome of a link's safety factor.

    Parameters
    ----------
    case : Case
    name : str
        Of the check.
    check : SafetyFactorCheck
    load_case : str
        Its name.
    link : str
    factor : Band
        Of one pose, or the least of a motion.
    meshes : Discretisation or None
        What the meshes of the link leave open; None where hand calculation gave the factor.

    Returns
    -------
    CheckOutcome

    Raises
    ------
    CaseError
        Where neither check nor material states a limit.
    """
    limit = least_safety_factor(name, check.minimum, case.material_of(link), link)
    outcome = CheckOutcome.of(name, Subject.link(link), load_case, Quantity.SAFETY_FACTOR, factor, limit)
    return _with_meshes(outcome, meshes)


def _with_meshes(outcome: CheckOutcome, meshes: Discretisation | None) -> CheckOutcome:
    """Return an outcome on a link with what its meshes have to do with it where it is open."""
    if meshes is not None and outcome.value.unknowable:
        return outcome.because(meshes.sentence)
    if meshes is not None and outcome.verdict is Verdict.UNDECIDED and meshes.stopped:
        return outcome.because(f"{outcome.reason}; refinement ended because {meshes.stopped}")
    return outcome


def _point(case: Case, name: str, check: DisplacementCheck, load_case: str, moved: LargeDisplacement) -> CheckOutcome:
    """Outcome of how far a point of the linkage moves, by the frame: linear, or on the deformed shape where that rules.

    Its band is that of ``_point_band``.
    """
    link, point = case.displaced_point(name, check)
    displacement, factor, value = moved.points.get((link, point)), moved.factor, Band.unknown()
    why = f"the frame gives no displacement: {moved.sentence}"
    if displacement is not None and moved.state in ("small", "deformed", "off"):
        size = float(np.linalg.norm(displacement))
        near = factor is not None and factor < SNAP
        blind = [other for other in case.checked_links if not case.part_of(other).has_centre_line(case.body(other))]
        if blind:
            why = f"the frame takes link {blind[0]} for a beam along its axis, which does not tell how far it gives"
        elif moved.followed or not (near or size > LARGE * moved.span):
            value, why = _point_band(case, load_case, moved, link, point, size), ""
        else:
            far = f"moves it by {size:.3g} mm, above {100.0 * LARGE:g} % of the span"
            what = f"may give way at {factor:.3g} times the load or less, below {SNAP:.3g}" if near else far
            why = f"the linear frame {what}, so it is not valid; remove large_displacement = off from the case"
    subject = Subject.point(point, link)
    found = CheckOutcome.of(name, subject, load_case, Quantity.DISPLACEMENT, value, check.maximum, why)
    if why:
        return found
    shape = "on its deformed shape" if moved.followed else "by linear theory"
    notes = () if moved.frame is None else moved.frame.notes
    return found.because("; ".join([f"by the frame of the linkage, {shape}: {found.reason}", *notes]))


def _point_band(case: Case, load_case: str, moved: LargeDisplacement, link: str, point: str, size: float) -> Band:
    """Band of how far a point moves: eyes, bores and holes (``fea.frame.displacement_band``), the moduli, and the load.

    The linear answer may grow as a toggle does (``fea.frame.stability``); on the deformed shape equilibrium is sought
    again with the ends of load over stiffness.
    """
    assert moved.frame is not None
    assert moved.solution is not None
    load, frame = load_scatter(case, load_case), moved.frame
    materials = [case.material_of(other) for other in case.checked_links]
    ratios = [m.youngs_modulus / e for m in materials for e in (m.youngs_modulus_range or ())]
    linear = float(np.linalg.norm(moved.solution.displacements[frame.points[link, point], :3]))
    least, largest = point_bounds(case, frame, moved.solution, link, point)
    low, high = (least / linear, largest / linear) if linear > 0.0 else (1.0, 1.0)
    low, high = low * min((*ratios, 1.0)) * load.low, high * max((*ratios, 1.0)) * load.high
    moduli = (compliance_scatter(material).sources for material in materials)
    sources = distinct((Source(kind=SourceKind.EYES),), *moduli, load.sources)
    if moved.followed:
        ends = [displaced(frame, link, point, factor) for factor in (low, high) if factor > 0.0]
        return Band(value=size, low=min(size, *ends) if low > 0.0 else 0.0, high=max(size, *ends), sources=sources)
    near_by = 0.0 if moved.factor is None else high / moved.factor
    grown = growth(1.0 / near_by) if near_by > 0.0 else 1.0
    most = high * grown * size if size > 0.0 else 0.0
    grows = Source(kind=SourceKind.GROWTH, detail="towards buckling or a dead point")
    return Band(value=size, low=low * size, high=most, sources=(*sources, grows))
