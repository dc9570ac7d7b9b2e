"""Springs, tendons and stops against closed forms and energy balances that share no code with them."""

import math
import tomllib

import numpy as np
import pytest
from scipy.optimize import brentq
from sprung_cases import CROWN, FOUR_BAR, HANG, LEVER, case_of, stands

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.loose_motion import loose_motion

TURN = {"joint": "O", "stiffness": "300 N*mm/rad"}


@pytest.mark.parametrize(("start", "free"), [("0 deg", 20.0), ("60 deg", 20.0), ("-100 deg", -45.0)])
def test_a_lever_on_a_torsional_spring_hangs_where_moments_balance(start, free):
    """k (free - t) = F L cos t; the second derivative of the potential energy is k - F L sin t."""
    case = case_of(LEVER + HANG, springs={"back": {**TURN, "free_angle": f"{free} deg"}}, pose=at(start))
    statics, found = stands(case)
    angle = brentq(lambda t: 300.0 * (math.radians(free) - t) - 200.0 * math.cos(t), -math.pi, math.pi, xtol=1e-15)
    assert found.pose.held == pytest.approx(angle, abs=1e-11)
    assert found.stiffness == pytest.approx(300.0 - 200.0 * math.sin(angle), rel=1e-6)
    assert statics.reactions["hang"].joints["O"].force[:2] == pytest.approx([0.0, 2.0], abs=1e-9)
    assert statics.reactions["hang"].drive_torque == pytest.approx(0.0, abs=1e-8)
    [spring] = found.springs
    assert spring.effort == pytest.approx(200.0 * math.cos(angle), rel=1e-9)


def at(angle):
    return {"coordinate": "lever", "angle": angle, "equilibrium": True}


SNAP = {"snap": {"between": [{"link": "base", "at": "S"}, {"link": "lever", "at": "H"}], "stiffness": "0.5 N/mm",
                 "free_length": "80 mm"}}  # fmt: skip


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_bistable_lever_goes_to_its_own_side(side):
    """The spring is free where its length is 80 mm: cos t = (100² + 40² - 80²)/(2 100 40)."""
    _, found = stands(case_of(LEVER, springs=SNAP, pose=at(f"{10.0 * side} deg")))
    angle = math.acos((100.0**2 + 40.0**2 - 80.0**2) / 8000.0)
    assert found.pose.held == pytest.approx(side * angle, abs=1e-10)
    rate = 100.0 * 40.0 * math.sin(angle) / 80.0  # dL/dt
    assert found.stiffness == pytest.approx(0.5 * rate**2, rel=1e-6)


def test_a_balance_that_is_not_stable_is_refused():
    """On the line of centres V'' = k (L - L0) L'' with L = 60 mm and L'' = 100 40/60 mm: -666.7 N mm/rad."""
    with pytest.raises(CaseError, match=r"not stably \(stiffness -666\.7 N·mm/rad\); state a start beside it"):
        stands(case_of(LEVER, springs=SNAP))


def test_an_indifferent_balance_and_none_are_refused():
    with pytest.raises(CaseError, match="indifferent"):
        stands(case_of(LEVER))
    turned = {"hang": {"moments": [{"link": "lever", "at": "P", "moment": "5 N*mm"}]}}
    with pytest.raises(CaseError, match=r"pose.equilibrium: let go at lever = 0 deg .* no balance and no stop"):
        stands(case_of(LEVER, load_cases=turned))


