"""Every number and check of the linkage as a whole, in one place."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from alula.fea.asked.asked import asks, checks_of
from alula.fea.common.verdict import CheckOutcome
from alula.fea.vibration.frequency_outcomes import asked_frequencies, frequency_outcomes
from alula.fea.vibration.over_motion import CaseFrequencies
from alula.fea.whole.clearance import clearance_outcomes
from alula.fea.whole.mass import mass_outcomes
from alula.fea.whole.motor import motor_outcomes
from alula.fea.whole.size import size_outcomes
from alula.geometry.base.model import CaseModel
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.check_spec import ClearanceCheck, FrequencyCheck, MassCheck, MotorCheck, SizeCheck
from alula.loads.states.actions import needs_masses
from alula.loads.states.clearance import Clearance, clearance
from alula.loads.states.extent import Extent, extent
from alula.loads.states.weighed import Weighed, weighed


@dataclass(frozen=True, kw_only=True)
class WholeNumbers:
    """What a linkage is as a whole, and at which frequencies it vibrates.

    Attributes
    ----------
    case : Case
    clearance : Clearance or None
        Its gaps; None where it has no layers.
    mass : Weighed or None
        None where no check asks for it and nothing weighs or moves, so that no part was weighed.
    size : Extent or None
        None where no check asks for it and no layers are stated, so that there are no outlines.
    frequencies : CaseFrequencies or None
        Its natural frequencies with flexible links; None where no check asks for them.
    """

    case: Case
    clearance: Clearance | None = None
    mass: Weighed | None = None
    size: Extent | None = None
    frequencies: CaseFrequencies | None = None


KINDS: dict[type[CaseModel], Callable[[WholeNumbers], Iterable[CheckOutcome]]] = {
    ClearanceCheck: lambda found: clearance_outcomes(found.case, found.clearance),
    MassCheck: lambda found: mass_outcomes(found.case, found.mass),
    SizeCheck: lambda found: size_outcomes(found.case, found.size),
    FrequencyCheck: lambda found: frequency_outcomes(found.frequencies),
}
"""Kind of check -> its outcomes; of those that do not come from loads, in a pose and over a motion alike."""


def whole_numbers(case: Case, pose: Pose | None = None, *, solids: bool = False, threads: int = 2) -> WholeNumbers:
    """Return gaps, mass, size and frequencies of a linkage, as far as a check asks for them or they come at no cost.

    Parameters
    ----------
    case : Case
    pose : Pose, optional
        The stated one, or where the linkage balances if it is let go; assembled anew when left out.
    solids : bool, optional
        True where solids may decide on the frequencies of links that their beams leave open.
    threads : int, optional
        Of each library.

    Returns
    -------
    WholeNumbers

    Raises
    ------
    CaseError
        As ``clearance``, ``weighed`` and ``extent``.
    """
    pose = pose or case.solve_pose()
    apart = clearance(case, pose)
    measures = apart is not None or asks(case, SizeCheck)
    return WholeNumbers(
        case=case,
        clearance=apart,
        mass=weighed(case, pose) if needs_masses(case) or asks(case, MassCheck) else None,
        size=extent(case, pose, apart) if measures else None,
        frequencies=asked_frequencies(case, solids=solids, threads=threads),
    )


def unloaded_outcomes(found: WholeNumbers) -> Iterator[CheckOutcome]:
    """Yield the outcomes that do not come from loads: of the first load case, or of those with a speed.

    Parameters
    ----------
    found : WholeNumbers

    Yields
    ------
    CheckOutcome
    """
    for outcomes in KINDS.values():
        yield from outcomes(found)


def whole_outcomes(found: WholeNumbers) -> dict[str, tuple[CheckOutcome, ...]]:
    """Return the outcomes of the checks of a linkage as a whole.

    Parameters
    ----------
    found : WholeNumbers

    Returns
    -------
    dict of str to tuple of CheckOutcome
        Load case -> its outcomes; those that no load changes stand with the first one.
    """
    case = found.case
    outcomes: dict[str, list[CheckOutcome]] = {load_case: [] for load_case in case.load_cases}
    for name, check in checks_of(case, MotorCheck):
        for load_case, own in motor_outcomes(case, name, check).items():
            outcomes[load_case] += own
    for outcome in unloaded_outcomes(found):
        outcomes[outcome.load_case].append(outcome)
    return {load_case: tuple(own) for load_case, own in outcomes.items()}
