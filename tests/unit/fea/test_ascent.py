"""Ascents in a box, against a general solver."""

import numpy as np
import pytest
from scipy.optimize import Bounds, minimize

from alula.fea.pins.ascent import GRID, ascend


def test_concave_quadratic_functions_end_where_a_general_solver_ends():
    draw = np.random.default_rng(2)
    n, k = 12, 6
    bent, middle, start = draw.uniform(-1.0, 1.0, (n, k, k)), draw.uniform(-0.5, 1.5, (n, k)), draw.uniform(size=(n, k))
    curved = bent @ bent.swapaxes(1, 2) + 0.5 * np.eye(k)

    def evaluate(x, which):
        slope = -np.einsum("nij,nj->ni", curved[which], x - middle[which])
        return (slope * (x - middle[which])).sum(axis=1) / 2.0, slope

    ends = ascend(start, evaluate, np.full(n, 1e-6))
    at_start, found = (evaluate(x, np.arange(n))[0] for x in (start, ends))
    best = np.array(
        [
            -minimize(lambda x, i=i: -evaluate(x[None], np.array([i]))[0][0], start[i], bounds=Bounds(0.0, 1.0)).fun
            for i in range(n)
        ]
    )
    assert np.median((best - found) / (best - at_start)) < 1e-4
    assert ((best - found) / (best - at_start)).max() < 0.05
    assert 10 < ((ends > 0.0) & (ends < 1.0)).sum() < n * k - 10


def test_shares_lie_on_the_grid_and_those_at_an_end_stay_there():
    def evaluate(x, _):
        return x[:, 0] - (x[:, 1] - 0.4321) ** 2, np.column_stack([np.ones(len(x)), 0.8642 - 2.0 * x[:, 1]])

    [ends] = ascend(np.array([[0.123456, 0.3]]), evaluate, np.zeros(1))
    assert ends[0] == 1.0
    assert ends[1] == pytest.approx(0.4321, abs=GRID)
    assert ends[1] / GRID == pytest.approx(round(ends[1] / GRID), abs=1e-9)
