"""What other answers make of a joint's force: its size counts, wherever it points."""

import numpy as np
import pytest

from alula.fea.common.sought import LEFT
from alula.fea.common.source import COUPLES
from alula.fea.doubts.force_doubt import _steps, of_sizes
from alula.fea.superposition.link_answers import widest

STATED = np.array([1.0, 0.0])


@pytest.mark.parametrize(
    ("others", "low", "high"),
    [
        ([(0.8, 0.0), (1.3, 0.0)], 0.8, 1.3),
        ([(-3.0, 0.0), (1.1, 0.0)], 0.0, 3.0),
        ([(1.0, 5.0), (0.9, 0.0)], 0.9, np.hypot(1.0, 5.0)),
    ],
)
def test_of_alternatives_the_largest_size_counts(others, low, high):
    found = of_sizes(widest(COUPLES))(STATED, np.array(others))
    assert low - 2.0 * LEFT * high <= found.low <= low
    assert high <= found.high <= (1.001 + 2.0 * LEFT) * high  # the search may have left something


@pytest.mark.parametrize(
    ("others", "low", "high"),
    [
        ([(0.8, 0.0), (1.3, 0.0)], 0.8, 1.3),
        ([(-3.0, 0.0), (1.1, 0.0)], 0.0, 3.0),
        ([(1.0, 5.0), (1.0, -1.0)], 1.0, np.hypot(1.0, 6.0)),
    ],
)
def test_steps_add_up_along_the_force_and_across_it(others, low, high):
    found = _steps(COUPLES)(STATED, np.array(others))
    assert (found.low, found.high) == pytest.approx((low, high))


@pytest.mark.parametrize("rule", [of_sizes(widest(COUPLES)), _steps(COUPLES)])
def test_a_joint_that_bears_nothing_as_stated_may_bear_any(rule):
    none = np.zeros(2)
    assert rule(none, np.zeros((2, 2))).high == 1.0
    assert rule(none, np.array([(0.0, 0.0), (0.0, 1.0)])).high == np.inf