@pytest.mark.parametrize("pose", [
    {"coordinate": "bar", "angle": "50 deg", "near": {"rod": "-50 deg", "block": "0 deg"}, "equilibrium": True},
    {"coordinate": "T", "travel": "60 mm", "near": {"bar": "50 deg", "rod": "-50 deg", "block": "0 deg"},
     "equilibrium": True},
])  # fmt: skip
def test_a_toggle_on_a_spring(pose):
    """V(t) = k (150 - 10 - 100 cos t - 70)²/2 + 3 50 sin t; whichever coordinate fixes the pose."""
    statics, found = stands(case_of(CROWN, pose=pose))

    def gradient(t: float) -> float:
        return 0.2 * (70.0 - 100.0 * math.cos(t)) * 100.0 * math.sin(t) + 150.0 * math.cos(t)

    angle = brentq(gradient, math.radians(20.0), math.radians(50.0), xtol=1e-15)
    assert found.pose.angles["bar"] == pytest.approx(angle, abs=1e-10)
    h = 1e-5
    per_angle = (gradient(angle + h) - gradient(angle - h)) / (2.0 * h)
    per_travel = per_angle / (100.0 * math.sin(angle)) ** 2
    assert found.stiffness == pytest.approx(per_travel if "travel" in pose else per_angle, rel=1e-6)
    push = 0.2 * (70.0 - 100.0 * math.cos(angle))  # of the wall on the block, to the right where the spring pulls
    force = statics.reactions["press"].joints["C"].force
    assert force[:2] == pytest.approx([-push, -1.5], abs=1e-7)  # half of the load goes down each bar


def test_a_tendon_bends_a_finger_against_its_spring():
    """The pull times its arm about O balances the spring; the eyelet E turns the cord, and is on the ground."""
    tendon = {"flexor": {"tension": "6 N", "through": [{"link": "base", "at": "S"}, {"link": "base", "at": "E"},
                                                       {"link": "lever", "at": "H"}]}}  # fmt: skip
    _, found = stands(case_of(LEVER, tendons=tendon, springs={"back": {**TURN, "preload": "0 N*mm"}}))

    def moment(t: float) -> float:
        tip, eye = np.array([40.0 * math.cos(t), 40.0 * math.sin(t)]), np.array([-10.0, 15.0])
        pull = 6.0 * (eye - tip) / np.linalg.norm(eye - tip)
        return float(tip[0] * pull[1] - tip[1] * pull[0]) - 300.0 * t

    assert found.pose.held == pytest.approx(brentq(moment, 0.0, 2.0, xtol=1e-15), abs=1e-10)
    assert found.springs[1].effort == 6.0


@pytest.mark.parametrize("from_", ["base.S", "base.W"])
def test_a_balance_at_which_a_cord_comes_taut_is_as_stiff_as_on_its_softer_side(from_):
    """The lever hangs on a torsional spring where the cord has just its free length: it pulls to one side only.

    S lies beyond the lever's end, so that the cord is taut below; W lies left of O, so that it is taut above.
    """
    data = tomllib.loads(LEVER + HANG)
    data["links"]["base"]["points"]["W"] = ["-30 mm", "-80 mm"]
    springs = {"back": {**TURN, "free_angle": "20 deg"}}
    _, without = stands(validate({**data, "springs": springs}))
    link, point = from_.split(".")
    place = complex(*(float(x.split()[0]) for x in data["links"]["base"]["points"][point]))
    arm = 40.0 * np.exp(1j * without.pose.held)
    cord = {"through": [{"link": link, "at": point}, {"link": "lever", "at": "H"}], "stiffness": "5 N/mm",
            "free_length": f"{float(abs(place - arm))!r} mm"}  # fmt: skip
    _, found = stands(validate({**data, "springs": springs, "tendons": {"cord": cord}}))
    assert found.pose.held == pytest.approx(without.pose.held, abs=1e-9)
    rate = float((np.conj(1j * arm) * (arm - place)).real) / abs(place - arm)  # of its length by the angle
    assert (rate > 0.0) == (point == "W")
    assert 5.0 * rate**2 > without.stiffness
    assert found.stiffness == pytest.approx(without.stiffness, rel=1e-4)


