"""Closure, invariance and derivatives of the closed forms, over random linkages."""

import math

import numpy as np
import pytest
from closed_forms import four_bar_motion, slider_crank_motion
from hypothesis import assume, given
from hypothesis import strategies as st

from alula.geometry.mechanisms.fourbar import FourBar

lengths = st.floats(0.05, 20.0)
angles = st.floats(-math.pi, math.pi)
branches = st.sampled_from(["open", "crossed"])


@st.composite
def four_bars(draw):
    a, b, c, d = (draw(lengths) for _ in range(4))
    assume(2 * max(a, b, c, d) < (a + b + c + d) * (1 - 1e-6))
    return FourBar(a=a, b=b, c=c, d=d)


@st.composite
def poses(draw):
    """Draw a four-bar and an input angle inside its range, some way off the dead points."""
    bar = draw(four_bars())
    low, high = draw(st.sampled_from(bar.input_range().intervals))
    theta2 = low + (high - low) * draw(st.floats(0.02, 0.98))
    transmission = bar.position([theta2]).transmission
    assume(not np.ma.getmaskarray(transmission).any())
    assume(math.sin(float(transmission[0])) > 1e-3)
    return bar, theta2


@given(poses(), branches)
def test_the_loop_closes(pose, branch):
    bar, theta2 = pose
    position = bar.position(theta2, branch=branch)
    links = bar.a * np.exp(1j * theta2) + bar.b * np.exp(1j * position.theta3) - bar.c * np.exp(1j * position.theta4)
    assert abs(links - bar.d) < 1e-12 * (bar.a + bar.b + bar.c + bar.d)
    assert bar.branch_of(theta2, float(position.theta3)) == branch


@given(poses(), branches, st.floats(1e-3, 1e3))
def test_scale_changes_no_angle(pose, branch, factor):
    bar, theta2 = pose
    assume(min(bar.a, bar.b, bar.c, bar.d) * factor > 1e-6)
    scaled = FourBar(a=bar.a * factor, b=bar.b * factor, c=bar.c * factor, d=bar.d * factor)
    here, there = bar.position(theta2, branch=branch), scaled.position(theta2, branch=branch)
    np.testing.assert_allclose(np.exp(1j * there.theta3), np.exp(1j * here.theta3), atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * there.theta4), np.exp(1j * here.theta4), atol=1e-9)


@given(poses())
def test_the_mirror_swaps_the_branches(pose):
    bar, theta2 = pose
    here, mirrored = bar.position(theta2, branch="open"), bar.position(-theta2, branch="crossed")
    np.testing.assert_allclose(np.exp(-1j * mirrored.theta3), np.exp(1j * here.theta3), atol=1e-12)
    np.testing.assert_allclose(np.exp(-1j * mirrored.theta4), np.exp(1j * here.theta4), atol=1e-12)


@given(poses(), branches)
def test_driving_the_output_leads_back(pose, branch):
    bar, theta2 = pose
    position = bar.position(theta2, branch=branch)
    reverse = bar.driven_by_output()
    angle, coupler = math.pi - float(position.theta4), -float(position.theta3)
    back = reverse.branch_of(angle, coupler)
    assume(back is not None)
    assume(math.hypot(reverse.a * math.cos(angle) - reverse.d, reverse.a * math.sin(angle)) > 1e-3 * bar.d)
    found = reverse.position(angle, branch=back)
    assume(math.sin(float(found.transmission)) > 1e-3)
    assert np.exp(1j * found.theta4) == pytest.approx(np.exp(1j * (math.pi - theta2)), abs=1e-9)
    assert np.exp(1j * found.theta3) == pytest.approx(np.exp(1j * coupler), abs=1e-9)


@given(poses(), branches, st.floats(-30, 30), st.floats(-100, 100))
def test_speeds_and_accelerations_are_derivatives(pose, branch, omega2, alpha2):
    """The loop, differentiated once and twice, closes; the six terms of each are summed independently of Norton's."""
    bar, theta2 = pose
    found = four_bar_motion(bar, theta2, omega2, alpha2, branch=branch)
    links = [
        (bar.a, theta2, omega2, alpha2),
        (bar.b, found.theta3, found.omega3, found.alpha3),
        (-bar.c, found.theta4, found.omega4, found.alpha4),
    ]
    speed = [length * 1j * w * np.exp(1j * angle) for length, angle, w, _ in links]
    pull = [length * (1j * alpha - w * w) * np.exp(1j * angle) for length, angle, w, alpha in links]
    assert abs(sum(speed)) <= 1e-9 * max(1e-12, *map(abs, speed))
    assert abs(sum(pull)) <= 1e-9 * max(1e-9, *map(abs, pull))


@given(four_bars())
def test_the_range_is_where_the_loop_closes(bar):
    reach = bar.input_range()
    theta2 = np.linspace(-np.pi, np.pi, 181)
    closes = ~np.ma.getmaskarray(bar.position(theta2).theta3)
    inside = np.array([reach.interval_of(angle) is not None for angle in theta2])
    # Angles at an end may fall either way by rounding, and with A on O4 the pose is not definite.
    ends = [end for interval in reach.intervals for end in interval]
    off = np.min([np.abs(np.sin((theta2 - end) / 2)) for end in ends], axis=0) > 1e-6
    off &= np.hypot(bar.a * np.cos(theta2) - bar.d, bar.a * np.sin(theta2)) > 1e-9
    np.testing.assert_array_equal(closes[off], inside[off])
    if bar.grashof.relation != "equal":
        assert reach.full_turn == (bar.grashof.inversion in ("crank-rocker", "double-crank"))


@given(poses(), branches)
def test_transmission_stays_in_its_range(pose, branch):
    bar, theta2 = pose
    reach = bar.transmission_range()
    transmission = float(bar.position(theta2, branch=branch).transmission)
    assert reach.minimum - 1e-9 <= transmission <= reach.maximum + 1e-9


@given(lengths, lengths, st.floats(-10, 10), angles, branches, st.floats(-30, 30), st.floats(-100, 100))
def test_slider_crank_closes_with_its_derivatives(a, b, c, theta2, branch, omega2, alpha2):
    assume(abs(a * math.sin(theta2) - c) < 0.999 * b)
    assume(abs(c) <= a + b)
    motion = slider_crank_motion(a, b, c, theta2, omega2, alpha2, branch=branch)
    theta3, omega3, alpha3 = (float(x) for x in (motion.theta3, motion.omega3, motion.alpha3))
    # a e^{jθ2} - b e^{jθ3} - j c - d = 0, and its derivatives
    crank, rod = a * np.exp(1j * theta2), b * np.exp(1j * theta3)
    assert abs(crank - rod - 1j * c - motion.d) < 1e-12 * (a + b + abs(c)) * 10
    speed = [1j * omega2 * crank, -1j * omega3 * rod, -motion.d_dot]
    pull = [(1j * alpha2 - omega2**2) * crank, -(1j * alpha3 - omega3**2) * rod, -motion.d_ddot]
    assert abs(sum(speed)) <= 1e-9 * max(1e-12, *map(abs, speed))
    assert abs(sum(pull)) <= 1e-9 * max(1e-9, *map(abs, pull))
