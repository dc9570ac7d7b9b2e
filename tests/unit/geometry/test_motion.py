"""Motion along a branch: closed forms, dead points, crossings, redundant linkages."""

import math

import numpy as np
import pytest
from closed_forms import four_bar_motion, slider_crank_motion
from motion_poses import (
    CRANK,
    four_bar_pose,
    parallelogram,
    parallelogram_pose,
    quick_return_pose,
    scotch_yoke_pose,
    slider_crank_pose,
    wing_pose,
)
from planar_linkages import four_bar

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.mechanisms.fourbar import FourBar

TURN = CRANK + np.linspace(0.0, 2.0 * math.pi, 97)
WING = np.radians(np.linspace(228.15, 124.62, 97))


def turned(first, second):
    return np.max(np.abs(np.exp(1j * np.asarray(first)) - np.exp(1j * np.asarray(second))))


@pytest.mark.parametrize(("up", "branch"), [(True, "open"), (False, "crossed")])
def test_four_bar_in_closed_form(up, branch):
    motion = solve_motion(four_bar_pose(up=up), TURN, speed=7.0, acceleration=-40.0)
    exact = four_bar_motion(FourBar(a=40.0, b=120.0, c=80.0, d=100.0), TURN, 7.0, -40.0, branch=branch)
    assert turned(motion.angle("coupler"), exact.theta3) < 1e-10
    assert turned(motion.angle("rocker"), exact.theta4) < 1e-10
    for link, speed, acceleration in (
        ("coupler", exact.omega3, exact.alpha3),
        ("rocker", exact.omega4, exact.alpha4),
    ):
        np.testing.assert_allclose(motion.angular_speed(link), speed, rtol=0, atol=1e-10 * 7.0)
        np.testing.assert_allclose(motion.angular_acceleration(link), acceleration, rtol=0, atol=1e-10 * 49.0)
    assert motion.returns


def test_slider_crank_in_closed_form():
    motion = solve_motion(slider_crank_pose(), TURN, speed=7.0, acceleration=3.0)
    # Norton measures the rod from the block's pin to the crank's.
    block = motion.position("block", "C")
    height = 10.0
    found = [slider_crank_motion(40.0, 130.0, height, TURN, 7.0, 3.0, branch=branch) for branch in ("open", "crossed")]
    one = min(found, key=lambda m: np.max(np.abs(m.d - block[:, 0])))
    np.testing.assert_allclose(block[:, 0], one.d, atol=1e-9)
    np.testing.assert_allclose(block[:, 1], height, atol=1e-12)
    np.testing.assert_allclose(motion.velocity("block", "C")[:, 0], one.d_dot, atol=1e-8)
    np.testing.assert_allclose(motion.linear_acceleration("block", "C")[:, 0], one.d_ddot, atol=1e-7)
    np.testing.assert_allclose(motion.travel("S"), block[:, 0], atol=1e-10)
    np.testing.assert_allclose(motion.angular_speed("block"), 0.0, atol=1e-12)


def test_quick_return_lever_in_closed_form():
    motion = solve_motion(quick_return_pose(), TURN, speed=2.0)
    pin = 15.0 * np.exp(1j * TURN) + 40j
    assert turned(motion.angle("lever"), np.angle(pin)) < 1e-12
    exact = 2.0 * (15.0**2 + 15.0 * 40.0 * np.sin(TURN)) / np.abs(pin) ** 2
    np.testing.assert_allclose(motion.angular_speed("lever"), exact, atol=1e-12)
    np.testing.assert_allclose(motion.travel("B"), np.abs(pin), atol=1e-11)


def test_scotch_yoke_moves_harmonically():
    motion = solve_motion(scotch_yoke_pose(), TURN, speed=2.0)
    np.testing.assert_allclose(motion.position("yoke", "Y")[:, 0], 25.0 * np.cos(TURN), atol=1e-11)
    np.testing.assert_allclose(motion.linear_acceleration("yoke", "Y")[:, 0], -100.0 * np.cos(TURN), atol=1e-10)


