"""Momentum, energy and shaking of linkages against closed forms, and against point masses.

A link's mass is that of two equal points, each the radius of gyration away from its centroid: no formula for bodies is
needed for them, and their velocities come from Fourier series of their places over a full turn.
"""

import math

import numpy as np
import pytest
from motion_poses import (
    CRANK,
    drive_of,
    forces_of,
    four_bar_pose,
    kinetostatics,
    masses_of,
    quick_return_pose,
    scotch_yoke_pose,
    slider_crank_pose,
    weights_of,
    wing_pose,
)
from planar_linkages import joint, link

from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.loads.acting.weight import inertia_loads
from alula.loads.records.applied import PartMass
from alula.loads.statics.momentum import linkage_momentum, on_ground

TURNING = {
    "four-bar": four_bar_pose,
    "slider-crank": slider_crank_pose,
    "pin-in-slot": quick_return_pose,
    "scotch-yoke": scotch_yoke_pose,
}
SPEED, COUNT = 12.0, 256
ABOUT = 17.0 - 29.0j


def by_time(values):
    """The derivative by time (COUNT, ...) of what repeats after a turn."""
    waves = np.fft.fftfreq(COUNT, 1.0 / COUNT)[:, None]
    return SPEED * np.fft.ifft(1j * waves * np.fft.fft(values.reshape(COUNT, -1), axis=0), axis=0).reshape(values.shape)


@pytest.fixture(params=TURNING)
def turning(request):
    """Motion over a full turn at constant speed, masses, and places (COUNT, points) of point masses in their place."""
    pose = TURNING[request.param]()
    motion = solve_motion(pose, CRANK + np.arange(COUNT) * 2.0 * math.pi / COUNT, speed=SPEED)
    masses, points, weights = masses_of(pose), [], []
    for name, own in masses.items():
        first, at = next(iter(pose.linkage.links[name].points.items()))
        away = math.sqrt(own.inertia / own.mass) * np.exp(0.7j)
        turn = np.exp(1j * motion.angle(name))
        origin = motion.position(name, first) @ [1.0, 1.0j] - turn * complex(*at)
        points += [origin + turn * (complex(*own.centroid) + away * sign) for sign in (1.0, -1.0)]
        weights += [0.5 * own.mass] * 2
    return motion, masses, np.stack(points, axis=1), np.array(weights)


def close(found, expected, size=None):
    size = np.max(np.abs(expected)) if size is None else size
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * size)


def test_momentum_and_energy_are_those_of_point_masses(turning):
    motion, masses, points, weights = turning
    found = linkage_momentum(motion.placement, masses, ABOUT)
    velocity = by_time(points)
    close(found.linear, velocity @ weights)
    close(found.angular, (np.conj(points - ABOUT) * velocity).imag @ weights)
    close(found.kinetic, 0.5 * np.abs(velocity) ** 2 @ weights)
    # The whole mass moves as its centroid does.
    close(found.linear, weights.sum() * by_time(points @ weights / weights.sum()))
    np.testing.assert_allclose(found.kinetic, sum(one.kinetic for one in found.links.values()))
    np.testing.assert_allclose(found.linear, sum(one.linear for one in found.links.values()))


def test_shaking_is_what_momentum_loses(turning):
    motion, masses, points, weights = turning
    found = linkage_momentum(motion.placement, masses, ABOUT)
    velocity = by_time(points)
    close(found.shaking_force, -by_time(velocity @ weights))
    close(found.shaking_moment, -by_time((np.conj(points - ABOUT) * velocity).imag @ weights).real)


