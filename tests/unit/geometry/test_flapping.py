import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.flapping import FlappingWing

CHOSEN = FlappingWing(crank=3, coupler=21, rocker=9, width=9.8, height=20.5)
TURN = np.linspace(0.0, 2 * np.pi, 361)


@st.composite
def wings(draw):
    """Draw a wing whose crank turns fully, with room to spare."""
    width, height = draw(st.floats(4, 20)), draw(st.floats(5, 40))
    ground = math.hypot(width, height)
    crank = draw(st.floats(0.05, 0.15)) * ground
    rocker = draw(st.floats(0.3, 0.7)) * ground
    spare = draw(st.floats(0.1, 0.9))
    low, high = ground + crank - rocker, ground - crank + rocker
    return FlappingWing(crank=crank, coupler=low + spare * (high - low), rocker=rocker, width=width, height=height)


@given(wings(), st.sampled_from(["right", "left"]))
def test_both_sides_close_in_the_frame_of_the_whole(wing, side):
    pose = wing.pose(TURN, side)
    pivot = np.array([wing.width if side == "right" else -wing.width, wing.height])
    size = wing.ground
    np.testing.assert_allclose(np.hypot(*pose.crank_pin.T), wing.crank, atol=1e-12 * size)
    np.testing.assert_allclose(np.hypot(*(pose.coupler_pin - pose.crank_pin).T), wing.coupler, atol=1e-11 * size)
    np.testing.assert_allclose(np.hypot(*(pose.coupler_pin - pivot).T), wing.rocker, atol=1e-11 * size)
    mirror = 1 if side == "right" else -1
    along = pose.coupler_pin - pose.crank_pin
    np.testing.assert_allclose(np.arctan2(along[:, 1], mirror * along[:, 0]), pose.theta3, atol=1e-11)


@given(wings())
def test_sides_mirror_each_other_and_the_circuit_is_kept(wing):
    right, left = wing.pose(TURN), wing.pose(np.pi - TURN, "left")
    np.testing.assert_allclose(left.coupler_pin * [-1, 1], right.coupler_pin, atol=1e-11 * wing.ground)
    np.testing.assert_allclose(left.beta, right.beta, atol=1e-11)
    assert np.abs(np.diff(right.coupler_pin, axis=0)).max() < 0.2 * wing.ground


@given(wings())
def test_program_relation_holds_the_outer_wing_at_80_degrees_to_the_coupler(wing):
    pose = wing.pose(TURN)
    turned = pose.lambda_ - (pose.theta3 - math.radians(80))
    np.testing.assert_allclose(np.cos(turned), 1.0, atol=1e-12)
    np.testing.assert_allclose(pose.phi, pose.psi - math.radians(100), atol=1e-15)


@given(wings(), st.floats(0.1, 10))
def test_scale_changes_no_metric(wing, factor):
    here, there = wing.metrics(), wing.scaled(factor).metrics()
    assert there.oscillation == pytest.approx(here.oscillation, abs=1e-10)
    assert there.phase_lag == pytest.approx(here.phase_lag, abs=1e-10)
    assert there.side_difference == pytest.approx(here.side_difference, abs=1e-10)


@given(wings())
def test_reversals_bound_a_fine_turn(wing):
    fine = wing.pose(np.linspace(-np.pi, np.pi, 20001))
    (low_at, low), (high_at, high) = wing.reversals()
    assert low <= fine.beta.min() + 1e-12
    assert high >= fine.beta.max() - 1e-12
    assert fine.beta.min() == pytest.approx(low, abs=1e-6)
    assert fine.beta.max() == pytest.approx(high, abs=1e-6)
    for at, extreme in ((low_at, fine.beta.argmin()), (high_at, fine.beta.argmax())):
        assert math.cos(at - fine.theta2[extreme]) == pytest.approx(1.0, abs=1e-6)
    assert wing.metrics().oscillation == pytest.approx(high - low)


def test_published_closed_form_agrees_where_it_holds():
    """Freitas (2022): Bx = S - By K with P By² + Q By + R = 0, the root with the larger y."""
    w, pose = CHOSEN, CHOSEN.pose(TURN)
    Ax, Ay = pose.crank_pin.T
    S = (w.crank**2 - w.coupler**2 + w.rocker**2 - w.width**2 - w.height**2) / (2 * (Ax - w.width))
    K = (Ay - w.height) / (Ax - w.width)
    P, Q = K**2 + 1, 2 * w.width * K - 2 * S * K - 2 * w.height
    R = w.width**2 - 2 * w.width * S + S**2 + w.height**2 - w.rocker**2
    y = (-Q + np.sqrt(Q**2 - 4 * P * R)) / (2 * P)
    np.testing.assert_allclose(pose.coupler_pin, np.stack([S - y * K, y], axis=-1), atol=1e-11)
    np.testing.assert_allclose(pose.beta, np.arctan((w.height - y) / (w.width - (S - y * K))), atol=1e-12)


def test_holds_where_the_crank_pin_is_level_with_or_below_the_pivot():
    level = FlappingWing(crank=6.0, coupler=14.0, rocker=5.0, width=15.0, height=3.0)
    theta2 = math.asin(0.5)
    assert level.pose(theta2).crank_pin[1] == pytest.approx(level.height)
    below = FlappingWing(crank=3.0, coupler=20.0, rocker=9.0, width=3.0, height=20.0)
    straight = below.pose(0.0)
    assert straight.crank_pin[0] == below.width  # the published form divides by zero here
    for wing, pose in ((level, level.pose(theta2)), (below, straight)):
        assert math.dist(pose.coupler_pin, pose.crank_pin) == pytest.approx(wing.coupler, abs=1e-12)
        assert math.dist(pose.coupler_pin, (wing.width, wing.height)) == pytest.approx(wing.rocker, abs=1e-12)


def test_criteria_of_the_chosen_design_and_of_one_that_fails_them():
    assert all(criterion.fulfilled for criterion in CHOSEN.criteria())
    failing = FlappingWing(crank=5, coupler=20, rocker=9, width=8.5, height=20)
    failed = {criterion.name for criterion in failing.criteria() if not criterion.fulfilled}
    assert failed == {"collision", "oscillation", "transmission"}
    wild = FlappingWing(crank=6, coupler=20, rocker=9, width=10, height=20)
    failed = {criterion.name for criterion in wild.criteria() if not criterion.fulfilled}
    assert failed == {"side difference", "oscillation", "tremor", "transmission"}
    locked = FlappingWing(crank=8, coupler=20, rocker=9, width=10, height=20)
    assert [(c.name, c.fulfilled) for c in locked.criteria()] == [("grashof", False), ("collision", True)]


def test_bad_input():
    with pytest.raises(CaseError, match="width = 0 mm must be positive"):
        FlappingWing(crank=3, coupler=21, rocker=9, width=0, height=20)
    with pytest.raises(CaseError, match="height = nan mm must be finite"):
        FlappingWing(crank=3, coupler=21, rocker=9, width=9, height=math.nan)
    with pytest.raises(CaseError, match="exceeds the other three"):
        FlappingWing(crank=3, coupler=60, rocker=9, width=9, height=20)
    locked = FlappingWing(crank=8, coupler=20, rocker=9, width=10, height=20)
    with pytest.raises(CaseError, match=r"cannot be assembled at crank angle .* open by .* mm"):
        locked.published_metrics()
    with pytest.raises(CaseError, match="cannot turn fully"):
        locked.metrics()
