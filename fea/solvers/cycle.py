"""What multilevel cycles are made of: Chebyshev smoothing by blocks, and smoothed aggregation below it."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.block_matrix import Product, SymmetricBlockMatrix, Vectors, block_diagonal
from alula.fea.solvers.direct import DirectFactor
from alula.geometry.base.errors import CannotRunError

_LANCZOS_STEPS = 10
_MARGIN = 1.1  # Lanczos finds the largest eigenvalue from below
_AROUND_AGGREGATES = (4, 30.0)
"""Degree, and ratio of the largest to the smallest eigenvalue treated: aggregates are three nodes wide.

Bars of 160,000 quadratic unknowns take 23 iterations, 24 with degrees 3 and 6, 19 with the linear elements' factor."""


class ChebyshevSmoother:
    """Chebyshev polynomial in D⁻¹K for the upper part of its spectrum; D are the 3×3 diagonal blocks.

    Where elements are flat, D holds the whole block of their nodes: a flat element is so stiff that its nodes can only
    be moved together. Blocks that overlap share their nodes by equal weights. Recurrence: Saad, Iterative Methods for
    Sparse Linear Systems, 2nd ed., algorithm 12.1.

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The system.
    flat : ndarray of int, shape (k, m)
        Nodes of the flat elements.
    degree : int
        Of the polynomial.
    ratio : float
        Of the largest to the smallest eigenvalue treated.
    """

    def __init__(self, K: SymmetricBlockMatrix, flat: NDArray[np.int64], degree: int, ratio: float) -> None:
        self._product = K.product
        self._degree = degree
        self._ratio = ratio
        try:
            np.linalg.cholesky(K.diagonal)
            self._inverse = _block_inverse(K, flat)
        except np.linalg.LinAlgError as error:
            raise CannotRunError(
                "the stiffness matrix has a diagonal block that is not positive definite: a node has no stiffness, or "
                "an element is folded over"
            ) from error
        self.largest = _MARGIN * _largest_eigenvalue(self._product, self._inverse)

    def __call__(self, r: Vectors) -> Vectors:
        """Approximate K⁻¹ r."""
        smallest = self.largest / self._ratio
        centre, half = (self.largest + smallest) / 2.0, (self.largest - smallest) / 2.0
        x = np.empty_like(r)
        for column, out in zip(r, x, strict=True):
            rho = half / centre
            step = (self._inverse @ column) / centre
            out[:] = step
            rest = column
            for _ in range(self._degree - 1):
                rest = rest - self._product(step)
                previous, rho = rho, 1.0 / (2.0 * centre / half - rho)
                step = (rho * previous) * step + (2.0 * rho / half) * (self._inverse @ rest)
                out += step
        return x

    def cycle(self, r: Vectors, correction: Callable[[Vectors], Vectors]) -> Vectors:
        """Smooth, correct, smooth: an approximate solution, symmetric in r where the correction is.

        Parameters
        ----------
        r : ndarray, shape (k, n)
            Right-hand sides.
        correction : callable
            Approximate solution for what the first smoothing leaves.

        Returns
        -------
        ndarray, shape (k, n)
            Approximate solutions.
        """
        x = self(r)
        rest = r - rows(self._product, x)
        correct = correction(rest)
        x += correct
        rest -= rows(self._product, correct)
        x += self(rest)
        return x


def rows(product: Product, x: Vectors) -> Vectors:
    """Multiply every row of x.

    Parameters
    ----------
    product : callable
        With one vector.
    x : ndarray, shape (k, n)
        Vectors.

    Returns
    -------
    ndarray, shape (k, n)
        Products.
    """
    return np.array([product(row) for row in x])


def _block_inverse(K: SymmetricBlockMatrix, flat: NDArray[np.int64]) -> Any:
    """Return D⁻¹ as a ``bsr_array``: the sum of inverse blocks, each between the roots of its share in its nodes."""
    from scipy.sparse import bsr_array, csr_array

    if not len(flat):
        return block_diagonal(np.linalg.inv(K.diagonal))
    count = np.bincount(flat.ravel(), minlength=len(K.indptr) - 1)
    row, column = np.broadcast_arrays(flat[:, :, None], flat[:, None, :])
    pattern = csr_array((np.arange(len(K.indices)), K.indices, K.indptr), shape=(len(count), len(count)))
    place = pattern[np.minimum(row, column).ravel(), np.maximum(row, column).ravel()]
    blocks = K.blocks[np.asarray(place).ravel()].reshape(*row.shape, 3, 3)
    blocks[row > column] = blocks[row > column].swapaxes(1, 2)
    k, m = flat.shape
    inverse = np.linalg.inv(blocks.swapaxes(2, 3).reshape(k, 3 * m, 3 * m))
    blocks = inverse.reshape(k, m, 3, m, 3).swapaxes(2, 3) / np.sqrt(count[row] * count[column])[..., None, None]
    alone = np.flatnonzero(count == 0)
    rows_, columns = np.concatenate([alone, row.ravel()]), np.concatenate([alone, column.ravel()])
    order = np.lexsort((columns, rows_))
    values = np.concatenate([np.linalg.inv(K.diagonal[alone]), blocks.reshape(-1, 3, 3)])[order]
    return bsr_array((values, columns[order], np.searchsorted(rows_[order], np.arange(len(count) + 1))))


