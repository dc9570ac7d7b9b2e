"""Outlines about circles against polygons, closed forms, the support function and a ball that is tried everywhere."""

import math

import numpy as np
import pytest

from alula.geometry.base.outline import BallError, gap, outline

EQUAL = [(0.0, 0.0, 3.0), (20.0, 0.0, 3.0), (12.0, 15.0, 3.0)]
TERNARY = [(0.0, 0.0, 7.0), (60.0, 0.0, 6.0), (22.0, 34.0, 8.0)]
TWICE = [(-12.0, 0.0, 2.0), (0.0, 0.0, 9.0), (12.0, 0.0, 2.0)]
"""The large circle is on either side of the outline."""
ANGLES = np.linspace(0.0, 2.0 * math.pi, 200_001)[:-1]
COSINES, SINES = np.cos(ANGLES), np.sin(ANGLES)
UPPER, LOWER = (slice(1, 100_000), slice(100_001, 200_000))  # where the sine is positive, and negative


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
CASES += [[(x, 0.0, 4.0) for x in (0.0, 30.0, 15.0)], *map(drawn, range(14))]


def support(circles):
    """h(θ) of the hull: the largest of the circles'."""
    x, y, radius = np.array(circles).T[:, :, None]
    return (x * COSINES + y * SINES + radius).max(axis=0)


@pytest.mark.parametrize("circles", CASES)
def test_area_is_that_of_the_support_function(circles):
    h = support(circles)
    slope = np.gradient(h, ANGLES[1])
    # ½ ∫ h² - h'², whose slope jumps where arcs meet.
    assert outline(circles).area == pytest.approx((h**2 - slope**2).mean() * math.pi, rel=2e-4)


@pytest.mark.parametrize("circles", CASES)
def test_arcs_meet_at_common_tangents_and_make_one_turn(circles):
    found = outline(circles)
    assert sum(arc.end - arc.start for arc in found.arcs) == pytest.approx(2.0 * math.pi)
    for arc in found.arcs:
        assert arc.end > arc.start
        for angle in (arc.start, arc.end, (arc.start + arc.end) / 2.0):
            reach = max(x * math.cos(angle) + y * math.sin(angle) + radius for x, y, radius in circles)
            assert arc.support(angle) == pytest.approx(reach, abs=2e-3 * arc.radius)
    for one, other in found.lines:
        assert math.dist(one, other) > 0.0


