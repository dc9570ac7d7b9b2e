"""The programme of pins in their holes: against a general solver, its own bound, and differences."""

import numpy as np
import pytest
from scipy.optimize import LinearConstraint, NonlinearConstraint, minimize

from alula.fea.pins import programme
from alula.fea.pins.programme import least_in_discs, slopes
from alula.geometry.base.errors import CannotRunError

DISCS = 5


def problem(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A stiffness with as many free directions as stiff ones, over four orders of magnitude, and forces."""
    draw = np.random.default_rng(seed)
    factor = draw.standard_normal((2 * DISCS, DISCS)) * np.logspace(-2.0, 2.0, DISCS)
    return factor @ factor.T, draw.standard_normal(2 * DISCS)


def by_scipy(K: np.ndarray, g: np.ndarray, radii: np.ndarray) -> float:
    """The least value with every pair in its disc, by a trust region method of scipy."""
    within = NonlinearConstraint(
        lambda v: (v.reshape(-1, 2) ** 2).sum(axis=1),
        -np.inf,
        radii**2,
        jac=lambda v: np.array([[2.0 * x * (i // 2 == k) for i, x in enumerate(v)] for k in range(len(radii))]),
    )
    found = minimize(
        lambda v: (0.5 * v @ K @ v - g @ v, K @ v - g),
        np.zeros(len(g)),
        jac=True,
        constraints=[within, LinearConstraint(np.eye(len(g)), -radii.max(), radii.max())],
        method="trust-constr",
        options={"gtol": 1e-11, "xtol": 1e-13, "maxiter": 4000},
    )
    return float(found.fun)


@pytest.mark.filterwarnings("ignore:delta_grad == 0.0:UserWarning")  # of scipy, where a step is too short to tell
@pytest.mark.parametrize("seed", [1, 2])
def test_finds_the_least_value_that_scipy_finds(seed):
    K, g = problem(seed)
    radii = np.random.default_rng(seed).uniform(0.01, 0.3, (2, DISCS))
    found = least_in_discs(K, g, radii)
    for v, gap, own in zip(found.v, found.gap, radii, strict=True):
        value = 0.5 * v @ K @ v - g @ v
        least = by_scipy(K, g, own)
        assert value == pytest.approx(least, rel=1e-6)
        assert value - gap <= least + 1e-6 * abs(least)
        assert (np.hypot(*v.reshape(-1, 2).T) <= own).all()
    assert not np.allclose(found.v[0], found.v[1])


def test_forces_vanish_inside_a_disc_and_point_outwards_at_its_rim():
    K, g = problem(3)
    K = K + 5.0 * np.eye(2 * DISCS)
    found = least_in_discs(K, g, np.tile([10.0, 10.0, 10.0, 0.01, 0.02], (1, 1)))
    force, v = (g - K @ found.v[0]).reshape(-1, 2), found.v[0].reshape(-1, 2)
    assert np.abs(force[:3]).max() < 1e-8
    assert (force[3:] * v[3:]).sum(axis=1) == pytest.approx(np.hypot(*force[3:].T) * [0.01, 0.02], rel=1e-6)


def test_a_disc_of_no_size_holds_its_pair():
    K, g = problem(4)
    radii = np.array([[0.0, 0.1, 0.1, 0.0, 0.1], [0.1, 0.0, 0.0, 0.1, 0.1]])
    found = least_in_discs(K, g, radii)
    assert np.array_equal(np.abs(found.v).reshape(2, DISCS, 2).max(axis=2) == 0.0, radii == 0.0)


def test_without_forces_nothing_moves():
    K, _ = problem(5)
    assert np.abs(least_in_discs(K, np.zeros(2 * DISCS), np.full((1, DISCS), 0.1)).v).max() < 1e-6


def test_slopes_are_those_of_differences():
    K, g = problem(6)
    radii, step = np.random.default_rng(6).uniform(0.05, 0.3, (2, DISCS)), 1e-5
    along = np.random.default_rng(7).standard_normal((3, 2 * DISCS))
    state = np.array([0, 1, 1])
    told = slopes(K, radii, least_in_discs(K, g, radii), state, along)
    for disc in range(DISCS):
        up, down = radii.copy(), radii.copy()
        up[:, disc] += step
        down[:, disc] -= step
        moved = (least_in_discs(K, g, up).v - least_in_discs(K, g, down).v)[state] / (2.0 * step)
        assert told[:, disc] == pytest.approx((moved * along).sum(axis=1), rel=2e-3, abs=2e-3)


def test_what_is_not_proven_is_no_answer(monkeypatch):
    """Of two states, of which one is idle."""
    K, g = problem(8)
    monkeypatch.setattr(programme, "STEPS", 3)
    with pytest.raises(CannotRunError, match="how pins stand in their holes was not found"):
        least_in_discs(K, np.array([0.0 * g, g]), np.full((2, DISCS), 0.1))