def _largest_eigenvalue(product: Product, inverse: Any) -> float:
    """Largest eigenvalue of D⁻¹K, from below, by the coefficients of conjugate gradients (Saad, section 6.7.3)."""
    from scipy.linalg import eigvalsh_tridiagonal

    r = np.random.default_rng(0).normal(size=inverse.shape[0])
    z = inverse @ r
    p, rz, last = z, r @ z, 0.0
    diagonal, beside = [], []
    for _ in range(_LANCZOS_STEPS):
        q = product(p)
        slope = (p @ q) / rz
        diagonal.append(slope + last)
        r = r - q / slope
        z = inverse @ r
        rz, previous = r @ z, rz
        beside.append(slope * np.sqrt(rz / previous))
        last = slope * rz / previous
        p = z + (rz / previous) * p
    return float(eigvalsh_tridiagonal(np.array(diagonal), np.array(beside[:-1])).max())


class SmoothedAggregation:
    """An approximate solver whose memory and work grow with the unknowns alone.

    Neighbouring nodes are gathered into aggregates, some twenty to each (by pyamg). The coarse level holds the six
    rigid-body motions of every aggregate, smoothed once by the matrix, and is factorised in double precision (Vaněk,
    Mandel and Brezina, Computing 56 (1996) 179-196). It bends as freely as linear elements do themselves. Around it
    stands Chebyshev smoothing.

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The system, with its fixed unknowns.
    motions : ndarray, shape (6, n, 3)
        Rigid-body motions of its nodes.
    fixed : ndarray of int
        Fixed unknowns.
    flat : ndarray of int, shape (k, 4)
        Nodes of flat elements.
    factorise : callable
        Direct solver of the aggregates' system.
    """

    name = "smoothed aggregation"

    def __init__(
        self,
        K: SymmetricBlockMatrix,
        motions: NDArray[np.float64],
        fixed: NDArray[np.int64],
        flat: NDArray[np.int64],
        factorise: Callable[[SymmetricBlockMatrix], DirectFactor],
    ) -> None:
        from pyamg.aggregation import fit_candidates, standard_aggregation
        from pyamg.strength import symmetric_strength_of_connection

        self._smoother = ChebyshevSmoother(K, flat, *_AROUND_AGGREGATES)
        whole = K.both_triangles()
        aggregates, _ = standard_aggregation(symmetric_strength_of_connection(whole))
        candidates = motions.reshape(6, -1).T.copy()
        candidates[fixed] = 0.0
        tentative, _ = fit_candidates(aggregates, candidates)
        damping = block_diagonal(np.linalg.inv(K.diagonal) * (4.0 / 3.0 / self._smoother.largest))
        upward = (tentative - damping @ (whole @ tentative)).tobsr(blocksize=(3, 6))
        downward = upward.T.tobsr(blocksize=(6, 3))
        self._factor = factorise(_upper(downward @ (whole @ upward)))
        self._upward, self._downward = upward.tocsr(), downward.tocsr()

    def apply(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Approximate the solution by one cycle, symmetric in the right-hand side.

        Parameters
        ----------
        rhs : ndarray, shape (n, k)
            Right-hand sides.

        Returns
        -------
        ndarray, shape (n, k)
            Approximate solutions.
        """
        return self._smoother.cycle(np.ascontiguousarray(rhs.T), self._correction).T

    def _correction(self, rest: NDArray[np.float64]) -> NDArray[np.float64]:
        coarse = self._factor.apply(np.column_stack([self._downward @ row for row in rest]))
        return np.array([self._upward @ column for column in coarse.T])


def _upper(matrix: Any) -> SymmetricBlockMatrix:
    """Return the upper triangle of a symmetric ``bsr_array``; where a motion of an aggregate is missing, a one."""
    from scipy.sparse import bsr_array

    blocks = bsr_array(matrix.tobsr(blocksize=(3, 3)))
    blocks.sort_indices()
    rows = np.repeat(np.arange(len(blocks.indptr) - 1), np.diff(blocks.indptr))
    above = blocks.indices >= rows
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows[above], minlength=len(blocks.indptr) - 1))])
    values = blocks.data[above]
    node, i = np.nonzero(np.einsum("kii->ki", values[indptr[:-1]]) == 0.0)
    values[indptr[node], i, i] = 1.0
    return SymmetricBlockMatrix(
        indptr=indptr.astype(np.int32), indices=blocks.indices[above].astype(np.int32), blocks=values
    )