@pytest.mark.parametrize("circles", CASES)
def test_depth_and_width_are_those_of_the_support_function(circles):
    rng, h, found = np.random.default_rng(7), support(circles), outline(circles)
    for x, y in rng.uniform(-40.0, 40.0, (20, 2)):
        depth = (h - x * COSINES - y * SINES).min()
        assert found.depth(x, y) == pytest.approx(depth, abs=1e-2)
    low, high = -h[len(h) // 2], h[0]
    for x in rng.uniform(low, high, 20):
        upper, lower = ((h - x * COSINES)[side] / SINES[side] for side in (UPPER, LOWER))
        assert found.across(x) == pytest.approx(upper.min() - lower.max(), abs=2e-2)


def test_equal_circles_make_their_polygon_drawn_out_by_the_radius():
    corners = np.array([circle[:2] for circle in EQUAL])
    sides = np.roll(corners, -1, axis=0) - corners
    area = 20.0 * 15.0 / 2.0 + 3.0 * np.hypot(*sides.T).sum() + math.pi * 9.0
    assert outline(EQUAL).area == pytest.approx(area, rel=1e-12)


def test_a_circle_between_two_equal_ones_is_not_part_of_the_outline():
    assert len(outline([(0.0, 0.0, 4.0), (15.0, 1e-6, 4.0), (30.0, 0.0, 4.0)]).arcs) == 2
    assert [arc.radius for arc in outline(TWICE).arcs].count(9.0) == 2


@pytest.mark.parametrize(
    ("circles", "ball"),
    [
        ([(-15.0, 0.0, 8.0), (15.0, 0.0, 6.0)], 20.0),
        ([(-15.0, -5.0, 8.0), (15.0, 0.0, 6.0), (0.0, 14.0, 5.0)], 9.0),
        ([(-15.0, 0.0, 6.0), (15.0, 0.0, 6.0), (0.0, 0.1, 6.0)], 25.0),
        ([(-18.0, 0.0, 5.0), (0.0, 0.0, 6.0), (18.0, 0.0, 5.0), (0.0, 18.0, 5.0)], 12.0),
    ],
)
def test_an_outline_is_what_a_ball_does_not_reach(circles, ball):
    found = outline(circles, ball)
    x, y, radius = np.array(circles).T[:, :, None]
    balls = [arc for arc in found.arcs if arc.radius < 0.0]
    assert {arc.radius for arc in balls} == {-ball}
    # Every concave arc lies on a ball that runs into no circle, and no ball that does not reaches inside.
    gaps = np.hypot(x - [b.x for b in balls], y - [b.y for b in balls]) - radius - ball
    assert gaps.min() == pytest.approx(0.0, abs=1e-9)
    grid = np.linspace(-50.0, 50.0, 401)
    free = np.array(np.meshgrid(grid, grid)).reshape(2, -1)
    free = free[:, (np.hypot(free[0] - x, free[1] - y) >= radius + ball).all(axis=0)]
    for px, py in np.random.default_rng(3).uniform(-25.0, 25.0, (60, 2)):
        assert found.depth(px, py) <= np.hypot(free[0] - px, free[1] - py).min() - ball + 1e-9
    stations = np.linspace(-30.0, 30.0, 1001)
    assert found.area == pytest.approx(sum(found.across(x) for x in stations) * 0.06, rel=1e-3)
    assert all(found.depth(*circle[:2]) >= (1.0 - 1e-3) * circle[2] for circle in circles)


def test_a_neck_between_equal_circles_is_as_wide_as_by_pythagoras():
    found = outline([(-15.0, 0.0, 8.0), (15.0, 0.0, 8.0)], 20.0)
    ((width, *_),) = found.webs
    assert width == pytest.approx(2.0 * (math.sqrt(28.0**2 - 15.0**2) - 20.0))
    assert found.across(0.0) == pytest.approx(width)
    # Two circles, and between them a trapezoid's worth of ball centres less the balls' sectors and the circles' own.
    high, angle = math.sqrt(28.0**2 - 15.0**2), math.atan2(math.sqrt(28.0**2 - 15.0**2), 15.0)
    between = 30.0 * high - 2.0 * 64.0 * angle - 400.0 * (math.pi - 2.0 * angle)
    assert found.area == pytest.approx(2.0 * 64.0 * math.pi + between)


@pytest.mark.parametrize("ball", [5.0, 6.99, 7.0, 7.5])
def test_a_ball_that_falls_through_or_pinches_is_refused(ball):
    with pytest.raises(BallError):
        outline([(-15.0, 0.0, 8.0), (15.0, 0.0, 8.0)], ball)


def test_a_huge_ball_makes_the_hull():
    assert outline(TERNARY, 1e7).area == pytest.approx(outline(TERNARY).area, rel=1e-5)


@pytest.mark.parametrize("seed", range(8))
def test_the_gap_of_two_outlines_is_that_of_their_nearest_points(seed):
    one = outline(drawn(seed))
    other = outline([(x + 75.0, y + 10.0 * seed, radius) for x, y, radius in drawn(seed + 20)])
    border = [arc.point(a) for arc in other.arcs for a in np.linspace(arc.start, arc.end, 300)]
    border += [(p + (q - p) * s, u + (v - u) * s) for (p, u), (q, v) in other.lines for s in np.linspace(0, 1, 300)]
    nearest = min(-one.depth(x, y) for x, y in border)
    assert gap(one, other) == pytest.approx(nearest, abs=1e-2)
