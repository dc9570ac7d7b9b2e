"""R. L. Norton, Design of Machinery, 5th ed.: worked examples 4-1, 4-2, 6-7 and 7-1, to their printed digits."""

import math

import numpy as np
import pytest
from closed_forms import four_bar_motion, slider_crank_motion

from alula.geometry.mechanisms.fourbar import FourBar

FOUR_BAR = FourBar(a=40, b=120, c=80, d=100)
THETA2 = math.radians(40)


@pytest.mark.parametrize(("branch", "theta3", "theta4"), [("open", 20.2979, 57.3249), ("crossed", -60.9780, -98.0050)])
def test_example_4_1_position(branch, theta3, theta4):
    position = FOUR_BAR.position(THETA2, branch=branch)
    np.testing.assert_allclose(np.degrees([position.theta3, position.theta4]), [theta3, theta4], atol=5.1e-5)


@pytest.mark.parametrize(("branch", "omega3", "omega4"), [("open", -4.1209, 6.9980), ("crossed", -9.2588, -20.3777)])
def test_example_6_7_velocity(branch, omega3, omega4):
    velocity = four_bar_motion(FOUR_BAR, THETA2, 25.0, branch=branch)
    np.testing.assert_allclose([velocity.omega3, velocity.omega4], [omega3, omega4], atol=5.1e-5)


def test_example_7_1_acceleration():
    acceleration = four_bar_motion(FOUR_BAR, THETA2, 25.0, 15.0)
    np.testing.assert_allclose([acceleration.alpha3, acceleration.alpha4], [296.089, 470.134], atol=5.1e-4)


@pytest.mark.parametrize(("branch", "theta3", "d"), [("open", 152.913, 126.838), ("crossed", 27.087, -86.838)])
def test_example_4_2_offset_slider_crank(branch, theta3, d):
    position = slider_crank_motion(40, 120, -20, math.radians(60), 1.0, branch=branch)
    assert math.degrees(position.theta3) == pytest.approx(theta3, abs=5.1e-4)
    assert float(position.d) == pytest.approx(d, abs=5.1e-4)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_equations_4_10b_and_4_13_as_printed_agree(branch):
    a, b, c, d = FOUR_BAR.a, FOUR_BAR.b, FOUR_BAR.c, FOUR_BAR.d
    K1, K2, K3 = d / a, d / c, (a * a - b * b + c * c + d * d) / (2 * a * c)
    K4, K5 = d / b, (c * c - d * d - a * a - b * b) / (2 * a * b)
    theta2 = np.radians(np.arange(1.0, 360.0, 7.0))
    cosine, sine = np.cos(theta2), np.sin(theta2)
    sign = -1 if branch == "open" else 1

    def half_tangent(p, q, r):
        return 2 * np.arctan((-q + sign * np.sqrt(q * q - 4 * p * r)) / (2 * p))

    theta4 = half_tangent(cosine - K1 - K2 * cosine + K3, -2 * sine, K1 - (K2 + 1) * cosine + K3)
    theta3 = half_tangent(cosine - K1 + K4 * cosine + K5, -2 * sine, K1 + (K4 - 1) * cosine + K5)
    position = FOUR_BAR.position(theta2, branch=branch)
    np.testing.assert_allclose(np.exp(1j * position.theta4), np.exp(1j * theta4), atol=1e-12)
    np.testing.assert_allclose(np.exp(1j * position.theta3), np.exp(1j * theta3), atol=1e-12)
