"""Whether a motor covers what the mechanism asks for over its motion: power, and speed and torque where it states them.

A motor that turns evenly with a flywheel gives the mean of all power, for the flywheel lends what is above it and takes
what is below, negative power too; a motor alone gives the peak. So the mean and the peak are the ends of a band. Play
of pins moves both: each is taken with the drive torque at either end of what play makes of it, at all poses together.
So does the air on wings that flap: each is taken at either end of the range of C_N, of which the mean is an affine and
the peak a convex function. And so does friction, at either end of what it may be (``alula.fea.standing.rubbing``). All
of it is in proportion to the loads of a load case, so that their stated scatter multiplies both ends.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.common.alternatives import least_of_convex
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import load_scatter
from alula.fea.common.source import Source, SourceKind, air_source, friction_source, play_source
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.whole.air_range import air_range
from alula.fea.whole.rubbed_motion import friction_range, rubbed_motion
from alula.geometry.base.ties import TIE
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import friction_ranges
from alula.loads.records.check_spec import MotorCheck
from alula.loads.records.flapping import Flapping
from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.loads.states.kinetostatics import relative_motion
from alula.loads.states.loose_motion import loose_motion

Real = NDArray[np.float64]
SOURCES = (Source(kind=SourceKind.FLYWHEEL, detail=reason("from_mean_to_peak")),)


@dataclass(frozen=True, kw_only=True)
class MotorDemand:
    """What a load case asks of the drive over its motion.

    Attributes
    ----------
    peak_power : float
        Greatest drive power [W].
    mean_power : float
        On average over time, what flows back taken off [W]; 0 where more flows back.
    peak_torque : float
        Greatest size of the drive torque [N mm].
    """

    peak_power: float
    mean_power: float
    peak_torque: float


def demand(power: Real, torque: Real, times: Real) -> MotorDemand:
    """Return what a motion asks of its drive.

    Parameters
    ----------
    power, torque : ndarray, shape (n,)
        [N mm/s] and [N mm].
    times : ndarray, shape (n,)
        [s]

    Returns
    -------
    MotorDemand
    """
    return MotorDemand(
        peak_power=max(float(power.max()), 0.0) / 1000.0,
        mean_power=max(_mean(power, times), 0.0) / 1000.0,
        peak_torque=float(np.abs(torque).max()),
    )


def line_share(torque: Real, speed: Real, times: Real, stall: float, free: float) -> tuple[float, float]:
    """Return the shares of what a motor with a straight torque-speed line gives: on average, and at the worst place.

    The motor drives with up to ``stall`` (1 - |speed|/``free``) and holds back with up to ``stall``
    (1 + |speed|/``free``), its full voltage reversed. The mean compares power, since a flywheel keeps energy.

    Parameters
    ----------
    torque, speed : ndarray, shape (n,)
        Of the drive [N mm], [rad/s].
    times : ndarray, shape (n,)
        [s]
    stall, free : float
        Torque at standstill [N mm] and speed without load [rad/s].

    Returns
    -------
    tuple of (float, float)
        Infinite beyond the speed without load.
    """
    drives = torque * speed > 0.0
    given = stall * (1.0 - np.where(drives, 1.0, -1.0) * np.abs(speed) / free)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(torque == 0.0, 0.0, np.where(given > 0.0, np.abs(torque) / given, math.inf))
    able = _mean(np.maximum(stall * (1.0 - np.abs(speed) / free), 0.0) * np.abs(speed), times)
    asked = max(_mean(torque * speed, times), 0.0)
    mean = asked / able if able > 0.0 else (math.inf if asked > 0.0 else 0.0)
    return min(mean, float(shares.max())), float(shares.max())


def _mean(values: Real, times: Real) -> float:
    """Return the mean over time; 0 where it is rounding beside the greatest value."""
    mean = float(np.trapezoid(values, times)) / float(times[-1] - times[0])
    return 0.0 if abs(mean) <= TIE * float(np.abs(values).max()) < math.inf else mean


def motor_outcomes(case: Case, name: str, check: MotorCheck) -> dict[str, tuple[CheckOutcome, ...]]:
    """Return the outcomes of every load case with a speed of its own: power, and what else the motor states.

    The drive power of the laden linkage is that of the empty one and a part proportional to what it carries,
    so that the largest load of that distribution which the motor drives follows as well.

    Parameters
    ----------
    case : Case
    name : str
        Of the check.
    check : MotorCheck

    Returns
    -------
    dict of str to tuple of CheckOutcome
        Load case -> power first, then speed and torque as far as the motor states them.
    """
    timed = case.motion is not None and case.motion.states is not None and case.motion.moves
    moving = {title: load_case for title, load_case in case.load_cases.items() if timed or load_case.speed != 0.0}
    empty_cases = {title: load_case.model_copy(update={"carried": False}) for title, load_case in moving.items()}
    laden = rubbed_motion(case.model_copy(update={"load_cases": moving}))
    empty = rubbed_motion(case.model_copy(update={"load_cases": empty_cases})) if case.carried else laden
    return {
        title: (_power(case, name, check, title, laden, empty), *_limits(name, check, title, laden)) for title in moving
    }


def _band(moved: CaseMotion, title: str, of: Callable[[Real], tuple[float, float, float]]) -> Band:
    """Return what is calculated from the drive torque and in proportion to it, with all that leaves it open."""
    value, plain_low, plain_high, sources = _loosened(moved, title, of)
    low, high, least, most = plain_low, plain_high, plain_low, plain_high
    air, airs = moved.case.load_cases[title].flapping, air_range(moved)
    if air is not None and airs is not None and (others := airs.at(title)):
        lows = {air.normal_coefficient: low}
        for coefficient, other in zip(air.ends, others, strict=True):
            locks = not np.isfinite(other.torque[title]).all()
            _, lows[coefficient], end, _ = (0.0, 0.0, math.inf, ()) if locks else _loosened(other, title, of)
            high = max(high, end)
        low = max(least_of_convex(lows.items()), 0.0)
        sources = (*sources, air_source(*air.ends))
    for other in friction_range(moved):
        locks = not np.isfinite(other.torque[title]).all()
        _, own, end, _ = (0.0, plain_low, math.inf, ()) if locks else _loosened(other, title, of)
        least, most = min(least, own), max(most, end)
    if moved.rubbing:
        sources = (*sources, friction_source(friction_ranges(moved.case)))
    # Air and friction, each alone so far, at their worst together: what either takes adds up, what it makes multiplies.
    low = max(low + least - plain_low, 0.0)
    # The share first: where friction makes no more of it, it is 1 in spite of rounding.
    high = high * (most / plain_high) if 0.0 < plain_high < math.inf else max(high, most)
    return load_scatter(moved.case, title).on(Band(value=value, low=low, high=high, sources=sources))


def _loosened(
    moved: CaseMotion, title: str, of: Callable[[Real], tuple[float, float, float]]
) -> tuple[float, float, float, tuple[Source, ...]]:
    """Return value, low and high with the torque as play may change it, and what makes them differ."""
    torque = moved.forces[title].drive_torque
    value, low, high = of(torque)
    if (loose := loose_motion(moved)) is None:
        return value, low, high, SOURCES
    (least, most), forwards = loose.effort(title), _rate(moved, title) > 0.0
    curves = (
        np.where(forwards, least, most),  # least power
        np.where(forwards, most, least),
        np.clip(0.0, least, most),  # least size
        np.where(np.abs(least) > np.abs(most), least, most),
    )
    with np.errstate(invalid="ignore"):
        ends = [of(np.asarray(curve)) for curve in curves]
    low, high = min(low, *(end[1] for end in ends)), max(high, *(end[2] for end in ends))
    low, high = (bound if math.isnan(end) else end for end, bound in ((low, 0.0), (high, math.inf)))
    return value, low, high, (*SOURCES, play_source(loose.clearances))


def _rate(moved: CaseMotion, title: str) -> Real:
    """Speed of the driven link against the other link of its joint [rad/s]."""
    return relative_motion(moved.motion, moved.drive) * moved.forces[title].motion.speed


def _limits(name: str, check: MotorCheck, title: str, moved: CaseMotion) -> Iterator[CheckOutcome]:
    solved, times, link = moved.forces[title], _times(moved, title), moved.drive.link
    torque, speed = solved.drive_torque, _rate(moved, title)

    def outcome(quantity: Quantity, value: Band, limit: float, why: Reason) -> CheckOutcome:
        return Asked(name=name, subject=Subject.link(link), quantity=quantity, limit=limit).outcome(title, value, why)

    if check.no_load_speed is not None:
        rpm = 30.0 / math.pi
        fastest, free = rpm * float(np.abs(speed).max()), rpm * check.no_load_speed
        why = reason("speed_of_drive", fastest=fastest, without_load=free)
        yield outcome(Quantity.DRIVE_SPEED, Band.exact(fastest), free, why)
        if check.stall_torque is not None:
            mean, most = line_share(torque, speed, times, check.stall_torque, check.no_load_speed)
            why = reason("share_of_torque", most=most, mean=mean, stall=check.stall_torque, without_load=free)
            line = (check.stall_torque, check.no_load_speed)

            def share(torque: Real) -> tuple[float, float, float]:
                least, most = line_share(torque, speed, times, *line)
                return most, least, most

            value = _band(moved, title, share)
            yield outcome(Quantity.TORQUE_SHARE, value, 1.0, why)
    if check.rated_torque is not None:
        effective, mean, _ = _effective(torque, times)
        why = reason("torque_of_drive", effective=effective, mean=mean, rated=check.rated_torque)
        value = _band(moved, title, lambda torque: _effective(torque, times))
        yield outcome(Quantity.DRIVE_TORQUE, value, check.rated_torque, why)


def _effective(torque: Real, times: Real) -> tuple[float, float, float]:
    """Root mean square, size of the mean, and root mean square again."""
    effective = math.sqrt(_mean(torque**2, times))
    return effective, min(abs(_mean(torque, times)), effective), effective


def _times(moved: CaseMotion, title: str) -> Real:
    """Times [s] of a load case at its own speed."""
    times = moved.moved[title].times
    assert times is not None
    return times


def _power(case: Case, name: str, check: MotorCheck, title: str, laden: CaseMotion, empty: CaseMotion) -> CheckOutcome:
    solved, times = laden.forces[title], _times(laden, title)
    found = demand(solved.drive_power, solved.drive_torque, times)
    limit = check.output_power
    rate = _rate(laden, title)

    def power(torque: Real) -> tuple[float, float, float]:
        asked = demand(torque * rate, torque, times)
        return asked.peak_power, asked.mean_power, asked.peak_power

    value = _band(laden, title, power)
    driven = Subject.link(laden.drive.link)
    outcome = Asked(name=name, subject=driven, quantity=Quantity.DRIVE_POWER, limit=limit).outcome(title, value)
    side = {
        Verdict.PASS: "covers_peak",
        Verdict.FAIL: "below_mean",
        Verdict.UNDECIDED: "covers_mean",
    }[outcome.verdict]
    asked: tuple[Reason, ...] = (reason("asked_of_drive", **_facts(found)),)
    air = case.load_cases[title].flapping
    if air is not None and (airs := air_range(laden)) is not None:
        also, side = _of_air(air, airs, title, times, outcome.verdict, limit)
        asked = (*asked, *also)
    drives = None
    if case.load_cases[title].carried and case.carried:
        bare = empty.forces[title].drive_power
        # What leaves the power open goes with it: play, air, friction and the scatter of the load.
        open_by = value.high / value.value if value.value > 0.0 else math.inf
        factor = largest_factor(bare, solved.drive_power - bare, 1000.0 * limit / open_by)
        carried = 1e6 * sum(mass.mass for mass in case.carried)
        if 0.0 < factor < math.inf:
            drives = reason("can_drive", mass=factor * carried, now=carried)
    output = reason(
        "output_of_motor", volt=check.voltage, milliampere=check.current * 1e3, efficiency=check.efficiency, watt=limit
    )
    return outcome.because(reason("power_of_drive", asked=asked, side=reason(side), output=output, drives=drives))


def _facts(asked: MotorDemand) -> dict[str, float]:
    return {"torque": asked.peak_torque, "power": asked.peak_power, "mean": asked.mean_power}


def _of_air(
    air: Flapping, airs: AirRange, title: str, times: Real, verdict: Verdict, limit: float
) -> tuple[tuple[Reason, ...], str]:
    """Return what air on wings makes of the drive, and the kind of reason that says whether the motor carries it."""
    bare, *ends = (
        demand(moved.forces[title].drive_power, moved.forces[title].drive_torque, times)
        for moved in (airs.without, airs.least, airs.largest)
    )
    also: tuple[Reason, ...] = (reason("asked_without_air", **_facts(bare)),)
    if airs.at(title):
        spans = {name: tuple(_facts(end)[name] for end in ends) for name in _facts(bare)}
        also = (reason("asked_over_range_of_air", coefficients=air.ends, **spans), *also)
    if verdict is Verdict.PASS:
        return also, "carries_air"
    if verdict is Verdict.FAIL:
        return also, "below_mean_without_air" if bare.mean_power > limit else "below_mean_with_air"
    if max(end.mean_power for end in ends) <= limit:
        return also, "covers_mean_with_air"
    return also, "depends_on_air"


def largest_factor(bare: Real, load: Real, limit: float) -> float:
    """Return the largest k with max(bare + k load) <= limit.

    Parameters
    ----------
    bare, load : ndarray, shape (n,)
        Power of the bare linkage, and of what it carries.
    limit : float

    Returns
    -------
    float
        0 where even the bare linkage exceeds the limit.
    """
    if bare.max() > limit:
        return 0.0
    rising = load > 0.0
    return float(np.min((limit - bare[rising]) / load[rising])) if rising.any() else math.inf
