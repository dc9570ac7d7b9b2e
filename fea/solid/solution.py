"""A link as a free elastic body: displacements under loads that balance."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.common.link_loads import LinkLoads
from fea.solid.elasticity import assemble_stiffness
from fea.solid.quadrature import Quadrature, SurfaceQuadrature, surface_quadrature, volume_quadrature
from fea.solid.slot_traction import DEGREE, slot_traction
from fea.solid.solve import Method, factorise
from fea.solid.space import DisplacementSpace, displacement_space
from fea.solid.supports import isostatic_supports, rigid_motions
from fea.solid.traction import (
    Transfer,
    body_density,
    couple_traction,
    line_density,
    pin_traction,
    thrust_traction,
    wrench_density,
)
from fea.solid.two_level import linear_level
from geometry.base.errors import CannotRunError, CaseError
from geometry.meshing.tagged_mesh import TaggedMesh
from loads.records.bearing import NARROW, WIDE, PressureLaw, Span

IMBALANCE_LIMIT = 1e-3
"""Resultant of all loads on a link, relative to their sum, above which the link is refused."""
LARGEST_POISSON_RATIO = 0.4999
"""Above it a solid model is refused: the error of displacements that resist a change of volume has no bound then."""
NEARLY_INCOMPRESSIBLE = 0.49
"""Poisson's ratio from which that error is told: at 4 elements through a wall 0.1 % here, 3 % at 0.4999."""
REACTION_NOTE = 1e-3
REACTION_LIMIT = 1e-2
"""Reaction of the six supports, relative to the load: noted above the first, refused above the second."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidCase:
    """Displacements of one load case under one model of pin pressure and one of torque transfer.

    load           name of the load case
    span           loaded angle of the pin holes [degrees]
    transfer       how the drive torque enters; None where the link carries no torque
    displacement   (n, 3) relative to the line through the link's first and last pin [mm]
    reaction       largest support reaction relative to the load
    imbalance      resultant of the loads relative to their sum
    strain_energy  half the work of the loads [N mm]
    """

    load: str
    span: Span
    transfer: Transfer | None
    displacement: NDArray[np.float64]
    reaction: float
    imbalance: float
    strain_energy: float

    @property
    def displacement_max(self) -> float:
        """Largest displacement of a node [mm]."""
        return float(np.linalg.norm(self.displacement, axis=1).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidSolution:
    """All cases of one link, solved with one factorisation.

    E, nu, density   of the material [MPa, -, tonne/mm³]
    cases            every load case under every variant
    solver           name of the solver
    solver_reason    why it was chosen
    solver_error     largest relative error that it left in a case, in the energy norm (``fea.solid.solved``)
    rank_margin      smallest singular value of the rigid-body motions at the supports
    notes            what the report has to say about this solution
    timings          stage -> seconds
    """

    space: DisplacementSpace
    E: float
    nu: float
    density: float
    cases: tuple[SolidCase, ...]
    solver: str
    solver_reason: str
    solver_error: float
    rank_margin: float
    notes: tuple[str, ...]
    timings: dict[str, float]


def require_compressible(nu: float) -> None:
    """Raise ``CaseError`` for a Poisson's ratio above ``LARGEST_POISSON_RATIO``: no solid model will be solved."""
    if nu > LARGEST_POISSON_RATIO:
        raise CaseError(
            f"poissons_ratio: it is {nu:g}, but displacements alone hold no solid model above {LARGEST_POISSON_RATIO}, "
            "where the material hardly changes its volume; state a lower one or check with fidelity beam"
        )


