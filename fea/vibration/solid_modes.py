"""Natural frequencies of one elastic body: quadratic tetrahedra, their consistent mass, rigid regions and conditions.

    K u = ω² M u,   u = T q,   C u = 0

with T from rigid regions (``rigid_regions``) and few conditions C on mean displacements. Bodies may move with the mean
motion B u of a surface, which adds Bᵀ m B to M. The least ω² are found by the Lanczos method on the inverse of K + s M,
whose shift s > 0 makes it positive definite whatever is held (Ericsson & Ruhe, Mathematics of Computation 35 (1980)
1251-1268). The inverse under C u = 0 takes off the displacements by the conditions' own forces, A⁻¹ - W (C W)⁻¹ Wᵀ with
W = A⁻¹ Cᵀ; bodies are added to it by Woodbury's formula.

By Rayleigh's principle each ω of such a mesh is above that of the body that it fills (Strang & Fix, An Analysis of the
Finite Element Method, 1973, section 6.3).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.space import DisplacementSpace
from alula.fea.solvers.solve import factorise
from alula.fea.vibration.rigid_regions import Reduction, RigidRegion, reduced
from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]
TOLERANCE = 1e-8
"""Of the eigenvalues 1/(ω² + s), relative."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CarriedOn:
    """A rigid body that moves as a surface does on average.

    Attributes
    ----------
    motion : ndarray, shape (6, 3 n)
        From displacements of the nodes to the mean displacement and rotation (``alula.fea.solid.bore_motion``).
    inertia : ndarray, shape (6, 6)
        Its mass matrix for these.
    """

    motion: Real
    inertia: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidModes:
    """The lowest modes of a body.

    Attributes
    ----------
    squares : ndarray, shape (k,)
        ω², rising; those of rigid motions come first [1/s²].
    shapes : ndarray, shape (k, n, 3)
        Displacements of the nodes, of unit modal mass.
    in_plane : ndarray, shape (k,)
        Share of the kinetic energy in motion along x and y, and of rigid bodies in rotation about z.
    """

    squares: Real
    shapes: Real
    in_plane: Real


def solid_modes(
    space: DisplacementSpace,
    mass: Any,
    *,
    E: float,
    nu: float,
    density: float,
    count: int,
    regions: Sequence[RigidRegion] = (),
    conditions: Real | None = None,
    bodies: Sequence[CarriedOn] = (),
    threads: int | None = None,
) -> SolidModes:
    """Return the lowest modes of a body.

    Parameters
    ----------
    space : DisplacementSpace
        Of the body.
    mass : csr_array, shape (n, n)
        Mass matrix of one displacement component (``alula.fea.elements.mass``) [tonne].
    E, nu, density : float
        Young's modulus [MPa], Poisson's ratio, and a density that sets the shift [tonne/mm³].
    count : int
        How many modes, with rigid ones.
    regions : sequence of RigidRegion, optional
        Surfaces that move as rigid bodies.
    conditions : ndarray, shape (c, 3 n), optional
        C; by default none.
    bodies : sequence of CarriedOn, optional
        What surfaces carry.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    SolidModes

    Raises
    ------
    CannotRunError
        Where the body has fewer modes, the matrices do not fit into memory, or the iteration does not end.
    """
    from scipy.linalg import block_diag
    from scipy.sparse import kron
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    reduction = reduced(space.nodes, regions)
    T = reduction.matrix
    K = assemble_stiffness(space, E=E, nu=nu)
    memory.require(10.0 * K.blocks.nbytes, f"the natural frequencies of {K.size:,} unknowns", None)
    full = kron(mass, np.eye(3), format="csr")
    M = (T.T @ full @ T + reduction.inertia).tocsr()
    shift = _shift(space, E, density)
    A = _upper((T.T @ K.both_triangles().tocsr() @ T + shift * M).tobsr(blocksize=(3, 3)))
    del K
    A.fix(reduction.held)
    keep = np.ones(T.shape[1])
    keep[reduction.held] = 0.0
    factor = factorise(A, right_hand_sides=100, threads=threads)
    C = np.zeros((0, T.shape[1])) if conditions is None else (T.T @ conditions.T).T * keep
    if count >= int(keep.sum()) - len(C) - 1:
        raise CannotRunError(f"a mesh of {int(keep.sum())} unknowns has no {count} modes; refine the mesh")
    B = np.vstack([np.zeros((0, T.shape[1])), *((T.T @ body.motion.T).T * keep for body in bodies)])
    m = block_diag(*(body.inertia for body in bodies)) if bodies else np.zeros((0, 0))
    V = factor.solve(B.T) if bodies else B.T
    added = np.linalg.solve(np.eye(len(B)) + shift * m @ (B @ V), shift * m)

    def laden(force: Real) -> Real:
        moved = factor.solve(force)
        return np.asarray(moved - V @ (added @ (B @ moved)))

    W = laden(C.T) if len(C) else C.T
    borne = np.linalg.inv(C @ W)

    def inverse(force: Real) -> Real:
        moved = laden(keep * force.ravel())
        return np.asarray(keep * (moved - W @ (borne @ (C @ moved))))

    def inertia(moved: Real) -> Real:
        moved = keep * moved.ravel()
        return np.asarray(keep * (M @ moved) + B.T @ (m @ (B @ moved)))

    size = T.shape[1]
    stand_in = LinearOperator((size, size), matvec=lambda x: x, dtype=np.float64)  # K itself is never applied
    start = np.random.default_rng(0).standard_normal(size)
    try:
        values, q = eigsh(
            stand_in,
            k=count,
            M=LinearOperator((size, size), matvec=inertia, dtype=np.float64),
            sigma=-shift,
            OPinv=LinearOperator((size, size), matvec=inverse, dtype=np.float64),
            v0=inverse(inertia(start)),
            ncv=min(max(2 * count + 8, 24), size - 1),
            tol=TOLERANCE,
        )
    except ArpackNoConvergence as error:
        raise CannotRunError(f"the Lanczos method did not find {count} natural frequencies; refine the mesh") from error
    order = np.argsort(values)
    values, q = values[order], q[:, order]
    q = q / np.sqrt(np.einsum("ik,ik->k", q, np.stack([inertia(v) for v in q.T], axis=1)))
    shapes = (T @ q).T.reshape(count, -1, 3)
    return SolidModes(squares=values, shapes=shapes, in_plane=_in_plane(shapes, q, mass, regions, reduction, bodies))