@pytest.mark.parametrize("name", [*TURNING, "six-bar"])
def test_the_ground_bears_joint_forces_and_the_reaction_of_the_drive(name):
    pose = TURNING[name]() if name in TURNING else wing_pose()
    angles = CRANK + np.linspace(0, 2 * math.pi, 61) if name in TURNING else np.radians(np.linspace(210.0, 126.0, 61))
    motion = solve_motion(pose, angles, speed=SPEED, acceleration=35.0)
    place, drive, masses = motion.placement, drive_of(pose), masses_of(pose)
    applied = forces_of(pose) + weights_of(pose)
    solved = kinetostatics(motion, drive, applied, masses)
    force, moment = on_ground([*applied, *inertia_loads(place, masses, np.zeros(3))], place, ABOUT)
    borne, turned = np.zeros(place.shape, dtype=complex), solved.torque_on(pose.linkage.ground)
    for point, wrench in solved.on_link(pose.linkage.ground):
        on = wrench[:, 0] + 1j * wrench[:, 1]
        borne = borne + on
        at = place.position(pose.linkage.ground, point) - ABOUT
        turned = turned + wrench[:, 5] + (np.conj(at) * on).imag
    clear = solved.leverage > 1e-3
    close(force[clear], borne[clear])
    close(moment[clear], turned[clear])
    # Without other loads that is the shaking force and moment.
    shaken = linkage_momentum(place, masses, ABOUT)
    alone = on_ground(inertia_loads(place, masses, np.zeros(3)), place, ABOUT)
    close(shaken.shaking_force, alone[0])
    close(shaken.shaking_moment, alone[1])


def test_a_bar_that_turns_about_its_end():
    """P = m ω L/2 across the bar, L = ω m L²/3 and T = ½ ω² m L²/3 about its end; it pulls outwards with m ω² L/2."""
    length, mass, speed, rate = 80.0, 3e-5, 7.0, 11.0
    bar = Linkage(
        {"base": link(ground=True, O=(0.0, 0.0), Q=(50.0, 0.0)), "bar": link(O=(0.0, 0.0), P=(length, 0.0))},
        {"O": joint("base", "bar")},
    )
    motion = solve_motion(solve_pose(bar, coordinate="bar", angle=0.3), [0.3, 0.9], speed=speed, acceleration=rate)
    own = PartMass(mass=mass, centroid=np.array([length / 2.0, 0.0]), inertia=mass * length**2 / 12.0)
    found = linkage_momentum(motion.placement, {"bar": own}, 0j)
    along = np.exp(1j * motion.angles)
    close(found.linear, mass * speed * length / 2.0 * 1j * along)
    close(found.angular, np.full(2, speed * mass * length**2 / 3.0))
    close(found.links["bar"].angular, np.full(2, speed * mass * length**2 / 12.0))
    close(found.kinetic, np.full(2, 0.5 * speed**2 * mass * length**2 / 3.0))
    close(found.shaking_force, mass * length / 2.0 * (speed**2 - 1j * rate) * along)
    close(found.shaking_moment, np.full(2, -rate * mass * length**2 / 3.0))


def test_a_slider_crank_shakes_along_its_slide_alone():
    """Norton, Design of Machinery, 5th ed., eq. 13.1d and 13.1e: velocity and acceleration of the piston, exact."""
    r, l, mass = 40.0, 130.0, 5e-5  # noqa: E741
    motion = solve_motion(slider_crank_pose(r, l, 0.0), CRANK + np.linspace(0.0, 2.0 * math.pi, 73), speed=SPEED)
    own = PartMass(mass=mass, centroid=np.zeros(2))
    found = linkage_momentum(motion.placement, {"block": own}, 0j)
    sin, cos = np.sin(motion.angles), np.cos(motion.angles)
    root = np.sqrt(l**2 - (r * sin) ** 2)
    velocity = -r * SPEED * (sin + r * np.sin(2.0 * motion.angles) / (2.0 * root))
    acceleration = -r * SPEED**2 * (cos - r * (l**2 * (1.0 - 2.0 * cos**2) - r**2 * sin**4) / root**3)
    close(found.linear, mass * velocity)
    close(found.kinetic, 0.5 * mass * velocity**2)
    close(found.shaking_force, -mass * acceleration)
    close(found.shaking_moment, np.zeros(73), size=mass * r**2 * SPEED**2)
    assert np.max(np.abs(found.shaking_force.real)) == pytest.approx(mass * r * SPEED**2 * (1.0 + r / l), rel=2e-3)