def solve_solid(
    mesh: TaggedMesh,
    *,
    E: float,
    nu: float,
    density: float,
    loads: Sequence[LinkLoads],
    line: tuple[str, str],
    laws: Sequence[PressureLaw] = (WIDE, NARROW),
    transfers: Sequence[Transfer] = ("eye-faces", "bore-shear"),
    order: int = 2,
    method: Method | None = None,
    threads: int | None = None,
) -> SolidSolution:
    """Solve a link under each load case with each pin pressure and, where it carries a torque, each transfer.

    line      names of the surfaces at the link's first and last pin (``bore:A``, ``bore:B``): displacements
              are relative to the line through them
    order     of the displacements, 2 or 1
    method    solver, by default the one with the least work that fits; ``threads`` bounds its threads

    Raises ``CaseError`` for a Poisson's ratio above ``LARGEST_POISSON_RATIO``, ``CannotRunError`` for loads that do
    not balance (to 0.1 % of the load), reactions above 1 %, surfaces that the mesh lacks, a mesh with folded elements,
    or a solver that fails.
    """
    require_compressible(nu)
    timings: dict[str, float] = {}
    clock = _Clock(timings)
    space = displacement_space(mesh, order=order)
    clock("space")
    vectors = _LoadVectors(space, density)
    names, columns, scales = [], [], []
    for case in loads:
        torque = any(c.torque != 0.0 for c in case.couples) or any(
            p.wrench[5] != 0.0 for p in case.pins if not p.slotted
        )
        scale = vectors.scale(case)
        rest = vectors.spread(case)
        pushed = {law.span: vectors.pins(case, law) for law in laws}
        variants: Sequence[Transfer | None] = transfers if torque else (None,)
        turned = {transfer: vectors.couples(case, transfer) for transfer in variants}
        for law in laws:
            for transfer in variants:
                names.append((case.name, law.span, transfer))
                columns.append(rest + pushed[law.span] + turned[transfer])
                scales.append(scale)
    F = np.array(columns).T
    size = np.array(scales)
    imbalance = _imbalance(space, F, size, names)
    clock("loads")
    K = assemble_stiffness(space, E=E, nu=nu)
    clock("assembly")
    supports = isostatic_supports(space.nodes, space.corners)
    factor = factorise(
        K.with_fixed(supports.unknowns),
        level=linear_level(space, E=E, nu=nu, fixed=supports.unknowns),
        right_hand_sides=F.shape[1],
        method=method,
        threads=threads,
    )
    clock("factorisation")
    free = F.copy()
    free[supports.unknowns] = 0.0
    answer = factor.solved(free)
    U = answer.x
    clock("solution")
    reaction = np.abs((K @ U - F)[supports.unknowns]).max(axis=0) / size
    notes = _reaction_notes(reaction, names)
    if nu > NEARLY_INCOMPRESSIBLE:
        notes += (
            f"Poisson's ratio {nu:g} is above {NEARLY_INCOMPRESSIBLE}: elements resist changes of volume, so that "
            "displacements come out too small, by 3 % at 0.4999 with four elements through a wall",
        )
    motions = rigid_motions(space.nodes, space.nodes.mean(axis=0))
    reference = LineReference(space, motions, line)
    cases = tuple(
        SolidCase(
            load=load,
            span=span,
            transfer=transfer,
            displacement=reference.relative(U[:, i].reshape(-1, 3)),
            reaction=float(reaction[i]),
            imbalance=float(imbalance[i]),
            strain_energy=float(U[:, i] @ F[:, i]) / 2.0,
        )
        for i, (load, span, transfer) in enumerate(names)
    )
    return SolidSolution(
        space=space,
        E=E,
        nu=nu,
        density=density,
        cases=cases,
        solver=factor.name,
        solver_reason=factor.reason,
        solver_error=answer.error,
        rank_margin=supports.rank_margin,
        notes=(*mesh.notes, *notes),
        timings=timings,
    )


class _Clock:
    """Writes down how long each stage took."""

    def __init__(self, timings: dict[str, float]) -> None:
        self._timings = timings
        self._last = time.perf_counter()

    def __call__(self, stage: str) -> None:
        now = time.perf_counter()
        self._timings[stage] = now - self._last
        self._last = now