def _upper(matrix: Any) -> SymmetricBlockMatrix:
    """Return the upper block triangle of a symmetric ``bsr_array``, every row with its diagonal block."""
    matrix.sort_indices()
    rows = np.repeat(np.arange(len(matrix.indptr) - 1), np.diff(matrix.indptr))
    chosen = matrix.indices >= rows
    start = np.concatenate([[0], np.cumsum(np.bincount(rows[chosen], minlength=len(matrix.indptr) - 1))])
    return SymmetricBlockMatrix(
        indptr=start.astype(np.int32),
        indices=matrix.indices[chosen].astype(np.int32),
        blocks=np.ascontiguousarray(matrix.data[chosen]),
    )


def _shift(space: DisplacementSpace, E: float, density: float) -> float:
    """Of the size of a slender body's least ω²: E h²/(ρ L⁴), with its least and its largest extent h and L [1/s²]."""
    extent = np.ptp(space.nodes, axis=0)
    return float(E * extent.min() ** 2 / (density * np.linalg.norm(extent) ** 4))


def _in_plane(
    shapes: Real,
    q: Real,
    mass: Any,
    regions: Sequence[RigidRegion],
    reduction: Reduction,
    bodies: Sequence[CarriedOn],
) -> Real:
    """Share (k,) of the kinetic energy in the plane."""
    parts = np.array([[mode[:, i] @ (mass @ mode[:, i]) for i in range(3)] for mode in shapes])
    plane, total = parts[:, :2].sum(axis=1), parts.sum(axis=1)
    moving = [
        (motion @ q[first : first + 6], region.inertia)
        for region, motion, first in zip(regions, reduction.motions, reduction.first, strict=True)
    ]
    moving += [(body.motion @ shapes.reshape(len(shapes), -1).T, body.inertia) for body in bodies]
    flat = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 1.0])[:, None]
    for moved, inertia in moving:
        total = total + np.einsum("ik,ij,jk->k", moved, inertia, moved)
        plane = plane + np.einsum("ik,ij,jk->k", flat * moved, inertia, flat * moved)
    return np.asarray(plane / total)
