"""Symmetric sparse matrices of 3×3 blocks, one block row per node, of which the upper triangle is stored."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True, eq=False)
class SymmetricBlockMatrix:
    """Upper block triangle in block-compressed rows; diagonal blocks are stored whole.

    indptr    (n + 1,) start of every block row
    indices   (b,) block column of every block, ascending, beginning with the diagonal
    blocks    (b, 3, 3)
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    blocks: NDArray[np.float64]

    @property
    def size(self) -> int:
        """Number of scalar rows."""
        return 3 * (len(self.indptr) - 1)

    def upper(self) -> Any:
        """Return the stored blocks as a scipy ``bsr_array`` (views, no copy)."""
        from scipy.sparse import bsr_array

        return bsr_array((self.blocks, self.indices, self.indptr), shape=(self.size, self.size))

    def full(self) -> Any:
        """Return the whole matrix as a scipy ``csc_array``."""
        from scipy.sparse import csc_array, triu

        upper = triu(self.upper(), format="csr")
        return csc_array(upper + triu(upper, 1, format="csr").T)

    def __matmul__(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Multiply with (size,) or (size, k)."""
        upper = self.upper()
        columns = x.reshape(self.size, -1)
        diagonal = self.blocks[self.indptr[:-1]]
        nodal = columns.reshape(-1, 3, columns.shape[1])
        product = upper @ columns + upper.T @ columns - (diagonal @ nodal).reshape(self.size, -1)
        return np.asarray(product).reshape(x.shape)

    def with_fixed(self, unknowns: NDArray[np.int64]) -> "SymmetricBlockMatrix":
        """Return a copy in which rows and columns of these unknowns are zero but for their diagonal entry."""
        blocks = self.blocks.copy()
        rows = np.repeat(np.arange(len(self.indptr) - 1), np.diff(self.indptr))
        for unknown in unknowns:
            node, component = divmod(int(unknown), 3)
            diagonal = self.blocks[self.indptr[node], component, component]
            blocks[rows == node, component, :] = 0.0
            blocks[self.indices == node, :, component] = 0.0
            blocks[self.indptr[node], component, component] = diagonal
        return SymmetricBlockMatrix(indptr=self.indptr, indices=self.indices, blocks=blocks)