class _LoadVectors:
    """Consistent load vectors of the loads on one link; surfaces are integrated once."""

    def __init__(self, space: DisplacementSpace, density: float) -> None:
        self._space = space
        self._density = density
        self._surfaces: dict[tuple[str, ...], SurfaceQuadrature] = {}
        self._volume: Quadrature | None = None
        self._size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))

    def surface(self, *names: str, degree: int | None = None) -> SurfaceQuadrature:
        if names not in self._surfaces:
            options = {} if degree is None else {"degree": degree}
            self._surfaces[names] = surface_quadrature(self._space, *names, **options)
        return self._surfaces[names]

    @property
    def volume(self) -> Quadrature:
        if self._volume is None:
            self._volume = volume_quadrature(self._space)
        return self._volume

    def scale(self, case: LinkLoads) -> float:
        """Sum of all forces, and of all moments over the link's size [N]: what a resultant is compared with."""
        wrenches = [p.wrench for p in case.pins] + [e.wrench for e in case.ends]
        total = sum(float(np.linalg.norm(w[:3]) + np.linalg.norm(w[3:]) / self._size) for w in wrenches)
        total += sum(abs(c.torque) / self._size for c in case.couples)
        for line in case.lines:
            total += float(np.linalg.norm(line.intensity, axis=1).mean()) * (line.last - line.first)
        for body in case.bodies:
            force = np.linalg.norm(body_density(self.volume, body, self._density), axis=2)
            total += float((self.volume.w * force).sum())
        if total == 0.0:
            raise CannotRunError(f"load case '{case.name}' puts no load on the link; leave it out")
        return total

    def pins(self, case: LinkLoads, law: PressureLaw) -> NDArray[np.float64]:
        """Load vector (3n,) of the pins' pressures and thrusts."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        for pin in case.pins:
            bore = self.surface(f"bore:{pin.name}", degree=DEGREE if pin.slotted else None)
            push = slot_traction if pin.slotted else pin_traction
            load += bore.load_vector(push(bore, pin, law), count)
            if pin.wrench[2] != 0.0:
                face = self.surface(f"{'bottom' if pin.wrench[2] > 0.0 else 'top'}:{pin.name}")
                load += face.load_vector(thrust_traction(face, pin), count)
        return load

    def couples(self, case: LinkLoads, transfer: Transfer | None) -> NDArray[np.float64]:
        """Load vector (3n,) of the torques about the pins."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        torques = [(c.pin, c.torque) for c in case.couples] + [
            (p.name, float(p.wrench[5])) for p in case.pins if not p.slotted
        ]
        centres = {pin.name: pin.centre for pin in case.pins}
        for name, torque in torques:
            if torque != 0.0:
                bore = self.surface(f"bore:{name}")
                faces = (f"top:{name}", f"bottom:{name}")
                surface = bore if transfer == "bore-shear" else self.surface(*faces)
                load += surface.load_vector(couple_traction(surface, centres.get(name, bore.centroid), torque), count)
        return load

    def spread(self, case: LinkLoads) -> NDArray[np.float64]:
        """Load vector (3n,) of what does not come from pins: plain ends, weight and inertia, spread loads."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        for end in case.ends:
            patch = self.surface(f"end:{end.name}")
            load += patch.load_vector(wrench_density(patch, end.point, end.wrench), count)
        for body in case.bodies:
            load += self.volume.load_vector(body_density(self.volume, body, self._density), count)
        for line in case.lines:
            load += self.volume.load_vector(line_density(self.volume, line), count)
        return load


def _imbalance(
    space: DisplacementSpace,
    F: NDArray[np.float64],
    scale: NDArray[np.float64],
    names: Sequence[tuple[str, Span, Transfer | None]],
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
            f"the loads of case '{names[worst][0]}' do not balance: they leave a force of ({force}) N and a moment of "
            f"({moment}) N mm, {relative[worst]:.2%} of the load (at most {IMBALANCE_LIMIT:.1%})"
        )
    return np.asarray(relative)


def _reaction_notes(
    reaction: NDArray[np.float64], names: Sequence[tuple[str, Span, Transfer | None]]
) -> tuple[str, ...]:
    worst = int(np.argmax(reaction))
    if not reaction[worst] <= REACTION_LIMIT:
        raise CannotRunError(
            f"the supports of the free body react with {reaction[worst]:.2%} of the load in case '{names[worst][0]}' "
            f"(at most {REACTION_LIMIT:.0%}): load and stress do not balance"
        )
    return tuple(
        f"the supports react with {value:.2%} of the load in case '{name[0]}'"
        for value, name in zip(reaction, names, strict=True)
        if value > REACTION_NOTE
    )


class LineReference:
    """Takes the rigid-body part out of displacements.

    Six conditions: the first hole does not move on average (3), the last one stays on the line through
    both (2), and both together do not turn about it on average (1). Where both are the same hole, that of the only
    joint, it neither moves nor turns on average (3 + 3).
    """

    def __init__(self, space: DisplacementSpace, motions: NDArray[np.float64], line: tuple[str, str]) -> None:
        self._first, self._last = (surface_quadrature(space, name) for name in line)
        self._alone = line[0] == line[1]
        span = np.array([1.0, 0.0, 0.0]) if self._alone else self._last.centroid - self._first.centroid
        if np.linalg.norm(span) == 0.0:
            raise CannotRunError(
                f"the surfaces {line[0]} and {line[1]} have the same centre: no line runs through them"
            )
        self._axis = span / np.linalg.norm(span)
        self._across = np.linalg.svd(self._axis[None, :])[2][1:]
        self._motions = motions
        self._conditions = np.linalg.inv(np.array([self._values(motion) for motion in motions]).T)

    def _values(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        if self._alone:
            hole = self._first
            moved = np.einsum("qb,kbi->kqi", hole.phi, field[hole.nodes])
            turned = np.einsum("kq,kqi->i", hole.w, np.cross(hole.x - hole.centroid, moved))
            return np.array([*hole.mean(field), *turned])
        twist = 0.0
        for hole in (self._first, self._last):
            lever = np.cross(self._axis, hole.x - self._first.centroid)
            moved = np.einsum("qb,kbi->kqi", hole.phi, field[hole.nodes])
            twist += float(np.einsum("kq,kqi,kqi->", hole.w, lever, moved))
        return np.array([*self._first.mean(field), *(self._across @ self._last.mean(field)), twist])

    def relative(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        """Displacements (n, 3) less their rigid-body part."""
        return np.asarray(field - np.tensordot(self._conditions @ self._values(field), self._motions, axes=1))
