"""A meshed body of a plastic material: internal forces and tangent stiffness from the points of its elements.

Four points in each quadratic tetrahedron, as in CalculiX's C3D10. Plastic flow keeps the volume at each of them, which
leaves such elements hardly any freedom: limit loads come out too high on coarse meshes, and fall with the mesh size (a
deeply notched tie, 5, 2 and 0 % too high at 3, 6 and 10 elements across its ligament; a thick cylinder 0.1 %). The
change of volume taken as its mean over each element halves that, but lets single elements at loaded rims flow by
themselves: an eye under the shear of its drive torque bore 1.34, 1.03, 1.26 and 1.19 times its load on ever finer
meshes, which no series tells from a limit.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.elasticity import add_blocks, block_pattern, jacobians, reference_basis
from alula.fea.elements.space import DisplacementSpace
from alula.fea.plastic.yield_law import Past, PointResponse, YieldLaw

Real = NDArray[np.float64]

DEGREE = 2
"""Of the integration rule: four points."""
_CHUNK = 1024  # elements at a time: their matrices take some 20 MB


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticBody:
    """A body on a mesh, of one material.

    Attributes
    ----------
    space : DisplacementSpace
    law : YieldLaw
    gradients : ndarray, shape (k, q, 3, b)
        Of the basis at the points [1/mm].
    weights : ndarray, shape (k, q)
        Of the points [mm³].
    """

    space: DisplacementSpace
    law: YieldLaw
    gradients: Real
    weights: Real
    _place: Any
    _target: NDArray[np.intp]
    _below: NDArray[np.bool_]

    @classmethod
    def of(cls, space: DisplacementSpace, law: YieldLaw) -> "PlasticBody":
        """Lay out a body.

        Parameters
        ----------
        space : DisplacementSpace
            Of quadratic elements.
        law : YieldLaw

        Returns
        -------
        PlasticBody
        """
        _, W, _, gradient = reference_basis(space, DEGREE)
        inverse, determinant = jacobians(space.nodes[space.cells], gradient)
        place = block_pattern(space.cells, len(space.nodes))
        first, second = np.triu_indices(space.cells.shape[1])
        row, column = space.cells[:, first], space.cells[:, second]
        target = place[np.minimum(row, column).ravel(), np.maximum(row, column).ravel()].astype(np.intp)
        return cls(
            space=space,
            law=law,
            gradients=inverse @ gradient.transpose(0, 2, 1),
            weights=determinant * W,
            _place=place,
            _target=target.reshape(row.shape),
            _below=row > column,
        )

    @property
    def points(self) -> int:
        """Number of integration points."""
        return int(self.weights.size)

    def strain(self, u: Real) -> Real:
        """Return the strain at the points.

        Parameters
        ----------
        u : ndarray, shape (3n,)
            Displacements [mm].

        Returns
        -------
        ndarray, shape (k q, 6)
            Shears are the engineer's.
        """
        slope = self.gradients @ u.reshape(-1, 3)[self.space.cells][:, None]  # (k, q, i, j) = ∂u_j/∂x_i
        found = np.empty((*slope.shape[:2], 6))
        for i in range(3):
            found[..., i] = slope[..., i, i]
        for place, (i, j) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
            found[..., place] = slope[..., i, j] + slope[..., j, i]
        return found.reshape(-1, 6)

    def respond(self, u: Real, past: Past, *, tangent: bool = True) -> PointResponse:
        """Return what displacements make of the points.

        Parameters
        ----------
        u : ndarray, shape (3n,)
            Displacements [mm].
        past : Past
        tangent : bool, optional
            Whether the tangent is wanted.

        Returns
        -------
        PointResponse
        """
        return self.law.respond(self.strain(u), past, tangent=tangent)

    def _matrices(self, part: slice) -> Real:
        """Return the strain of each unknown (k, q, 6, 3b) of some elements."""
        G = self.gradients[part]
        k, q, _, b = G.shape
        each = np.zeros((k, q, 6, b, 3))
        for i in range(3):
            each[:, :, i, :, i] = G[:, :, i]
        for place, (i, j) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
            each[:, :, place, :, i], each[:, :, place, :, j] = G[:, :, j], G[:, :, i]
        B: Real = each.reshape(k, q, 6, 3 * b)
        return B

    def forces(self, stress: Real) -> Real:
        """Return the internal forces.

        Parameters
        ----------
        stress : ndarray, shape (k q, 6)
            [MPa]

        Returns
        -------
        ndarray, shape (3n,)
            [N]
        """
        k, q = self.weights.shape
        s = stress.reshape(k, q, 6)
        tensor = s[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]] * self.weights[..., None, None]
        local = np.einsum("kqib,kqij->kbj", self.gradients, tensor, optimize=True)
        node, count = self.space.cells.ravel(), len(self.space.nodes)
        columns = [np.bincount(node, local[..., j].ravel(), minlength=count) for j in range(3)]
        return np.asarray(np.column_stack(columns).ravel(), dtype=np.float64)

    def stiffness(self, tangent: Real) -> SymmetricBlockMatrix:
        """Return the tangent stiffness.

        Parameters
        ----------
        tangent : ndarray, shape (k q, 6, 6)
            Symmetric [MPa].

        Returns
        -------
        SymmetricBlockMatrix
            [N/mm]
        """
        k, q = self.weights.shape
        C = tangent.reshape(k, q, 6, 6)
        blocks = np.zeros((self._place.nnz, 3, 3))
        first, second = np.triu_indices(self.space.cells.shape[1])
        for part in (slice(i, i + _CHUNK) for i in range(0, k, _CHUNK)):
            B = self._matrices(part)
            CB = (C[part] * self.weights[part][..., None, None]) @ B
            n, width = len(B), B.shape[3]
            K = B.reshape(n, 6 * q, width).transpose(0, 2, 1) @ CB.reshape(n, 6 * q, width)
            values = K.reshape(n, width // 3, 3, width // 3, 3)[:, first, :, second].swapaxes(0, 1)
            below = self._below[part]
            values[below] = values[below].swapaxes(1, 2)
            add_blocks(blocks, self._target[part].ravel(), np.ascontiguousarray(values))
        return SymmetricBlockMatrix(indptr=self._place.indptr, indices=self._place.indices, blocks=blocks)
