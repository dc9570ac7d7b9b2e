"""The motion of a case: what its table says, and what is refused in one sentence."""

import math

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case
from alula.loads.states.actions import acting_loads
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.masses import laden_masses
from alula.loads.statics.statics import solve_statics

FOUR_BAR = """
schema_version = 1
title = "A four-bar"
massless = ["crank", "rocker"]
[links.base]
ground = true
points.O2 = ["0 mm", "0 mm"]
points.O4 = ["100 mm", "0 mm"]
[links.crank]
points.O2 = ["0 mm", "0 mm"]
points.A = ["40 mm", "0 mm"]
[links.coupler]
points.A = ["0 mm", "0 mm"]
points.B = ["120 mm", "0 mm"]
points.P = ["60 mm", "40 mm"]
[links.rocker]
points.O4 = ["0 mm", "0 mm"]
points.B = ["80 mm", "0 mm"]
[joints]
O2 = { links = ["base", "crank"] }
A = { links = ["crank", "coupler"] }
B = { links = ["coupler", "rocker"] }
O4 = { links = ["base", "rocker"] }
[pose]
coordinate = "crank"
angle = "40 deg"
near = { coupler = "20 deg", rocker = "57 deg" }
[drive]
link = "crank"
joint = "O2"
[motion]
turn = true
poses = 37
speed = "150 rpm"
inertia = true
[[carried]]
link = "coupler"
at = "P"
mass = "200 g"
centroid = ["60 mm", "10 mm"]
radius_of_gyration = "40 mm"
[load_cases.hung]
own_weight = false
forces = [{ link = "coupler", at = "P", force = ["0 N", "-3 N"] }]
[load_cases.follower]
own_weight = false
forces = [{ link = "rocker", at = "B", force = ["0 N", "3 N"], axes = "link" }]
spread = [{ link = "coupler", start = "A", end = "B", total = ["1 N", "2 N"], axes = "link" }]
"""


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "four-bar.toml"
    path.write_text(FOUR_BAR, encoding="utf-8")
    return str(path)


def solved(path, *overrides):
    return solve_case_motion(read_case(path, overrides))


def test_a_full_turn_at_constant_speed(path):
    result = solved(path)
    omega = 150.0 * 2.0 * math.pi / 60.0
    np.testing.assert_allclose(result.motion.speed, omega)
    assert result.motion.returns
    assert result.motion.times[-1] == pytest.approx(60.0 / 150.0)
    laden = laden_masses(result.case, result.masses)
    assert laden["coupler"].mass == pytest.approx(2e-4)
    assert laden["coupler"].inertia == pytest.approx(2e-4 * 40.0**2)
    for load_case in ("hung", "follower"):
        solution = result.forces[load_case]
        assert np.max(np.abs(solution.imbalance)) < 1e-8 * np.max(np.abs(solution.drive_power))
    assert result.dead_points == ()


def test_inertia_counts_only_where_it_is_asked_for(path):
    with_inertia, without = solved(path), solved(path, "motion.inertia=false")
    assert np.max(np.abs(with_inertia.torque["hung"] - without.torque["hung"])) > 10.0
    assert np.max(without.forces["hung"].power.kinetic) == 0.0


def test_carried_masses_weigh(path):
    result = solved(path, "motion.inertia=false", "load_cases.hung.own_weight=true")
    ground = result.forces["hung"].forces["O2"] + result.forces["hung"].forces["O4"]
    np.testing.assert_allclose(ground, np.tile([0.0, 3.0 + 0.2 * 9.81], (37, 1)), atol=1e-10)


def test_loads_in_the_axes_of_their_link_are_so_in_statics_too(path):
    case = read_case(path)
    result = solved(path, "motion.inertia=false")
    for i in (0, 11, 23):
        pose = result.motion.pose(i)
        one = solve_statics(
            pose, case.pinned_drive, acting_loads(case, case.load_cases["follower"], pose.placement, {})
        )
        assert result.torque["follower"][i] == pytest.approx(one.drive_torque, abs=1e-10)


def test_a_range_is_passed_in_its_order(path):
    result = solved(path, "motion.turn=false", 'motion.range=["100 deg", "60 deg"]', 'motion.acceleration="50 rad/s^2"')
    motion = result.motion
    assert np.degrees(motion.angles[[0, -1]]) == pytest.approx([100.0, 60.0])
    assert motion.speed[0] == pytest.approx(-5.0 * math.pi)
    assert np.all(motion.acceleration == -50.0)
    assert motion.speed[-1] ** 2 == pytest.approx(motion.speed[0] ** 2 + 100.0 * math.radians(40.0))
    # The time of a body that accelerates evenly.
    t = motion.times
    np.testing.assert_allclose(motion.angles, motion.angles[0] + motion.speed[0] * t - 25.0 * t**2, atol=1e-12)


