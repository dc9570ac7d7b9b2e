"""Direct solution of symmetric positive definite systems: one factorisation, any number of right-hand sides.

MKL PARDISO where MKL is installed (x86-64), else SuperLU.
"""

import ctypes
import weakref
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory, mkl
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.solvers.solved import Solved, accept, refined
from alula.geometry.base.errors import CannotRunError


class DirectFactor(ABC):
    """A factorised matrix."""

    name: str
    _K: SymmetricBlockMatrix

    @abstractmethod
    def apply(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve without looking at the residual.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        ndarray
            Solutions, of the same shape.
        """

    def solve(self, rhs: NDArray[np.float64]) -> Solved:
        """Solve, refined where rounding shows.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        Solved
            Solutions and their error.

        Raises
        ------
        CannotRunError
            For too large an error.
        """
        x, error = refined(self._K, self.apply, rhs)
        accept(error, self.name)
        return Solved(x=x, error=error, iterations=0)


class SuperLUFactor(DirectFactor):
    """SuperLU in symmetric mode: minimum degree on A' + A, pivots on the diagonal (Li 1999, SuperLU users' guide)."""

    name = "SuperLU"

    def __init__(self, K: SymmetricBlockMatrix) -> None:
        from scipy.sparse.linalg import splu

        self._K = K
        try:
            self._lu = splu(
                K.full(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except MemoryError as error:
            raise CannotRunError(f"SuperLU ran out of memory at {K.size} unknowns; use a coarser mesh") from error
        except RuntimeError as error:
            raise CannotRunError(f"SuperLU could not solve with the stiffness matrix: {error}") from error

    def apply(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve by forward and back substitution.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        ndarray
            Solutions, of the same shape.
        """
        return np.asarray(self._lu.solve(rhs))


class PardisoFactor(DirectFactor):
    """MKL PARDISO for symmetric positive definite matrices (``mtype`` 2) on the upper block triangle.

    Parameters and error numbers: Intel oneMKL Developer Reference, "pardiso" and "pardiso iparm Parameter".
    ``memory`` is what the analysis says that the factor takes [bytes].

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The system.
    memory_limit : float or None, optional
        Bytes that the whole process may hold, by default what the system leaves.

    Raises
    ------
    CannotRunError
        After the analysis, which knows the factor's size, if it does not fit.
    """

    name = "MKL PARDISO"
    _MTYPE = 2
    _ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
    _KILOBYTE = 1024.0
    _ERRORS = {
        -2: "it ran out of memory; use a coarser mesh",
        -4: "it is not positive definite: the body is not supported or an element is folded over",
        -8: "its size exceeds 32-bit numbering",
    }

    def __init__(self, K: SymmetricBlockMatrix, *, memory_limit: float | None = None) -> None:
        self._K = K
        self._library = mkl.library()
        self._handle = np.zeros(64, dtype=np.int64)
        self._iparm = np.zeros(64, dtype=np.int32)
        self._iparm[0] = 1  # no defaults
        self._iparm[1] = 2  # nested dissection (METIS)
        self._iparm[7] = 0  # no refinement here: it would triple the time of every solution
        self._iparm[34] = 1  # zero-based indices
        self._iparm[36] = 3  # block-compressed rows of 3×3 blocks
        self._finalizer = weakref.finalize(self, _release, self._library, self._handle, self._iparm, self._MTYPE)
        self._call(self._ANALYSE, None)
        self.memory = self._KILOBYTE * float(self._iparm[16])
        memory.require(self.memory, f"the factor of {K.size:,} unknowns by {self.name}", memory_limit)
        self._call(self._FACTORISE, None)

    def apply(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve by forward and back substitution.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        ndarray
            Solutions, of the same shape.
        """
        return np.asarray(self._call(self._SOLVE, np.asfortranarray(rhs, dtype=np.float64)))

    def _call(self, phase: int, b: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
        x = None if b is None else np.zeros_like(b)
        error = _pardiso(self._library, self._handle, self._iparm, self._MTYPE, phase, self._K, b, x)
        if error:
            reason = self._ERRORS.get(error, f"error {error}")
            raise CannotRunError(f"{self.name} could not solve with the stiffness matrix: {reason}")
        return x


def _pardiso(
    library: Any,
    handle: NDArray[np.int64],
    iparm: NDArray[np.int32],
    mtype: int,
    phase: int,
    K: SymmetricBlockMatrix | None,
    b: NDArray[np.float64] | None,
    x: NDArray[np.float64] | None,
) -> int:
    """Call ``pardiso`` and return its error number."""

    def integer(value: int) -> Any:
        return ctypes.byref(ctypes.c_int32(value))

    error = ctypes.c_int32(0)
    library.pardiso(
        mkl.address(handle), integer(1), integer(1), integer(mtype), integer(phase),
        integer(0 if K is None else K.size // 3),
        mkl.address(None if K is None else K.blocks), mkl.address(None if K is None else K.indptr),
        mkl.address(None if K is None else K.indices), None,
        integer(0 if b is None else b.size // b.shape[0]), mkl.address(iparm), integer(0), mkl.address(b),
        mkl.address(x), ctypes.byref(error),
    )  # fmt: skip
    return error.value


def _release(library: Any, handle: NDArray[np.int64], iparm: NDArray[np.int32], mtype: int) -> None:
    """Free the factor's memory."""
    _pardiso(library, handle, iparm, mtype, PardisoFactor._RELEASE, None, None, None)
