"""From results to verdicts: every check that the case asks for, decided on its band."""

from collections.abc import Mapping

from alula.fea.buckling.linkage import linkage_outcomes
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.frame.joint_forces import JointForces
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.layers import layer_outcomes, unless_built_otherwise
from alula.fea.outcomes.limits import least_safety_factor
from alula.fea.outcomes.pins import PinStress, pin_outcome
from alula.fea.outcomes.point_displacement import point_outcome
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.outcomes.solid_buckling import solid_buckling
from alula.fea.refine.discretisation import Discretisation
from alula.loads.case.case import Case
from alula.loads.records.check_spec import (
    DisplacementCheck,
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
    free: Mapping[str, LinkLoads],
    uneven: Mapping[str, Scatter] | None = None,
    forces: JointForces | None = None,
) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of links, pins and points, and of the linkage's equilibrium, of a load case.

    Bearing is in ``alula.fea.outcomes.bearing``, limit load in ``alula.fea.check.linkage_numbers``, buckling of links
    in ``alula.fea.buckling.buckling``, and what is checked of the linkage as a whole in ``alula.fea.whole``.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    links : mapping of str to LinkResult
    pins : mapping of str to PinStress
        Of every joint whose pin a check asks for.
    moved : LargeDisplacement
    free : mapping of str to LinkLoads
        Loads of every link cut free; empty where equilibrium alone does not give the joint forces.
    uneven : mapping of str to Scatter, optional
        Joint -> how its force grows beside scattered loads (``alula.fea.doubts.load_growth``).
    forces : JointForces, optional
        Where these come from a frame of solids, which tells how far points move as well.

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
            found.append(point_outcome(case, name, check, load_case, moved, links, free, forces))
        elif isinstance(check, SafetyFactorCheck | DisplacementCheck | SustainedCheck):
            found += [_link(case, name, check, load_case, links[link]) for link in check.links or case.checked_links]
    beams = {link: result.beam for link, result in links.items()}
    found += layer_outcomes(case, load_case, links)
    solids = {
        link: (own.least * (1.0 - own.error), own.most)
        for link, result in links.items()
        if (own := solid_buckling(result)) is not None and not own.without
    }
    return (*found, *linkage_outcomes(load_case, moved, beams, solids))


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
    if not result.decided_by and outcome.verdict is not Verdict.UNDECIDED and not result.beam.idle:
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
    return unless_built_otherwise(case, link, _with_meshes(outcome, meshes))


def _with_meshes(outcome: CheckOutcome, meshes: Discretisation | None) -> CheckOutcome:
    """Return an outcome on a link with what its meshes have to do with it where it is open."""
    if meshes is not None and outcome.value.unknowable:
        return outcome.because(meshes.reason)
    if meshes is not None and outcome.verdict is Verdict.UNDECIDED and meshes.stopped:
        return outcome.because(reason("open_for_meshes", found=outcome.reason, why=meshes.stopped))
    return outcome
