"""Whether a linkage weighs no more than it may."""

from alula.fea.asked.asked import GRAMS, asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import play_source
from alula.fea.common.verdict import CheckOutcome
from alula.loads.case.case import Case
from alula.loads.records.check_spec import MassCheck
from alula.loads.states.masses import masses_by_holes
from alula.loads.states.weighed import Weighed


def mass_outcomes(case: Case, found: Weighed | None) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of mass, in the name of the first load case: no load changes it.

    Parameters
    ----------
    case : Case
    found : Weighed or None
        What the linkage weighs; None where no check asks for it.

    Returns
    -------
    tuple of CheckOutcome
    """
    if found is None:
        return ()
    outcomes = []
    for one in asked(case, MassCheck):
        others = one.check.others if isinstance(one.check, MassCheck) else None
        whole = found.total.total + (others or 0.0)
        ends = [GRAMS * (whole - found.total.part + parts) for parts in masses_by_holes(case)]
        holes = (play_source(case.linkage.plays),) if ends[0] < ends[1] else ()
        total = Band.around(GRAMS * whole, (GRAMS * whole, *ends), *holes)
        outcomes.append(one.for_all(case, total, mass_reason(found, others)))
    return tuple(outcomes)


def mass_reason(found: Weighed, others: float | None = None) -> Reason:
    """Tell what a linkage's mass is made up of, and what is not counted.

    Parameters
    ----------
    found : Weighed
    others : float, optional
        Mass of what the case does not model, as stated [tonne].

    Returns
    -------
    Reason
        Masses in grams.
    """
    total = found.total
    kinds = (("parts", total.part), ("pins", total.pins), ("carried", total.carried))
    return reason(
        "made_up_of",
        masses=[reason("mass_of_kind", kind=kind, mass=GRAMS * mass) for kind, mass in kinds if mass > 0.0],
        others=None if others is None else GRAMS * others,
        not_counted=tuple(found.not_counted),
    )