def test_another_link_may_be_the_coordinate(path):
    result = solved(
        path, "motion.turn=false", 'motion.coordinate="rocker"', 'motion.range=["70 deg", "110 deg"]', "motion.poses=5"
    )
    np.testing.assert_allclose(np.degrees(result.motion.angle("rocker")), np.linspace(70.0, 110.0, 5))
    assert result.drive.link == "crank"


def test_a_clockwise_turn(path):
    assert np.degrees(solved(path, 'motion.speed="-150 rpm"').motion.angles[-1]) == pytest.approx(-320.0)


def test_a_redundant_linkage_has_a_torque_alone(path):
    text = FOUR_BAR.replace(
        'points.B = ["120 mm", "0 mm"]', 'points.B = ["100 mm", "0 mm"]\npoints.M = ["50 mm", "20 mm"]'
    )
    text = text.replace(
        'points.O4 = ["100 mm", "0 mm"]', 'points.O4 = ["100 mm", "0 mm"]\npoints.N = ["50 mm", "20 mm"]'
    )
    text = text.replace('["80 mm", "0 mm"]', '["40 mm", "0 mm"]')
    text = text.replace(
        "[joints]", '[links.third]\npoints.N = ["0 mm", "0 mm"]\npoints.M = ["40 mm", "0 mm"]\n[joints]'
    )
    text = text.replace("[pose]", 'N = { links = ["base", "third"] }\nM = { links = ["coupler", "third"] }\n[pose]')
    text = text.replace(
        'coupler = "20 deg", rocker = "57 deg"', 'coupler = "0 deg", rocker = "40 deg", third = "40 deg"'
    )
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text)
    result = solved(path, "motion.inertia=false")
    assert result.case.linkage.mobility == 0
    assert result.forces == {}
    np.testing.assert_allclose(result.torque["hung"], 3.0 * 40.0 * np.cos(result.motion.angles), atol=1e-9)


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        (['motion.speed="150"'], r"motion\.speed .*needs its unit"),
        (["motion.speed=150"], r"motion\.speed .*needs its unit"),
        (['motion.speed="150 mm/s"'], r"motion\.speed .*not a unit of angular speed"),
        (['motion.range=["0 deg", "90 deg"]'], "either turn = true or a range"),
        (["motion.turn=false"], "either turn = true or a range"),
        (["motion.turn=false", 'motion.range=["9 deg", "9 deg"]'], "begins and ends at the same angle"),
        (["motion.turn=false", 'motion.range=["0 deg", "90 deg"]', 'motion.speed="-1 rpm"'], "must not be negative"),
        (['motion.speed="0 rpm"'], "inertia = true needs a speed"),
        (['motion.speed="0 rpm"', 'motion.acceleration="-1 rad/s^2"'], "must be positive"),
        (['motion.acceleration="-500 rad/s^2"'], r"slows down to a stop at 54\.137\d* deg"),
        (['motion.coordinate="base"'], "'base' is not a moving link"),
        (['carried.0.link="base"'], "'base' is not a moving link"),
        (['carried.0.mass="0 g"'], r"carried\.0\.mass .*greater than zero"),
        (["carried=[]"], r"motion\.speed: link 'coupler' has neither a part nor a mass.*massless"),
        (["motion.poses=1"], r"motion\.poses"),
        (
            ['motion.coordinate="rocker"', 'drive.link="rocker"', 'drive.joint="O4"'],
            r"dead point at rocker = \d+\.\d+ deg",
        ),
        (['pose.near={ coupler = "200 deg", rocker = "57 deg" }'], "no assembly lies within 90 deg"),
    ],
)
def test_bad_input_ends_in_one_sentence(path, overrides, sentence):
    with pytest.raises(CaseError, match=sentence) as caught:
        solved(path, *overrides)
    assert caught.value.exit_status == 2
    assert "\n" not in str(caught.value)


def test_a_case_without_motion(path):
    with open(path, encoding="utf-8") as stream:
        text = stream.read()
    head, _, rest = text.partition("[motion]")
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(head + rest[rest.index("[load_cases.hung]") :])
    with pytest.raises(CaseError, match=r"the case states no motion; add \[motion\]"):
        solved(path)


def test_built_in_owl_wing_closes():
    result = solve_case_motion(read_case("owl-wing-static"))
    assert abs(result.torque["weight"][-1]) == pytest.approx(19.90, abs=5e-3)
    assert [math.degrees(a) for a in result.dead_points] == pytest.approx([213.51], abs=5e-3)
