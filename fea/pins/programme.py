"""The least of a convex quadratic function in which pairs of variables stay in discs: by an interior point method.

    minimise  ½ vᵀ K v - gᵀ v   with  |v_i| <= r_i  for each pair v_i (x and y) of the variables.

Written in shares w of the radii, v = r w, a disc of radius zero takes no part. With a multiplier z_i >= 0 of each disc
and its slack s_i = (1 - |w_i|²)/2 the state is optimal where

    A w - b + z w = 0,   z_i s_i = 0,   A = r K r,  b = r g.

Newton's method follows z_i s_i = μ towards μ = 0 (Boyd & Vandenberghe, Convex Optimization, 2004, section 11.7). It
needs no curvature in K: directions in which nothing resists are held by the discs. For any z > 0

    -½ bᵀ (A + z)⁻¹ b - ½ Σ z_i

is a lower bound of the least value (the Lagrange dual), so that what is found proves how near it is: by
``gap`` >= ½ eᵀ K e, where e is the error of v.

Many states, with other radii each, are solved side by side.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]

CLOSE = 1e-11
"""Residual at which the steps end."""
PROVEN = 1e-8
"""Gap between the value and its lower bound, over the largest entry of b, that is taken."""
ROUNDING = 1e-15
"""Least slack that is told from none."""
IDLE = 1e-9
"""Share of the force that moving a pin through its disc would take below which a force is none."""
STEPS = 80
SHORTER = 0.995
"""Share of the way to the nearest boundary that a step may go."""
TOWARDS = 0.1
"""Share of the mean product z s that a step aims at."""


@dataclass(frozen=True, kw_only=True, eq=False)
class InDiscs:
    """The least values of n states of m pairs.

    Attributes
    ----------
    v : ndarray, shape (n, 2 m)
        The variables.
    share : ndarray, shape (n, 2 m)
        The same in shares of the radii.
    multiplier : ndarray, shape (n, m)
        Of the discs, in shares of the radii.
    gap : ndarray, shape (n,)
        By what the value may lie above the least one.
    """

    v: Real
    share: Real
    multiplier: Real
    gap: Real


def least_in_discs(K: Real, g: Real, radii: Real, close: float = CLOSE) -> InDiscs:
    """Return where ½ vᵀ K v - gᵀ v is least with every pair of variables in its disc.

    Parameters
    ----------
    K : ndarray, shape (2 m, 2 m)
        Symmetric, without negative eigenvalues.
    g : ndarray, shape (2 m,) or (n, 2 m)
    radii : ndarray, shape (n, m)
        Not negative.
    close : float, optional
        Of the residual and of the mean product z s, over the largest entry of b, at which the steps end.

    Returns
    -------
    InDiscs

    Raises
    ------
    CannotRunError
        Where the bound does not come near to the value.
    """
    count, discs = radii.shape
    scale = np.repeat(radii, 2, axis=1)
    A, b = scale[:, :, None] * K * scale[:, None, :], scale * g
    size = np.abs(b).max(axis=1)
    idle = size <= IDLE * np.abs(A).max(axis=(1, 2))
    A[idle], b[idle] = 0.0, 0.0
    unit = np.where(idle, 1.0, size)
    A, b = A / unit[:, None, None], b / unit[:, None]
    w, z = np.zeros_like(b), np.ones((count, discs))
    own = np.arange(count)
    for _ in range(STEPS):
        a, at, inner, pull = A[own], b[own], w[own].reshape(-1, discs, 2), z[own]
        slack = _slack(inner)
        force = at - np.einsum("nij,nj->ni", a, w[own])
        rest = np.abs(np.repeat(pull, 2, axis=1) * w[own] - force).max(axis=1)
        mean = (pull * slack).mean(axis=1)
        going = np.maximum(rest, mean) > close
        if not going.any():
            break
        own = own[going]
        a, inner, pull, slack = a[going], inner[going], pull[going], slack[going]
        force, aim = force[going], TOWARDS * mean[going, None]
        matrix = _with_discs(a, inner, pull)
        right = force - ((aim / slack)[:, :, None] * inner).reshape(len(own), -1)
        step = np.linalg.solve(matrix, right[:, :, None])[:, :, 0].reshape(-1, discs, 2)
        further = (aim - pull * slack + pull * (inner * step).sum(axis=2)) / slack
        length = np.minimum(_to_rim(inner, step), _to_zero(pull, further)).min(axis=1)
        length = np.minimum(SHORTER * length, 1.0)
        w[own] += (length[:, None, None] * step).reshape(len(own), -1)
        z[own] += length[:, None] * further
    gap = unit * _gap(A, b, w, z)
    if not (gap <= max(PROVEN, 100.0 * discs * close) * unit).all():
        raise CannotRunError(
            f"how pins stand in their holes was not found: the energy may be {float((gap / unit).max()):.1e} of that "
            "of the load too high; state in which links pins are tight, or other clearances"
        )
    return InDiscs(v=scale * w, share=w, multiplier=z * unit[:, None], gap=gap)


def _to_rim(inner: Real, step: Real) -> Real:
    """Length of a step (n, m) at which a pair leaves the unit disc."""
    across, along = (step**2).sum(axis=2), (inner * step).sum(axis=2)
    room = np.maximum(1.0 - (inner**2).sum(axis=2), 0.0)
    root = np.sqrt(along**2 + across * room)
    return np.asarray(np.divide(room, along + root, out=np.full_like(room, np.inf), where=along + root > 0.0))


def _to_zero(value: Real, step: Real) -> Real:
    """Length of a step (n, m) at which a positive value ends."""
    return np.asarray(np.divide(value, -step, out=np.full_like(value, np.inf), where=step < 0.0))


def _gap(A: Real, b: Real, w: Real, z: Real) -> Real:
    """Value less its lower bound (n,)."""
    value = 0.5 * np.einsum("ni,nij,nj->n", w, A, w) - (b * w).sum(axis=1)
    pull = np.repeat(z, 2, axis=1)
    held = A + pull[:, :, None] * np.eye(A.shape[1])
    bound = -0.5 * (b * np.linalg.solve(held, b[:, :, None])[:, :, 0]).sum(axis=1) - 0.5 * z.sum(axis=1)
    return np.asarray(np.maximum(value - bound, 0.0))


def slopes(K: Real, radii: Real, found: InDiscs, state: NDArray[np.int64], along: Real) -> Real:
    """Return how linear functions of the variables change with the radii.

    The optimal state follows from A w - b + z w = 0 with z s = μ at the last μ, which is smooth in the radii r. Its
    Jacobian is inverted once for each state.

    Parameters
    ----------
    K : ndarray, shape (2 m, 2 m)
    radii : ndarray, shape (n, m)
    found : InDiscs
        Of these.
    state : ndarray of int, shape (k,)
        Which state each function is of.
    along : ndarray, shape (k, 2 m)
        a of each function aᵀ v.

    Returns
    -------
    ndarray, shape (k, m)
        Of aᵀ v by each radius.
    """
    count, discs = radii.shape
    scale, w = np.repeat(radii, 2, axis=1), found.share
    inverse = np.linalg.inv(
        _with_discs(scale[:, :, None] * K * scale[:, None, :], w.reshape(count, discs, 2), found.multiplier)
    )
    pull = np.repeat(found.multiplier, 2, axis=1) * w  # what is left of g - K v at a rim, times its radius
    force = np.divide(pull, scale, out=np.zeros_like(pull), where=scale > 0.0)
    y = np.einsum("kij,kj->ki", inverse[state], scale[state] * along)
    each = along * w[state] + y * force[state] - (scale[state] * y) @ K * w[state]
    return np.asarray(each.reshape(len(state), discs, 2).sum(axis=2))


def _with_discs(A: Real, inner: Real, pull: Real) -> Real:
    """A with the curvature of the discs' barriers (n, 2 m, 2 m), from shares (n, m, 2) and multipliers (n, m)."""
    own = (pull / _slack(inner))[:, :, None, None] * inner[:, :, :, None] * inner[:, :, None, :]
    own += pull[:, :, None, None] * np.eye(2)
    found = A.copy()
    for i in range(inner.shape[1]):
        found[:, 2 * i : 2 * i + 2, 2 * i : 2 * i + 2] += own[:, i]
    return found


def _slack(inner: Real) -> Real:
    return np.asarray(np.maximum((1.0 - (inner**2).sum(axis=2)) / 2.0, ROUNDING))
