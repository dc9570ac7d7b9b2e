"""The lowest natural modes of a stiffness and a mass matrix, and their record.

With K = L Lᵀ the largest eigenvalues μ of L⁻¹ M L⁻ᵀ are 1/λ of K x = λ M x (Bathe, Finite Element Procedures, 1996,
section 10.2.5, with the matrices' parts exchanged). Unknowns without mass have μ = 0, so that they give no spurious
values. Where K is not positive definite, as of a frame that its loads make unstable, K + s M takes its place, which
shifts every λ by s (section 10.2.3).

Where loads scatter, forces grow with the share s of the stated loads, and λ of (K + s K_g) x = λ M x is sought over its
range. By Rayleigh's quotient the lowest λ is the least of functions that are linear in s: it is concave, and least at
an end of the range, where it is solved. The k-th λ is at most the largest of any k shapes together, and no less than
the least of all shapes that k - 1 conditions leave (Courant & Hilbert, Methods of Mathematical Physics, vol. 1, 1953,
section I.4). With the lowest modes under the stated loads as shapes and conditions, the former is convex in s and the
latter concave, so that the ends bound what lies between them: the latter but for modes beyond those found.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import distinct
from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]

_FIRST_SHIFT, _SHIFTS = 1e-10, 14
"""First shift over the largest ratio of diagonal entries, and how often it is made ten times as large.

It is far below what an elastic frame has, and far above the rounding of a motion without strain, whose 1/λ would hide
all others."""
_ROUNDING = 1e-13
"""Pivot over its diagonal entry below which it is rounding."""
_NO_MASS = 1e-14
"""Share of the largest 1/λ below which an unknown counts as without mass."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Mode:
    """A natural mode.

    Attributes
    ----------
    frequency : Band
        [Hz]; 0 where the pose is unstable in this shape, which does not swing but departs.
    shape : ndarray, shape (n, 6)
        Displacements and rotations of the nodes of the model, global axes, with the largest displacement 1 mm [mm,
        rad].
    in_plane : float
        Share of its kinetic energy in the linkage's plane.
    """

    frequency: Band
    shape: Floats
    in_plane: float


@dataclass(frozen=True, kw_only=True, eq=False)
class NaturalModes:
    """Lowest eigenvalues with their vectors.

    Attributes
    ----------
    values : ndarray, shape (c,)
        λ [rad²/s²], the least first; negative where unstable.
    vectors : ndarray, shape (n, c)
        Of unit modal mass, with the largest entry positive.
    shift : float
        s [rad²/s²] by which the stiffness was made positive definite; 0 where it is.
    """

    values: Floats
    vectors: Floats
    shift: float = 0.0


def lowest(K: Floats, M: Floats, count: int) -> NaturalModes:
    """Return the lowest eigenvalues of K x = λ M x.

    Parameters
    ----------
    K : ndarray, shape (n, n)
        Stiffness.
    M : ndarray, shape (n, n)
        Mass; it may be singular.
    count : int
        Eigenvalues at the most; fewer where fewer unknowns have mass.

    Returns
    -------
    NaturalModes

    Raises
    ------
    CannotRunError
        Where nothing has mass, or what has none is unstable.
    """
    from scipy.linalg import eigh, solve_triangular

    K, M = (K + K.T) / 2.0, (M + M.T) / 2.0
    if not np.trace(M) > 0.0:
        raise CannotRunError("nothing of the frame that can move has mass, so that it has no natural frequency")
    L, shift = _factorised(K, M)
    half = solve_triangular(L, M, lower=True, check_finite=False)
    A = solve_triangular(L, half.T, lower=True, check_finite=False)
    size = len(A)
    mu, y = eigh((A + A.T) / 2.0, subset_by_index=[max(size - count, 0), size - 1], check_finite=False)
    mu, y = mu[::-1], y[:, ::-1]
    heavy = mu > _NO_MASS * mu[0]
    mu, y = mu[heavy], y[:, heavy]
    vectors = solve_triangular(L, y, lower=True, trans=1, check_finite=False) / np.sqrt(mu)
    largest = np.abs(vectors).argmax(axis=0)
    vectors = vectors * np.sign(vectors[largest, np.arange(len(mu))])
    return NaturalModes(values=1.0 / mu - shift, vectors=vectors, shift=shift)


