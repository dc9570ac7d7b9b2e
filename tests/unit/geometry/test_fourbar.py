import math

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.fourbar import FourBar

CRANK_ROCKER = FourBar(a=40, b=120, c=80, d=100)
TRIPLE_ROCKER = FourBar(a=6, b=3, c=5, d=7.5)


@pytest.mark.parametrize("bad", [{"a": 0.0}, {"b": -1.0}, {"c": math.nan}, {"d": math.inf}])
def test_lengths_must_be_positive(bad):
    with pytest.raises(CaseError, match=rf"length {next(iter(bad))} = .* must be positive"):
        FourBar(**{"a": 1.0, "b": 1.0, "c": 1.0, "d": 1.0, **bad})


def test_a_link_longer_than_the_rest_never_closes():
    with pytest.raises(CaseError, match=r"d = 10 exceeds the other three together by 1"):
        FourBar(a=2, b=3, c=4, d=10)


def test_a_pose_that_does_not_assemble_says_by_how_much():
    # Input straight back: A lies 13.5 from O4, coupler and output reach 8.
    with pytest.raises(CaseError, match=r"180\.0000°: the loop stays open by 5\.5;"):
        TRIPLE_ROCKER.position(math.pi)


def test_arrays_are_masked_where_the_loop_stays_open():
    theta2 = np.linspace(-np.pi, np.pi, 91)
    position = TRIPLE_ROCKER.position(theta2)
    (interval, *_) = TRIPLE_ROCKER.input_range().intervals
    reachable = np.array([TRIPLE_ROCKER.input_range().interval_of(angle) is not None for angle in theta2])
    assert 0 < reachable.sum() < theta2.size
    assert interval[0] < interval[1]
    for values in (position.theta3, position.theta4, position.transmission):
        np.testing.assert_array_equal(~np.ma.getmaskarray(values), reachable)
        assert np.isfinite(np.asarray(values)).all()


def test_dead_points_close_the_loop_with_collinear_links():
    for bar in (
        TRIPLE_ROCKER,
        FourBar(a=5, b=2, c=6.5, d=4),
        FourBar(a=5, b=6.5, c=2, d=4),
        FourBar(a=3, b=7, c=2, d=6),
    ):
        dead_points = bar.dead_points()
        assert dead_points
        for dead in dead_points:
            loop = (
                bar.a * np.exp(1j * dead.theta2)
                + bar.b * np.exp(1j * dead.theta3)
                - bar.c * np.exp(1j * dead.theta4)
                - bar.d
            )
            assert abs(loop) < 1e-13 * bar.d * 10
            turn = math.cos(dead.theta3 - dead.theta4)
            assert turn == pytest.approx(-1.0 if dead.kind == "extended" else 1.0, abs=1e-12)


def test_input_may_have_two_ranges_apart():
    # Folded at a small angle and stretched at a large one: the input rocks on either side of the ground.
    bar = FourBar(a=7, b=2, c=6, d=9)
    reach = bar.input_range()
    (low, high), (minus_high, minus_low) = reach.intervals
    assert 0 < low < high < math.pi
    assert (minus_high, minus_low) == (-high, -low)
    assert reach.interval_of((low + high) / 2) == 0
    assert reach.interval_of(-(low + high) / 2 + 2 * math.pi) == 1
    assert reach.interval_of(0.0) is None


def test_parallelogram_stays_parallel_and_meets_its_branches():
    bar = FourBar(a=3, b=7, c=3, d=7)
    theta2 = np.linspace(0.1, 3.0, 30)
    position = bar.position(theta2)
    np.testing.assert_allclose(position.theta4, theta2, atol=1e-13)
    np.testing.assert_allclose(position.theta3, 0.0, atol=1e-13)
    assert bar.input_range().full_turn
    assert bar.input_range().change_points == (0.0, math.pi)


def test_kite_whose_pins_coincide_has_no_definite_pose():
    bar = FourBar(a=7, b=3, c=3, d=7)
    with pytest.raises(CaseError, match="spin about it"):
        bar.position(0.0)
    assert np.ma.getmaskarray(bar.position([0.0, 0.1]).theta3).tolist() == [True, False]


def test_norton_quotient_vanishes_where_this_form_holds():
    # A at (3, 4) and B at (-2, 0), straight back from O4 at (4, 0): θ4 = 180°, whose half tangent is infinite.
    bar = FourBar(a=5.0, b=math.hypot(5.0, 4.0), c=6.0, d=4.0)
    theta2 = math.atan2(4.0, 3.0)
    K1, K2, K3 = bar.d / bar.a, bar.d / bar.c, (bar.a**2 - bar.b**2 + bar.c**2 + bar.d**2) / (2 * bar.a * bar.c)
    assert math.cos(theta2) - K1 - K2 * math.cos(theta2) + K3 == pytest.approx(0.0, abs=1e-15)
    ends = [bar.d + bar.c * np.exp(1j * bar.position(theta2, branch=branch).theta4) for branch in ("open", "crossed")]
    assert min(abs(end + 2.0) for end in ends) < 1e-14


def test_transmission_range_of_a_crank_rocker_lies_at_zero_and_half_turn():
    reach = CRANK_ROCKER.transmission_range()
    transmission = CRANK_ROCKER.position(np.linspace(-np.pi, np.pi, 721)).transmission
    assert reach.minimum == pytest.approx(float(transmission.min()), abs=1e-12)
    assert reach.maximum == pytest.approx(float(transmission.max()), abs=1e-12)
    # An input with two ranges runs between its folded and its stretched dead point.
    stopped = FourBar(a=7, b=2, c=6, d=9).transmission_range()
    assert (stopped.minimum, stopped.maximum) == (0.0, math.pi)


def test_branch_of_recognises_its_own_poses():
    for branch in ("open", "crossed"):
        for theta2 in (0.4, 2.5, -1.9):
            theta3 = float(CRANK_ROCKER.position(theta2, branch=branch).theta3)
            assert CRANK_ROCKER.branch_of(theta2, theta3) == branch
    dead = TRIPLE_ROCKER.dead_points()[0]
    assert TRIPLE_ROCKER.branch_of(dead.theta2, dead.theta3) is None
