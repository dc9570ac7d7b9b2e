"""At how many times its load an elastic body buckles: the linear eigenvalue problem of its solid.

With the stress σ that linear theory gives for the load, the body stays as well in place as displaced by u at the least
λ > 0 at which

    K u + λ G u = 0,   v·G u = ∫ ∇v : (∇u σ) dV

(Zienkiewicz & Taylor, The Finite Element Method, 6th ed., vol. 2, section 7.8). Forces keep their directions. The body
is held by conditions on the mean motions of bores and patches (``alula.fea.solid.bore_motion``), which take its rigid
motions and whatever else its joints prevent.

A pin's pressure acts on the wall of its bore. If it stayed on the same points of the wall while the body turned about
the pin, it would turn the body back: tractions t at arms r from the pin's axis do the work -½ ω·D ω in a small
rotation ω, with D = tr(V) 1 - (V + Vᵀ)/2 and V = ∫ t rᵀ dA, which is positive for a pressure. The force of a pin that
turns goes through the pin's axis instead. So D is taken off, on the mean rotation of the bore.

Where body and stress are symmetric about z = 0, u is symmetric or antisymmetric, and each kind is sought on half the
body (``alula.fea.solid.solution``).
"""

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.elasticity import assemble_stiffness, jacobians, reference_basis
from alula.fea.elements.quadrature import SurfaceQuadrature, surface_quadrature
from alula.fea.elements.space import DisplacementSpace, UpperHalf, upper_half
from alula.fea.elements.supports import IN_PLANE, OUT_OF_PLANE, half_supports, isostatic_supports, rigid_motions
from alula.fea.solid.stress import PAIRS, element_stress
from alula.fea.solvers.solve import factorise
from alula.fea.tractions.slot_traction import slot_traction
from alula.fea.tractions.traction import pin_traction, wrench_density
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.bearing import WIDE

