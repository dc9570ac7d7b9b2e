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

Differences of two pairs may be kept in discs too. With the inner share e of any disc, linear in w, its multiplier adds
z e to the slope along e; else all is the same.

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
NARROW = 1e-6
"""Radius of the disc of a difference, over those of its two pairs, in place of a smaller one."""
NO_TIES = np.empty((0, 2), dtype=np.int64)


@dataclass(frozen=True, kw_only=True, eq=False)
class InDiscs:
    """The least values of n states of m pairs, with f discs of differences.

    Attributes
    ----------
    v : ndarray, shape (n, 2 m)
        The variables.
    share : ndarray, shape (n, 2 m)
        The same in shares of the radii.
    multiplier : ndarray, shape (n, m + f)
        Of the discs, in shares of the radii.
    gap : ndarray, shape (n,)
        By what the value may lie above the least one.
    """

    v: Real
    share: Real
    multiplier: Real
    gap: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class _Discs:
    """Inner shares of all discs by the shares w of the radii of n states of m pairs.

    Attributes
    ----------
    pairs : ndarray of int, shape (f, 2)
        Of the discs of differences: the second pair less the first; each pair is in one of them at most.
    by : ndarray, shape (n, f, 2)
        Factors of their w.
    """

    pairs: NDArray[np.int64]
    by: Real

    @classmethod
    def of(cls, radii: Real, ties: NDArray[np.int64]) -> "_Discs":
        count = radii.shape[1] - len(ties)
        size = radii[:, ties]
        own = np.maximum(radii[:, count:], NARROW * size.sum(axis=2))[:, :, None]
        by = np.divide(size * [-1.0, 1.0], own, out=np.zeros_like(size), where=own > 0.0)
        return cls(pairs=ties, by=by)

    def __getitem__(self, states: NDArray[np.int64]) -> "_Discs":
        return _Discs(pairs=self.pairs, by=self.by[states])

    def inner(self, w: Real) -> Real:
        """(n, m + f, 2) of w (n, 2 m)."""
        each = w.reshape(len(w), -1, 2)
        return np.concatenate([each, (self.by[..., None] * each[:, self.pairs]).sum(axis=2)], axis=1)

    def outer(self, forces: Real) -> Real:
        """(n, 2 m) what forces (n, m + f, 2) on the inner shares are on w."""
        found = forces[:, : forces.shape[1] - len(self.pairs)].copy()
        found[:, self.pairs] += self.by[..., None] * forces[:, found.shape[1] :, None]
        return found.reshape(len(found), -1)

    def held(self, A: Real, own: Real) -> Real:
        """A (n, 2 m, 2 m) with the stiffness (n, m + f, 2, 2) of the inner shares."""
        found = A.copy()
        count = A.shape[1] // 2
        for i in range(count):
            found[:, 2 * i : 2 * i + 2, 2 * i : 2 * i + 2] += own[:, i]
        for k, pair in enumerate(self.pairs):
            for i, one in zip(pair, self.by[:, k].T, strict=True):
                for j, other in zip(pair, self.by[:, k].T, strict=True):
                    found[:, 2 * i : 2 * i + 2, 2 * j : 2 * j + 2] += (one * other)[:, None, None] * own[:, count + k]
        return found


def least_in_discs(K: Real, g: Real, radii: Real, close: float = CLOSE, ties: NDArray[np.int64] = NO_TIES) -> InDiscs:
    """Return where ½ vᵀ K v - gᵀ v is least with every pair of variables in its disc.

    Parameters
    ----------
    K : ndarray, shape (2 m, 2 m)
        Symmetric, without negative eigenvalues.
    g : ndarray, shape (2 m,) or (n, 2 m)
    radii : ndarray, shape (n, m + f)
        Not negative.
    close : float, optional
        Of the residual and of the mean product z s, over the largest entry of b, at which the steps end.
    ties : ndarray of int, shape (f, 2), optional
        Pairs whose difference stays in a disc too, whose radii come last; each pair in one of them at most.

    Returns
    -------
    InDiscs

    Raises
    ------
    CannotRunError
        Where the bound does not come near to the value.
    """
    count, discs = radii.shape
    scale, every = np.repeat(radii[:, : discs - len(ties)], 2, axis=1), _Discs.of(radii, ties)
    A, b = scale[:, :, None] * K * scale[:, None, :], scale * g
    size = np.abs(b).max(axis=1)
    idle = size <= IDLE * np.abs(A).max(axis=(1, 2))
    A[idle], b[idle] = 0.0, 0.0
    unit = np.where(idle, 1.0, size)
    A, b = A / unit[:, None, None], b / unit[:, None]
    w, z = np.zeros_like(b), np.ones((count, discs))
    own = np.arange(count)
    for _ in range(STEPS):
        a, at, by, pull = A[own], b[own], every[own], z[own]
        inner = by.inner(w[own])
        slack = _slack(inner)
        force = at - np.einsum("nij,nj->ni", a, w[own])
        rest = np.abs(by.outer(pull[:, :, None] * inner) - force).max(axis=1)
        mean = (pull * slack).mean(axis=1)
        going = np.maximum(rest, mean) > close
        if not going.any():
            break
        own, by = own[going], by[going]
        a, inner, pull, slack = a[going], inner[going], pull[going], slack[going]
        force, aim = force[going], TOWARDS * mean[going, None]
        matrix = by.held(a, _barriers(inner, pull))
        right = force - by.outer((aim / slack)[:, :, None] * inner)
        step = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        moved = by.inner(step)
        further = (aim - pull * slack + pull * (inner * moved).sum(axis=2)) / slack
        length = np.minimum(_to_rim(inner, moved), _to_zero(pull, further)).min(axis=1)
        length = np.minimum(SHORTER * length, 1.0)
        w[own] += length[:, None] * step
        z[own] += length[:, None] * further
    gap = unit * _gap(A, b, w, z, every)
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