def test_a_slack_tendon_does_nothing():
    through = [{"link": "base", "at": "S"}, {"link": "lever", "at": "H"}]
    springs = {"back": {**TURN, "free_angle": "20 deg"}}
    _, without = stands(case_of(LEVER + HANG, springs=springs))
    tendon = {"through": through, "stiffness": "5 N/mm", "free_length": "80 mm"}
    _, slack = stands(case_of(LEVER + HANG, springs=springs, tendons={"cord": tendon}))
    assert slack.pose.held == without.pose.held
    assert slack.springs[1].effort == 0.0
    tendon["free_length"] = "60 mm"  # as long as it is with the lever at 0 deg
    _, tight = stands(case_of(LEVER + HANG, springs=springs, tendons={"cord": tendon}))
    assert abs(tight.pose.held) < abs(without.pose.held)
    length = float(np.hypot(40.0 * math.cos(tight.pose.held) - 100.0, 40.0 * math.sin(tight.pose.held)))
    assert tight.springs[1].effort == pytest.approx(5.0 * (length - 60.0), rel=1e-9)


def energy(z: dict[str, complex], turned: float) -> float:
    """Elastic energy of the springs of ``FOUR_BAR`` by places of points; the hinge has turned since the first pose."""
    line, cord = abs(z["P"] - z["S"]) - 25.0, max(abs(z["Q"] - z["E"]) + abs(z["P"] - z["Q"]) - 85.0, 0.0)
    inner = abs(z["Q"])
    return (
        0.15 * line**2 + 0.05 * (inner**2) + 0.2 * cord**2 + 2.5 * abs(z["C"] - z["S"])
        + 75.0 * turned**2 - (-40.0) * turned
    )  # fmt: skip


def test_the_drive_does_the_work_that_the_springs_store():
    """Its torque over the angle, by Simpson's rule, is the change of the elastic energy; power balances too."""
    case = case_of(FOUR_BAR, motion={"range": ["60 deg", "200 deg"], "poses": 141, "speed": "5 rad/s"})
    moved = solve_case_motion(case)
    motion, torque = moved.motion, moved.torque["own"]
    free = float(np.linalg.norm(case.stated_pose.position("rocker", "Q"))) - 4.0 / 0.1
    stored = []
    for i in (0, -1):
        z = {p: complex(*motion.position(link, p)[i]) for link, points in case.link_points.items() for p in points}
        turned = float((motion.angle("rocker") - motion.angle("coupler"))[i])
        turned -= float((motion.angle("rocker") - motion.angle("coupler"))[0])
        stored.append(energy(z, turned) - 0.1 * free * abs(z["Q"]))
    weights = np.ones(141)
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    work = float(weights @ torque) * math.radians(1.0) / 3.0
    assert abs(stored[1] - stored[0]) > 50.0
    assert work == pytest.approx(stored[1] - stored[0], rel=1e-6)
    power = np.abs(moved.forces["own"].drive_power).max()
    assert np.abs(moved.forces["own"].imbalance).max() < 1e-9 * power


def test_the_whole_linkage_balances_with_its_springs():
    """Forces and moments of the ground's joints and of the springs' ends on the ground sum to nothing but the load."""
    statics, _ = stands(case_of(FOUR_BAR))
    reactions, pose = statics.reactions["own"], statics.pose
    total = np.zeros(3)
    for name in ("A", "D"):
        force, place = reactions.joints[name].force[:2], pose.position("base", name)
        total += [*force, place[0] * force[1] - place[1] * force[0]]
    total[2] += reactions.drive_torque
    for load in statics.loads["own"]:
        if load.link == "base":
            force, place = load.wrench[:2], pose.position("base", load.point)
            total -= [*force, place[0] * force[1] - place[1] * force[0] + load.wrench[5]]
    assert total == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_wound_spring_goes_on_over_a_whole_turn():
    case = case_of(
        LEVER, springs={"back": {**TURN, "preload": "900 N*mm"}}, drive={"link": "lever", "joint": "O"},
        pose={"coordinate": "lever", "angle": "0 deg"}, motion={"turn": True, "poses": 9},
    )  # fmt: skip
    moved = solve_case_motion(case)
    torque = -900.0 + 300.0 * np.linspace(0.0, 2.0 * math.pi, 9)
    assert moved.torque["hang"] == pytest.approx(torque, abs=1e-9)