@pytest.mark.parametrize(
    ("pose", "angles"),
    [(four_bar_pose(), TURN), (slider_crank_pose(), TURN), (quick_return_pose(), TURN), (wing_pose(), WING)],
    ids=["four-bar", "slider-crank", "pin-in-slot", "six-bar"],
)
def test_derivatives_are_those_of_the_positions(pose, angles):
    h = 1e-4
    inner = angles[1:-1]
    here = solve_motion(pose, inner, speed=3.0, acceleration=-5.0)
    ahead, behind = solve_motion(pose, inner + h), solve_motion(pose, inner - h)
    first = (ahead.points - behind.points) / (2.0 * h)
    second = (ahead.points - 2.0 * here.points + behind.points) / h**2
    # Central differences: truncated at h² times the fourth derivative, which is greatest near the wing's dead point.
    size = np.max(np.abs(here.points_second))
    assert np.max(np.abs(here.points_first - first)) < 1e-5 * size
    assert np.max(np.abs(here.points_second - second)) < 1e-4 * size
    np.testing.assert_allclose(here.point_velocities, 3.0 * here.points_first)
    np.testing.assert_allclose(here.point_accelerations, -5.0 * here.points_first + 9.0 * here.points_second)


def test_owl_wing_closes_as_published():
    """Paredes (2018), table 8 read as directions: AE 108.06°, CF 263.95°, CH 100.72° with F at 124.62°."""
    motion = solve_motion(wing_pose(), WING)
    for link, degrees in (("AE", 108.06), ("CF", 263.95), ("CH", 100.72)):
        assert math.degrees(motion.angle(link)[-1]) % 360.0 == pytest.approx(degrees, abs=0.01)
    assert motion.residual < 1e-14
    [angle] = motion.turning_points("AE")
    assert math.degrees(angle) == pytest.approx(213.51, abs=0.005)
    assert motion.angular_speed("AE")[0] == 0.0  # it stands still: no speed was given
    # There AE, held, does not hold the wing.
    at = solve_motion(wing_pose(), [angle]).pose(0)
    assert at.dead_point_distance(Coordinate("AE")) < 1e-10 < at.dead_point_distance(Coordinate("GF"))


def test_owl_wing_cannot_be_driven_past_the_point_where_AE_turns_back():
    motion = solve_motion(wing_pose(), WING)
    [turn] = motion.turning_points("AE")
    limit = solve_motion(wing_pose(), [turn]).angle("AE")[0]
    with pytest.raises(DeadPointError) as caught:
        solve_motion(wing_pose(), np.radians([143.5, 150.0]), coordinate=Coordinate("AE"))
    assert caught.value.angle == pytest.approx(limit, abs=1e-9)
    assert caught.value.exit_status == 2
    assert "AE = 144.977865 deg" in str(caught.value)


@pytest.mark.parametrize("end", [3.0, -3.0])
def test_dead_points_of_a_four_bar(end):
    lengths = {"a": 70.0, "b": 50.0, "c": 60.0, "d": 100.0}
    pose = four_bar_pose(**lengths, angle=0.6)
    with pytest.raises(DeadPointError, match=r"^motion: .*dead point at crank = -?78\.463041 deg") as caught:
        solve_motion(pose, np.linspace(0.6, end, 5))
    assert "\n" not in str(caught.value)
    exact = min(abs(caught.value.angle - dead.theta2) for dead in FourBar(**lengths).dead_points())
    assert exact < 1e-9


@pytest.mark.parametrize("up", [True, False])
def test_next_to_a_dead_point_the_branch_is_kept(up):
    bar = FourBar(a=70.0, b=50.0, c=60.0, d=100.0)
    end = bar.input_range().intervals[0][1] - 1e-6
    pose = four_bar_pose(70.0, 50.0, 60.0, 100.0, angle=0.6, up=up)
    angles = end - np.geomspace(1.0, 1e-12, 80)
    motion = solve_motion(pose, angles)
    exact = bar.position(angles, branch="open" if up else "crossed")
    assert turned(motion.angle("rocker"), exact.theta4) < 1e-9


