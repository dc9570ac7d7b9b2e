"""Whether a linkage weighs no more than it may."""

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity
from alula.loads.case.case import Case
from alula.loads.records.check_spec import MassCheck
from alula.loads.states.weighed import Weighed

GRAMS = 1e6
"""In a tonne."""


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
    load_case = next(iter(case.load_cases))
    return tuple(
        CheckOutcome.of(
            name,
            LINKAGE,
            load_case,
            Quantity.MASS,
            Band.exact(GRAMS * (found.total.total + (check.others or 0.0))),
            GRAMS * check.maximum,
            mass_reason(found, check.others),
        )
        for name, check in case.checks.items()
        if isinstance(check, MassCheck) and found is not None
    )


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