def test_a_wound_spring_keeps_its_turns_at_single_poses_of_a_motion():
    """With play, and in a frame, a pose of the motion is looked at by itself."""
    case = case_of(
        LEVER.replace('["base", "lever"]', '["base", "lever"], clearance = "0.1 mm"'),
        springs={"back": {**TURN, "preload": "900 N*mm"}},
        drive={"link": "lever", "joint": "O"}, pose={"coordinate": "lever", "angle": "0 deg"},
        motion={"turn": True, "poses": 9},
    )  # fmt: skip
    moved = solve_case_motion(case)
    wound = case.springs["back"].acting("back", case.stated_pose.placement).along
    for i, angle in enumerate(np.linspace(0.0, 2.0 * math.pi, 9)):
        assert wound.of(moved.motion.pose(i).placement) == pytest.approx(angle, abs=1e-9)
        assert loose_motion(moved).play("hang", i).effort.value == pytest.approx(-900.0 + 300.0 * angle, abs=1e-9)


STOP = {"low": {"joint": "O", "at_least": "-10 deg"}}


def test_a_stop_bears_what_the_spring_leaves():
    """At -10 deg the spring has 300 (30 deg), the load 200 cos 10 deg: the stop bears the difference."""
    case = case_of(LEVER + HANG, springs={"back": {**TURN, "free_angle": "20 deg"}}, stops=STOP)
    statics, found = stands(case)
    contact = 200.0 * math.cos(math.radians(10.0)) - 300.0 * math.radians(30.0)
    assert found.stop == "low"
    assert math.degrees(found.pose.held) == pytest.approx(-10.0, abs=1e-9)
    assert found.contact == pytest.approx(contact, rel=1e-7)
    assert statics.reactions["hang"].drive_torque == pytest.approx(contact, rel=1e-9)
    assert statics.reactions["hang"].driving == (0.0, 0.0)


@pytest.mark.parametrize(("force", "stop"), [("-2 N", "low"), ("2 N", "")])
def test_at_a_stop_the_drive_holds_only_what_pulls_away(force, stop):
    case = case_of(
        LEVER, stops=STOP, drive={"link": "lever", "joint": "O"}, pose={"coordinate": "lever", "angle": "-10 deg"},
        load_cases={"hang": {"forces": [{"link": "lever", "at": "P", "force": ["0 N", force]}]}},
    )  # fmt: skip
    statics, found = stands(case)
    moment = 200.0 * math.cos(math.radians(10.0))
    assert found.stop == stop
    assert found.contact == pytest.approx(moment if stop else 0.0, rel=1e-7)
    assert statics.reactions["hang"].driving[0] == pytest.approx(0.0 if stop else -moment, rel=1e-9)


def test_a_slider_comes_to_its_stop():
    """The block goes out from 60 mm under the load on the knee; at 90 mm the stop bears what spring and load push."""
    pose = {"coordinate": "bar", "angle": "50 deg", "near": {"rod": "-50 deg", "block": "0 deg"}, "equilibrium": True}
    case = case_of(CROWN, pose=pose, stops={"out": {"joint": "T", "at_most": "72 mm"}})
    statics, found = stands(case)
    angle = math.acos(0.72)
    push = 3.0 * 50.0 * math.cos(angle) / (100.0 * math.sin(angle)) + 0.2 * (140.0 - 72.0 - 70.0)
    assert found.stop == "out"
    assert found.contact == pytest.approx(-push, rel=1e-7)
    assert statics.reactions["press"].joints["T"].force[0] == pytest.approx(-push, rel=1e-9)


def test_a_motion_beyond_a_stop_is_refused_with_the_place():
    stops = {"up": {"joint": "D", "at_most": "95 deg"}}
    case = case_of(FOUR_BAR, motion={"range": ["60 deg", "200 deg"], "poses": 141}, stops=stops)
    with pytest.raises(CaseError, match=r"stops\.up: the motion comes to it at crank = (\S+) deg") as error:
        solve_case_motion(case)
    told = float(str(error.value).split("crank = ")[1].split(" deg")[0])
    free = solve_case_motion(case_of(FOUR_BAR, motion={"range": ["60 deg", f"{told} deg"], "poses": 9})).motion
    assert math.degrees(free.angle("rocker")[-1]) == pytest.approx(95.0, abs=0.01)
