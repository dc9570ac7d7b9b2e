"""The energy balance closes: drive power = rate of kinetic and potential energy - power of the applied loads.

Once with the rates by exact differentiation, at every pose, and once with the energies alone, whose
rates are then taken numerically: by Fourier series over a full turn, by Chebyshev series over a range.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from motion_poses import (
    CRANK,
    drive_of,
    forces_of,
    four_bar_pose,
    kinetostatics,
    masses_of,
    parallelogram_pose,
    quick_return_pose,
    scotch_yoke_pose,
    slider_crank_pose,
    virtual_work,
    weights_of,
    wing_pose,
)

from alula.geometry.linkage.motion import solve_motion

SPEED = 12.0
TURNING = {
    "four-bar": four_bar_pose,
    "slider-crank": slider_crank_pose,
    "pin-in-slot": quick_return_pose,
    "scotch-yoke": scotch_yoke_pose,
}
OPEN, CLOSED = math.radians(210.0), math.radians(126.0)
"""A range of the owl wing on one side of the point at which AE turns back (213.51°)."""


def balance(found):
    """Largest imbalance as a share of the largest drive power."""
    clear = found.leverage > 1e-3
    return np.max(np.abs(found.imbalance[clear])) / np.max(np.abs(found.drive_power[clear]))


@pytest.mark.parametrize("name", [*TURNING, "six-bar"])
@pytest.mark.parametrize("acceleration", [0.0, 35.0])
def test_rates_at_every_pose(name, acceleration):
    pose = TURNING[name]() if name in TURNING else wing_pose()
    angles = CRANK + np.linspace(0, 2 * math.pi, 361) if name in TURNING else np.linspace(OPEN, CLOSED, 361)
    sense = np.sign(angles[-1] - angles[0])
    speed = sense * np.sqrt(SPEED**2 + 2.0 * acceleration * np.abs(angles - angles[0]))
    motion = solve_motion(pose, angles, speed=speed, acceleration=sense * acceleration)
    found = kinetostatics(motion, drive_of(pose), forces_of(pose) + weights_of(pose), masses_of(pose))
    assert balance(found) < 1e-8
    # Each term matters: without any one of them the balance is open.
    for term in ("kinetic_rate", "potential_rate", "applied"):
        assert np.max(np.abs(getattr(found.power, term))) > 1e-3 * np.max(np.abs(found.drive_power))


@pytest.mark.parametrize("name", TURNING)
def test_energies_over_a_turn(name):
    pose = TURNING[name]()
    count = 256
    angles = CRANK + np.arange(count) * 2.0 * math.pi / count
    motion = solve_motion(pose, angles, speed=SPEED)
    found = kinetostatics(motion, drive_of(pose), forces_of(pose) + weights_of(pose), masses_of(pose))
    energy = found.power.kinetic + found.power.potential
    waves = np.fft.fftfreq(count, 1.0 / count)
    rate = SPEED * np.fft.ifft(1j * waves * np.fft.fft(energy)).real
    np.testing.assert_allclose(
        found.drive_power + found.power.applied, rate, rtol=0, atol=1e-8 * np.max(np.abs(found.drive_power))
    )


def test_energies_over_the_wing():
    """The drive torque acts on AE while the speed of GF is given."""
    pose = wing_pose()
    nodes = np.cos(np.pi * (np.arange(140) + 0.5) / 140)
    angles = 0.5 * (OPEN + CLOSED) + 0.5 * (OPEN - CLOSED) * nodes
    motion = solve_motion(pose, angles, speed=-SPEED)
    found = kinetostatics(motion, drive_of(pose), forces_of(pose) + weights_of(pose), masses_of(pose))
    energy = np.polynomial.Chebyshev.fit(nodes, found.power.kinetic + found.power.potential, 139, domain=[-1, 1])
    rate = energy.deriv()(nodes) / (0.5 * (OPEN - CLOSED)) * -SPEED
    np.testing.assert_allclose(
        found.drive_power + found.power.applied, rate, rtol=0, atol=1e-8 * np.max(np.abs(found.drive_power))
    )


def test_over_a_full_turn_conservative_loads_take_no_work():
    pose = four_bar_pose()
    angles = CRANK + np.arange(128) * 2.0 * math.pi / 128
    motion = solve_motion(pose, angles, speed=SPEED)
    found = kinetostatics(motion, drive_of(pose), weights_of(pose), masses_of(pose))
    assert abs(np.mean(found.drive_power)) < 1e-12 * np.max(np.abs(found.drive_power))


def test_a_redundant_linkage_balances_too():
    pose = parallelogram_pose()
    angles = CRANK + np.arange(64) * 2.0 * math.pi / 64
    motion = solve_motion(pose, angles, speed=SPEED)
    masses, weights = masses_of(pose), weights_of(pose)
    torque = virtual_work(motion, drive_of(pose), weights, masses)
    # At constant speed the cranks and the level coupler keep their kinetic energy; the weights alone are lifted.
    potential = np.zeros(len(angles))
    for load in weights:
        own, at = load.mass, motion.position(load.link, next(iter(pose.linkage.links[load.link].points)))
        turn = np.exp(1j * motion.angle(load.link)) * complex(*own.centroid)
        potential -= own.mass * (at + np.stack([turn.real, turn.imag], axis=1)) @ load.specific_force[:2]
    waves = np.fft.fftfreq(64, 1.0 / 64)
    lifted = np.fft.ifft(1j * waves * np.fft.fft(potential)).real
    np.testing.assert_allclose(torque, lifted, rtol=0, atol=1e-10 * np.max(np.abs(torque)))


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 1e3, 1e6])
def test_masses_of_very_different_size(ratio):
    """Every other link's mass times ``ratio``: joint forces balance and work as the motion alone says."""
    pose = four_bar_pose()
    own = masses_of(pose)
    for name in list(own)[::2]:
        own[name] = replace(own[name], mass=ratio * own[name].mass, inertia=ratio * own[name].inertia)
    motion = solve_motion(pose, CRANK + np.linspace(0, 2 * math.pi, 181), speed=SPEED, acceleration=35.0)
    found = kinetostatics(motion, drive_of(pose), forces_of(pose), own)
    assert balance(found) < 1e-10
    torque = virtual_work(motion, drive_of(pose), forces_of(pose), own)
    np.testing.assert_allclose(found.drive_torque, torque, rtol=0, atol=1e-10 * np.max(np.abs(torque)))
