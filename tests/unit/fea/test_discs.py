"""The programme of pins in their holes: against a general solver, its own bound, and differences."""

import numpy as np
import pytest
from scipy.optimize import LinearConstraint, NonlinearConstraint, minimize

from alula.fea.pins import programme
from alula.fea.pins.programme import NO_TIES, least_in_discs, slopes
from alula.geometry.base.errors import CannotRunError

DISCS = 5
TIES = np.array([[0, 1], [4, 3]])


def problem(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A stiffness with as many free directions as stiff ones, over four orders of magnitude, and forces."""
    draw = np.random.default_rng(seed)
    factor = draw.standard_normal((2 * DISCS, DISCS)) * np.logspace(-2.0, 2.0, DISCS)
    return factor @ factor.T, draw.standard_normal(2 * DISCS)


def by_scipy(K: np.ndarray, g: np.ndarray, radii: np.ndarray, ties: np.ndarray) -> float:
    """The least value with every pair and every difference in its disc, by a trust region method of scipy."""
    by = np.vstack([np.eye(DISCS), np.eye(DISCS)[ties[:, 1]] - np.eye(DISCS)[ties[:, 0]]])
    within = NonlinearConstraint(
        lambda v: ((by @ v.reshape(-1, 2)) ** 2).sum(axis=1),
        -np.inf,
        radii**2,
        jac=lambda v: 2.0 * np.einsum("ki,kx->kix", by, by @ v.reshape(-1, 2)).reshape(len(radii), -1),
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
@pytest.mark.parametrize(("seed", "ties"), [(1, NO_TIES), (2, NO_TIES), (2, TIES)])
def test_finds_the_least_value_that_scipy_finds(seed, ties):
    K, g = problem(seed)
    radii = np.random.default_rng(seed).uniform(0.01, 0.3, (2, DISCS))
    radii[:, ties[:, 1]] = radii[:, ties[:, 0]]
    radii = np.hstack([radii, np.array([[0.05, 0.2], [0.01, 0.03]])[:, : len(ties)]])
    found = least_in_discs(K, g, radii, ties=ties)
    for v, gap, own in zip(found.v, found.gap, radii, strict=True):
        value = 0.5 * v @ K @ v - g @ v
        least = by_scipy(K, g, own, ties)
        assert value == pytest.approx(least, rel=1e-6)
        assert value - gap <= least + 1e-6 * abs(least)
        assert (np.hypot(*v.reshape(-1, 2).T) <= own[:DISCS]).all()
        apart = v.reshape(-1, 2)[ties[:, 1]] - v.reshape(-1, 2)[ties[:, 0]]
        assert (np.hypot(*apart.T) <= own[DISCS:] * (1.0 + 1e-9)).all()
    assert not np.allclose(found.v[0], found.v[1])


def test_a_difference_of_no_size_makes_one_pair_of_two_and_a_wide_one_does_nothing():
    K, g = problem(9)
    one = np.vstack([np.eye(8)[:2], np.eye(8)])  # pairs 0 and 1 are the first of four
    merged = least_in_discs(one.T @ K @ one, one.T @ g, np.array([[0.1, 0.2, 0.3, 0.1]])).v @ one.T
    radii = np.array([[0.1, 0.1, 0.2, 0.3, 0.1, apart] for apart in (0.0, 0.2)])
    found = least_in_discs(K, g, radii, ties=TIES[:1])
    assert K @ found.v[0] == pytest.approx(K @ merged[0], abs=1e-4)
    assert K @ found.v[1] == pytest.approx(K @ least_in_discs(K, g, radii[:1, :DISCS]).v[0], abs=1e-6)
    assert np.abs(K @ (found.v[0] - found.v[1])).max() > 0.01


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


@pytest.mark.parametrize("ties", [NO_TIES, TIES])
def test_slopes_are_those_of_differences(ties):
    K, g = problem(6)
    radii, step = np.random.default_rng(6).uniform(0.05, 0.3, (2, DISCS + len(ties))), 1e-5
    radii[:, ties[:, 1]] = radii[:, ties[:, 0]]
    along = np.random.default_rng(7).standard_normal((3, 2 * DISCS))
    state = np.array([0, 1, 1])
    told = slopes(K, radii, least_in_discs(K, g, radii, ties=ties), state, along, ties)
    alone = np.setdiff1d(np.arange(DISCS + len(ties)), ties)
    for discs in (*alone[:, None], *ties):  # rims of one hole have one radius
        up, down = radii.copy(), radii.copy()
        up[:, discs] += step
        down[:, discs] -= step
        ends = (least_in_discs(K, g, at, ties=ties).v for at in (up, down))
        moved = np.subtract(*ends)[state] / (2.0 * step)
        assert told[:, discs].sum(axis=1) == pytest.approx((moved * along).sum(axis=1), rel=2e-3, abs=2e-3)


def test_what_is_not_proven_is_no_answer(monkeypatch):
    """Of two states, of which one is idle."""
    K, g = problem(8)
    monkeypatch.setattr(programme, "PACES", ((0.1, 0.995, 3),))
    with pytest.raises(CannotRunError, match="how pins stand in their holes was not found"):
        least_in_discs(K, np.array([0.0 * g, g]), np.full((2, DISCS), 0.1))


@pytest.mark.parametrize("far", [0, 1, 2])
def test_one_state_of_several_that_is_not_proven_is_enough_to_refuse_all(monkeypatch, far):
    K, g, radii = np.diag([1.0, 2.0]), np.array([1.0, 0.5]), np.array([[0.1], [0.2], [0.3]])
    assert (least_in_discs(K, g, radii).gap < 1e-6).all()
    monkeypatch.setattr(programme, "_gap", lambda *_: 1e-3 * np.eye(3)[far])
    with pytest.raises(CannotRunError, match="how pins stand in their holes was not found"):
        least_in_discs(K, g, radii)
