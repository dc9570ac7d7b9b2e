"""Isotropic linear elasticity: the constitutive law and the stiffness matrix of a link."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.space import DisplacementSpace
from alula.geometry.base.errors import CannotRunError

CURVED_DEGREE = 5  # 14 points with positive weights
_LINEAR = np.array([[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])  # gradients
_CHUNK = 1024  # elements at a time: some 10 MB of working memory, which caches hold in part
_GROUP = 16 * _CHUNK  # elements whose blocks are looked up at once: scipy reads the whole pattern each time


def lame_constants(E: float, nu: float) -> tuple[float, float]:
    """Return Lamé's constants: λ = Eν/((1+ν)(1−2ν)), μ = E/(2(1+ν)) (Timoshenko-Goodier, 3rd ed., art. 6).

    Parameters
    ----------
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    tuple of 2 float
        Λ and μ [MPa].
    """
    return E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))


def reference_basis(
    space: DisplacementSpace, degree: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the integration points of scikit-fem's rule on the unit tetrahedron, with the basis there.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    degree : int
        Of the polynomials that the rule integrates exactly.

    Returns
    -------
    tuple of 4 ndarray
        Points (3, q), weights (q,), basis functions (q, b) and their gradients (q, b, 3).
    """
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTet

    X, W = get_quadrature(RefTet, degree)
    return X, W, *basis_at(space, X)


