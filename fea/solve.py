"""Solution of symmetric positive definite systems: one factorisation, any number of right-hand sides.

MKL PARDISO where pypardiso can be imported (x86-64), else SuperLU.
"""

import ctypes
import importlib.util
import weakref
from functools import cache
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from fea.block_matrix import SymmetricBlockMatrix
from geometry.errors import CannotRunError

Method = Literal["pardiso", "superlu"]
RESIDUAL_LIMIT = 1e-8
"""Largest residual allowed, relative to the right-hand side."""


class Factor(Protocol):
    """A factorised matrix."""

    name: str
    """What the report calls the solver."""

    def solve(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve for (n,) or (n, k); raises ``CannotRunError`` where the residual is not small."""
        ...


def available_methods() -> tuple[Method, ...]:
    """Return the solvers of this installation, the fastest first."""
    return ("pardiso", "superlu") if importlib.util.find_spec("pypardiso") else ("superlu",)


def factorise(K: SymmetricBlockMatrix, *, method: Method | None = None, threads: int | None = None) -> Factor:
    """Factorise a symmetric positive definite matrix.

    method    by default the fastest available
    threads   upper bound on the threads of the solver, by default what its library chooses

    Raises ``CannotRunError`` if the matrix is not positive definite or memory runs out.
    """
    if method is None and "pardiso" in available_methods():
        try:
            return PardisoFactor(K, threads)
        except ImportError:  # pypardiso is there, but not the library it wraps
            return SuperLUFactor(K)
    return PardisoFactor(K, threads) if method == "pardiso" else SuperLUFactor(K)


def _checked(K: SymmetricBlockMatrix, x: NDArray[np.float64], rhs: NDArray[np.float64], name: str) -> None:
    residual = np.linalg.norm(K @ x - rhs, axis=0)
    limit = RESIDUAL_LIMIT * np.linalg.norm(rhs, axis=0)
    if not (residual <= limit).all():
        worst = float(np.max(residual / np.where(limit > 0.0, limit, 1.0)) * RESIDUAL_LIMIT)
        raise CannotRunError(
            f"{name} left a residual of {worst:.1e} of the load (limit {RESIDUAL_LIMIT:g}): the stiffness matrix is "
            "nearly singular; check supports, mesh quality and Poisson's ratio"
        )


class SuperLUFactor:
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

    def solve(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve for (n,) or (n, k)."""
        x = np.asarray(self._lu.solve(rhs))
        _checked(self._K, x, rhs, self.name)
        return x


class PardisoFactor:
    """MKL PARDISO for symmetric positive definite matrices (``mtype`` 2) on the upper block triangle.

    Parameters and error numbers: Intel oneMKL Developer Reference, "pardiso" and "pardiso iparm Parameter".
    pypardiso only finds the library: its own solver stores the matrix twice and compares it at every solution.
    """

    name = "MKL PARDISO"
    _MTYPE = 2
    _ANALYSE_AND_FACTORISE, _SOLVE, _RELEASE = 12, 33, -1
    _ERRORS = {
        -2: "it ran out of memory; use a coarser mesh",
        -4: "it is not positive definite: the body is not supported or an element is folded over",
        -8: "its size exceeds 32-bit numbering",
    }

    def __init__(self, K: SymmetricBlockMatrix, threads: int | None = None) -> None:
        self._K = K
        self._threads = threads
        self._library = _mkl()
        self._handle = np.zeros(64, dtype=np.int64)
        self._iparm = np.zeros(64, dtype=np.int32)
        self._iparm[0] = 1  # no defaults
        self._iparm[1] = 2  # nested dissection (METIS)
        self._iparm[7] = 2  # at most two steps of iterative refinement
        self._iparm[34] = 1  # zero-based indices
        self._iparm[36] = 3  # block-compressed rows of 3×3 blocks
        self._call(self._ANALYSE_AND_FACTORISE, None)
        self._finalizer = weakref.finalize(self, _release, self._library, self._handle, self._iparm, self._MTYPE)

    def solve(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve for (n,) or (n, k)."""
        b = np.asfortranarray(rhs, dtype=np.float64)
        x = np.asarray(self._call(self._SOLVE, b))
        _checked(self._K, x, rhs, self.name)
        return x

    def _call(self, phase: int, b: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
        x = None if b is None else np.zeros_like(b)
        previous = self._library.MKL_Set_Num_Threads_Local(ctypes.c_int(self._threads or 0))
        try:
            error = _pardiso(self._library, self._handle, self._iparm, self._MTYPE, phase, self._K, b, x)
        finally:
            self._library.MKL_Set_Num_Threads_Local(ctypes.c_int(previous))
        if error:
            reason = self._ERRORS.get(error, f"error {error}")
            raise CannotRunError(f"{self.name} could not solve with the stiffness matrix: {reason}")
        return x


@cache
def _mkl() -> Any:
    """Load MKL; kept, because pypardiso searches the whole environment for it.

    Raises ``ImportError`` where it is missing.
    """
    from pypardiso import PyPardisoSolver

    return PyPardisoSolver().libmkl


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

    def array(values: NDArray[Any] | None) -> Any:
        return None if values is None else ctypes.c_void_p(values.ctypes.data)

    error = ctypes.c_int32(0)
    function = library.pardiso
    function.argtypes = None
    function.restype = None
    function(
        array(handle), integer(1), integer(1), integer(mtype), integer(phase),
        integer(0 if K is None else K.size // 3),
        array(None if K is None else K.blocks), array(None if K is None else K.indptr),
        array(None if K is None else K.indices), None,
        integer(0 if b is None else b.size // b.shape[0]), array(iparm), integer(0), array(b), array(x),
        ctypes.byref(error),
    )  # fmt: skip
    return error.value


def _release(library: Any, handle: NDArray[np.int64], iparm: NDArray[np.int32], mtype: int) -> None:
    """Free the factor's memory."""
    _pardiso(library, handle, iparm, mtype, PardisoFactor._RELEASE, None, None, None)
