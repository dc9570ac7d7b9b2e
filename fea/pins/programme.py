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

The difference of two pairs of one radius r may be kept in a disc too, of the radius ρ. Half their sum over r and half
their difference over min(r, ρ/2) are the variables then. The inner share e of every disc is linear in the variables,
and its multiplier z adds z e to the slope along e; else all is the same.

Many states, with other radii each, are solved side by side.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]

CLOSE = 1e-11
"""Residual at which the steps end, unless the rounding of A leaves more."""
PROVEN = 1e-8
"""Gap between the value and its lower bound, over the largest entry of b, that is taken."""
ROUNDING = 1e-15
"""Least slack, and least share of the largest entry of A, that is told from none."""
IDLE = 1e-9
"""Share of the force that moving a pin through its disc would take below which a force is none."""
PACES = ((0.1, 0.995, 40), (0.5, 0.9, 200))
"""Share of the mean product z s that a step aims at, share of the way to the nearest boundary that it may go, and how
many steps there are at most. Of thousands of states one comes to a rim too soon, along which it can hardly go; those
that the first pace does not end start anew at the second, which keeps all products near their mean."""
BATCH = 100
"""States that are solved side by side: with more, their matrices leave the processor's cache."""
NO_TIES = np.empty((0, 2), dtype=np.int64)


