"""The choice among solvers of symmetric positive definite systems, by unknowns, right-hand sides and memory.

Conjugate gradients over linear elements (``alula.fea.solvers.two_level``) take little to set up and much for each
right-hand side; a factorisation the reverse, and its work grows faster than the unknowns. So a factorisation takes less
work up to a number of unknowns that rises with the right-hand sides (``WORTH_FACTORISING``). Measured on quadratic
tetrahedra, on one core of an AMD EPYC server (cubes have the fullest factors: memory is estimated by them):

    MKL PARDISO    cubes of 47,000 unknowns: 2.3 s and 0.26 GB; 152,000: 1.35 GB; 499,000: 7.2 GB
                   bar of 160,000: 9.8 s and 1.07 GB, 0.1 s for each right-hand side
                   tube with two eyes of 43,000: 0.6 s and 0.12 GB; 123,000: 3.5 s and 0.53 GB
    SuperLU        cubes of 15,000 unknowns: 1.4 s and 0.17 GB; 47,000: 36 s and 1.4 GB
                   bar of 160,000: 102 s and 4.4 GB
    two levels     bar of 160,000 unknowns, ν = 0.38: 0.4 s, and 0.04 s for each of 19 iterations
    links from the mesher, set-up and each right-hand side, by PARDISO and by two levels (17 to 22 iterations):
                   48,000 unknowns: 0.87 + 0.02 s, 0.12 + 0.42 s; 62,000: 1.16 + 0.03 s, 0.20 + 0.63 s
                   98,000: 2.46 + 0.04 s, 0.34 + 0.76 s; 107,000: 2.67 + 0.05 s, 0.42 + 0.94 s
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory, mkl
from alula.fea.common.reason import Reason, reason
from alula.fea.common.threads import bounded
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.solvers.direct import DirectFactor, PardisoFactor, SuperLUFactor
from alula.fea.solvers.solved import Solved
from alula.fea.solvers.two_level import TOLERANCE, LinearLevel, TwoLevelFactor
from alula.geometry.base.errors import CannotRunError

Method = Literal["pardiso", "superlu", "two-level"]
DirectMethod = Literal["pardiso", "superlu"]
LOCKING_POISSON_RATIO = 0.49
"""For the two-level cycle, which takes 2.7 times as many iterations there as at 0.38, and ever more beyond."""
SLENDER = 60.0
"""Slenderness from which a factorisation is taken: linear elements bend so stiffly that the two-level cycle takes 52
iterations at a slenderness of 19 (30 diameters), 132 at 62, 376 at 187 and more than it may beyond, while a factor's
work grows with the length alone: 785,000 unknowns of a tube of 1000 diameters took 15 s and 2.2 GB, all in all."""
WORTH_FACTORISING: dict[DirectMethod, tuple[float, int]] = {"pardiso": (33_000.0, 0), "superlu": (1_250.0, 3)}
"""(a, b): for k right-hand sides a factorisation takes less work up to a (k + b) unknowns.

By the figures above: for one right-hand side both take the same work at some 33,000 unknowns of a link, for two at
80,000, for four at 140,000."""
AGGREGATED_FROM = 20_000
"""Unknowns of the linear elements, from which smoothed aggregation takes the place of their factor.

