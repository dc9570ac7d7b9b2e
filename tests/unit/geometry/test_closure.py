import math

import numpy as np
import pytest
from planar_linkages import four_bar, oscillating_cylinder, quick_return, scotch_yoke, six_bar, slider_crank

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.pose import solve_pose

LINKAGES = {
    "four-bar": four_bar(40, 120, 80, 100),
    "slider-crank": slider_crank(40, 120, -20),
    "scotch yoke": scotch_yoke(30),
    "quick return": quick_return(30, 80),
    "cylinder": oscillating_cylinder(30, 80, 0.4),
    "owl wing": six_bar(),
}


@pytest.mark.parametrize("name", LINKAGES)
def test_the_jacobian_is_the_derivative_of_the_residual(name: str) -> None:
    closure = LoopClosure(LINKAGES[name])
    rng = np.random.default_rng(3)
    q = np.concatenate([rng.uniform(-3, 3, len(closure.linkage.moving)), rng.uniform(-80, 80, len(closure.slots))])
    if closure.angles_fixed:
        # Away from the half turn at which the slider's angle error jumps.
        q[: len(closure.linkage.moving)] = rng.uniform(-1, 1, len(closure.linkage.moving))
    h = 1e-5
    for k in range(closure.unknowns):
        step = h * np.eye(closure.unknowns)[k]
        # Richardson's extrapolation of central differences: error of order h^4.
        wide = (closure.residual(q + 2 * step) - closure.residual(q - 2 * step)) / (4 * h)
        near = (closure.residual(q + step) - closure.residual(q - step)) / (2 * h)
        np.testing.assert_allclose(closure.jacobian(q)[:, k], (4 * near - wide) / 3, atol=1e-7)


@pytest.mark.parametrize("name", LINKAGES)
def test_as_many_equations_as_unknowns_less_the_mobility(name: str) -> None:
    closure = LoopClosure(LINKAGES[name])
    assert closure.jacobian(np.zeros(closure.unknowns)).shape == (closure.unknowns - 1, closure.unknowns)


def _motion(linkage: Linkage, crank: str, angle: float, rate: float, more: float) -> tuple[np.ndarray, ...]:
    """Unknowns, rates and accelerations where the crank turns with ``rate`` and ``more`` acceleration."""
    near = None if linkage is not LINKAGES["owl wing"] else {"AE": 2.5, "CF": 3.5, "CH": 2.48, "ED": 3.5}
    if linkage is LINKAGES["four-bar"]:
        near = {"coupler": 0.35, "rocker": 1.0}
    if linkage is LINKAGES["slider-crank"]:
        near = {"coupler": -0.45, "block": 0.0}
    if linkage is LINKAGES["cylinder"]:
        near = {"cylinder": 3.0}
    if linkage is LINKAGES["quick return"]:
        near = {"lever": 1.5}
    closure = LoopClosure(linkage)
    q = solve_pose(linkage, coordinate=crank, angle=angle, near=near).q
    held = np.zeros(closure.unknowns)
    held[linkage.moving.index(crank)] = 1.0
    matrix = np.vstack([closure.jacobian(q), held])
    zero = np.zeros(closure.unknowns - 1)
    qdot = np.linalg.solve(matrix, [*zero, rate])
    qddot = np.linalg.solve(matrix, [*-closure.quadratic(q, qdot), more])
    return q, qdot, qddot


@pytest.mark.parametrize("name", LINKAGES)
def test_velocities_and_accelerations_along_a_motion(name: str) -> None:
    """Central differences along crank angle t -> 4.0 + 2 t + 1.5 t²: rate 2, acceleration 3 at t = 0."""
    linkage = LINKAGES[name]
    closure, crank, h = LoopClosure(linkage), linkage.moving[0], 1e-3

    def unknowns(t: float) -> np.ndarray:
        return _motion(linkage, crank, 4.0 + 2 * t + 1.5 * t**2, 0.0, 0.0)[0]

    def differences(at: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        first = (8 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * h)
        return first, (16 * (at[1] + at[-1]) - (at[2] + at[-2]) - 30 * at[0]) / (12 * h**2)

    q, qdot, qddot = _motion(linkage, crank, 4.0, 2.0, 3.0)
    along = {k: unknowns(k * h) for k in (-2, -1, 0, 1, 2)}
    # The unknowns themselves: travels in slots show in no point that another chain of links carries.
    for found, expected in zip((qdot, qddot), differences(along), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.max(np.abs(expected)))
    velocity, acceleration = differences({k: closure.positions(q_k) for k, q_k in along.items()})
    np.testing.assert_allclose(closure.velocities(q, qdot), velocity, atol=1e-6 * np.max(np.abs(velocity)))
    scale = np.max(np.abs(acceleration))
    np.testing.assert_allclose(closure.accelerations(q, qdot, qddot), acceleration, atol=1e-6 * scale)


def test_norton_velocity_and_acceleration_of_the_four_bar() -> None:
    """Norton, Design of Machinery, 5th ed., examples 6-7 and 7-1: ω2 25 rad/s, α2 15 rad/s² at θ2 40°."""
    linkage = LINKAGES["four-bar"]
    _, qdot, qddot = _motion(linkage, "crank", math.radians(40), 25.0, 15.0)
    np.testing.assert_allclose(qdot[1:], [-4.1209, 6.9980], atol=5e-4)
    np.testing.assert_allclose(qddot[1:], [296.089, 470.134], atol=5e-2)


def test_many_poses_at_once_equal_one_at_a_time() -> None:
    closure = LoopClosure(LINKAGES["slider-crank"])
    rng = np.random.default_rng(1)
    q, qdot, qddot = rng.normal(size=(3, 4, 5, closure.unknowns))
    together = [
        closure.positions(q),
        closure.residual(q),
        closure.jacobian(q),
        closure.velocities(q, qdot),
        closure.accelerations(q, qdot, qddot),
        closure.quadratic(q, qdot),
        closure.origins(q),
    ]
    i, j = 2, 3
    alone = [
        closure.positions(q[i, j]),
        closure.residual(q[i, j]),
        closure.jacobian(q[i, j]),
        closure.velocities(q[i, j], qdot[i, j]),
        closure.accelerations(q[i, j], qdot[i, j], qddot[i, j]),
        closure.quadratic(q[i, j], qdot[i, j]),
        closure.origins(q[i, j]),
    ]
    for many, one in zip(together, alone, strict=True):
        np.testing.assert_allclose(many[i, j], one, atol=1e-10)


def test_inputs_are_left_unchanged() -> None:
    closure = LoopClosure(LINKAGES["slider-crank"])
    q, qdot, qddot = np.random.default_rng(2).normal(size=(3, closure.unknowns))
    before = q.copy(), qdot.copy(), qddot.copy()
    closure.accelerations(q, qdot, qddot), closure.jacobian(q), closure.residual(q), closure.quadratic(q, qdot)
    for array, copy in zip((q, qdot, qddot), before, strict=True):
        np.testing.assert_array_equal(array, copy)


def test_loops_of_the_owl_wing() -> None:
    closure = LoopClosure(LINKAGES["owl wing"])
    paths = {frozenset(closure.loop_path(name)) for name in closure.loops}
    assert paths == {frozenset("AGFB"), frozenset("BCDE")}
