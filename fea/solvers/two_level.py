"""Conjugate gradients with a two-level cycle: linear elements below quadratic ones.

The linear displacements on a mesh are a subspace of the quadratic ones. Their system has about an eighth
of the unknowns and is factorised; what they cannot hold is short-waved and left to Chebyshev smoothing
with the 3×3 diagonal blocks, or those of whole flat elements (Adams, Brezina, Hu and Tuminaro, J. Comput. Phys. 188
(2003) 593-610). How well the two divide the work depends on the shape of the elements and on Poisson's ratio, not on
their number nor on the body's slenderness. Where the linear level is large, smoothed aggregation
(``alula.fea.solvers.cycle``) takes the place of its factor. On curved elements the linear level is that of straight
ones on the same corners, and a mid-node takes what their linear displacement is where it stands: functions that are
linear in the reference element alone would lack rigid rotations, and a tube took 40 iterations in place of 21. The
cycle remains positive definite, since the linear level enters between two equal smoothing steps.

Measured iterations to an energy error of 1e-9, bars cut into cubes of six: 20 at 33,000 and 19 at 160,000 unknowns
(ν = 0.38). Links from the mesher, ν = 0.36 to 0.38, at 30,000 to 107,000 unknowns: 17 to 22. Linear elements lock as ν
nears 0.5, and iterations grow as 1/√(1−2ν): the bar of 33,000 takes 17 at ν = 0, 27 at 0.45, 52 at 0.49, 72 at
0.495. Elements stretched 4 and 10 to 1 take 45 and 124. 34 flat elements of a mesher's made 76 iterations of
24, before they had blocks of their own.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.block_matrix import SymmetricBlockMatrix, Vectors
from alula.fea.elements.elasticity import assemble_stiffness, linear_gradients
from alula.fea.elements.space import EDGES, DisplacementSpace
from alula.fea.elements.supports import rigid_motions
from alula.fea.solvers.cycle import ChebyshevSmoother, SmoothedAggregation, rows
from alula.fea.solvers.direct import DirectFactor
from alula.fea.solvers.solved import ENERGY_LIMIT, REFINEMENTS, Solved, accept, energy_error
from alula.geometry.base.errors import CannotRunError

TOLERANCE = 1e-9
"""Energy norm of the error, by the preconditioner, relative to that of the solution, at which iterations end."""
MOST_ITERATIONS = 400
_SLACK = 10.0  # of the error measured in the end over the one at which iterations end
_BATCH = 8  # columns iterated together: bounds the working memory
_SMOOTHERS = ((2, 10.0), (3, 16.0))
"""Degree, and ratio of the largest to the smallest eigenvalue treated, on straight elements and where some are curved:
a mesher's are worse in shape than a grid's, and take 17 to 22 iterations in place of 20 to 29; a grid's 17 for 19."""
_FLAT = 12.0  # longest edge cubed over volume, over a regular tetrahedron's: a grid's have 3.7, most of a mesher's < 7
_MOST_FLAT = 0.01  # of all elements, the flattest first: their blocks take as much memory as 5 % of the matrix
_PATIENCE = 40  # iterations, after which smoothed aggregation gives way to a factor: that takes as long as some seven


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearLevel:
    """What the system of linear elements is built from.

    Attributes
    ----------
    space : DisplacementSpace
        Of the quadratic displacements.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    fixed : ndarray of int
        Unknowns fixed in the quadratic system.
    """

    space: DisplacementSpace
    E: float
    nu: float
    fixed: NDArray[np.int64]

    @property
    def slenderness(self) -> float:
        """Longest over second-longest extent of the body along the axes."""
        extents = np.sort(np.ptp(self.space.nodes, axis=0))
        return float(extents[2] / extents[1])

    @cached_property
    def flat(self) -> NDArray[np.int64]:
        """Nodes (k, 10) of the flattest elements."""
        corners = self.space.nodes[self.space.cells[:, :4]]
        longest = np.linalg.norm(np.diff(corners[:, np.array(EDGES)], axis=2), axis=(2, 3)).max(axis=1)
        flatness = longest**3 / (np.sqrt(2.0) * np.linalg.det(corners[:, 1:] - corners[:, :1]))
        worst = np.argsort(-flatness)[: int(_MOST_FLAT * len(flatness))]
        return np.asarray(self.space.cells[worst[flatness[worst] > _FLAT]])

    def stiffness(self) -> SymmetricBlockMatrix:
        """Return the stiffness of the linear displacements, with what is fixed of them."""
        K = assemble_stiffness(self.space, E=self.E, nu=self.nu, order=1)
        K.fix(self.coarse_fixed)
        return K

    @property
    def coarse_fixed(self) -> NDArray[np.int64]:
        """Those of the fixed unknowns that belong to corner nodes."""
        return self.fixed[self.fixed < 3 * self.space.corners]

    def aggregated(self, factorise: Callable[[SymmetricBlockMatrix], DirectFactor]) -> SmoothedAggregation:
        """Return a cycle of smoothed aggregation for the system of linear elements.

        Parameters
        ----------
        factorise : callable
            Direct solver of the aggregates' system.

        Returns
        -------
        SmoothedAggregation
            Approximate solver.
        """
        corners = self.space.nodes[: self.space.corners]
        motions = rigid_motions(corners, corners.mean(axis=0))
        return SmoothedAggregation(self.stiffness(), motions, self.coarse_fixed, self.flat[:, :4], factorise)