@dataclass(frozen=True, kw_only=True, eq=False)
class InDiscs:
    """The least values of n states of m pairs, with f discs of differences.

    Attributes
    ----------
    v : ndarray, shape (n, 2 m)
        The variables.
    share : ndarray, shape (n, 2 m)
        w: the same in shares of the radii; of two pairs with a disc for their difference, half the sum in the place of
        the first, half the difference in that of the second.
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
    """Inner shares of all discs by the variables w of n states of m pairs.

    Attributes
    ----------
    ties : ndarray of int, shape (f, 2)
        The pairs i, j whose difference has a disc; each pair is in one of them at most.
    half : ndarray, shape (n, f)
        q: the inner shares of both pairs are w_i - q w_j and w_i + q w_j.
    own : ndarray, shape (n, f)
        p: that of the difference is p w_j.
    """

    ties: NDArray[np.int64]
    half: Real
    own: Real

    @classmethod
    def of(cls, radii: Real, ties: NDArray[np.int64]) -> "_Discs":
        wide, apart = 2.0 * radii[:, ties[:, 0]], radii[:, radii.shape[1] - len(ties) :]
        half = np.divide(apart, wide, out=np.ones_like(wide), where=apart < wide)
        own = np.divide(wide, apart, out=np.ones_like(wide), where=apart > wide)
        return cls(ties=ties, half=half, own=own)

    def __getitem__(self, states: NDArray[np.int64] | NDArray[np.bool_]) -> "_Discs":
        return _Discs(ties=self.ties, half=self.half[states], own=self.own[states])

    def inner(self, w: Real) -> Real:
        """(n, m + f, 2) of w (n, 2 m)."""
        pairs, (i, j) = w.reshape(len(w), -1, 2), self.ties.T
        if not len(self.ties):
            return pairs
        found = np.concatenate([pairs, self.own[..., None] * pairs[:, j]], axis=1)
        by_half = self.half[..., None] * pairs[:, j]
        found[:, i], found[:, j] = pairs[:, i] - by_half, pairs[:, i] + by_half
        return found

    def folded(self, along: Real) -> Real:
        """(n, 2 m, ...) by the variables, of what is (n, 2 m, ...) by the inner shares of pairs."""
        if not len(self.ties):
            return along
        each, (i, j) = along.reshape(len(along), -1, 2, *along.shape[2:]), self.ties.T
        found, half = each.copy(), self.half.reshape(*self.half.shape, *(1 for _ in each.shape[2:]))
        found[:, i], found[:, j] = each[:, i] + each[:, j], half * (each[:, j] - each[:, i])
        return found.reshape(along.shape)

    def outer(self, forces: Real) -> Real:
        """(n, 2 m) what forces (n, m + f, 2) on all inner shares are on w."""
        count = forces.shape[1] - len(self.ties)
        found = self.folded(forces[:, :count].reshape(len(forces), -1))
        if len(self.ties):
            found.reshape(len(found), -1, 2)[:, self.ties[:, 1]] += self.own[..., None] * forces[:, count:]
        return found

    def held(self, A: Real, own: Real) -> Real:
        """A (n, 2 m, 2 m) with the stiffness (n, m + f, 2, 2) of all inner shares."""
        found, count = A.copy(), A.shape[1] // 2
        blocks = found.reshape(len(A), count, 2, count, 2)
        free = np.setdiff1d(np.arange(count), self.ties) if len(self.ties) else np.arange(count)
        blocks[:, free, :, free] += own[:, free].swapaxes(0, 1)
        for k, (i, j) in enumerate(self.ties):
            both, half = own[:, i] + own[:, j], self.half[:, k, None, None]
            across = half * (own[:, j] - own[:, i])
            blocks[:, i, :, i] += both
            blocks[:, i, :, j] += across
            blocks[:, j, :, i] += across
            blocks[:, j, :, j] += half**2 * both + self.own[:, k, None, None] ** 2 * own[:, count + k]
        return found


def least_in_discs(K: Real, g: Real, radii: Real, close: float = CLOSE, ties: NDArray[np.int64] = NO_TIES) -> InDiscs:
    """Return where ½ vᵀ K v - gᵀ v is least with every pair of variables in its disc.

    Parameters
    ----------
    K : ndarray, shape (2 m, 2 m) or (n, 2 m, 2 m)
        Symmetric, without negative eigenvalues.
    g : ndarray, shape (2 m,) or (n, 2 m)
    radii : ndarray, shape (n, m + f)
        Not negative.
    close : float, optional
        Of the residual and of the mean product z s, over the largest entry of b, at which the steps end.
    ties : ndarray of int, shape (f, 2), optional
        Pairs of one radius whose difference stays in a disc too, whose radii come last; each pair in one at most.

    Returns
    -------
    InDiscs

    Raises
    ------
    CannotRunError
        Where the bound does not come near to the value.
    """
    count, size = len(radii), K.shape[-1]
    stiff, each = np.broadcast_to(K, (count, size, size)), np.broadcast_to(g, (count, size))
    batches = [slice(k, k + BATCH) for k in range(0, max(count, 1), BATCH)]
    found = [_least(stiff[batch], each[batch], radii[batch], close, ties) for batch in batches]
    return InDiscs(**{name: np.concatenate([vars(one)[name] for one in found]) for name in vars(found[0])})


def _least(K: Real, g: Real, radii: Real, close: float, ties: NDArray[np.int64]) -> InDiscs:
    count, discs = radii.shape
    scale, every = np.repeat(radii[:, : discs - len(ties)], 2, axis=1), _Discs.of(radii, ties)
    A, b = _scaled(K, scale, every), every.folded(scale * g)
    size = np.abs(b).max(axis=1)
    idle = size <= IDLE * np.abs(A).max(axis=(1, 2))
    A[idle], b[idle] = 0.0, 0.0
    unit = np.where(idle, 1.0, size)
    A, b = A / unit[:, None, None], b / unit[:, None]
    w, z, left = np.empty_like(b), np.empty((count, discs)), np.arange(count)
    for pace in PACES:
        w[left], z[left], ended = _followed(A[left], b[left], every[left], close, pace)
        left = left[~ended]
        if not len(left):
            break
    gap = unit * _gap(A, b, w, z, every)
    if not (gap <= np.maximum(PROVEN, 100.0 * discs * np.maximum(close, _floor(A))) * unit).all():
        raise CannotRunError(
            f"how pins stand in their holes was not found: the energy may be {float((gap / unit).max()):.1e} of that "
            "of the load too high; state in which links pins are tight, or other clearances"
        )
    return InDiscs(
        v=scale * every.inner(w)[:, : w.shape[1] // 2].reshape(w.shape), share=w, multiplier=z * unit[:, None], gap=gap
    )


def _scaled(K: Real, scale: Real, every: _Discs) -> Real:
    """K by the variables w (n, 2 m, 2 m)."""
    A = every.folded(scale[:, :, None] * K * scale[:, None, :])
    return every.folded(A.swapaxes(1, 2)).swapaxes(1, 2)


def _to_rim(inner: Real, step: Real) -> Real:
    """Length of a step (n, m) at which a pair leaves the unit disc."""
    across, along = _dot(step, step), _dot(inner, step)
    room = np.maximum(1.0 - _dot(inner, inner), 0.0)
    root = np.sqrt(along**2 + across * room)
    return np.asarray(np.divide(room, along + root, out=np.full_like(room, np.inf), where=along + root > 0.0))


def _to_zero(value: Real, step: Real) -> Real:
    """Length of a step (n, m) at which a positive value ends."""
    return np.asarray(np.divide(value, -step, out=np.full_like(value, np.inf), where=step < 0.0))


def _followed(
    A: Real, b: Real, every: _Discs, close: float, pace: tuple[float, float, int]
) -> tuple[Real, Real, NDArray[np.bool_]]:
    """Variables, multipliers, and of which states the steps have ended."""
    towards, shorter, steps = pace
    w, z = np.zeros_like(b), np.ones((len(b), b.shape[1] // 2 + len(every.ties)))
    own, a, by, tolerance = np.arange(len(b)), A, every, np.maximum(close, _floor(A))
    for _ in range(steps):
        pull, inner = z[own], by.inner(w[own])
        slack = _slack(inner)
        force = b[own] - (a @ w[own][:, :, None])[:, :, 0]
        rest = np.abs(by.outer(pull[:, :, None] * inner) - force).max(axis=1)
        mean = (pull * slack).mean(axis=1)
        going = np.maximum(rest, mean) > tolerance[own]
        if not going.all():
            own, a, by, inner = own[going], a[going], by[going], inner[going]
            pull, slack, force, mean = pull[going], slack[going], force[going], mean[going]
        if not len(own):
            break
        aim = towards * mean[:, None]
        matrix = by.held(a, _barriers(inner, pull))
        right = force - by.outer((aim / slack)[:, :, None] * inner)
        step = np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], dtype=np.float64)
        moved = by.inner(step)
        further = (aim - pull * slack + pull * _dot(inner, moved)) / slack
        length = np.minimum(_to_rim(inner, moved), _to_zero(pull, further)).min(axis=1)
        length = np.minimum(shorter * length, 1.0)
        w[own] += length[:, None] * step
        z[own] += length[:, None] * further
    ended = np.ones(len(b), dtype=bool)
    ended[own] = False
    return w, z, ended


def _floor(A: Real) -> Real:
    """Residual (n,) below which rounding leaves nothing to be told, where little load meets much stiffness."""
    return np.asarray(ROUNDING * np.abs(A).max(axis=(1, 2)))


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

    The optimal state follows from A w - b + Σ z e = 0 with z s = μ at the last μ, which is smooth in the radii. Its
    Jacobian is inverted once for each state. Of pairs with a disc for their difference v stays, in place of w, and a
    disc that grows presses its e by (2 + |e|²/s) z over its radius less.

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
    scale, every = np.repeat(radii[:, :pairs], 2, axis=1), _Discs.of(radii, ties)
    w, z, inner = found.share, found.multiplier, every.inner(found.share)
    inverse = np.linalg.inv(every.held(_scaled(K, scale, every), _barriers(inner, z)))
    moved = np.einsum("kij,kj->ki", inverse[state], every[state].folded(scale[state] * along))
    y = every[state].inner(moved)
    force = _over(np.repeat(z[:, :pairs], 2, axis=1) * w, scale)  # what is left of g - K v at a rim, times its radius
    own = y[:, :pairs].reshape(along.shape)
    each = along * w[state] + own * force[state] - (scale[state] * own) @ K * w[state]
    by_radii = np.hstack([each.reshape(len(state), pairs, 2).sum(axis=2), np.zeros((len(state), len(ties)))])
    tied = [*ties.ravel(), *range(pairs, pairs + len(ties))]  # whose w depends on several radii
    pull = _over(z * (2.0 + _dot(inner, inner) / _slack(inner)), radii)[state]
    by_radii[:, tied] = (pull * _dot(y, inner[state]))[:, tied]
    return np.asarray(by_radii)


def _over(value: Real, size: Real) -> Real:
    return np.divide(value, size, out=np.zeros_like(value), where=size > 0.0)


def _barriers(inner: Real, pull: Real) -> Real:
    """Stiffness (n, m + f, 2, 2) of the discs' barriers, from inner shares (n, m + f, 2) and multipliers (n, m + f)."""
    own = (pull / _slack(inner))[:, :, None, None] * inner[:, :, :, None] * inner[:, :, None, :]
    return np.asarray(own + pull[:, :, None, None] * np.eye(2))


def _slack(inner: Real) -> Real:
    return np.asarray(np.maximum((1.0 - _dot(inner, inner)) / 2.0, ROUNDING))


def _dot(one: Real, other: Real) -> Real:
    """Products (n, m) of pairs (n, m, 2), quicker than sums over so short an axis."""
    return np.asarray(one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1])