def _gap(A: Real, b: Real, w: Real, z: Real, every: _Discs) -> Real:
    """Value less its lower bound (n,)."""
    value = 0.5 * np.einsum("ni,nij,nj->n", w, A, w) - (b * w).sum(axis=1)
    held = every.held(A, z[:, :, None, None] * np.eye(2))
    bound = -0.5 * (b * np.linalg.solve(held, b[:, :, None])[:, :, 0]).sum(axis=1) - 0.5 * z.sum(axis=1)
    return np.asarray(np.maximum(value - bound, 0.0))


def slopes(
    K: Real,
    radii: Real,
    found: InDiscs,
    state: NDArray[np.int64],
    along: Real,
    ties: NDArray[np.int64] = NO_TIES,
) -> Real:
    """Return how linear functions of the variables change with the radii.

    The optimal state follows from A w - b + z w = 0 with z s = μ at the last μ, which is smooth in the radii r. Its
    Jacobian is inverted once for each state.

    Parameters
    ----------
    K : ndarray, shape (2 m, 2 m)
    radii : ndarray, shape (n, m + f)
    found : InDiscs
        Of these.
    state : ndarray of int, shape (k,)
        Which state each function is of.
    along : ndarray, shape (k, 2 m)
        a of each function aᵀ v.
    ties : ndarray of int, shape (f, 2), optional
        As in ``least_in_discs``.

    Returns
    -------
    ndarray, shape (k, m + f)
        Of aᵀ v by each radius.
    """
    pairs = radii.shape[1] - len(ties)
    scale, w, every = np.repeat(radii[:, :pairs], 2, axis=1), found.share, _Discs.of(radii, ties)
    inner, z = every.inner(w), found.multiplier
    own = _barriers(inner, z)
    A, rims = scale[:, :, None] * K * scale[:, None, :], np.zeros_like(own)
    rims[:, :pairs] = own[:, :pairs]
    tied = every.held(A, own - rims)  # with the discs of differences, which rims move at a share that stays
    inverse = np.linalg.inv(every.held(tied, rims))
    force = _over(np.repeat(z[:, :pairs], 2, axis=1) * w, scale)  # of a rim on its pair, times the share's radius
    y = np.einsum("kij,kj->ki", inverse[state], scale[state] * along)
    each = along * w[state] + y * force[state]
    each -= np.einsum("ki,kij->kj", y, tied[state]) * _over(w, scale)[state]
    by_pairs = each.reshape(len(state), pairs, 2).sum(axis=2)
    # z e of a difference grows by (2 + |e|²/s) over its radius, as that shrinks and all else stays
    pull = _over(z * (2.0 + (inner**2).sum(axis=2) / _slack(inner)), radii)[state, pairs:]
    return np.hstack([by_pairs, pull * (every[state].inner(y) * inner[state])[:, pairs:].sum(axis=2)])


def _over(value: Real, size: Real) -> Real:
    return np.divide(value, size, out=np.zeros_like(value), where=size > 0.0)


def _barriers(inner: Real, pull: Real) -> Real:
    """Stiffness (n, m + f, 2, 2) of the discs' barriers, from inner shares (n, m + f, 2) and multipliers (n, m + f)."""
    own = (pull / _slack(inner))[:, :, None, None] * inner[:, :, :, None] * inner[:, :, None, :]
    return np.asarray(own + pull[:, :, None, None] * np.eye(2))


def _slack(inner: Real) -> Real:
    return np.asarray(np.maximum((1.0 - (inner**2).sum(axis=2)) / 2.0, ROUNDING))