def linear_level(space: DisplacementSpace, *, E: float, nu: float, fixed: NDArray[np.int64]) -> LinearLevel | None:
    """Return the linear level below a space of quadratic displacements.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    fixed : ndarray of int
        Unknowns fixed in the quadratic system.

    Returns
    -------
    LinearLevel or None
        None below a linear space.
    """
    return LinearLevel(space=space, E=E, nu=nu, fixed=fixed) if space.order == 2 else None


class TwoLevelFactor:
    """A quadratic system prepared for conjugate gradients.

    Parameters
    ----------
    K : SymmetricBlockMatrix
        The quadratic system, with its fixed unknowns.
    level : LinearLevel
        The linear elements below.
    coarse : DirectFactor or SmoothedAggregation
        Their system, prepared for solution.
    spare : callable, optional
        Factorises their system, where iterations with ``coarse`` are many.
    """

    def __init__(
        self,
        K: SymmetricBlockMatrix,
        level: LinearLevel,
        coarse: DirectFactor | SmoothedAggregation,
        spare: Callable[[], DirectFactor] | None = None,
    ) -> None:
        self.name = f"conjugate gradients over linear elements by {coarse.name}"
        self._K = K
        self._coarse, self._spare = coarse, spare
        self._fixed = level.fixed
        self._transfer = _Transfer(level.space)
        self._smoother = ChebyshevSmoother(K, level.flat, *_SMOOTHERS[int(level.space.curved.any())])

    def solve(
        self, rhs: NDArray[np.float64], *, start: NDArray[np.float64] | None = None, tolerance: float = TOLERANCE
    ) -> Solved:
        """Solve the system.

        Parameters
        ----------
        rhs : ndarray, shape (n,) or (n, k)
            Right-hand sides.
        start : ndarray, shape (n,) or (n, k), optional
            First guess of the solutions.
        tolerance : float, optional
            Error in the energy norm, relative to the solution, at which iterations end.

        Returns
        -------
        Solved
            Solutions, error and iterations.

        Raises
        ------
        CannotRunError
            Where the iteration does not converge.
        """
        columns = np.ascontiguousarray(rhs.reshape(self._K.size, -1).T, dtype=np.float64)
        solution = np.zeros_like(columns)
        if start is not None:
            solution[:] = np.broadcast_to(start.reshape(self._K.size, -1).T, columns.shape)
            solution[:, self._fixed] = 0.0
        iterations, error = 0, 0.0
        loaded = columns.any(axis=1)
        solution[~loaded] = 0.0
        numbers = np.flatnonzero(loaded)
        for first in range(0, len(numbers), _BATCH):
            batch = numbers[first : first + _BATCH]
            guess = None if start is None else solution[batch]
            solution[batch], left, count = self._solved(columns[batch], guess, tolerance)
            iterations, error = max(iterations, count), max(error, left)
        return Solved(x=solution.T.reshape(rhs.shape), error=error, iterations=iterations)

    def _solved(self, b: Vectors, start: Vectors | None, tolerance: float) -> tuple[Vectors, float, int]:
        """Iterate, and again on the residual computed anew if rounding has spoilt what the iteration believes."""
        z = self._cycle(b)
        target = tolerance**2 * _dot(b, z)
        if start is None:
            x, iterations = self._conjugate_gradients(b, target, z)
        else:
            # The multiple of the guess with the least energy of the error: none is worse than no guess at all.
            image = self._product(start)
            work = _dot(start, image)
            share = (_dot(start, b) / np.where(work > 0.0, work, np.inf))[:, None]
            x, iterations = self._conjugate_gradients(b - share * image, target)
            x += share * start
        error = np.inf
        for _ in range(REFINEMENTS):
            residual = b - self._product(x)
            previous, error = error, energy_error(residual.T, self._cycle(residual).T, b.T, x.T)
            if not (error > _SLACK * tolerance and error < 0.5 * previous):
                break
            step, count = self._conjugate_gradients(residual, target)
            x += step
            iterations += count
        accept(error, self.name, limit=max(ENERGY_LIMIT, _SLACK * tolerance))
        return x, error, iterations

    def _conjugate_gradients(
        self, b: Vectors, target: NDArray[np.float64], z: Vectors | None = None
    ) -> tuple[Vectors, int]:
        """Iterate until the squared energy of each column's error is below its target; columns that are leave.

        ``z`` is the cycle's answer to b where it is known already.
        """
        x = np.zeros_like(b)
        active = np.arange(len(b))
        r = b.copy()
        z = self._cycle(r) if z is None else z
        rz = _dot(r, z)
        p = z
        for iteration in range(MOST_ITERATIONS):
            going = ~(rz <= target[active])
            if not going.all():
                active, r, p, rz = active[going], r[going], p[going], rz[going]
            if not len(active):
                return x, iteration
            if iteration == _PATIENCE and self._spare is not None:
                with suppress(CannotRunError):  # it may not fit into memory
                    self._coarse = self._spare()
                self._spare = None
                p = self._cycle(r)
                rz = _dot(r, p)
            q = self._product(p)
            curvature = _dot(p, q)
            if not (curvature > 0.0).all():
                break
            alpha = (rz / curvature)[:, None]
            x[active] += alpha * p
            r -= alpha * q
            z = self._cycle(r)
            rz, previous = _dot(r, z), rz
            p *= (rz / previous)[:, None]
            p += z
        raise CannotRunError(
            f"{self.name} did not converge in {iteration + 1} iterations: the elements are too distorted or Poisson's "
            "ratio is too close to 0.5 for it; improve the mesh or choose a direct solver"
        )

    def _product(self, x: Vectors) -> Vectors:
        return rows(self._K.product, x)

    def _cycle(self, r: Vectors) -> Vectors:
        """Smooth, correct by the linear elements, smooth: an approximate solution, symmetric in r."""
        return self._smoother.cycle(r, self._correction)

    def _correction(self, rest: Vectors) -> Vectors:
        coarse = self._transfer.restricted(self._without_fixed(rest))
        coarse[:, self._fixed[self._fixed < coarse.shape[1]]] = 0.0
        return self._without_fixed(self._transfer.prolonged(self._coarse.apply(coarse.T).T))

    def _without_fixed(self, x: Vectors) -> Vectors:
        x = x.copy()
        x[:, self._fixed] = 0.0
        return x


