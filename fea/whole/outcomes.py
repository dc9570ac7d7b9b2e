"""Every check of the linkage as a whole, in one place."""

from fea.common.verdict import CheckOutcome
from fea.whole.clearance import clearance_outcomes
from fea.whole.motor import motor_outcomes
from loads.case.case import Case
from loads.records.check_spec import MotorCheck
from loads.states.clearance import Clearance


def whole_outcomes(case: Case, apart: Clearance | None) -> dict[str, tuple[CheckOutcome, ...]]:
    """Return the outcomes of the checks of a linkage as a whole, with its links rigid.

    Parameters
    ----------
    case : Case
    apart : Clearance or None
        Its gaps; None where it has no layers.

    Returns
    -------
    dict of str to tuple of CheckOutcome
        Load case -> its outcomes; those that no load changes stand with the first one.
    """
    found: dict[str, list[CheckOutcome]] = {load_case: [] for load_case in case.load_cases}
    for name, check in case.checks.items():
        if isinstance(check, MotorCheck):
            for load_case, outcomes in motor_outcomes(case, name, check).items():
                found[load_case] += outcomes
    found[next(iter(found))] += clearance_outcomes(case, apart)
    return {load_case: tuple(outcomes) for load_case, outcomes in found.items()}
