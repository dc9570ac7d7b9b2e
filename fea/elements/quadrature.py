"""Integration over the elements and the boundary faces of a link, curved ones included."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.elasticity import jacobians, reference_basis
from alula.fea.elements.space import DisplacementSpace


@dataclass(frozen=True, kw_only=True, eq=False)
class Quadrature:
    """Integration points on k elements or faces with q points each and b basis functions.

    Attributes
    ----------
    nodes : ndarray of int, shape (k, b)
        Node numbers.
    phi : ndarray, shape (q, b)
        Basis functions at the points.
    x : ndarray, shape (k, q, 3)
        Positions of the points [mm].
    w : ndarray, shape (k, q)
        Weights: mm³ in elements, mm² on faces.
    """

    nodes: NDArray[np.int64]
    phi: NDArray[np.float64]
    x: NDArray[np.float64]
    w: NDArray[np.float64]

    @property
    def measure(self) -> float:
        """Volume [mm³] or area [mm²]."""
        return float(self.w.sum())

    @property
    def centroid(self) -> NDArray[np.float64]:
        """Centroid (3,) of the volume or area [mm]."""
        return np.asarray(np.einsum("kq,kqi->i", self.w, self.x) / self.w.sum())

    def only(self, elements: NDArray[np.bool_]) -> "Quadrature":
        """Return the points of some elements.

        Parameters
        ----------
        elements : ndarray of bool, shape (k,)
            Which.

        Returns
        -------
        Quadrature
        """
        return Quadrature(nodes=self.nodes[elements], phi=self.phi, x=self.x[elements], w=self.w[elements])

    def load_vector(self, density: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        """Return the consistent load vector of a force density.

        Parameters
        ----------
        density : ndarray, shape (k, q, 3)
            Force per volume or area [N/mm³, MPa].
        count : int
            Number of nodes.

        Returns
        -------
        ndarray, shape (3 count,)
            Nodal forces [N].
        """
        local = np.einsum("kq,qb,kqi->kbi", self.w, self.phi, density, optimize=True)
        node = self.nodes.ravel()
        columns = [np.bincount(node, local[..., i].ravel(), minlength=count) for i in range(3)]
        return np.asarray(np.column_stack(columns).ravel(), dtype=np.float64)

    def wrench(self, density: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the resultant of a force density.

        Parameters
        ----------
        density : ndarray, shape (k, q, 3)
            Force per volume or area [N/mm³, MPa].
        point : ndarray, shape (3,)
            About which the moment is taken [mm].

        Returns
        -------
        ndarray, shape (6,)
            Force [N] and moment [N mm].
        """
        weighted = (self.w[..., None] * density).reshape(-1, 3)
        product = (self.x.reshape(-1, 3) - point).T @ weighted  # ∫ r_i f_j
        turning = product - product.T
        return np.array([*weighted.sum(axis=0), turning[1, 2], turning[2, 0], turning[0, 1]])

    def mean(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the mean of a nodal field over the volume or area.

        Parameters
        ----------
        field : ndarray, shape (n, 3)
            At the nodes.

        Returns
        -------
        ndarray, shape (3,)
            Mean.
        """
        return np.asarray(np.einsum("kq,qb,kbi->i", self.w, self.phi, field[self.nodes]) / self.w.sum())


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceQuadrature(Quadrature):
    """Integration points on boundary faces.

    Attributes
    ----------
    normals : ndarray, shape (k, q, 3)
        Outward unit normals.
    """

    normals: NDArray[np.float64]


def surface_quadrature(space: DisplacementSpace, *names: str, degree: int = 8) -> SurfaceQuadrature:
    """Prepare integration over named surfaces.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    degree : int, optional
        Of the rule; 8 because a pin pressure has kinks in its angle.
    *names : str
        Of surfaces, taken together.

    Returns
    -------
    SurfaceQuadrature
        Points of all faces.
    """
    return face_quadrature(space, space.faces(*names), degree=degree)


def face_quadrature(space: DisplacementSpace, faces: NDArray[np.int64], *, degree: int) -> SurfaceQuadrature:
    """Prepare integration over boundary faces.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    faces : ndarray of int, shape (k, 3) or (k, 6)
        Nodes, seen from outside.
    degree : int
        Of the rule.

    Returns
    -------
    SurfaceQuadrature
        Points of the faces.
    """
    from skfem.element import ElementTriP1, ElementTriP2
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    X, W = get_quadrature(RefTri, degree)
    element = ElementTriP1() if space.order == 1 else ElementTriP2()
    basis = [element.lbasis(X, i) for i in range(faces.shape[1])]
    phi = np.array([b[0] for b in basis]).T
    gradient = np.array([np.broadcast_to(b[1], X.shape) for b in basis])
    corners = space.nodes[faces]
    tangents = np.einsum("kbi,bdq->kqdi", corners, gradient, optimize=True)
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    area = np.linalg.norm(normals, axis=2)
    return SurfaceQuadrature(
        nodes=faces,
        phi=phi,
        x=np.einsum("qb,kbi->kqi", phi, corners),
        w=area * W,
        normals=normals / area[:, :, None],
    )


def volume_quadrature(space: DisplacementSpace, *, degree: int = 5) -> Quadrature:
    """Prepare integration over all elements.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    degree : int, optional
        Of the rule; 5 (14 points, weights positive) is exact for the mass of a straight element.

    Returns
    -------
    Quadrature
        Points of the elements.
    """
    _, W, phi, gradient = reference_basis(space, degree)
    nodes = space.nodes[space.cells]
    _, determinant = jacobians(nodes, gradient)
    return Quadrature(
        nodes=space.cells, phi=phi, x=np.einsum("qb,kbi->kqi", phi, nodes, optimize=True), w=determinant * W
    )
