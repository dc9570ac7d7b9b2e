"""Stress of a link: recovered at the nodes, at the integration points, and over cross-sections.

Recovery. Stresses at the four integration points of a quadratic element (the points of CalculiX's
C3D10) are carried by the linear function through them to its nodes and averaged over the elements
that share a node (Zienkiewicz-Taylor-Zhu, The Finite Element Method, 6th ed., vol. 1, ch. 13: stresses
of quadratic elements are most accurate near these points). Linear elements have one stress each.
Measured as the error of the peak von Mises stress, on a thick cylinder under pressure at 4,320 and
29,376 unknowns and on a hole in tension at 3,744 and 24,000:

    this recovery                               3.9 and 1.3 %,  4.2 and 2.5 %
    derivatives at the nodes, averaged          3.8 and 1.0 %, 11.5 and 4.8 %
    least squares over the whole body           1.7 and 0.8 %,  4.2 and 2.3 %

The last costs a linear system for every field. Linear fits over patches of elements, which are
one-sided at a bore, fell short of the hole's peak by 9 to 28 % on its coarse meshes.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.elasticity import jacobians, lame_constants, reference_basis
from alula.fea.elements.quadrature import SurfaceQuadrature, face_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.geometry.base.errors import CannotRunError

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
_CHUNK = 8192
_NODES = np.array(
    [
        [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5],
    ]
).T  # fmt: skip


def von_mises(sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the von Mises stress (Shigley, 10th ed., chapter 5).

    Parameters
    ----------
    sigma : ndarray, shape (..., 6)
        Components in the order of ``COMPONENTS`` [MPa].

    Returns
    -------
    ndarray, shape (...)
        Stress [MPa].
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(sigma, -1, 0)
    direct = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(0.5 * direct + 3.0 * (xy**2 + yz**2 + xz**2)))


def principal(sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the principal stresses.

    Parameters
    ----------
    sigma : ndarray, shape (..., 6)
        Components [MPa].

    Returns
    -------
    ndarray, shape (..., 3)
        Signed, the largest first [MPa].
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(sigma, -1, 0)
    tensor = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=-1).reshape(*sigma.shape[:-1], 3, 3)
    return np.asarray(np.linalg.eigvalsh(tensor)[..., ::-1])


def extreme_principal(sigma: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the largest and smallest principal stress, by the closed form.

    σ1 = m + 2 √(J2/3) cos θ and σ3 = m + 2 √(J2/3) cos(θ + 2π/3) with cos 3θ = (3√3/2) J3 / J2^(3/2), m the mean stress
    and J2, J3 of the deviator (Malvern, Introduction to the Mechanics of a Continuous Medium, section 3.3). To about
    1e-8 of the von Mises stress, ten times as fast as the eigenvalues of ``principal``.

    Parameters
    ----------
    sigma : ndarray, shape (..., 6)
        Components [MPa].

    Returns
    -------
    tuple of 2 ndarray
        The largest and the smallest (...), signed [MPa].
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(sigma, -1, 0)
    mean = (xx + yy + zz) / 3.0
    x, y, z = xx - mean, yy - mean, zz - mean
    third = ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) / 18.0 + (xy**2 + yz**2 + xz**2) / 3.0  # J2/3
    J3 = x * (y * z - yz**2) - xy * (xy * z - yz * xz) + xz * (xy * yz - y * xz)
    radius = np.sqrt(third)
    cube = np.where(third > 0.0, 2.0 * radius * third, 1.0)
    angle = np.arccos(np.clip(J3 / cube, -1.0, 1.0)) / 3.0
    return mean + 2.0 * radius * np.cos(angle), mean + 2.0 * radius * np.cos(angle + 2.0 * np.pi / 3.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Peak:
    """The largest von Mises stress and where it occurs.

    Attributes
    ----------
    value : float
        Stress [MPa].
    location : ndarray, shape (3,)
        In the link's frame [mm].
    """

    value: float
    location: NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearisedStress:
    """Stress along x over one cross-section, as a beam has it [MPa].

    Attributes
    ----------
    x : float
        Of the section [mm].
    axial : float
        Mean, N/A.
    bending_y : float
        At the extreme fibre z = +half_z, of bending about y (out of the linkage's plane).
    bending_z : float
        At the extreme fibre y = +half_y, of bending about z (in the linkage's plane).
    scatter : float
        Root mean square of what is not linear over the section, relative to the largest fibre stress.
    """

    x: float
    axial: float
    bending_y: float
    bending_z: float
    scatter: float


@dataclass(frozen=True, kw_only=True, eq=False)
class StressField:
    """Stress of one displacement field; components in the order of ``COMPONENTS`` [MPa].

    Attributes
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    nodal : ndarray, shape (n, 6)
        Recovered at the nodes.
    at_points : ndarray, shape (m, q, 6)
        At the integration points of the elements (4, or 1 in linear ones).
    points : ndarray, shape (m, q, 3)
        Integration points [mm].
    weights : ndarray, shape (m, q)
        Their volumes [mm³].
    """

    space: DisplacementSpace
    nodal: NDArray[np.float64]
    at_points: NDArray[np.float64]
    points: NDArray[np.float64]
    weights: NDArray[np.float64]

    @cached_property
    def von_mises(self) -> NDArray[np.float64]:
        """Von Mises stress (n,) at the nodes, of the recovered components."""
        return von_mises(self.nodal)

    @cached_property
    def principal(self) -> NDArray[np.float64]:
        """Principal stresses (n, 3) at the nodes, signed, the largest first."""
        return principal(self.nodal)

    def decisive(self, *, brittle: bool) -> NDArray[np.float64]:
        """Return the stress at the nodes that a strength is set against.

        Parameters
        ----------
        brittle : bool
            True where the principal stress decides, False where von Mises does.

        Returns
        -------
        ndarray, shape (n,)
            Stress [MPa].
        """
        return extreme_principal(self.nodal)[0] if brittle else self.von_mises

    @property
    def peak(self) -> Peak:
        """Largest von Mises stress of all nodes; no node is left out."""
        node = int(np.argmax(self.von_mises))
        return Peak(value=float(self.von_mises[node]), location=self.space.nodes[node].copy())

    @property
    def peak_at_points(self) -> Peak:
        """Largest von Mises stress of all integration points."""
        values = von_mises(self.at_points)
        element, point = np.unravel_index(int(np.argmax(values)), values.shape)
        return Peak(value=float(values[element, point]), location=self.points[element, point].copy())

    def section(self, *, x: float, half_length: float, half_y: float, half_z: float) -> LinearisedStress:
        """Fit a beam's stress to the recovered σxx on the outer surface of a slab.

        The fit σxx = (a + b y + c z) + (x' − x)(a' + b' y + c' z) by least squares over that surface is independent of
        the equilibrium of the section, which any solution satisfies on average.

        Parameters
        ----------
        x : float
            Of the section [mm].
        half_length : float
            Of the slab about it [mm].
        half_y : float
            Distance of the extreme fibre from the axis along y [mm].
        half_z : float
            The same along z [mm].

        Returns
        -------
        SectionStress
            The beam's stress, and what of the field is not linear.

        Raises
        ------
        CannotRunError
            Where the slab holds too few faces.
        """
        face = self._outer
        where = np.abs(face.x[..., 0] - x) <= half_length
        along, y, z = (face.x[where] - (x, 0.0, 0.0)).T
        columns = np.column_stack([np.ones_like(y), y, z, along, along * y, along * z])
        scale = np.array([1.0, half_y, half_z, half_length, half_length * half_y, half_length * half_z])
        root = np.sqrt(face.w[where])[:, None]
        values = np.einsum("qb,kb->kq", face.phi, self.nodal[face.nodes, 0])[where]
        if len(y) < 6 or np.linalg.matrix_rank(root * columns / scale, tol=1e-6 * np.linalg.norm(root)) < 6:
            raise CannotRunError(f"the mesh is too coarse for a section of {2.0 * half_length:g} mm at x = {x:g} mm")
        fitted, *_ = np.linalg.lstsq(root * columns / scale, root[:, 0] * values, rcond=None)
        rest = values - columns @ (fitted / scale)
        rms = np.sqrt((face.w[where] * rest**2).sum() / face.w[where].sum())
        largest = abs(fitted[0]) + max(abs(fitted[1]), abs(fitted[2]))
        return LinearisedStress(
            x=x,
            axial=float(fitted[0]),
            bending_y=float(fitted[2]),
            bending_z=float(fitted[1]),
            scatter=float(rms / largest) if largest > 0.0 else 0.0,
        )

    @cached_property
    def _outer(self) -> SurfaceQuadrature:
        """Boundary faces that look away from the axis y = z = 0 and not along it: no bore, no end."""
        space = self.space
        corners = space.nodes[space.boundary[:, :3]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        radial = corners.mean(axis=1) * (0.0, 1.0, 1.0)
        away = np.einsum("ki,ki->k", normal, radial) > 0.0
        lateral = np.abs(normal[:, 0]) < 0.5 * np.linalg.norm(normal, axis=1)
        return face_quadrature(space, space.boundary[away & lateral], degree=2)


def stress_field(space: DisplacementSpace, displacement: NDArray[np.float64], *, E: float, nu: float) -> StressField:
    """Recover the stress of nodal displacements.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    displacement : ndarray, shape (n, 3)
        At the nodes [mm].
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    StressField
        At the nodes and at the integration points.
    """
    X, W, phi, _ = reference_basis(space, space.order)
    shape = (len(space.cells), len(W))
    at_points, weights = np.empty((*shape, 6)), np.empty(shape)
    every = np.arange(len(space.cells))
    for part, sigma, volume in element_stress(space, displacement, space.order, every, E=E, nu=nu):
        at_points[part], weights[part] = sigma, volume
    return StressField(
        space=space,
        nodal=_averaged(space, X, at_points),
        at_points=at_points,
        points=phi @ space.nodes[space.cells],
        weights=weights,
    )


def element_stress(
    space: DisplacementSpace,
    displacement: NDArray[np.float64],
    degree: int,
    members: NDArray[np.int64],
    *,
    E: float,
    nu: float,
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
    """Yield the elements' own stress at the points of a rule.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    displacement : ndarray, shape (n, 3)
        At the nodes [mm].
    degree : int
        Of the integration rule.
    members : ndarray of int
        Elements.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Yields
    ------
    tuple of 3 ndarray
        Which elements (k,), their stress (k, q, 6) [MPa] and the points' volumes (k, q) [mm³].
    """
    _, W, _, gradient = reference_basis(space, degree)
    q, b, _ = gradient.shape
    local = np.ascontiguousarray(gradient.transpose(0, 2, 1)).reshape(3 * q, b)
    for start in range(0, len(members), _CHUNK):
        part = members[start : start + _CHUNK]
        cells = space.cells[part]
        inverse, determinant = jacobians(space.nodes[cells], gradient)
        slopes = inverse @ (local @ displacement[cells]).reshape(inverse.shape)  # ∂u_j/∂x_i at [k, q, i, j]
        yield part, components(slopes, E, nu), determinant * W


def components(slopes: NDArray[np.float64], E: float, nu: float) -> NDArray[np.float64]:
    """Return the stress components of displacement gradients.

    Parameters
    ----------
    slopes : ndarray, shape (..., 3, 3)
        Of the displacement, ∂u_j/∂x_i.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (..., 6)
        Stress [MPa].
    """
    lam, mu = lame_constants(E, nu)
    found = np.empty((*slopes.shape[:-2], 6))
    dilatation = lam * (slopes[..., 0, 0] + slopes[..., 1, 1] + slopes[..., 2, 2])
    for number, (i, j) in enumerate(PAIRS):
        found[..., number] = mu * (slopes[..., i, j] + slopes[..., j, i])
        if i == j:
            found[..., number] += dilatation
    return found


def carry_to_nodes(X: NDArray[np.float64], local: int) -> NDArray[np.float64]:
    """Return the weights that carry values at points of an element to its nodes, linearly.

    Parameters
    ----------
    X : ndarray, shape (3, q)
        Points of the unit tetrahedron.
    local : int
        Number of the element's nodes.

    Returns
    -------
    ndarray
        (local, q) Weights.
    """
    if X.shape[1] == 1:
        return np.ones((local, 1))
    linear = np.vstack([np.ones(X.shape[1]), X]).T
    return np.asarray(np.vstack([np.ones(local), _NODES[:, :local]]).T @ np.linalg.inv(linear))


def _averaged(space: DisplacementSpace, X: NDArray[np.float64], at_points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Extrapolate from the integration points X (3, q) to each element's nodes and average over elements."""
    carry = carry_to_nodes(X, space.cells.shape[1])
    values = carry @ at_points
    node = space.cells.ravel()
    sums = [np.bincount(node, values[..., i].ravel(), minlength=len(space.nodes)) for i in range(6)]
    return np.column_stack(sums) / np.bincount(node, minlength=len(space.nodes))[:, None]
