"""A link as a free elastic body: displacements under loads that balance, by halves where it is symmetric about z = 0.

Let R be the reflection in that plane. A load that is its own image, f(Rx) = R f(x), moves the body symmetrically, with
u_z = 0 on the plane; one that is minus its image moves it antisymmetrically, with u_x = u_y = 0 there. Any load is the
sum of two such parts, and the upper half alone, so held, answers each of them. Both have the stiffness of the half, and
nodes on the plane carry half of their load. A part that no load has is not solved.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.mouth import Mouth
from alula.fea.elements.space import DisplacementSpace, displacement_space, upper_half
from alula.fea.elements.supports import LineReference, half_supports, isostatic_supports, rigid_motions
from alula.fea.solvers.solve import Method, factorise
from alula.fea.solvers.two_level import linear_level
from alula.fea.tractions.link_tractions import LinkTractions, Variant
from alula.fea.tractions.traction import TRANSFERS, Transfer
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw, Span

Real = NDArray[np.float64]

IMBALANCE_LIMIT = 1e-3
"""Resultant of all loads on a link, relative to their sum, above which the link is refused."""
LARGEST_POISSON_RATIO = 0.4999
"""Above it a solid model is refused: the error of displacements that resist a change of volume has no bound then."""
NEARLY_INCOMPRESSIBLE = 0.49
"""Poisson's ratio from which that error is told: at 4 elements through a wall 0.1 % here, 3 % at 0.4999."""
NO_PART = 1e-12
"""Sum of the nodal forces of a part, relative to the load's, below which it is rounding, which is 1e-16 to 1e-14."""
REACTION_NOTE = 1e-3
REACTION_LIMIT = 1e-2
"""Reaction of the six supports, relative to the load: noted above the first, refused above the second."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidCase:
    """Displacements of one load case under one model of pin pressure and one of torque transfer.

    Attributes
    ----------
    load : str
        Name of the load case.
    span : Span
        Loaded angle of the pin holes [degrees].
    transfer : Transfer or None
        How the drive torque enters; None where the link carries no torque.
    displacement : ndarray, shape (n, 3)
        Relative to the line through the link's first and last pin [mm].
    reaction : float
        Largest support reaction relative to the load.
    imbalance : float
        Resultant of the loads relative to their sum.
    strain_energy : float
        Half the work of the loads [N mm].
    symmetric : bool
        True where the displacements are their own image in z = 0, so that the upper half tells all.
    """

    load: str
    span: Span
    transfer: Transfer | None
    displacement: NDArray[np.float64]
    reaction: float
    imbalance: float
    strain_energy: float
    symmetric: bool = False

    @property
    def displacement_max(self) -> float:
        """Largest displacement of a node [mm]."""
        return float(np.linalg.norm(self.displacement, axis=1).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidSolution:
    """All cases of one link.

    Attributes
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    density : float
        Of the material [tonne/mm³].
    cases : tuple of SolidCase
        Every load case under every variant.
    solver : str
        Name of the solver.
    solver_reason : Reason
        Why it was chosen.
    solver_error : float
        Largest relative error that it left in a case, in the energy norm (``alula.fea.solvers.solved``).
    notes : tuple of Reason or str
        What the report has to say about this solution.
    """

    space: DisplacementSpace
    E: float
    nu: float
    density: float
    cases: tuple[SolidCase, ...]
    solver: str
    solver_reason: Reason
    solver_error: float
    notes: tuple[Reason | str, ...]


def require_compressible(nu: float) -> None:
    """Refuse a Poisson's ratio at which no solid model can be solved.

    Parameters
    ----------
    nu : float
        Poisson's ratio.

    Raises
    ------
    CaseError
        For a Poisson's ratio above ``LARGEST_POISSON_RATIO``.
    """
    if nu > LARGEST_POISSON_RATIO:
        raise CaseError(
            f"poissons_ratio: it is {nu:g}, but solid models need at most {LARGEST_POISSON_RATIO}, since displacement "
            "elements lock in nearly incompressible material; state a lower value or use --fidelity beam"
        )


def solve_solid(
    mesh: TaggedMesh,
    *,
    E: float,
    nu: float,
    density: float,
    loads: Sequence[LinkLoads],
    line: tuple[str, str] | Mouth,
    laws: Sequence[PressureLaw] = (WIDE, NARROW),
    transfers: Sequence[Transfer] = TRANSFERS,
    order: int = 2,
    method: Method | None = None,
    threads: int | None = None,
) -> SolidSolution:
    """Solve a link under each load case with each pin pressure and, where it carries a torque, each transfer.

    Parameters
    ----------
    mesh : TaggedMesh
        Of the link.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    density : float
        Of the material [tonne/mm³].
    loads : sequence of LinkLoads
        One per load case.
    line : tuple of 2 str or Mouth
        Names of the surfaces at the link's first and last pin (``bore:A``, ``bore:B``): displacements are relative to
        the line through them, or to the section at the mouth of a clamp.
    laws : sequence of PressureLaw, optional
        Of pin pressure.
    transfers : sequence of Transfer, optional
        Of the drive torque, where the link carries one.
    order : int, optional
        Of the displacements, 2 or 1.
    method : Method or None, optional
        Solver, by default the one with the least work that fits.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    SolidSolution
        All cases under all variants.

    Raises
    ------
    CaseError
        For a Poisson's ratio above ``LARGEST_POISSON_RATIO``.
    CannotRunError
        For loads that do not balance (to 0.1 % of the load), reactions above 1 %, surfaces that the mesh lacks, a mesh
        with folded elements, or a solver that fails.
    """
    require_compressible(nu)
    space = displacement_space(mesh, order=order)
    poses = [case.chosen(None) for case in loads]
    tractions = LinkTractions.of(space, poses, density=density)
    variants = [variant for pose in poses for variant in tractions.variants(pose, laws, transfers)]
    F = np.array([variant.load for variant in variants]).T
    size = np.array([variant.scale for variant in variants])
    imbalance = _imbalance(space, F, size, variants)
    free = solve_free(space, F, E=E, nu=nu, method=method, threads=threads)
    reaction = np.abs(free.reactions).max(axis=0) / size
    reference = LineReference(space, line)
    rows = zip(variants, free.displacement.T, F.T, reaction, imbalance, free.symmetric, strict=True)
    return SolidSolution(
        space=space,
        E=E,
        nu=nu,
        density=density,
        cases=tuple(_case(reference, *row) for row in rows),
        solver=free.solver,
        solver_reason=free.reason,
        solver_error=free.error,
        notes=(*mesh.notes, *_notes(reaction, variants, nu)),
    )


def _case(
    reference: LineReference,
    variant: Variant,
    u: NDArray[np.float64],
    f: NDArray[np.float64],
    reaction: float,
    imbalance: float,
    symmetric: bool,
) -> SolidCase:
    return SolidCase(
        load=variant.name,
        span=variant.span,
        transfer=variant.transfer,
        displacement=reference.relative(u.reshape(-1, 3)),
        reaction=float(reaction),
        imbalance=float(imbalance),
        strain_energy=float(u @ f) / 2.0,
        symmetric=bool(symmetric),
    )


def _imbalance(
    space: DisplacementSpace,
    F: NDArray[np.float64],
    scale: NDArray[np.float64],
    variants: Sequence[Variant],
) -> NDArray[np.float64]:
    """Resultants of the load vectors relative to their scale; refuses what does not balance."""
    motions = rigid_motions(space.nodes, space.nodes.mean(axis=0)).reshape(6, -1)
    resultant = motions @ F
    size = np.linalg.norm(np.ptp(space.nodes, axis=0))
    relative = np.maximum(np.linalg.norm(resultant[:3], axis=0), np.linalg.norm(resultant[3:], axis=0) / size) / scale
    worst = int(np.argmax(relative))
    if not relative[worst] <= IMBALANCE_LIMIT:
        force = ", ".join(f"{value:.4g}" for value in resultant[:3, worst])
        moment = ", ".join(f"{value:.4g}" for value in resultant[3:, worst])
        raise CannotRunError(
            f"the loads of case '{variants[worst].name}' do not balance: they leave a force of ({force}) N and a "
            f"moment of ({moment}) N mm, {relative[worst]:.2%} of the load (at most {IMBALANCE_LIMIT:.1%})"
        )
    return np.asarray(relative)


def _notes(reaction: NDArray[np.float64], variants: Sequence[Variant], nu: float) -> tuple[Reason, ...]:
    """What the reader must know; refuses supports that react."""
    worst = int(np.argmax(reaction))
    if not reaction[worst] <= REACTION_LIMIT:
        raise CannotRunError(
            f"the supports of the free body react with {reaction[worst]:.2%} of the load in case "
            f"'{variants[worst].name}' (at most {REACTION_LIMIT:.0%}): load and stress do not balance"
        )
    notes = [
        reason("supports_react", share=float(value), case=variant.name)
        for value, variant in zip(reaction, variants, strict=True)
        if value > REACTION_NOTE
    ]
    if nu > NEARLY_INCOMPRESSIBLE:
        notes.append(reason("nearly_incompressible", ratio=nu, most=NEARLY_INCOMPRESSIBLE))
    return tuple(notes)


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeSolution:
    """Displacements of a free body under k loads.

    Attributes
    ----------
    displacement : ndarray, shape (3n, k)
        Held isostatically [mm].
    reactions : ndarray, shape (6, k)
        Of the supports [N], linear in the loads; those of a half count for both.
    symmetric : ndarray of bool, shape (k,)
        True where the displacements are their own image.
    error : float
        Largest relative error of a solution in the energy norm.
    solver : str
        Its name.
    reason : Reason
        Why it was chosen.
    """

    displacement: Real
    reactions: Real
    symmetric: NDArray[np.bool_]
    error: float
    solver: str
    reason: Reason


def solve_free(
    space: DisplacementSpace, F: Real, *, E: float, nu: float, method: Method | None = None, threads: int | None = None
) -> FreeSolution:
    """Solve a free body under load vectors.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    F : ndarray, shape (3n, k)
        Consistent nodal forces [N]; what does not balance is borne by the supports.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    method : Method or None, optional
        Solver, by default the one with the least work that fits.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    FreeSolution
        Displacements and reactions.

    Raises
    ------
    CannotRunError
        For a mesh with folded elements, or a solver that fails.
    """
    half, count = upper_half(space), F.shape[1]
    body = space if half is None else half.space
    K = assemble_stiffness(body, E=E, nu=nu)
    told: list[tuple[int, float, str, Reason]] = []

    def held(
        K: SymmetricBlockMatrix, load: Real, fixed: NDArray[np.int64], supports: NDArray[np.int64]
    ) -> tuple[Real, Real]:
        """Return displacements and the reactions of the supports among what is fixed, in K too; the factor goes."""
        level, count = linear_level(body, E=E, nu=nu, fixed=fixed), load.shape[1]
        removed = K.fix(fixed)
        factor = factorise(K, level=level, right_hand_sides=count, method=method, threads=threads)
        free = load.copy()
        free[fixed] = 0.0
        answer = factor.solved(free)
        told.append((count, answer.error, factor.name, factor.reason))
        return answer.x, removed[supports] @ answer.x - load[supports]

    if half is None:
        supports = isostatic_supports(space.nodes, space.corners)
        displacement, reactions = held(K, F, supports, supports)
        symmetric = np.zeros(count, dtype=np.bool_)
    else:
        parts = half.parts(F.reshape(-1, 3, count))
        loaded = _loaded(*parts)
        plane = 3 * np.flatnonzero(half.on_plane)
        conditions = (plane + 2, np.concatenate([plane, plane + 1]))
        reactions = np.zeros((6, count))
        rows = zip(
            parts, loaded, conditions, half_supports(body.nodes, body.corners), np.split(reactions, 2), strict=True
        )
        again = all(columns.any() for columns in loaded)
        for part, columns, flat, supports, reaction in rows:
            if columns.any():
                part[half.on_plane] /= 2.0
                load = part[..., columns].reshape(body.unknowns, -1)
                matrix, again = K.copy() if again else K, False
                moved, borne = held(matrix, load, np.concatenate([flat, supports]), supports)
                part[..., columns], reaction[:, columns] = moved.reshape(-1, 3, load.shape[1]), 2.0 * borne
            part[..., ~columns] = 0.0
        displacement, symmetric = half.whole(*parts).reshape(F.shape), ~loaded[1]
    _, _, solver, why = max(told, key=lambda one: one[:3])
    return FreeSolution(
        displacement=displacement,
        reactions=reactions,
        symmetric=symmetric,
        error=max(error for _, error, _, _ in told),
        solver=solver,
        reason=why if half is None else reason("half_the_body", why=why),
    )


def _loaded(symmetric: Real, antisymmetric: Real) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which loads (k,) have a symmetric part, as one that is zero does, and which an antisymmetric one."""
    one, other = (np.abs(part).sum(axis=(0, 1)) for part in (symmetric, antisymmetric))
    least = NO_PART * (one + other)
    return one >= least, other > least
