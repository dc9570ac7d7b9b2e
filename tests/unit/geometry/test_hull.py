"""The hull of circles against polygons, closed forms and the support function."""

import math

import numpy as np
import pytest

from geometry.base.hull import Hull, hull

EQUAL = [(0.0, 0.0, 3.0), (20.0, 0.0, 3.0), (12.0, 15.0, 3.0)]
TERNARY = [(0.0, 0.0, 7.0), (60.0, 0.0, 6.0), (22.0, 34.0, 8.0)]
TWICE = [(-12.0, 0.0, 2.0), (0.0, 0.0, 9.0), (12.0, 0.0, 2.0)]
"""The large circle is on either side of the outline."""
ANGLES = np.linspace(0.0, 2.0 * math.pi, 200_001)[:-1]


def drawn(seed):
    rng = np.random.default_rng(seed)
    number = int(rng.integers(1, 12))
    return [(*map(float, rng.uniform(-30.0, 30.0, 2)), float(rng.uniform(1.0, 15.0))) for _ in range(number)]


CASES = [
    EQUAL,
    TERNARY,
    TWICE,
    [(1.0, 2.0, 5.0)],
    [(0.0, 0.0, 8.0), (1.0, 1.0, 2.0)],
    [(0.0, 0.0, 3.0), (0.0, 9.0, 3.0)],
]
CASES += [[(x, 0.0, 4.0) for x in (0.0, 30.0, 15.0)], *map(drawn, range(40))]


def support(circles):
    """h(θ) of the hull: the largest of the circles'."""
    x, y, radius = np.array(circles).T[:, :, None]
    return (x * np.cos(ANGLES) + y * np.sin(ANGLES) + radius).max(axis=0)


@pytest.mark.parametrize("circles", CASES)
def test_area_is_that_of_the_support_function(circles):
    h = support(circles)
    slope = np.gradient(h, ANGLES[1])
    # ½ ∫ h² - h'², whose slope jumps where arcs meet.
    assert hull(circles).area == pytest.approx((h**2 - slope**2).mean() * math.pi, rel=2e-4)


@pytest.mark.parametrize("circles", CASES)
def test_arcs_meet_at_common_tangents_and_make_one_turn(circles):
    found = hull(circles)
    assert sum(arc.end - arc.start for arc in found.arcs) == pytest.approx(2.0 * math.pi)
    for arc in found.arcs:
        assert arc.end > arc.start
        for angle in (arc.start, arc.end, (arc.start + arc.end) / 2.0):
            reach = max(x * math.cos(angle) + y * math.sin(angle) + radius for x, y, radius in circles)
            assert arc.support(angle) == pytest.approx(reach, abs=2e-3 * arc.radius)
    for one, other in found.lines:
        assert math.dist(one, other) > 0.0


@pytest.mark.parametrize("circles", CASES)
def test_depth_and_chord_are_those_of_the_support_function(circles):
    rng, h, found = np.random.default_rng(7), support(circles), hull(circles)
    for x, y in rng.uniform(-40.0, 40.0, (20, 2)):
        depth = (h - x * np.cos(ANGLES) - y * np.sin(ANGLES)).min()
        assert found.depth(x, y) == pytest.approx(depth, abs=1e-2)
    low, high = -h[len(h) // 2], h[0]
    for x in rng.uniform(low, high, 20):
        for y in found.chord(x):
            assert found.depth(x, y) == pytest.approx(0.0, abs=1e-6)


def test_equal_circles_make_their_polygon_drawn_out_by_the_radius():
    corners = np.array([circle[:2] for circle in EQUAL])
    sides = np.roll(corners, -1, axis=0) - corners
    area = 20.0 * 15.0 / 2.0 + 3.0 * np.hypot(*sides.T).sum() + math.pi * 9.0
    assert hull(EQUAL).area == pytest.approx(area, rel=1e-12)


def test_a_circle_between_two_equal_ones_is_not_part_of_the_outline():
    assert len(hull([(0.0, 0.0, 4.0), (15.0, 1e-6, 4.0), (30.0, 0.0, 4.0)]).arcs) == 2
    assert isinstance(hull(TWICE), Hull)
    assert [arc.radius for arc in hull(TWICE).arcs].count(9.0) == 2
