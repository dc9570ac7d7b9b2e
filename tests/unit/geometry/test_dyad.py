import math

import numpy as np
import pytest

from alula.geometry.mechanisms.dyad import close_dyad, triangle_angle, wrap


def test_wrap_takes_minus_pi_to_pi():
    assert wrap(-math.pi) == math.pi
    assert wrap(math.pi) == math.pi
    np.testing.assert_allclose(wrap([3 * math.pi / 2, -7.0, 0.1]), [-math.pi / 2, 2 * math.pi - 7.0, 0.1], atol=1e-15)


def test_right_triangle():
    assert triangle_angle(3, 4, 5) == pytest.approx(math.pi / 2, abs=1e-15)
    assert triangle_angle(4, 5, 3) == pytest.approx(math.asin(0.6), abs=1e-15)


def test_needle_triangle_keeps_its_digits():
    # Legs 1 and 1 about an angle of 1e-7: arccos of the law of cosines gives 9.996e-8 or worse.
    angle = 1e-7
    assert triangle_angle(1.0, 1.0, 2 * math.sin(angle / 2)) == pytest.approx(angle, rel=1e-12)


def test_flat_triangles_are_clipped():
    assert triangle_angle(1.0, 2.0, 3.5) == math.pi
    assert triangle_angle(1.0, 2.0, 0.5) == 0.0


@pytest.mark.parametrize("side", [1, -1])
def test_both_sides_of_a_level_dyad(side):
    dyad = close_dyad(8.0, 0.0, 5.0, 5.0, side)
    np.testing.assert_allclose(
        [dyad.first, dyad.second], [side * math.atan2(3, 4), side * (math.pi - math.atan2(3, 4))]
    )
    assert dyad.closes
    assert dyad.gap == 0.0


def test_gap_says_how_far_the_bars_fail_to_meet():
    dyad = close_dyad([10.0, 1.0, 5.0], 0.0, 5.0, 3.0, 1)
    np.testing.assert_allclose(dyad.gap, [2.0, 1.0, 0.0])
    np.testing.assert_array_equal(dyad.closes, [False, False, True])


def test_equal_bars_over_one_point_have_no_definite_pose():
    dyad = close_dyad(0.0, 0.0, 5.0, 5.0, 1)
    assert not dyad.closes
    assert dyad.gap == 0.0
    assert np.isfinite([dyad.first, dyad.second, dyad.between]).all()
