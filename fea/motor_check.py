"""Whether a motor covers what the mechanism draws: drive power over the motion against the motor's output."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fea.band import Band
from fea.verdict import DRIVE_POWER, CheckOutcome, Verdict, at_most
from loads.case import Case
from loads.case_motion import CaseMotion, solve_case_motion
from loads.check_spec import MotorCheck

Real = NDArray[np.float64]
HOLDS = ("from the mean of the positive power (a flywheel lends the rest) to its peak",)


@dataclass(frozen=True, kw_only=True)
class MotorDemand:
    """What a load case asks of the drive over its motion.

    peak_power           greatest drive power [W]
    mean_positive_power  its positive part on average over time [W]: the work to speed the links up and lift
                         them, where nothing stores what they give back
    peak_torque          greatest size of the drive torque [N mm]
    """

    peak_power: float
    mean_positive_power: float
    peak_torque: float


def demand(power: Real, torque: Real, times: Real) -> MotorDemand:
    """Return the demand from power [N mm/s] and torque [N mm] at the times [s] of a motion."""
    positive = np.maximum(power, 0.0)
    mean = float(np.trapezoid(positive, times)) / float(times[-1] - times[0])
    return MotorDemand(
        peak_power=float(positive.max()) / 1000.0,
        mean_positive_power=mean / 1000.0,
        peak_torque=float(np.abs(torque).max()),
    )


def motor_outcomes(case: Case, name: str, check: MotorCheck) -> dict[str, CheckOutcome]:
    """Judge every load case with a speed of its own; by load case.

    The drive power of the laden linkage is that of the empty one and a part proportional to what it carries,
    so that the largest load of that distribution which the motor drives follows as well.
    """
    moving = {title: load_case for title, load_case in case.load_cases.items() if load_case.speed != 0.0}
    empty_cases = {title: load_case.model_copy(update={"carried": False}) for title, load_case in moving.items()}
    laden = solve_case_motion(case.model_copy(update={"load_cases": moving}))
    empty = solve_case_motion(case.model_copy(update={"load_cases": empty_cases})) if case.carried else laden
    return {title: _outcome(case, name, check, title, laden, empty) for title in moving}


def _outcome(
    case: Case, name: str, check: MotorCheck, title: str, laden: CaseMotion, empty: CaseMotion
) -> CheckOutcome:
    solved = laden.forces[title]
    times = replace(laden.motion, speed=solved.motion.speed, acceleration=solved.motion.acceleration).times
    assert times is not None
    found = demand(solved.drive_power, solved.torque, times)
    limit = check.output_power
    value = Band(value=found.peak_power, low=found.mean_positive_power, high=found.peak_power, holds=HOLDS)
    verdict = at_most(value, limit)
    side = {
        Verdict.PASS: "the motor's output covers its peak",
        Verdict.FAIL: "the motor's output stays below its mean",
        Verdict.UNDECIDED: "the motor covers its mean but not its peak, so a flywheel decides",
    }[verdict]
    reason = (
        f"the drive asks for {found.peak_torque:.3g} N·mm and {found.peak_power:.3g} W at most, "
        f"{found.mean_positive_power:.3g} W on average; {side}, "
        f"{check.voltage:g} V × {check.current * 1e3:g} mA × {check.efficiency:g} = {limit:.3g} W"
    )
    if case.load_cases[title].carried and case.carried:
        bare = empty.forces[title].drive_power
        factor = largest_factor(bare, solved.drive_power - bare, 1000.0 * limit)
        carried = 1e6 * sum(mass.mass for mass in case.carried)
        if 0.0 < factor < math.inf:
            reason += f"; it drives up to {factor * carried:.3g} g of carried mass, where {carried:.3g} g are carried"
    return CheckOutcome(
        name=name,
        link=laden.drive.link,
        load_case=title,
        quantity=DRIVE_POWER,
        unit="W",
        value=value,
        limit=limit,
        verdict=verdict,
        reason=reason,
    )


def largest_factor(bare: Real, load: Real, limit: float) -> float:
    """Return the largest k with max(bare + k load) <= limit; 0 where even the bare linkage exceeds it."""
    if bare.max() > limit:
        return 0.0
    rising = load > 0.0
    return float(np.min((limit - bare[rising]) / load[rising])) if rising.any() else math.inf