def _factorised(K: Floats, M: Floats) -> tuple[Floats, float]:
    """Return L of K + s M = L Lᵀ, and s."""
    from scipy.linalg import LinAlgError, cholesky

    ratio = float(np.diag(K).max() / np.diag(M).max())
    for shift in (0.0, *(_FIRST_SHIFT * ratio * 10.0**k for k in range(_SHIFTS))):
        try:
            L = np.asarray(cholesky(K + shift * M, lower=True, check_finite=False))
        except LinAlgError:
            continue
        if shift > 0.0 or np.all(np.diag(L) ** 2 > _ROUNDING * np.diag(K)):
            return L, shift
    raise CannotRunError(
        "the frame is unstable in a motion in which nothing has mass, so that it has no natural frequencies; check "
        "what holds its links"
    )


def frequency(value: float) -> float:
    """Return the frequency of an eigenvalue.

    Parameters
    ----------
    value : float
        λ [rad²/s²].

    Returns
    -------
    float
        [Hz]; 0 where λ is not positive.
    """
    return float(np.sqrt(max(value, 0.0)) / (2.0 * np.pi))


def ends_between(found: NaturalModes, work: Floats, ends: Sequence[float], count: int) -> list[tuple[float, float]]:
    """Return bounds of the lowest eigenvalues under all loads of a range.

    Parameters
    ----------
    found : NaturalModes
        Under the stated loads; c of them.
    work : ndarray, shape (c, c)
        Xᵀ K_g X of their vectors X.
    ends : sequence of float
        Least and largest load over the stated one.
    count : int
        Eigenvalues at the most.

    Returns
    -------
    list of tuple of (float, float)
        Least and largest λ [rad²/s²]; the least one of the first is an estimate, to be solved at the ends.
    """
    at = [np.diag(found.values) + (share - 1.0) * (work + work.T) / 2.0 for share in ends]
    return [
        (
            min(float(np.linalg.eigvalsh(A[k:, k:])[0]) for A in at),
            max(float(np.linalg.eigvalsh(A[: k + 1, : k + 1])[-1]) for A in at),
        )
        for k in range(min(count, len(found.values)))
    ]


def with_scatter(
    modes: Sequence[Mode], others: Sequence[Sequence[Mode]], between: Sequence[tuple[float, float]], scatter: Scatter
) -> tuple[Mode, ...]:
    """Return modes whose bands hold the frequencies under all loads of a range.

    Parameters
    ----------
    modes : sequence of Mode
        Under the stated loads, the lowest frequency first.
    others : sequence of sequence of Mode
        The same under the least and the largest load; a mode that is missing there begins at 0.
    between : sequence of tuple of (float, float)
        Those of ``ends_between``.
    scatter : Scatter
        Of the loads.

    Returns
    -------
    tuple of Mode
    """
    found = []
    for k, (mode, bounds) in enumerate(zip(modes, between, strict=True)):
        known = [mode.frequency, *(one[k].frequency for one in others if k < len(one))]
        least, most = min(band.value for band in known), max(band.value for band in known)
        low, high = min(band.low for band in known), max(band.high for band in known)
        # What flexibilities leave open at the ends holds between them as well.
        below, above = least if k == 0 else min(frequency(bounds[0]), least), max(frequency(bounds[1]), most)
        low = low * below / least if least > 0.0 and len(known) > len(others) else 0.0
        high = max(high * above / most, above) if most > 0.0 else max(high, above)
        width = above / below if below > 0.0 else math.inf
        told = tuple(replace(one, width=width) for one in scatter.sources)
        band = replace(mode.frequency, low=low, high=high, sources=distinct(mode.frequency.sources, told))
        found.append(replace(mode, frequency=band))
    return tuple(found)
