"""Properties of any motion: closed loops, rigid links, invariance, superposition, virtual work."""

import math
from dataclasses import replace

import numpy as np
import pytest
from closed_forms import four_bar_motion
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from motion_poses import drive_of, forces_of, kinetostatics, masses_of, virtual_work, weights_of
from planar_linkages import OPEN_WING, four_bar, joint, link, six_bar

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import Motion, solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.mechanisms.fourbar import FourBar
from alula.loads.records.applied import PartMass, PointLoad
from alula.loads.statics.statics import Drive

RANGE = np.radians(np.linspace(228.15, 130.0, 25))
factors = st.floats(0.93, 1.07)
offsets = st.floats(-6.0, 6.0)


@st.composite
def six_bars(draw) -> Linkage:
    """The owl wing's topology with other lengths and pins off the links' axes."""
    length = lambda nominal: nominal * draw(factors)  # noqa: E731
    off = lambda: draw(offsets)  # noqa: E731
    return Linkage(
        {
            "AG": link(ground=True, A=(off(), off()), G=(off(), length(125.0))),
            "GF": link(G=(0.0, 0.0), F=(length(50.0), off())),
            "AE": link(A=(0.0, 0.0), B=(length(112.0), off()), E=(length(190.0), off())),
            "CF": link(F=(0.0, 0.0), B=(length(60.0), off()), C=(length(150.0), off())),
            "CH": link(C=(0.0, 0.0), D=(length(77.0), off()), H=(length(124.0), off())),
            "ED": link(E=(0.0, 0.0), D=(length(88.0), off())),
        },
        six_bar().joints | {"A": joint("AG", "AE")},
    )


def move(linkage: Linkage, **rates: float) -> Motion:
    """Move a wing over its range; examples that do not assemble or meet a dead point are passed over."""
    try:
        pose = solve_pose(linkage, coordinate="GF", angle=float(RANGE[0]), near=OPEN_WING)
        return solve_motion(pose, RANGE, **rates)
    except CaseError:
        assume(False)
        raise


@given(six_bars())
@settings(max_examples=25)
def test_loops_stay_closed_and_links_rigid(linkage):
    motion = move(linkage, speed=4.0, acceleration=7.0)
    longest = linkage.longest
    for name, record in linkage.joints.items():
        points = linkage.joint_points(name)
        first, second = (motion.position(n, p) for n, p in zip(record.links, points, strict=True))
        assert np.max(np.abs(first - second)) < 1e-12 * longest
        for of in (motion.velocity, motion.linear_acceleration):
            first, second = (of(n, p) for n, p in zip(record.links, points, strict=True))
            assert np.max(np.abs(first - second)) < 1e-9 * max(np.max(np.abs(first)), 1.0)
    for name in linkage.moving:
        points = linkage.links[name].points
        for one in points:
            for other in points:
                span = motion.position(name, one) - motion.position(name, other)
                length = math.dist(points[one], points[other])
                assert np.max(np.abs(np.hypot(*span.T) - length)) < 1e-12 * longest
    assert np.max(np.abs(np.diff(motion.q[:, : len(linkage.moving)], axis=0))) < 1.0


@given(st.floats(10.0, 60.0), st.floats(40.0, 150.0), st.floats(40.0, 150.0), st.floats(40.0, 150.0), st.booleans())
@settings(max_examples=60)
def test_random_four_bars_follow_their_closed_form(a, b, c, d, up):
    assume(2.0 * max(a, b, c, d) < 0.999 * (a + b + c + d))
    bar = FourBar(a=a, b=b, c=c, d=d)
    assume(not bar.input_range().change_points)
    low, high = bar.input_range().intervals[0]
    low, high = low + 1e-3, high - 1e-3
    assume(high - low > 0.1)
    branch = "open" if up else "crossed"
    middle = 0.5 * (low + high)
    start = bar.position(middle, branch=branch)
    near = {"coupler": float(start.theta3), "rocker": float(start.theta4)}
    pose = solve_pose(four_bar(a, b, c, d), coordinate="crank", angle=middle, near=near)
    angles = np.linspace(low, high, 33)
    motion = solve_motion(pose, angles, speed=1.0)
    exact = four_bar_motion(bar, angles, 1.0, branch=branch)
    assert np.max(np.abs(np.exp(1j * motion.angle("rocker")) - np.exp(1j * exact.theta4))) < 1e-10
    size = np.max(np.abs(exact.omega4)) + 1.0
    np.testing.assert_allclose(motion.angular_speed("rocker"), exact.omega4, rtol=0, atol=1e-9 * size)