def basis_at(space: DisplacementSpace, X: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the basis functions and their gradients at points of the unit tetrahedron.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    X : ndarray, shape (3, q)
        Points of the unit tetrahedron.

    Returns
    -------
    tuple of 2 ndarray
        Basis functions (q, b) and their gradients (q, b, 3).
    """
    basis = [space.element.lbasis(X, i) for i in range(space.cells.shape[1])]
    phi = np.array([b[0] for b in basis]).T
    gradient = np.array([np.broadcast_to(b[1].reshape(3, -1), X.shape) for b in basis]).transpose(2, 0, 1)
    return np.ascontiguousarray(phi), np.ascontiguousarray(gradient)


def jacobians(
    nodes: NDArray[np.float64], gradient: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the inverse Jacobians and determinants of elements.

    Parameters
    ----------
    nodes : ndarray, shape (k, b, 3)
        Of each element [mm].
    gradient : ndarray, shape (q, b, 3)
        Of the basis at the integration points.

    Returns
    -------
    tuple of 2 ndarray
        Inverses (k, q, 3, 3), ∂X_j/∂x_i at [i, j], and determinants (k, q).

    Raises
    ------
    CannotRunError
        Where a determinant is not positive: such an element is folded over.
    """
    k, b, _ = nodes.shape
    q = len(gradient)
    # J[k, q, j, i] = ∂x_i/∂X_j
    J = (gradient.transpose(0, 2, 1).reshape(3 * q, b) @ nodes).reshape(k, q, 3, 3)
    cofactor = np.empty_like(J)  # cofactor[i, j] J[j, i'] = det δ
    for j in range(3):
        cofactor[..., :, j] = np.cross(J[..., (j + 1) % 3, :], J[..., (j + 2) % 3, :])
    determinant = np.einsum("kqi,kqi->kq", J[..., 0, :], cofactor[..., :, 0])
    if not (determinant > 0.0).all():
        bad = np.count_nonzero((determinant <= 0.0).any(axis=1))
        raise CannotRunError(f"{bad} elements of the mesh are folded over (Jacobian not positive); refine the mesh")
    cofactor /= determinant[..., None, None]
    return cofactor, determinant


def linear_gradients(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the gradients of the linear functions of straight-sided elements.

    Parameters
    ----------
    corners : ndarray, shape (k, 4, 3)
        Of each element [mm].

    Returns
    -------
    ndarray, shape (k, 3, 4)
        ∂N_a/∂x_i at [i, a] [1/mm].
    """
    inverse, _ = jacobians(corners, _LINEAR[None])
    return np.asarray(inverse[:, 0] @ _LINEAR.T)


def assemble_stiffness(
    space: DisplacementSpace,
    *,
    E: float,
    nu: float,
    order: int | None = None,
    memory_limit: float | None = None,
) -> SymmetricBlockMatrix:
    """Assemble the stiffness matrix of an isotropic body.

    Equal to scikit-fem's ``linear_elasticity`` form on the same basis. Straight-sided elements: the reference tensor ∫
    ∂φa/∂Xk ∂φb/∂Xl dX contracted with the inverse Jacobian, exact. Curved ones: products of the gradients' matrices at
    the points of the rule of degree ``CURVED_DEGREE``. Elements are taken in chunks, so the working memory does not
    grow with the mesh.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    order : int or None, optional
        1 for linear displacements on the corner nodes of a quadratic space, on straight-sided elements; by default the
        order of the space.
    memory_limit : float or None, optional
        Bytes that the whole process may hold, by default what the system leaves.

    Returns
    -------
    SymmetricBlockMatrix
        The matrix [N/mm].

    Raises
    ------
    CannotRunError
        For a material that is not stable, a folded element, or a matrix that does not fit into memory.
    """
    if not (E > 0.0 and 0.0 <= nu < 0.5):
        raise CannotRunError(f"E = {E} MPa with ν = {nu} is no stable compressible material (E > 0, 0 ≤ ν < 0.5)")
    order = space.order if order is None else order
    cells, count = (space.cells[:, :4], space.corners) if order == 1 else (space.cells, len(space.nodes))
    place = block_pattern(cells, count)
    memory.require(72.0 * place.nnz, f"the stiffness matrix of {3 * count:,} unknowns", memory_limit)
    blocks = np.zeros((place.nnz, 3, 3))
    first, second = np.triu_indices(cells.shape[1])
    curved = space.curved & (order == 2)
    straight = _StraightElements(space, order, E, nu), np.flatnonzero(~curved)
    for kernel, members in (straight, (_CurvedElements(space, E, nu), np.flatnonzero(curved))):
        for group in (members[i : i + _GROUP] for i in range(0, len(members), _GROUP)):
            row, column = cells[group][:, first], cells[group][:, second]
            mirror = row > column
            target = place[np.minimum(row, column).ravel(), np.maximum(row, column).ravel()].astype(np.intp)
            target = target.reshape(row.shape)
            for part in (slice(i, i + _CHUNK) for i in range(0, len(group), _CHUNK)):
                values = np.ascontiguousarray(kernel(space.nodes[space.cells[group[part]]]).transpose(0, 3, 1, 2))
                # The block of a pair whose nodes stand in descending order belongs below the diagonal.
                below = mirror[part]
                values[below] = values[below].swapaxes(1, 2)
                add_blocks(blocks, target[part].ravel(), values)
    return SymmetricBlockMatrix(indptr=place.indptr, indices=place.indices, blocks=blocks)


def add_blocks(blocks: NDArray[np.float64], where: NDArray[np.intp], values: NDArray[np.float64]) -> None:
    """Add values to the blocks whose numbers are given, which may repeat.

    Entry by entry, since numpy is fast on flat arrays alone: by blocks it takes twice the time.

    Parameters
    ----------
    blocks : ndarray, shape (b, 3, 3)
        That are changed.
    where : ndarray of int, shape (k,)
        Numbers of blocks.
    values : ndarray, shape (..., 3, 3)
        k of them.
    """
    np.add.at(blocks.reshape(-1), (9 * where[:, None] + np.arange(9)).ravel(), values.ravel())


def block_pattern(cells: NDArray[np.int64], count: int) -> Any:
    """Return the upper triangle of the pairs of nodes that share an element, as a ``csr_array`` of the blocks' numbers.

    A boolean product of incidence matrices: no list of all pairs of all elements has to be stored and sorted.

    Parameters
    ----------
    cells : ndarray of int, shape (m, b)
        Nodes of each element.
    count : int
        Number of nodes n.

    Returns
    -------
    csr_array, shape (n, n)
        Its entry is the number of the block.
    """
    from scipy.sparse import csr_array, triu

    elements, local = cells.shape
    start = np.arange(0, elements * local + 1, local, dtype=np.int32)
    node = cells.astype(np.int32).ravel()
    incidence = csr_array((np.ones(len(node), dtype=np.bool_), node, start), shape=(elements, count))
    pairs = triu(incidence.T.tocsr() @ incidence, format="csr")
    pairs.sort_indices()
    return csr_array((np.arange(pairs.nnz, dtype=np.int32), pairs.indices, pairs.indptr), shape=pairs.shape)


class _StraightElements:
    """Stiffness blocks (k, 3, 3, pairs) of straight-sided elements."""

    def __init__(self, space: DisplacementSpace, order: int, E: float, nu: float) -> None:
        _, W, _, gradient = reference_basis(space, 2)
        if order < space.order:
            gradient = np.broadcast_to(_LINEAR, (len(W), *_LINEAR.shape))
        first, second = np.triu_indices(gradient.shape[1])
        reference = np.einsum("q,qpk,qpl->klp", W, gradient[:, first], gradient[:, second])
        self.reference = np.ascontiguousarray(reference.reshape(9, -1))
        self.lame = lame_constants(E, nu)

    def __call__(self, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
        inverse, determinant = jacobians(nodes[:, :4], _LINEAR[None])
        G = inverse[:, 0]
        outer = np.einsum("k,kip,kjq->kijpq", determinant[:, 0], G, G)
        S = _law(outer.reshape(-1, 3, 3, 9), *self.lame)
        return np.asarray((S.reshape(-1, 9) @ self.reference).reshape(len(nodes), 3, 3, -1))


class _CurvedElements:
    """Stiffness blocks (k, 3, 3, pairs) of curved elements."""

    def __init__(self, space: DisplacementSpace, E: float, nu: float) -> None:
        _, self.W, _, self.geometry = reference_basis(space, CURVED_DEGREE)
        self.gradient = np.ascontiguousarray(self.geometry.transpose(0, 2, 1))
        b = self.geometry.shape[1]
        first, second = np.triu_indices(b)
        i, j = np.arange(3)[:, None, None], np.arange(3)[:, None]
        self.place = (3 * b * (b * i + first) + b * j + second).ravel()  # in a matrix (3b, 3b)
        self.lame = lame_constants(E, nu)

    def __call__(self, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
        k, b = len(nodes), self.gradient.shape[2]
        inverse, determinant = jacobians(nodes, self.geometry)
        # G[k, q, i, a] = ∂φa/∂x_i, weighted by the root of the integration weight
        G = inverse @ self.gradient
        G *= np.sqrt(determinant * self.W)[:, :, None, None]
        G = G.reshape(k, len(self.W), 3 * b)
        M = np.take((G.transpose(0, 2, 1) @ G).reshape(k, -1), self.place, axis=1)
        return _law(M.reshape(k, 3, 3, -1), *self.lame)


def _law(M: NDArray[np.float64], lam: float, mu: float) -> NDArray[np.float64]:
    """Stiffness λ M_ij + μ M_ji + μ δ_ij M_ll of products M (k, 3, 3, ...) of gradients; M is overwritten."""
    K = lam * M
    M *= mu
    K += M.swapaxes(1, 2)
    laplace = M[:, 0, 0] + M[:, 1, 1] + M[:, 2, 2]
    for i in range(3):
        K[:, i, i] += laplace
    return K