Bars of cubes, quadratic unknowns, set-up in seconds of processor time (by a factor), iterations (by a factor): 160,000:
0.1 (0.45), 23 (19); 555,000: 0.9 (2.8), 23 (19). A cycle takes less time than a solution with the factor."""
AGGREGATED_MEMORY = 1500.0
"""Bytes of smoothed aggregation for every unknown of the linear elements; measured some 800."""
_NAMES = {"pardiso": "MKL PARDISO", "superlu": "SuperLU", "two-level": "conjugate gradients over linear elements"}


@dataclass(frozen=True, kw_only=True, eq=False)
class Factor:
    """A system prepared for solution.

    Attributes
    ----------
    name : str
        What the report calls the solver.
    reason : Reason
        Why it was chosen.
    threads : int or None
        Upper bound on the threads of the libraries; their own choice where it is None.
    solver : DirectFactor or TwoLevelFactor
        What solves.
    """

    name: str
    reason: Reason
    threads: int | None
    solver: DirectFactor | TwoLevelFactor

    def solve(self, rhs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Solve the system.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        ndarray
            Solutions, of the same shape.

        Raises
        ------
        CannotRunError
            Where the error is not small.
        """
        return self.solved(rhs).x

    def solved(
        self, rhs: NDArray[np.float64], *, start: NDArray[np.float64] | None = None, tolerance: float = TOLERANCE
    ) -> Solved:
        """Solve the system, and tell the error and the number of iterations.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.
        start : ndarray, shape (n,) or (n, k), optional
            First guess of the solutions, one for all or one for each; a factorisation needs none.
        tolerance : float, optional
            Error in the energy norm, relative to the solution, at which iterations end; a factorisation has none.

        Returns
        -------
        Solved
            Solutions, error and iterations.
        """
        with bounded(self.threads):
            if isinstance(self.solver, TwoLevelFactor):
                return self.solver.solve(rhs, start=start, tolerance=tolerance)
            return self.solver.solve(rhs)


def available_methods() -> tuple[DirectMethod, ...]:
    """Return the direct solvers of this installation, the fastest first."""
    return ("pardiso", "superlu") if mkl.installed() else ("superlu",)


def factorise(
    K: SymmetricBlockMatrix,
    *,
    level: LinearLevel | None = None,
    right_hand_sides: int = 1,
    method: Method | None = None,
    threads: int | None = None,
    memory_limit: float | None = None,
) -> Factor:
    """Prepare a symmetric positive definite system for solution.

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The system.
    level : LinearLevel or None, optional
        Of linear elements; without it only direct solvers are considered.
    right_hand_sides : int, optional
        That will be solved for: the more, the better a factorisation pays.
    method : Method or None, optional
        By default the one that takes less work, or fits into memory.
    threads : int or None, optional
        Upper bound on the threads of the solver, by default what its libraries choose.
    memory_limit : float or None, optional
        Bytes that the whole process may hold, by default what the system leaves.

    Returns
    -------
    Factor
        Ready to solve.

    Raises
    ------
    CannotRunError
        If no solver fits into memory, the matrix is not positive definite, or the method does not suit the system.
    """
    direct = available_methods()
    if direct[0] == "pardiso":
        try:
            mkl.library()
        except ImportError:  # installed, but it cannot be loaded
            if method == "pardiso":
                raise
            direct = ("superlu",)
    if method is None:
        method, why = _chosen(K, level, right_hand_sides, direct[0], memory_limit)
        if mkl.missing():
            why = reason("without_mkl", why=why)
    else:
        why = reason("chosen_by_user")
        if method == "two-level" and level is None:
            raise CannotRunError("the two-level solver needs quadratic elements; choose a direct solver")
    with bounded(threads):
        if method == "two-level" and level is not None:
            needed = two_level_memory(K, level, right_hand_sides, direct[0])
            memory.require(needed, _task(method, K.size), memory_limit)
            solver: DirectFactor | TwoLevelFactor = _two_levels(K, level, direct[0], memory_limit)
        else:
            solver = _direct(K, "superlu" if method == "superlu" else "pardiso", memory_limit)
    return Factor(name=solver.name, reason=why, threads=threads, solver=solver)


def _two_levels(
    K: SymmetricBlockMatrix, level: LinearLevel, method: DirectMethod, limit: float | None
) -> TwoLevelFactor:
    """Prepare conjugate gradients with the linear elements' factor, or smoothed aggregation where they are many."""

    def factor() -> DirectFactor:
        return _direct(level.stiffness(), method, limit)

    if 3 * level.space.corners < AGGREGATED_FROM:
        return TwoLevelFactor(K, level, factor())
    return TwoLevelFactor(K, level, level.aggregated(lambda coarse: _direct(coarse, method, limit)), factor)


