"""From results to verdicts: every check that the case asks for, decided on its band."""

from collections.abc import Mapping

from alula.fea.asked.asked import Asked, asked
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.judging.layers import layer_outcomes, unless_built_otherwise, with_meshes
from alula.fea.judging.linkage import linkage_outcomes
from alula.fea.judging.solid_buckling import solid_buckling
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.pins import PinStress, pin_outcome
from alula.fea.outcomes.point_displacement import point_outcome
from alula.fea.outcomes.point_shares import LoadedLinkage
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.refine.discretisation import Discretisation
from alula.fea.standing.joint_forces import JointForces
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

    Bearing is in ``alula.fea.judging.bearing``, limit load in ``alula.fea.judging.linkage_numbers``, buckling of links
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
    loaded = LoadedLinkage(case=case, load_case=load_case, moved=moved, links=links, free=free, forces=forces)
    found: list[CheckOutcome] = []
    for one in asked(case, SafetyFactorCheck, DisplacementCheck, SustainedCheck, PinCheck):
        name = one.subject.name
        if isinstance(one.check, PinCheck):
            found.append(pin_outcome(case, load_case, one, pins[name], (uneven or {}).get(name)))
        elif one.quantity is Quantity.DISPLACEMENT:
            found.append(point_outcome(loaded, one))
        else:
            found.append(of_link(case, load_case, one, links[name]))
    beams = {link: result.beam for link, result in links.items()}
    found += layer_outcomes(case, load_case, links)
    solids = {
        link: (own.least * (1.0 - own.error), own.most)
        for link, result in links.items()
        if (own := solid_buckling(result)) is not None and not own.without
    }
    return (*found, *linkage_outcomes(load_case, moved, beams, solids))


def of_link(case: Case, load_case: str, one: Asked, result: LinkResult) -> CheckOutcome:
    """Return the outcome of what is asked of the result of a link.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        A safety factor, a deflection or a sustained stress.
    result : LinkResult

    Returns
    -------
    CheckOutcome
        Open where no model decided the link.
    """
    bands = {
        Quantity.SAFETY_FACTOR: result.safety_factor,
        Quantity.DEFLECTION: result.displacement_max,
        Quantity.SUSTAINED_STRESS: result.decisive,
    }
    meshes = result.discretisation if isinstance(result, SolidResult) else None
    outcome = link_outcome(case, load_case, one, bands[one.quantity], meshes)
    if not result.decided_by and outcome.verdict is not Verdict.UNDECIDED and not result.beam.idle:
        return outcome.left_open(result.why)
    return outcome


def link_outcome(case: Case, load_case: str, one: Asked, value: Band, meshes: Discretisation | None) -> CheckOutcome:
    """Return the outcome of what is asked of a link by itself.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
    value : Band
        Of one pose, or the worst of a motion.
    meshes : Discretisation or None
        What the meshes of the link leave open; None where hand calculation gave the number.

    Returns
    -------
    CheckOutcome
    """
    return unless_built_otherwise(case, one.subject.name, with_meshes(one.outcome(load_case, value), meshes))