@pytest.mark.parametrize("excess", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("up", [True, False])
def test_branches_that_nearly_cross_are_not_mixed_up(excess, up):
    """A near parallelogram: at 0° and 180° its two branches pass within the square root of the excess."""
    lengths = (40.0, 100.0 + excess, 40.0 + excess, 100.0 + 1.5 * excess)
    bar = FourBar(**dict(zip("abcd", lengths, strict=True)))
    assert bar.input_range().full_turn
    branch = "open" if up else "crossed"
    start = float(bar.position(CRANK, branch=branch).theta4)
    coupler = float(bar.position(CRANK, branch=branch).theta3)
    pose = solve_pose(four_bar(*lengths), coordinate="crank", angle=CRANK, near={"rocker": start, "coupler": coupler})
    motion = solve_motion(pose, TURN)
    assert turned(motion.angle("rocker"), bar.position(TURN, branch=branch).theta4) < 1e-10


@pytest.mark.parametrize("end", [-1.0, 4.0])
def test_where_two_branches_cross_the_motion_stops(end):
    near = {"coupler": 0.0, "rocker": CRANK}
    pose = solve_pose(four_bar(40.0, 100.0, 40.0, 100.0), coordinate="crank", angle=CRANK, near=near)
    with pytest.raises(DeadPointError, match="two branches cross") as caught:
        solve_motion(pose, [CRANK, end])
    assert caught.value.angle == pytest.approx(0.0 if end < 0 else math.pi, abs=1e-6)


def test_a_redundant_parallelogram_moves():
    pose = parallelogram_pose()
    assert pose.linkage.mobility == 0
    motion = solve_motion(pose, TURN, speed=3.0, acceleration=1.0)
    for link in ("second", "third"):
        np.testing.assert_allclose(motion.angle(link), TURN, atol=1e-12)
        np.testing.assert_allclose(motion.angular_speed(link), 3.0, atol=1e-12)
        np.testing.assert_allclose(motion.angular_acceleration(link), 1.0, atol=1e-10)
    np.testing.assert_allclose(motion.angle("top"), 0.0, atol=1e-12)


def test_a_redundant_parallelogram_with_pivots_in_line_stops_where_its_cranks_are_in_line():
    pose = parallelogram_pose(parallelogram(third=(50.0, 0.0)))
    with pytest.raises(DeadPointError, match="two branches cross") as caught:
        solve_motion(pose, TURN)
    assert caught.value.angle == pytest.approx(math.pi, abs=1e-6)


def test_a_third_crank_of_another_length_locks_the_parallelogram():
    with pytest.raises(CaseError, match="mobility 0"):
        parallelogram_pose(parallelogram(length=30.1))


def test_the_order_of_the_angles_and_the_start_do_not_matter():
    pose = wing_pose()
    ordered = solve_motion(pose, WING)
    shuffled = np.random.default_rng(3).permutation(len(WING))
    np.testing.assert_allclose(solve_motion(pose, WING[shuffled]).q, ordered.q[shuffled], atol=1e-12)
    inside = solve_motion(ordered.pose(40), WING)
    np.testing.assert_allclose(inside.q, ordered.q, atol=1e-12)
    outside = solve_motion(pose, WING[60:] - 2.0 * math.pi)
    assert turned(outside.angle("ED"), ordered.angle("ED")[60:]) < 1e-12


def test_a_clockwise_turn():
    motion = solve_motion(four_bar_pose(), TURN[0] - (TURN - TURN[0]), speed=-2.0)
    forward = solve_motion(four_bar_pose(), TURN, speed=2.0)
    np.testing.assert_allclose(motion.position("coupler", "P"), forward.position("coupler", "P")[::-1], atol=1e-11)
    assert motion.returns
    assert motion.times[-1] == pytest.approx(math.pi)


def test_times_under_constant_acceleration():
    angles = np.linspace(CRANK, CRANK + 2.0, 9)
    speed = np.sqrt(2.0 * 0.5 * (angles - CRANK))
    motion = solve_motion(four_bar_pose(), angles, speed=speed, acceleration=0.5)
    np.testing.assert_allclose(motion.times, np.sqrt(2.0 * (angles - CRANK) / 0.5), atol=1e-12)
    assert solve_motion(four_bar_pose(), angles).times is None


def test_each_pose_is_one_that_assembles():
    motion = solve_motion(wing_pose(), WING)
    for i in (0, 50, 96):
        pose = motion.pose(i)
        near = {name: angle for name, angle in pose.angles.items() if name not in ("AG", "GF")}
        again = solve_pose(pose.linkage, coordinate="GF", angle=WING[i], near=near)
        for name, angle in pose.angles.items():
            assert turned(angle, again.angles[name]) < 1e-12
        np.testing.assert_allclose(motion.position("CH", "H")[i], pose.position("CH", "H"))


@pytest.mark.parametrize("angles", [[], [[0.1]], [math.nan]])
def test_angles_that_are_none(angles):
    with pytest.raises(CaseError, match="angles"):
        solve_motion(wing_pose(), angles)


def test_a_coordinate_that_does_not_move():
    with pytest.raises(CaseError, match="'AG' is not a moving link"):
        solve_motion(wing_pose(), [3.9], coordinate=Coordinate("AG"))