def _direct(K: SymmetricBlockMatrix, method: DirectMethod, limit: float | None) -> DirectFactor:
    if method == "superlu":
        memory.require(direct_memory("superlu", K.size, 1), _task("superlu", K.size), limit)
        return SuperLUFactor(K)
    return PardisoFactor(K, memory_limit=limit)


def _task(method: Method, unknowns: int) -> str:
    return f"the solution of {unknowns:,} unknowns by {_NAMES[method]}"


def direct_memory(method: DirectMethod, unknowns: int, right_hand_sides: int) -> float:
    """Return the memory of a factorisation.

    Parameters
    ----------
    method : DirectMethod
        Solver.
    unknowns : int
        Their number.
    right_hand_sides : int
        Their number.

    Returns
    -------
    float
        Estimate [bytes].
    """
    size = unknowns / 47_000.0
    factor: float = 0.27e9 * size**1.41 if method == "pardiso" else 1.45e9 * size**1.8
    return factor + 24.0 * unknowns * right_hand_sides


def two_level_memory(K: SymmetricBlockMatrix, level: LinearLevel, right_hand_sides: int, direct: DirectMethod) -> float:
    """Return the memory of conjugate gradients with a factorisation of the linear elements.

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The quadratic system.
    level : LinearLevel
        The linear elements below.
    right_hand_sides : int
        Their number.
    direct : DirectMethod
        Solver of the linear elements.

    Returns
    -------
    float
        Estimate [bytes].
    """
    linear = 3 * level.space.corners
    coarse = direct_memory(direct, linear, 1) if linear < AGGREGATED_FROM else AGGREGATED_MEMORY * linear
    copy = 0.0 if direct == "pardiso" else 1.2 * K.blocks.nbytes
    vectors = 8.0 * K.size * (2 * right_hand_sides + 10 * min(right_hand_sides, 8))
    return coarse + copy + 0.15 * K.blocks.nbytes + vectors


def _chosen(
    K: SymmetricBlockMatrix,
    level: LinearLevel | None,
    right_hand_sides: int,
    direct: DirectMethod,
    limit: float | None,
) -> tuple[Method, Reason]:
    """Return the method that takes less work, or fits into memory, and why it is that one."""
    room = memory.room(limit)
    needed = direct_memory(direct, K.size, right_hand_sides)
    size = reason("size_of_system", unknowns=K.size, right_hand_sides=right_hand_sides)
    fits = needed <= room
    if level is None:
        return direct, reason("factorisation_alone_suits", size=size)
    # MKL PARDISO refuses what does not fit by itself, by its own count: the estimate is far too large here.
    if level.slenderness > SLENDER and (fits or direct == "pardiso"):
        return direct, reason("too_slender_for_linear_elements", size=size, slenderness=level.slenderness)
    if level.nu > LOCKING_POISSON_RATIO:
        memory.require(needed, _task(direct, K.size), limit)
        return direct, reason("linear_elements_lock", ratio=level.nu, most=LOCKING_POISSON_RATIO)
    if not fits:
        iterated = two_level_memory(K, level, right_hand_sides, direct)
        if iterated > room:
            least: Method = direct if needed < iterated else "two-level"
            memory.require(min(needed, iterated), _task(least, K.size), limit)
        return "two-level", reason("factor_does_not_fit", size=size, needed=needed / 1e9, left=room / 1e9)
    each, more = WORTH_FACTORISING[direct]
    most = int(each * (right_hand_sides + more))
    if K.size <= most:
        return direct, reason("small_enough_for_factorisation", size=size)
    return "two-level", reason("iteration_takes_less_work", size=size, most=most, solver=_NAMES[direct])
