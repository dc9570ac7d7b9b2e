"""Hernández (2022), resin-printed ornithopter: parametric rules, and which published kinematics follow."""

import math

import numpy as np
import pytest

from alula.geometry.mechanisms.ornithopter import OrnithopterRules, variants
from alula.geometry.mechanisms.wing_drive import WingDrive

RPM_150 = 150 * 2 * math.pi / 60


def degrees(value: float) -> float:
    return math.degrees(value)


def test_published_dimensions_of_the_built_ornithopter():
    sizes = OrnithopterRules().dimensions()
    assert sizes.pivot_offset == pytest.approx(7.06756, abs=5.1e-6)
    assert sizes.slot_reach == pytest.approx(7.67791, abs=5.1e-6)
    assert (sizes.crank_disc_radius, sizes.motor_half_width, sizes.body_half_width) == (4.5, 4.0, 4.5)
    assert (sizes.link_length, sizes.pivot_height, sizes.base_height) == (10.0, 10.0, 14.5)
    assert sizes.base_width == pytest.approx(8.56756, abs=5.1e-6)
    assert (sizes.pin_diameter, sizes.hole_diameter, sizes.thick_wall, sizes.thin_wall) == (2.0, 2.0, 0.5, 0.5)
    assert (sizes.lever_thickness, sizes.gear_thickness, sizes.crank_pin_height) == (3.5, 2.0, 2.0)


def test_variants_flap_over_twice_their_wing_angle():
    strokes = {name: degrees(rules.drive().extremes(1.0).stroke) for name, rules in variants().items()}
    assert list(strokes.values()) == pytest.approx([60.0, 40.0, 46.0], abs=1e-12)
    sizes = {name: rules.dimensions() for name, rules in variants().items()}
    assert sizes["30° 8 mm 25 mm"].slot_reach == pytest.approx(16.0)
    assert sizes["30° 8 mm 25 mm"].link_length == 20.0
    assert sizes["20° 3 mm 25 mm"].body_half_width == 8.0  # the 16 mm motor is wider than the crank disc


def test_published_kinematics_at_150_rpm():
    """401 °/s and 6792 °/s²: with the rule's rod of 10 mm between the pins 398.12 °/s and -6610.1 °/s²."""
    extremes = OrnithopterRules().drive().extremes(RPM_150)
    assert degrees(extremes.stroke) == pytest.approx(46.0, abs=1e-12)
    assert degrees(extremes.fastest_up) == pytest.approx(398.120, abs=1e-3)
    assert degrees(extremes.fastest_down) == pytest.approx(-398.120, abs=1e-3)
    assert degrees(extremes.least_acceleration) == pytest.approx(-6610.13, abs=1e-2)
    assert degrees(extremes.greatest_acceleration) == pytest.approx(4297.48, abs=1e-2)
    assert abs(degrees(extremes.fastest_up) / 401 - 1) == pytest.approx(0.0072, abs=1e-4)
    assert abs(degrees(extremes.least_acceleration) / -6792 - 1) == pytest.approx(0.0268, abs=1e-4)


def test_a_rod_of_9_mm_comes_closer_to_the_published_kinematics():
    """Were the two walls not part of it (9 mm between the pins), 401.93 °/s and -6779.6 °/s² would follow."""
    rules = OrnithopterRules()
    drive = WingDrive(throw=3.0, rod=9.0, pivot_offset=rules.dimensions().pivot_offset, pivot_height=9.0)
    extremes = drive.extremes(RPM_150)
    assert degrees(extremes.fastest_up) == pytest.approx(401.927, abs=1e-3)
    assert degrees(extremes.least_acceleration) == pytest.approx(-6779.62, abs=1e-2)


def test_published_linear_figures_belong_to_a_point_near_the_wing_pivot():
    """1.7 mm/s and 29 mm/s² cannot be the pin's (49.2 mm/s, -962 mm/s²); both fit a point 0.24 mm off a pivot."""
    extremes = OrnithopterRules().drive().extremes(RPM_150)
    assert extremes.pin_speed_up == pytest.approx(49.213, abs=1e-3)
    assert extremes.pin_acceleration_min == pytest.approx(-962.286, abs=1e-3)
    assert 1.7 / math.radians(401) == pytest.approx(0.243, abs=5e-4)
    assert 29 / math.radians(6792) == pytest.approx(0.245, abs=5e-4)


def test_filmed_frequency():
    """Ten frames at 500 per second are 50 Hz, that is 3000 rpm; wing speed grows with the crank's."""
    assert 500 / 10 * 60 == 3000
    drive = OrnithopterRules().drive()
    slow, fast = drive.extremes(RPM_150), drive.extremes(20 * RPM_150)
    assert fast.fastest_up == pytest.approx(20 * slow.fastest_up, rel=1e-12)
    assert fast.least_acceleration == pytest.approx(400 * slow.least_acceleration, rel=1e-12)


def test_filmed_figures_fit_no_single_crank_speed():
    """Filmed wing speed 444 °/s asks for 167 rpm, pin speeds of 30.74 and 32.6 mm/s for 94 and 99 rpm."""
    extremes = OrnithopterRules().drive().extremes(RPM_150)
    rpm = 150 * np.array(
        [444 / degrees(extremes.fastest_up), 30.74 / extremes.pin_speed_up, 32.6 / extremes.pin_speed_up]
    )
    assert rpm == pytest.approx([167.3, 93.7, 99.4], abs=0.1)
