"""Whether a linkage weighs no more than it may."""

from alula.fea.common.band import Band
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
            mass_sentence(found, check.others),
        )
        for name, check in case.checks.items()
        if isinstance(check, MassCheck) and found is not None
    )


def mass_sentence(found: Weighed, others: float | None = None) -> str:
    """Say what a linkage's mass is made up of, and what is not counted.

    Parameters
    ----------
    found : Weighed
    others : float, optional
        Mass of what the case does not model, as stated [tonne].

    Returns
    -------
    str
    """
    total, left = found.total, ", ".join(found.not_counted)
    kinds = (("parts", total.part), ("pins", total.pins), ("carried", total.carried))
    told = ", ".join(f"{kind} {GRAMS * mass:.4g} g" for kind, mass in kinds if mass > 0.0) or "no part weighs anything"
    if others is not None:
        return f"{told}, others as stated {GRAMS * others:.4g} g{f', which stand for {left}' if left else ''}"
    return f"{told}{f'; not counted: {left}' if left else ''}"