Real = NDArray[np.float64]
DEGREE = 5
"""Of the integration rule: exact in straight elements, with positive weights."""
MOST = 100.0
"""Largest factor that is sought. Stubby bodies buckle beyond it, in many modes at the rims of their bores at once."""
TOLERANCE = 1e-3
"""Residual of an eigenvalue 1/λ over the larger of itself and 1/``MOST``; the error goes with its square."""
LEAST_STEPS, STEPS = 12, 80
"""Of the Lanczos method."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Buckled:
    """The least factor at which a held body buckles, and its mode.

    Attributes
    ----------
    factor : float
        On the load; infinite where it is above ``MOST``, or no load buckles the body.
    mode : ndarray, shape (n, 3)
        Displacements of the nodes, of any size; zero where there is none.
    """

    factor: float
    mode: Real


class BucklingProblem:
    """The stiffness of a body, factorised for buckling under any stress and any way to hold it.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    places : dict of str to ndarray
        Surface, and point (3,) about which its mean motion counts [mm].
    E, nu : float
        Young's modulus [MPa] and Poisson's ratio.
    halved : bool
        True where all stress is its own image in z = 0: then half the body tells all, if it is symmetric.
    threads : int or None, optional
        Upper bound on the threads of the solver.
    """

    def __init__(
        self,
        space: DisplacementSpace,
        places: Mapping[str, Real],
        *,
        E: float,
        nu: float,
        halved: bool,
        threads: int | None = None,
    ) -> None:
        self.space, self.E, self.nu = space, E, nu
        self._surfaces = {name: surface_quadrature(space, name) for name in places}
        self._number = {name: number for number, name in enumerate(places)}
        size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))
        motions = np.array(
            [
                self._surfaces[name].load_vector(wrench_density(self._surfaces[name], point, unit), len(space.nodes))
                for name, point in places.items()
                for unit in np.eye(6)
            ]
        )
        half = upper_half(space) if halved else None
        self._halves: list[_Held] = []
        if half is None:
            K = assemble_stiffness(space, E=E, nu=nu)
            supports = isostatic_supports(space.nodes, space.corners)
            self._halves.append(_Held(space, K, motions, supports, supports[:0], tuple(range(6)), size, None, threads))
            return
        K = assemble_stiffness(half.space, E=E, nu=nu)
        plane = 3 * np.flatnonzero(half.on_plane)
        flat = (plane + 2, np.concatenate([plane, plane + 1]))
        isostatic = half_supports(half.space.nodes, half.space.corners)
        parts = half.parts(motions.T.reshape(-1, 3, len(motions)))
        for part, fixed, held, own in zip(parts, flat, isostatic, (IN_PLANE, OUT_OF_PLANE), strict=True):
            part[half.on_plane] /= 2.0
            rows = 2.0 * part.reshape(half.space.unknowns, -1).T
            matrix = K.copy() if own == IN_PLANE else K
            self._halves.append(_Held(half.space, matrix, rows, held, fixed, own, size, half, threads))

    def prestress(self, displacement: Real, loads: LinkLoads) -> "Prestress":
        """Return what the stress of a solved load case takes of the stiffness.

        Parameters
        ----------
        displacement : ndarray, shape (n, 3)
            Its solution [mm].
        loads : LinkLoads
            The load case, whose pins press on places.

        Returns
        -------
        Prestress
        """
        half = self._halves[0].half
        space = self.space if half is None else half.space
        moved = displacement if half is None else displacement[half.nodes]
        return Prestress(
            geometric=geometric_stiffness(space, moved, E=self.E, nu=self.nu),
            turning=tuple(
                (6 * self._number[f"bore:{pin.name}"] + 3, _turned_back(self._surfaces[f"bore:{pin.name}"], pin))
                for pin in loads.pins
                if np.any(pin.wrench[:2])
            ),
        )

    def least(self, prestress: "Prestress", conditions: Real) -> Buckled:
        """Return the least factor at which the body buckles, held in one way.

        Parameters
        ----------
        prestress : Prestress
        conditions : ndarray, shape (k, 6 p)
            On the mean motions of the p places, translations and rotations: each of the k sums is zero. They leave no
            rigid motion free.

        Returns
        -------
        Buckled

        Raises
        ------
        CannotRunError
            Where the iteration does not end.
        """
        found = [held.least(prestress, conditions) for held in self._halves]
        return min(found, key=lambda buckled: buckled.factor)


@dataclass(frozen=True, kw_only=True, eq=False)
class Prestress:
    """What the stress of a load case takes of the stiffness.

    Attributes
    ----------
    geometric : csr_array, shape (n, n)
        G of one displacement component, of half the body where that tells all [N/mm].
    turning : tuple of (int, ndarray)
        Of each pin the number of its bore's first rotation among the motions of the places, and D (3, 3) [N mm].
    """

    geometric: Any
    turning: tuple[tuple[int, Real], ...]


class _Held:
    """The factor of a body, or of a half with u_z or u_x and u_y zero on the plane, and the motions of its places."""

    def __init__(
        self,
        space: DisplacementSpace,
        K: SymmetricBlockMatrix,
        motions: Real,
        supports: NDArray[np.int64],
        plane: NDArray[np.int64],
        rigid: Sequence[int],
        size: float,
        half: UpperHalf | None,
        threads: int | None,
    ) -> None:
        self.half, self._motions, self._rigid_numbers = half, motions, rigid
        self._fixed = np.concatenate([plane, supports])
        K.fix(self._fixed)
        self._factor = factorise(K, right_hand_sides=len(motions), threads=threads)
        on_plane = space.nodes.mean(axis=0) * (1.0, 1.0, 0.0)  # about which a half turns without leaving z = 0
        self._rigid = rigid_motions(space.nodes, on_plane).reshape(6, -1)
        self._rigid[3:] /= size
        self._rigid = self._rigid[list(rigid)]
        self._plane, self._count = plane, space.unknowns
        self._moved = self._inverse(motions.T)
        self._start = smooth_forces(space)

    def _inverse(self, load: Real) -> Real:
        """Displacements under loads, on the isostatic supports."""
        free = load.copy()
        free[self._fixed] = 0.0
        return self._factor.solve(free)

    def least(self, prestress: Prestress, conditions: Real) -> Buckled:
        """As ``BucklingProblem.least``, among the displacements of this half.

        K is regular on the displacements that meet the conditions. Its inverse there is that on the isostatic supports,
        less the displacements by the conditions' own forces μ, plus a rigid motion q; both follow from the conditions
        and from the balance of all forces.
        """
        own = np.zeros(conditions.shape[1], dtype=np.bool_).reshape(-1, 6)
        own[:, list(self._rigid_numbers)] = True
        T = conditions[np.any(conditions[:, own.ravel()] != 0.0, axis=1)] * own.ravel()
        C, W, R, k = T @ self._motions, self._moved @ T.T, self._rigid, len(T)
        system = np.block([[C @ W, -C @ R.T], [R @ C.T, np.zeros((len(R), len(R)))]])
        borne = np.linalg.inv(system)
        share = 1.0 if self.half is None else 0.5
        turning = [(self._motions[i : i + 3], share * D) for i, D in prestress.turning]

        def inverse(force: Real) -> Real:
            moved = self._inverse(force)
            answer = borne @ np.concatenate([C @ moved, R @ force])
            return np.asarray(moved - W @ answer[:k] + R.T @ answer[k:])

        def taken(u: Real) -> Real:
            force = -(prestress.geometric @ u.reshape(-1, 3)).ravel()
            for B, D in turning:
                force += B.T @ (D @ (B @ u))
            force[self._plane] = 0.0
            return np.asarray(force)

        start = self._start.copy()
        start[self._plane] = 0.0
        largest, vector = largest_eigenvalue(taken, inverse, start)
        if not largest > 1.0 / MOST:
            return Buckled(factor=math.inf, mode=np.zeros((0, 3)))
        return Buckled(factor=1.0 / largest, mode=self._whole(vector.reshape(-1, 3)))

    def _whole(self, mode: Real) -> Real:
        if self.half is None:
            return mode
        parts = [mode[..., None], np.zeros((*mode.shape, 1))]
        symmetric, antisymmetric = parts if self._rigid_numbers == IN_PLANE else parts[::-1]
        return self.half.whole(symmetric, antisymmetric)[..., 0]


def smooth_forces(space: DisplacementSpace) -> Real:
    """Return nodal forces that bend and twist a body in every way: cubics with random factors, and a little noise.

    Noise alone holds next to nothing of the smooth modes in which bodies buckle, and the Lanczos method might end
    before it has found one.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the body.

    Returns
    -------
    ndarray, shape (3n,)
        Forces.
    """
    random = np.random.default_rng(0)
    x = 2.0 * (space.nodes - space.nodes.min(axis=0)) / np.ptp(space.nodes, axis=0) - 1.0
    powers = [p for p in itertools.product(range(4), repeat=3) if sum(p) <= 3]
    terms = np.stack([np.prod(x**p, axis=1) for p in powers], axis=1)
    forces = terms @ random.standard_normal((len(powers), 3)) + 0.1 * random.standard_normal(x.shape)
    return np.asarray(forces.ravel())


def largest_eigenvalue(
    taken: Callable[[Real], Real], inverse: Callable[[Real], Real], start: Real
) -> tuple[float, Real]:
    """Return the largest eigenvalue of A u = θ K u and its vector, by the Lanczos method with full orthogonalisation.

    Vectors are orthogonal by K, which is never applied: with each q its product K q is kept, but for forces that do no
    work on what the inverse returns (Parlett, The Symmetric Eigenvalue Problem, section 15.11).

    Parameters
    ----------
    taken : callable
        A, symmetric (n,) -> (n,).
    inverse : callable
        Of K, on the displacements that conditions allow.
    start : ndarray, shape (n,)
        Any forces.

    Returns
    -------
    tuple of (float, ndarray)
        θ, within ``TOLERANCE``, and u (n,).

    Raises
    ------
    CannotRunError
        Where ``STEPS`` do not suffice.
    """
    force, moved = start, inverse(start)
    Q, P, T = np.empty((0, len(start))), np.empty((0, len(start))), np.zeros((STEPS + 1, STEPS + 1))
    for step in range(STEPS):
        size = math.sqrt(max(float(moved @ force), 0.0))
        Q, P = np.vstack([Q, moved / size]), np.vstack([P, force / size])
        force = taken(Q[-1])
        moved = inverse(force)
        for _ in range(2):
            shares = P @ moved
            moved, force = moved - shares @ Q, force - shares @ P
            T[step, : step + 1] += shares
        values, vectors = np.linalg.eigh(T[: step + 1, : step + 1], UPLO="L")
        residual = math.sqrt(max(float(moved @ force), 0.0)) * abs(vectors[-1, -1])
        if step + 1 >= LEAST_STEPS and residual <= TOLERANCE * max(values[-1], 1.0 / MOST):
            return float(values[-1]), vectors[:, -1] @ Q
    raise CannotRunError(f"the buckling factor of its solid was not found in {STEPS} steps of the Lanczos method")


def geometric_stiffness(space: DisplacementSpace, displacement: Real, *, E: float, nu: float) -> Any:
    """Return the geometric stiffness of one displacement component, ∫ ∂φa/∂x_i σ_ij ∂φb/∂x_j dV.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    displacement : ndarray, shape (n, 3)
        From which the elements' own stress σ follows [mm].
    E, nu : float
        Young's modulus [MPa] and Poisson's ratio.

    Returns
    -------
    csr_array, shape (n, n)
        The same for x, y and z [N/mm].
    """
    from scipy.sparse import csr_array

    _, _, _, gradient = reference_basis(space, DEGREE)
    q, b, _ = gradient.shape
    values = np.empty((len(space.cells), b, b))
    every = np.arange(len(space.cells))
    for part, stress, volume in element_stress(space, displacement, DEGREE, every, E=E, nu=nu):
        inverse, _ = jacobians(space.nodes[space.cells[part]], gradient)
        slopes = inverse @ gradient.transpose(0, 2, 1)  # ∂φa/∂x_i at [k, q, i, a]
        tensor = np.empty((*stress.shape[:2], 3, 3))
        for number, (i, j) in enumerate(PAIRS):
            tensor[..., i, j] = tensor[..., j, i] = volume * stress[..., number]
        weighted = (tensor @ slopes).reshape(len(part), 3 * q, b)
        values[part] = slopes.reshape(len(part), 3 * q, b).transpose(0, 2, 1) @ weighted
    row, column = np.repeat(space.cells, b, axis=1).ravel(), np.tile(space.cells, (1, b)).ravel()
    return csr_array((values.ravel(), (row, column)), shape=(len(space.nodes), len(space.nodes)))


def _turned_back(bore: SurfaceQuadrature, pin: Any) -> Real:
    """D (3, 3) of a pin's pressure about its axis [N mm]."""
    push = slot_traction if pin.slotted else pin_traction
    V = np.einsum("kq,kqi,kqj->ij", bore.w, push(bore, pin, WIDE), bore.x - pin.centre)
    return np.asarray(np.trace(V) * np.eye(3) - (V + V.T) / 2.0)
