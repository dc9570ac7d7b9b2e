import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.ornithopter import OrnithopterRules, motors
from alula.geometry.mechanisms.periodic import periodic_maximum, periodic_minimum
from alula.geometry.mechanisms.wing_drive import WingDrive

DRIVE = OrnithopterRules().drive()


@st.composite
def drives(draw):
    throw = draw(st.floats(0.5, 10))
    rod = throw * draw(st.floats(1.2, 6))
    return WingDrive(
        throw=throw, rod=rod, pivot_offset=throw * draw(st.floats(0.5, 5)), pivot_height=rod * draw(st.floats(0.8, 1.2))
    )


def test_motor_table():
    table = motors()
    assert list(table) == ["M-C 10 mm", "M-SC 10 mm", "M-SC 25 mm", "M-SC 30.5 mm"]
    last = table["M-SC 30.5 mm"]
    assert (last.shaft_diameter, last.shaft_height, last.diameter) == (2.0, 11.5, 23.85)
    assert (last.round_height, last.square_width, last.square_height) == (30.5, 18.0, 30.6)
    assert table["M-C 10 mm"].kind == "round"


def test_clearance_goes_to_pins_holes_and_walls_and_not_to_the_link():
    sizes = OrnithopterRules(clearance="0.2 mm").dimensions()
    assert (sizes.pin_diameter, sizes.hole_diameter) == pytest.approx((1.8, 2.2))
    assert (sizes.thick_wall, sizes.thin_wall) == pytest.approx((0.6, 0.4))
    assert sizes.crank_disc_radius == pytest.approx(4.6)
    assert sizes.link_length == pytest.approx(10.0)


def test_bad_rules():
    with pytest.raises(ValidationError, match="between 0 and 90 degrees"):
        OrnithopterRules(wing_angle="90 deg")
    with pytest.raises(ValidationError, match='there is no motor "M-X"; choose one of M-C 10 mm'):
        OrnithopterRules(motor="M-X")
    with pytest.raises(ValidationError, match="needs its unit"):
        OrnithopterRules(throw=3)
    with pytest.raises(CaseError, match="clearance = 1 mm must stay below 1 mm"):
        OrnithopterRules(clearance="1 mm").dimensions()
    with pytest.raises(CaseError, match=r"below the pin diameter of 0\.4 mm"):
        OrnithopterRules(clearance="0.5 mm", pin_diameter="0.4 mm").dimensions()
    with pytest.raises(CaseError, match="rod = 2 mm must be longer"):
        WingDrive(throw=3, rod=2, pivot_offset=7, pivot_height=10)
    with pytest.raises(CaseError, match="give a positive offset"):
        WingDrive(throw=3, rod=10, pivot_offset=0, pivot_height=10)


@given(drives(), st.floats(-math.pi, math.pi), st.floats(-50, 50))
def test_the_mechanism_closes_and_its_motion_is_its_derivative(drive, angle, speed):
    """Positions against the constraints; speeds and accelerations by differentiating those on paper a second way."""
    motion = drive.motion(angle, speed)
    crank = drive.throw * np.array([-math.sin(angle), math.cos(angle)])  # from the crank's pivot, the line upwards
    pin = np.array([0.0, float(motion.pin_height)])
    assert math.dist(crank, pin) == pytest.approx(drive.rod, rel=1e-12)
    # The pin lies in the slot: from the right pivot at X it is seen at the wing angle, mirrored.
    phi, reach = float(motion.wing_angle), float(motion.slot_position)
    seen = pin - np.array([drive.pivot_offset, drive.pivot_height])
    np.testing.assert_allclose(seen, reach * np.array([-math.cos(phi), math.sin(phi)]), atol=1e-12 * drive.rod)
    # Rod of constant length: (pin - crank)·(their relative velocity) = 0, and its derivative.
    crank_v = speed * drive.throw * np.array([-math.cos(angle), -math.sin(angle)])
    crank_a = -(speed**2) * crank
    rod, rod_v = pin - crank, np.array([0.0, float(motion.pin_speed)]) - crank_v
    rod_a = np.array([0.0, float(motion.pin_acceleration)]) - crank_a
    size = drive.rod * (np.abs(crank_v).max() + 1e-9)
    assert abs(rod @ rod_v) < 1e-11 * size
    size = drive.rod * np.abs(crank_a).max() + (rod_v @ rod_v) + 1e-9
    assert abs(rod @ rod_a + rod_v @ rod_v) < 1e-10 * size
    # The pin's velocity in polar coordinates about the wing's pivot: ρ' along the slot, ρ φ' across it.
    along, across = np.array([-math.cos(phi), math.sin(phi)]), np.array([math.sin(phi), math.cos(phi)])
    velocity = float(motion.slot_speed) * along + reach * float(motion.wing_speed) * across
    np.testing.assert_allclose(velocity, [0.0, float(motion.pin_speed)], atol=1e-11 * (abs(speed) * drive.rod + 1e-9))
    # Across the slot: ρ φ'' + 2 ρ' φ' = the pin's acceleration across it.
    coriolis = reach * float(motion.wing_acceleration) + 2 * float(motion.slot_speed) * float(motion.wing_speed)
    pull = float(motion.pin_acceleration)
    assert coriolis == pytest.approx(pull * math.cos(phi), abs=1e-10 * (abs(pull) + speed**2 * drive.rod + 1e-9))


def test_motion_agrees_with_differences():
    angle, step = np.linspace(0.0, 6.2, 50), 1e-5

    def state(t):
        motion = DRIVE.motion(angle + 3.0 * t, 3.0)
        return np.stack([motion.wing_angle, motion.pin_height]), np.stack([motion.wing_speed, motion.pin_speed])

    now = DRIVE.motion(angle, 3.0)
    (before, speed_before), (after, speed_after) = state(-step), state(step)
    np.testing.assert_allclose((after - before) / (2 * step), [now.wing_speed, now.pin_speed], atol=1e-8)
    np.testing.assert_allclose(
        (speed_after - speed_before) / (2 * step), [now.wing_acceleration, now.pin_acceleration], atol=1e-7
    )


@given(drives())
def test_extremes_bound_a_fine_turn(drive):
    extremes, fine = drive.extremes(2.0), drive.motion(np.linspace(0, 2 * np.pi, 20001), 2.0)
    size = float(np.abs(fine.wing_acceleration).max())
    assert extremes.highest == pytest.approx(float(fine.wing_angle.max()), abs=1e-6)
    assert extremes.lowest == pytest.approx(float(fine.wing_angle.min()), abs=1e-6)
    assert extremes.fastest_up == pytest.approx(float(fine.wing_speed.max()), rel=1e-5)
    assert extremes.greatest_acceleration == pytest.approx(float(fine.wing_acceleration.max()), abs=1e-5 * size)
    assert extremes.least_acceleration == pytest.approx(float(fine.wing_acceleration.min()), abs=1e-5 * size)


def test_periodic_maximum_is_refined():
    grid = np.arange(100) * (2 * np.pi / 100)
    assert periodic_maximum(np.sin(grid + 0.013)) == pytest.approx(1.0, abs=1e-6)
    assert np.sin(grid + 0.013).max() < 1 - 5e-5
    assert periodic_minimum(3 + np.cos(grid + 0.013)) == pytest.approx(2.0, abs=1e-6)
    assert periodic_maximum(np.full(5, 2.0)) == 2.0
