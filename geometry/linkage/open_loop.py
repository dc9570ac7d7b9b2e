"""Which loop of a linkage stays open where it cannot be assembled, and by how much."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure

Real = NDArray[np.float64]

_CLOSED = 1e-6
"""Largest gap of a loop that counts as closed here, as a share of the longest link."""
_ITERATIONS = 40
"""Of one search. Those that get anywhere take fewer; where the constraints leave no freedom the line search stalls, and
then every iteration costs eleven evaluations."""


def open_loop(closure: LoopClosure, free: NDArray[np.bool_], attempts: Sequence[Real]) -> tuple[str, float] | None:
    """Return the joint that closes the first open loop, and the least gap there [mm]; None if none was found.

    Loops with few free unknowns come first, for they can least give way. The gap is the least with
    which a loop can be left while all loops before it (and the fixed angles) are closed.
    ``attempts`` are (unknowns,) vectors from which the search starts; only the ``free`` unknowns (a
    mask) move.

    Parameters
    ----------
    closure : LoopClosure
        The loop closure.
    free : ndarray
        Mask (unknowns,) of the unknowns that may move.
    attempts : sequence of ndarray
        Unknowns (unknowns,) from which the search starts.

    Returns
    -------
    tuple, optional
        Name of the joint, and the gap [mm].
    """
    count = len(closure.loops)
    takes_part = closure.jacobian(attempts[0])[:, free] != 0.0
    order = sorted(range(count), key=lambda k: int(np.sum(takes_part[k] | takes_part[count + k])))
    earlier = list(range(2 * count, 2 * count + len(closure.angles_fixed)))
    for k in order:
        ends = [end for q in attempts if (end := _narrowed(closure, free, q, [k, count + k], earlier)) is not None]
        if not ends:
            return None
        least = min(gap for gap, _ in ends)
        if least > _CLOSED * closure.linkage.longest:
            return closure.loops[k], least
        attempts = [q for gap, q in ends if gap <= _CLOSED * closure.linkage.longest]
        earlier += [k, count + k]
    return None


def _narrowed(
    closure: LoopClosure, free: NDArray[np.bool_], start: Real, loop: list[int], closed: list[int]
) -> tuple[float, Real] | None:
    """Least gap of one loop with others closed, by sequential quadratic programming from one start."""
    from scipy.optimize import minimize

    scale = closure.linkage.longest
    weights = np.array([1.0] * len(closure.linkage.moving) + [scale] * len(closure.slots))[free]

    def unknowns(x: Real) -> Real:
        q = start.copy()
        q[free] = x * weights
        return q

    def rows(x: Real, which: list[int]) -> tuple[Real, Real]:
        q = unknowns(x)
        return closure.residual(q)[which] / scale, closure.jacobian(q)[which][:, free] * weights / scale

    def objective(x: Real) -> tuple[float, Real]:
        gap, slope = rows(x, loop)
        return float(gap @ gap), 2.0 * gap @ slope

    constraint = {"type": "eq", "fun": lambda x: rows(x, closed)[0], "jac": lambda x: rows(x, closed)[1]}
    found: Any = minimize(
        objective,
        start[free] / weights,
        jac=True,
        method="SLSQP",
        constraints=[constraint] if closed else [],
        options={"ftol": 1e-15, "maxiter": _ITERATIONS},
    )
    if closed and np.max(np.abs(rows(found.x, closed)[0])) > _CLOSED:
        return None
    return float(np.linalg.norm(rows(found.x, loop)[0])) * scale, unknowns(found.x)
