"""The motor's demand from a known power, and the heaviest load that it drives."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Verdict
from alula.fea.whole import motor
from alula.fea.whole.motor import demand, largest_factor, line_share, motor_outcomes
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.loose_motion import loose_motion


def test_demand_of_a_sine() -> None:
    times = np.linspace(0.0, 2.0, 4001)
    power = 3000.0 * np.sin(2.0 * math.pi * times)
    found = demand(power, -power / 10.0, times)
    assert found.peak_power == pytest.approx(3.0, rel=1e-6)
    assert found.mean_power == pytest.approx(0.0, abs=1e-12)  # a flywheel takes what the other half gives back
    assert found.peak_torque == pytest.approx(300.0, rel=1e-6)


def test_the_largest_factor_meets_the_limit_and_not_more() -> None:
    bare, load = np.array([1.0, -2.0, 0.5]), np.array([2.0, 9.0, -4.0])
    k = largest_factor(bare, load, 10.0)
    assert np.max(bare + k * load) == pytest.approx(10.0)
    assert k == pytest.approx(12.0 / 9.0)


def test_no_load_fits_where_the_bare_linkage_asks_too_much() -> None:
    assert largest_factor(np.array([11.0]), np.array([1.0]), 10.0) == 0.0
    assert largest_factor(np.array([1.0]), np.array([-1.0]), 10.0) == math.inf


@pytest.mark.parametrize(("level", "mean", "peak"), [(2000.0, 2.0, 7.0), (-2000.0, 0.0, 3.0), (-6000.0, 0.0, 0.0)])
def test_a_flywheel_stores_what_is_negative(level, mean, peak) -> None:
    """Power 2 + 5 sin: the mean is 2, the positive part alone would be 2.6. Braking by 7 W asks the motor for none."""
    times = np.linspace(0.0, 1.0, 4001)
    power = level + 5000.0 * np.sin(2.0 * math.pi * times)
    found = demand(power, power, times)
    assert (found.mean_power, found.peak_power) == pytest.approx((mean, peak), rel=1e-6)


def test_shares_of_a_straight_torque_speed_line() -> None:
    """Stall torque 20 at 0, 0 at 100 rad/s: at 25 rad/s it drives with 15 and holds back with 25."""
    times = np.linspace(0.0, 1.0, 5)
    speed = np.full(5, -25.0)
    pulling = np.array([-3.0, -12.0, -3.0, -3.0, -3.0])
    mean, most = line_share(pulling, speed, times, 20.0, 100.0)
    assert most == pytest.approx(12.0 / 15.0)
    assert mean == pytest.approx((3.0 + (12.0 - 3.0) / 4.0) / 15.0)
    assert line_share(-pulling, speed, times, 20.0, 100.0) == (0.0, pytest.approx(12.0 / 25.0))
    assert line_share(pulling, 5.0 * speed, times, 20.0, 100.0) == (math.inf, math.inf)
    for phase in (0.4, 1.2, 2.0, 3.0):  # what is lent and given back over a turn is zero, and its sum is rounding
        turning = np.cos(2.0 * np.pi * np.linspace(0.0, 1.0, 73) + phase)
        assert demand(turning, turning, np.linspace(0.0, 2.0, 73)).mean_power == 0.0
        assert line_share(turning, np.full(73, 50.0), np.linspace(0.0, 2.0, 73), 20.0, 100.0)[0] == 0.0


@pytest.mark.parametrize("heaviest", [1.0, 2.0, 3.0])
def test_what_a_motor_needs_in_a_range_of_air_has_the_outer_ends_of_all_airs(monkeypatch, heaviest) -> None:
    """The largest is that of any C_N; the least is that of a convex function through 3, 2 and 2.5: no less than 1."""
    found = {1.0: (3.0, 6.0), 2.0: (2.0, 5.0), 3.0: (2.5, 7.0)}
    found = {c: (c, low, 9.0 if c == heaviest else high, ()) for c, (low, high) in found.items()}
    air = SimpleNamespace(normal_coefficient=2.0, ends=(1.0, 3.0))
    load_case = SimpleNamespace(flapping=air, scatter=(0.5, 2.0))
    stated, least, largest = (
        SimpleNamespace(
            c=c, rubbing={}, case=SimpleNamespace(load_cases={"flap": load_case}), torque={"flap": np.zeros(3)}
        )
        for c in (2.0, 1.0, 3.0)
    )
    monkeypatch.setattr(motor, "friction_range", lambda moved: ())
    monkeypatch.setattr(motor, "air_range", lambda moved: SimpleNamespace(at=lambda title: (least, largest)))
    monkeypatch.setattr(motor, "_loosened", lambda moved, title, of: found[moved.c])
    band = motor._band(stated, "flap", lambda torque: (0.0, 0.0, 0.0))
    assert (band.value, band.low, band.high) == pytest.approx((2.0, 0.5 * 1.0, 2.0 * 9.0))
    # With air as stated less friction takes 0.5 of the least, and more makes 8 of the largest.
    found |= {4.0: (4.0, 1.5, 4.5, ()), 5.0: (5.0, 2.2, 8.0, ())}
    rubbed = [SimpleNamespace(c=c, torque={"flap": np.zeros(3)}) for c in (4.0, 5.0)]
    monkeypatch.setattr(motor, "friction_range", lambda moved: rubbed)
    both = motor._band(stated, "flap", lambda torque: (0.0, 0.0, 0.0))
    more = 8.0 / 5.0 if heaviest != 2.0 else 1.0
    assert (both.value, both.low, both.high) == pytest.approx((2.0, 0.5 * (1.0 + 1.5 - 2.0), 2.0 * 9.0 * more))


@pytest.mark.parametrize("end", [0, 1])
def test_a_linkage_that_locks_itself_at_an_end_of_the_air_asks_for_a_power_without_end(monkeypatch, end) -> None:
    """Without play: its torque is not a number there at one pose, and is zero and 1 N mm else."""
    air = SimpleNamespace(normal_coefficient=2.0, ends=(1.0, 3.0))
    cases = SimpleNamespace(load_cases={"flap": SimpleNamespace(flapping=air, scatter=(1.0, 1.0))})
    torques = [np.array([0.0, math.nan if i == end else 1.0]) for i in (0, 1)]

    def in_air(torque):
        forces = {"flap": SimpleNamespace(drive_torque=torque)}
        return SimpleNamespace(case=cases, rubbing={}, torque={"flap": torque}, forces=forces)

    monkeypatch.setattr(motor, "friction_range", lambda moved: ())
    monkeypatch.setattr(motor, "loose_motion", lambda moved: None)
    monkeypatch.setattr(motor, "air_range", lambda moved: SimpleNamespace(at=lambda title: map(in_air, torques)))
    band = motor._band(in_air(np.array([0.0, 2.0])), "flap", lambda torque: (torque.sum(), torque.sum(), torque.max()))
    assert (band.value, band.low, band.high) == (2.0, 0.0, math.inf)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_play_asks_a_motor_for_the_most_and_the_least_power_whichever_way_it_turns(monkeypatch, way) -> None:
    """It turns one way at the first pose and back at the second; power is least with [1, 4] or [4, 1] N mm of torque.

    The root mean square is least with the torques of least size.
    """
    least, most, rate = np.array([1.0, -2.0]), np.array([4.0, 4.0]), way * np.array([1.0, -1.0])
    loose = SimpleNamespace(effort=lambda title: (least, most), clearances={"B": 0.1})
    monkeypatch.setattr(motor, "loose_motion", lambda moved: loose)
    monkeypatch.setattr(motor, "_rate", lambda moved, title: rate)
    moved = SimpleNamespace(forces={"turn": SimpleNamespace(drive_torque=np.array([2.0, 2.0]))})

    def power(torque):
        asked = torque * rate
        return asked.max(), asked.mean(), asked.max()

    value, low, high, sources = motor._loosened(moved, "turn", power)
    assert (value, low, high) == ((2.0, -1.5, 4.0) if way > 0.0 else (2.0, -3.0, 4.0))
    assert SourceKind.PLAY in {source.kind for source in sources}
    size = motor._loosened(moved, "turn", lambda torque: (*[float(np.hypot(*torque))] * 3,))
    assert size[:3] == (np.hypot(2.0, 2.0), 1.0, np.hypot(4.0, 4.0))


MOTOR = ['checks.motor.no_load_speed="3500 rpm"', "motion.poses=13"]


def limits(*more: str, load_case: str = "wings-12", fits: bool = True):
    case = edited("ornithopter", [*MOTOR, *more], fits=fits)
    return {o.quantity: o for o in motor_outcomes(case, "motor", case.checks["motor"])[load_case]}


def test_the_drive_must_not_be_faster_than_the_motor_without_load() -> None:
    found = limits(load_case="fast")["drive speed"]
    assert (found.value.value, found.limit, found.verdict) == (
        pytest.approx(3000.0),
        pytest.approx(3500.0),
        Verdict.PASS,
    )
    slow = limits('checks.motor.no_load_speed="2900 rpm"', load_case="fast")["drive speed"]
    assert slow.verdict is Verdict.FAIL


def test_between_two_moving_links_the_motor_turns_as_one_against_the_other() -> None:
    """A crank at 100 rpm that is driven against the coupler: their own speed, which makes power of the torque."""
    motor = 'type="motor", voltage="12 V", current="3 A", efficiency=0.7'
    limits = 'no_load_speed="110 rpm", stall_torque="2000 N*mm"'
    entries = ['drive.joint="A"', 'load_cases.lift.speed="100 rpm"', f"checks.motor={{{motor}, {limits}}}"]
    case = edited("four-bar", entries)
    found = {o.quantity: o for o in motor_outcomes(case, "motor", case.checks["motor"])["lift"]}
    solved = solve_case_motion(case).forces["lift"]
    turns = np.abs(solved.motion.angular_speed("crank") - solved.motion.angular_speed("coupler"))
    np.testing.assert_allclose(np.abs(solved.drive_power), np.abs(solved.drive_torque) * turns, atol=1e-9)
    fastest = 30.0 / math.pi * float(turns.max())
    assert fastest > 150.0
    assert (found["drive speed"].value.value, found["drive speed"].verdict) == (pytest.approx(fastest), Verdict.FAIL)
    assert found["share of the motor's torque at its speed"].verdict is not Verdict.PASS


def test_torque_over_the_line_and_over_time() -> None:
    """A stall torque twice what the peak needs at 720 rpm passes; one that it exceeds is for a flywheel to decide."""
    case = read_case("ornithopter", ["motion.poses=13"])
    torque = solve_case_motion(case).forces["wings-12"].drive_torque
    peak = float(np.abs(torque).max())
    line = "share of the motor's torque at its speed"
    twice = f'checks.motor.stall_torque="{2.0 * peak / (1.0 - 720.0 / 3500.0)} N*mm"'
    enough = limits(twice, fits=False)[line]
    assert (enough.verdict, enough.value.high) == (Verdict.PASS, pytest.approx(0.5, rel=1e-3))
    loose = loose_motion(solve_case_motion(case))
    assert loose is not None
    most = float(np.abs(loose.effort("wings-12")).max())
    assert most > 1.02 * peak
    played = limits(twice)[line]  # its fits leave play, with which the peak needs more
    assert (played.verdict, played.value.value) == (Verdict.PASS, pytest.approx(0.5, rel=1e-3))
    assert played.value.high == pytest.approx(0.5 * most / peak, rel=1e-3)
    assert SourceKind.PLAY in {source.kind for source in played.value.sources}
    weak = limits(f'checks.motor.stall_torque="{0.5 * peak} N*mm"')[line]
    assert weak.verdict is Verdict.UNDECIDED
    effective = math.sqrt(float(np.mean(torque[:-1] ** 2)))  # evenly spaced over a whole turn
    for fits, verdict in ((False, Verdict.PASS), (True, Verdict.UNDECIDED)):  # play may ask for more than 1 % more
        rated = limits(f'checks.motor.rated_torque="{1.01 * effective} N*mm"', fits=fits)["drive torque over time"]
        assert (rated.verdict, rated.value.value) == (verdict, pytest.approx(effective, rel=1e-3))
    assert limits('checks.motor.rated_torque="1e-6 N*mm"')["drive torque over time"].verdict is not Verdict.PASS


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["checks.motor.efficiency=1.5"], "efficiency"),
        (
            ['checks.motor={type="motor",voltage="6 V",current="1 A",efficiency=0.5,stall_torque="1 N*mm"}'],
            "no_load_speed",
        ),
        (['checks.motor.voltage="6 A"'], "not a unit of voltage"),
        (['checks.motor.current="-1 mA"'], "greater than zero"),
        (['load_cases={held={own_weight=true,speed="0 rpm"}}'], "no load case"),
    ],
)
def test_bad_motors_are_told(overrides: list[str], told: str) -> None:
    with pytest.raises(CaseError, match=told):
        read_case("ornithopter", overrides)
