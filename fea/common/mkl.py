"""Intel's Math Kernel Library through ctypes: where it is, and products with symmetric block matrices.

Calls and constants: Intel oneMKL Developer Reference for C, "Inspector-Executor Sparse BLAS Routines"
and "Conditional Numerical Reproducibility Control".
"""

import ctypes
import importlib.metadata
import platform
import sys
import weakref
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_REPRODUCIBLE = 2  # MKL_CBWR_AUTO: the best code branch, the same at every call
_OPERATION_NON_TRANSPOSE, _INDEX_BASE_ZERO, _LAYOUT_ROW_MAJOR = 10, 0, 101


class _Description(ctypes.Structure):
    """``struct matrix_descr``: symmetric, upper triangle stored, diagonal stored."""

    _fields_ = [("type", ctypes.c_int), ("mode", ctypes.c_int), ("diag", ctypes.c_int)]


_SYMMETRIC_UPPER = _Description(21, 41, 50)


def _candidates() -> Iterator[Path]:
    """Where pip puts the library of its package ``mkl``, then where conda does."""
    try:
        files = importlib.metadata.files("mkl") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    yield from (Path(str(file.locate())) for file in files if "mkl_rt" in file.name)
    for pattern in ("lib/libmkl_rt.so*", "Library/bin/mkl_rt*.dll"):
        yield from sorted(Path(sys.prefix).glob(pattern))


def installed() -> bool:
    """Return whether this installation has the library."""
    return any(path.exists() for path in _candidates())


def missing() -> bool:
    """Return whether this installation lacks the library though the extra ``pardiso`` has it for this machine."""
    return (sys.platform, platform.machine()) in (("linux", "x86_64"), ("win32", "AMD64")) and not installed()


@cache
def library() -> Any:
    """Load MKL, set to give the same bits at every run with the same number of threads.

    Raises ``ImportError`` where it is missing or cannot be loaded.
    """
    for path in _candidates():
        try:
            loaded = ctypes.CDLL(str(path))
        except OSError as error:
            raise ImportError(f"{path} cannot be loaded: {error}") from error
        loaded.MKL_CBWR_Set(ctypes.c_int(_REPRODUCIBLE))
        return loaded
    raise ImportError("the Math Kernel Library (package mkl) is not installed")


def address(values: NDArray[Any] | None) -> ctypes.c_void_p | None:
    """Return a pointer to the first entry, or a null pointer.

    Parameters
    ----------
    values : ndarray or None
        Array.

    Returns
    -------
    c_void_p or None
        Pointer; null for None.
    """
    return None if values is None else ctypes.c_void_p(values.ctypes.data)


class SymmetricProduct:
    """Products of a symmetric matrix of 3×3 blocks, given by its upper block triangle, with vectors.

    Refers to the arrays handed in and copies nothing.
    """

    def __init__(self, indptr: NDArray[np.int32], indices: NDArray[np.int32], blocks: NDArray[np.float64]) -> None:
        self._arrays = (indptr, indices, blocks)
        self._library = library()
        self._handle = ctypes.c_void_p()
        rows = ctypes.c_int(len(indptr) - 1)
        status = self._library.mkl_sparse_d_create_bsr(
            ctypes.byref(self._handle), _INDEX_BASE_ZERO, _LAYOUT_ROW_MAJOR, rows, rows, ctypes.c_int(3),
            address(indptr), address(indptr[1:]), address(indices), address(blocks),
        )  # fmt: skip
        if status:
            raise MemoryError(f"MKL could not take the matrix (status {status})")
        weakref.finalize(self, self._library.mkl_sparse_destroy, self._handle)

    def __call__(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Multiply with a contiguous vector (n,)."""
        y = np.empty_like(x)
        status = self._library.mkl_sparse_d_mv(
            _OPERATION_NON_TRANSPOSE, ctypes.c_double(1.0), self._handle, _SYMMETRIC_UPPER,
            address(x), ctypes.c_double(0.0), address(y),
        )  # fmt: skip
        if status:
            raise MemoryError(f"MKL could not multiply (status {status})")
        return y