class _Transfer:
    """Linear displacements at the nodes of the quadratic ones.

    Those of an element are linear in position. A mid-node that stands beside the middle of its edge has the mean of
    what the elements at that edge say: so rigid motions and constant strains reach curved elements unchanged.
    """

    def __init__(self, space: DisplacementSpace) -> None:
        from scipy.sparse import coo_array, csr_array

        nodes, corners = len(space.nodes), space.corners
        ends = np.empty((nodes - corners, 2), dtype=np.int64)
        for local, edge in enumerate(EDGES):
            ends[space.cells[:, 4 + local] - corners] = space.cells[:, edge]
        columns = np.concatenate([np.arange(corners), ends.ravel()])
        values = np.concatenate([np.ones(corners), np.full(2 * len(ends), 0.5)])
        indptr = np.concatenate([np.arange(corners), corners + 2 * np.arange(len(ends) + 1)])
        straight = csr_array((values, columns, indptr), shape=(nodes, corners))
        middle, cells = space.cells[:, 4:], space.cells[space.curved]
        slopes = linear_gradients(space.nodes[cells[:, :4]])
        beside = space.nodes[cells[:, 4:]] - space.nodes[cells[:, np.array(EDGES)]].mean(axis=2)
        share = (beside @ slopes) / np.bincount(middle.ravel(), minlength=nodes)[cells[:, 4:], None]
        row, column = np.broadcast_arrays(cells[:, 4:, None], cells[:, None, :4])
        bows = coo_array((share.ravel(), (row.ravel(), column.ravel())), shape=(nodes, corners)).tocsr()
        self._upward = (straight + bows).tocsr()
        self._downward = self._upward.T.tocsr()

    def prolonged(self, x: Vectors) -> Vectors:
        """Return the values (k, 3 nodes) at all nodes of values (k, 3 corners)."""
        return np.array([(self._upward @ row.reshape(-1, 3)).ravel() for row in x])

    def restricted(self, r: Vectors) -> Vectors:
        """Return the transpose of ``prolonged``."""
        return np.array([(self._downward @ row.reshape(-1, 3)).ravel() for row in r])


def _dot(a: Vectors, b: Vectors) -> NDArray[np.float64]:
    return np.array([u @ v for u, v in zip(a, b, strict=True)])
