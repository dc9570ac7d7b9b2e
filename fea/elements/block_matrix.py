"""Symmetric sparse matrices of 3×3 blocks, one block row per node, of which the upper triangle is stored."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import mkl

Product = Callable[[NDArray[np.float64]], NDArray[np.float64]]
Vectors = NDArray[np.float64]
"""(k, n): one contiguous row per right-hand side."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SymmetricBlockMatrix:
    """Upper block triangle in block-compressed rows; diagonal blocks are stored whole.

    Attributes
    ----------
    indptr : ndarray of int, shape (n + 1,)
        Start of every block row.
    indices : ndarray of int, shape (b,)
        Block column of every block, ascending, beginning with the diagonal.
    blocks : ndarray, shape (b, 3, 3)
        Entries.
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    blocks: NDArray[np.float64]

    @property
    def size(self) -> int:
        """Number of scalar rows."""
        return 3 * (len(self.indptr) - 1)

    @property
    def diagonal(self) -> NDArray[np.float64]:
        """Diagonal blocks (n, 3, 3)."""
        return np.asarray(self.blocks[self.indptr[:-1]])

    def upper(self) -> Any:
        """Return the stored blocks as a scipy ``bsr_array`` (views, no copy)."""
        from scipy.sparse import bsr_array

        return bsr_array((self.blocks, self.indices, self.indptr), shape=(self.size, self.size))

    def both_triangles(self) -> Any:
        """Return the whole matrix as a scipy ``bsr_array``; blocks of zeros are left out."""
        upper = self.upper()
        return upper + (upper - block_diagonal(self.diagonal)).T.tobsr(blocksize=(3, 3))

    def full(self) -> Any:
        """Return the whole matrix as a scipy ``csc_array``."""
        from scipy.sparse import csc_array, triu

        upper = triu(self.upper(), format="csr")
        return csc_array(upper + triu(upper, 1, format="csr").T)

    @cached_property
    def product(self) -> Product:
        """Multiply with contiguous vectors (size,): by MKL, else by scipy with the transpose stored as well."""
        try:
            return mkl.SymmetricProduct(self.indptr, self.indices, self.blocks)
        except ImportError:
            return _ScipyProduct(self)

    def __matmul__(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Multiply with (size,) or (size, k)."""
        if x.ndim == 1:
            return self.product(np.ascontiguousarray(x, dtype=np.float64))
        found = np.empty(x.shape, order="F")
        for column, out in zip(x.T, found.T, strict=True):
            out[:] = self.product(np.ascontiguousarray(column, dtype=np.float64))
        return found

    def fix(self, unknowns: NDArray[np.int64]) -> Any:
        """Set rows and columns of these unknowns to zero but for their diagonal entries, here and not in a copy.

        Parameters
        ----------
        unknowns : ndarray of int
            That are fixed.

        Returns
        -------
        csr_array, shape (size, size)
            What was taken away: with it the matrix is the one before.
        """
        from scipy.sparse import coo_array

        self.__dict__.pop("product", None)  # it may hold a copy
        fixed = np.zeros((len(self.indptr) - 1, 3), dtype=np.bool_)
        fixed.reshape(-1)[unknowns] = True
        touched = np.any(fixed, axis=1, keepdims=True)[:, 0]
        rows = np.repeat(np.arange(len(fixed), dtype=np.int32), np.diff(self.indptr))
        place = np.flatnonzero(touched[rows] | touched[self.indices])
        row, column = rows[place], self.indices[place]
        cleared = fixed[row][:, :, None] | fixed[column][:, None, :]
        cleared[row == column] &= ~np.eye(3, dtype=np.bool_)
        block, i, j = np.nonzero(cleared)
        values, i, j = self.blocks[place[block], i, j], i + 3 * row[block], j + 3 * column[block]
        self.blocks[place] = np.where(cleared, 0.0, self.blocks[place])
        above = row[block] != column[block]  # diagonal blocks are stored whole
        i, j = np.concatenate([i, j[above]]), np.concatenate([j, i[above]])
        return coo_array((np.concatenate([values, values[above]]), (i, j)), shape=(self.size, self.size)).tocsr()

    def copy(self) -> "SymmetricBlockMatrix":
        """Return a matrix with blocks of its own."""
        return SymmetricBlockMatrix(indptr=self.indptr, indices=self.indices, blocks=self.blocks.copy())

    def with_fixed(self, unknowns: NDArray[np.int64]) -> "SymmetricBlockMatrix":
        """Return a copy in which these unknowns are fixed.

        Parameters
        ----------
        unknowns : ndarray of int
            That are fixed.

        Returns
        -------
        SymmetricBlockMatrix
            The copy; what was taken away is lost.
        """
        found = self.copy()
        found.fix(unknowns)
        return found


def block_diagonal(blocks: NDArray[Any]) -> Any:
    """Return a scipy ``bsr_array`` of diagonal blocks.

    Parameters
    ----------
    blocks : ndarray, shape (n, 3, 3)
        Entries.

    Returns
    -------
    bsr_array
        The matrix.
    """
    from scipy.sparse import bsr_array

    nodes = np.arange(len(blocks) + 1)
    return bsr_array((blocks, nodes[:-1], nodes))


class _ScipyProduct:
    """Products where MKL is missing; scipy's transpose of block rows is a copy, so it is made once."""

    def __init__(self, matrix: SymmetricBlockMatrix) -> None:
        self._upper = matrix.upper()
        self._lower = self._upper.T.tobsr(blocksize=(3, 3))
        self._diagonal = matrix.diagonal

    def __call__(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        twice = (self._diagonal @ x.reshape(-1, 3, 1)).ravel()
        return np.asarray(self._upper @ x + self._lower @ x - twice)