@given(st.floats(0.01, 50.0), st.floats(-3.0, 3.0), st.booleans(), st.floats(-500.0, 500.0), st.floats(-500.0, 500.0))
@settings(max_examples=30)
def test_invariance(scale, turn, mirrored, x, y):
    """A wing that is scaled, turned, mirrored and moved moves alike; forces and torques follow."""
    mirror = -1.0 if mirrored else 1.0
    drive = Drive(link="AE", joint="A")

    def image(z):
        return np.where(mirrored, np.conj(z), z) * np.exp(1j * turn)

    def solve(linkage, angle, near, speed, force, size):
        pose = solve_pose(linkage, coordinate="GF", angle=angle(RANGE[0]), near={k: angle(v) for k, v in near.items()})
        motion = solve_motion(pose, angle(RANGE), speed=speed)
        wrench = np.array([force.real, force.imag, 0.0, 0.0, 0.0, 0.0])
        own = {"CH": PartMass(mass=1e-5, centroid=np.array([70.0, 0.0]) * size, inertia=0.02 * size**2)}
        static = kinetostatics(motion, drive, [PointLoad(link="CH", point="H", wrench=wrench)])
        return motion, static, kinetostatics(motion, drive, [], own)

    force = 0.3 - 0.8j
    motion, static, inert = solve(six_bar(), lambda a: a, OPEN_WING, -5.0, force, 1.0)
    shifted = six_bar(scale=scale, ground_turn=turn, mirror=mirror, shift=complex(x, y))
    other, other_static, other_inert = solve(
        shifted, lambda a: mirror * a + turn, OPEN_WING, -5.0 * mirror, complex(image(force)), scale
    )
    span = scale * 200.0 + math.hypot(x, y)
    np.testing.assert_allclose(other.points, image(motion.points) * scale + complex(x, y), atol=1e-11 * span)
    for name in ("AE", "CH"):
        np.testing.assert_allclose(other.angular_speed(name), mirror * motion.angular_speed(name), atol=1e-8)
    for one, two, power in ((static, other_static, 0), (inert, other_inert, 1)):
        held = one.leverage > 1e-2
        for name, found in two.forces.items():
            z = one.forces[name] @ np.array([1.0, 1.0j])
            size = np.max(np.abs(z[held]))
            np.testing.assert_allclose(
                (found @ np.array([1.0, 1.0j]))[held], (image(z) * scale**power)[held], atol=1e-8 * size * scale**power
            )
        expected = mirror * one.drive_torque * scale ** (power + 1)
        np.testing.assert_allclose(two.drive_torque[held], expected[held], atol=1e-8 * np.max(np.abs(expected[held])))
    np.testing.assert_allclose(
        np.sort(mirror * (np.array(other_static.dead_points) - turn)), static.dead_points, atol=1e-9
    )


@given(six_bars(), st.floats(-30.0, 30.0), st.floats(-100.0, 100.0), st.floats(-3.0, 3.0))
@settings(max_examples=25)
def test_superposition_and_virtual_work(linkage, speed, acceleration, factor):
    motion = move(linkage, speed=speed, acceleration=acceleration)
    pose, masses = motion.pose(0), masses_of(motion.pose(0))
    drive, forces, weights = drive_of(pose), forces_of(pose), weights_of(pose)
    alone, weight = kinetostatics(motion, drive, forces), kinetostatics(motion, drive, weights, masses)
    scaled = [replace(load, wrench=factor * load.wrench) for load in forces if isinstance(load, PointLoad)]
    points = kinetostatics(motion, drive, [load for load in forces if isinstance(load, PointLoad)])
    sums = (
        (kinetostatics(motion, drive, forces + weights, masses), [(1.0, alone), (1.0, weight)]),
        (kinetostatics(motion, drive, scaled + weights, masses), [(factor, points), (1.0, weight)]),
    )
    held = alone.leverage > 1e-2
    assume(np.any(held))
    for whole, parts in sums:
        bound = sum(np.max(np.abs(part.drive_torque[held])) for _, part in parts) + 1.0
        total = sum(f * part.drive_torque for f, part in parts)
        np.testing.assert_allclose(whole.drive_torque[held], total[held], rtol=0, atol=1e-9 * bound)
        for name, force in whole.forces.items():
            total = sum(f * part.forces[name] for f, part in parts)
            bound = sum(np.max(np.abs(part.forces[name][held])) for _, part in parts) + 1.0
            np.testing.assert_allclose(force[held], total[held], rtol=0, atol=1e-9 * bound)
    work = virtual_work(motion, drive, forces + weights, masses)[held]
    np.testing.assert_allclose(sums[0][0].drive_torque[held], work, rtol=0, atol=1e-9 * (np.max(np.abs(work)) + 1.0))
    peak = np.max(np.abs(sums[0][0].drive_power[held])) + np.max(np.abs(sums[0][0].power.applied)) + 1e-9
    assert np.max(np.abs(sums[0][0].imbalance[held])) <= 1e-8 * peak


def test_a_dead_point_is_told_and_not_passed_over():
    """What ``move`` passes over above is a sentence with an angle, not a crash."""
    pose = solve_pose(six_bar(), coordinate="GF", angle=float(RANGE[0]), near=OPEN_WING)
    with pytest.raises(DeadPointError, match=r"GF = 122\.837129 deg"):
        solve_motion(pose, np.radians([228.15, 100.0]))
