"""Boundary-value problems on structured meshes, for the published benchmarks: fixed faces, symmetry, pressure.

Links are free bodies, so ``alula.fea.solid.solution`` offers no fixed faces; here they are put on top of the same
space, stiffness, solver and quadrature.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import permutations

import numpy as np
import pytest
from known_solutions import law

from alula.fea.elements.elasticity import assemble_stiffness, jacobians, reference_basis
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import EDGES, displacement_space
from alula.fea.elements.supports import rigid_motions
from alula.fea.refine.convergence import GridConvergence, grid_convergence, observed_order
from alula.fea.refine.error_estimate import energy_density, energy_factor, estimate_error, relative_error
from alula.fea.solid.stress import stress_field
from alula.fea.solvers.solve import factorise
from alula.geometry.meshing.tagged_mesh import TaggedMesh

SIDES = ("u0", "u1", "v0", "v1", "w0", "w1")


def even(count, start=0.0, stop=1.0):
    """Corner coordinates of ``count`` equal cells."""
    return np.linspace(start, stop, count + 1)


def graded(count, ratio, start=0.0, stop=1.0):
    """Corner coordinates of ``count`` cells growing geometrically, the last ``ratio`` times the first."""
    sizes = ratio ** (np.arange(count) / max(count - 1, 1))
    return start + (stop - start) * np.concatenate([[0.0], np.cumsum(sizes) / sizes.sum()])


@dataclass(frozen=True, kw_only=True)
class Block:
    """Points (n, 3), quadratic cells (m, 10) and the triangles of its six sides."""

    points: np.ndarray
    cells: np.ndarray
    sides: dict[str, np.ndarray]


def block(u, v, w, warp: Callable[..., np.ndarray]) -> Block:
    """Bricks between the corner coordinates u, v, w, each cut into six tetrahedra (Kuhn), then warped.

    ``warp`` maps arrays u, v, w to points (..., 3); mid-nodes are mapped too, so that edges follow the shape.
    A side's diagonals run from its least to its greatest indices, so that blocks fit that share a side whose two
    indices run the same way.
    """
    lattice = [np.interp(np.arange(2 * len(c) - 1) / 2.0, np.arange(len(c)), c) for c in (u, v, w)]
    shape = tuple(len(c) for c in lattice)
    points = warp(*np.meshgrid(*lattice, indexing="ij")).reshape(-1, 3)
    first = np.stack(np.meshgrid(*(np.arange(0, n - 1, 2) for n in shape), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    cells = []
    for order in permutations(range(3)):
        corner = np.zeros((4, 3), dtype=np.int64)
        for step, axis in enumerate(order, start=1):
            corner[step:, axis] = 2
        local = np.vstack([corner, [(corner[a] + corner[b]) // 2 for a, b in EDGES]])
        cells.append(np.ravel_multi_index(tuple(np.moveaxis(first + local, -1, 0)), shape))
    cells = np.vstack(cells)
    index = np.stack(np.unravel_index(cells[:, :4], shape), axis=-1)
    sides = {}
    for axis in range(3):
        for name, place in ((SIDES[2 * axis], 0), (SIDES[2 * axis + 1], shape[axis] - 1)):
            on = index[..., axis] == place
            chosen = on.sum(axis=1) == 3
            sides[name] = cells[chosen, :4][on[chosen]].reshape(-1, 3)
    return Block(points=points, cells=cells, sides=sides)


def joined(blocks: Sequence[Block], names: Sequence[dict[str, str]]) -> TaggedMesh:
    """One mesh of blocks that touch; ``names[i]`` gives sides of block i their surface names."""
    offsets = np.cumsum([0] + [len(b.points) for b in blocks[:-1]])
    points = np.vstack([b.points for b in blocks])
    size = np.ptp(points, axis=0).max()
    _, first, number = np.unique(np.round(points / size, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    surfaces: dict[str, list[np.ndarray]] = {}
    for b, offset, named in zip(blocks, offsets, names, strict=True):
        for side, name in named.items():
            surfaces.setdefault(name, []).append(number[b.sides[side] + offset])
    found = {name: np.vstack(parts) for name, parts in surfaces.items()}
    return TaggedMesh(
        points=points[first],
        cells=np.vstack([number[b.cells + offset] for b, offset in zip(blocks, offsets, strict=True)]),
        surfaces=found,
        areas=dict.fromkeys(found, 0.0),
        volume=0.0,
        centroid=np.zeros(3),
    )


def single(u, v, w, warp) -> TaggedMesh:
    """Mesh of one block whose surfaces are called u0, u1, v0, v1, w0, w1."""
    return joined([block(u, v, w, warp)], [{name: name for name in SIDES}])


def element_stress(space, u, E, nu, degree=5):
    """Points (k, q, 3), volumes (k, q) and the elements' own stress (k, q, 6)."""
    _, W, phi, gradient = reference_basis(space, degree)
    nodes = space.nodes[space.cells]
    inverse, determinant = jacobians(nodes, gradient)
    slopes = np.einsum("kqib,kbj->kqji", inverse @ gradient.transpose(0, 2, 1), u[space.cells])
    tensor = law(slopes, E, nu)
    own = tensor[..., [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    return np.einsum("qb,kbi->kqi", phi, nodes), determinant * W, own


@dataclass
class Problem:
    """A body with E and ν, prescribed displacements and loads; ``solve`` gives displacements and stress."""

    mesh: TaggedMesh
    E: float
    nu: float
    order: int = 2
    fixed: dict[int, float] = field(default_factory=dict)

    def __post_init__(self):
        self.space = displacement_space(self.mesh, order=self.order)
        self.load = np.zeros(self.space.unknowns)

    def nodes_on(self, *names):
        """Nodes of the named surfaces."""
        return np.unique(self.space.faces(*names))

    def nodes_where(self, condition):
        """Nodes at which ``condition(x, y, z)`` holds."""
        return np.flatnonzero(condition(*self.space.nodes.T))

    def node_at(self, *point):
        """The node at a point, which must be there."""
        distance = np.linalg.norm(self.space.nodes - point, axis=1)
        node = int(np.argmin(distance))
        assert distance[node] < 1e-6 * np.ptp(self.space.nodes), f"no node at {point}"
        return node

    def fix(self, nodes, components, value=0.0):
        """Prescribe components ("x", "yz", ...) at nodes; value a number or (nodes,)."""
        nodes = np.atleast_1d(nodes)
        for c in components:
            values = np.broadcast_to(value, nodes.shape)
            self.fixed.update(zip((3 * nodes + "xyz".index(c)).tolist(), values.tolist(), strict=True))

    def traction(self, name, density):
        """Add a traction: a vector (3,), or a function of the surface quadrature to (k, q, 3)."""
        quadrature = surface_quadrature(self.space, name)
        value = density(quadrature) if callable(density) else np.broadcast_to(density, quadrature.x.shape)
        self.load += quadrature.load_vector(value, len(self.space.nodes))

    def force(self, name, vector):
        """Add a force spread evenly over a surface."""
        area = surface_quadrature(self.space, name).measure
        self.traction(name, np.asarray(vector) / area)

    def solve(self):
        """Solve under the loads so far."""
        (solved,) = self.solve_each([self.load])
        return solved

    def solve_each(self, loads):
        """Solve for several load vectors with one factorisation."""
        K = assemble_stiffness(self.space, E=self.E, nu=self.nu)
        unknowns = np.array(sorted(self.fixed))
        prescribed = np.zeros(self.space.unknowns)
        prescribed[unknowns] = [self.fixed[i] for i in unknowns.tolist()]
        rhs = np.array(loads).T - (K @ prescribed)[:, None]
        rhs[unknowns] = 0.0
        found = factorise(K.with_fixed(unknowns), right_hand_sides=len(loads), threads=1).solve(rhs)
        solutions = []
        for load, column in zip(loads, found.T, strict=True):
            u, reaction = column + prescribed, np.zeros(len(prescribed))
            reaction[unknowns] = (K @ u - load)[unknowns]
            solutions.append(Solved(problem=self, load=load, u=u.reshape(-1, 3), reaction=reaction.reshape(-1, 3)))
        return solutions


@dataclass(frozen=True, kw_only=True, eq=False)
class Solved:
    """Displacements (n, 3), reactions (n, 3) and what follows from them."""

    problem: Problem
    load: np.ndarray
    u: np.ndarray
    reaction: np.ndarray

    def __post_init__(self):
        """Loads and reactions must balance, in force and in moment, whatever the benchmark."""
        p = self.problem
        size = np.ptp(p.space.nodes, axis=0).max()
        loads = np.stack([self.load, self.reaction.ravel()])
        motions = rigid_motions(p.space.nodes, p.space.nodes.mean(axis=0)).reshape(6, -1)
        motions[3:] /= size
        scale = np.abs(motions) @ np.abs(loads).sum(axis=0)
        assert (np.abs(motions @ loads.sum(axis=0)) <= 1e-7 * scale.max()).all()

    @property
    def unknowns(self):
        return self.problem.space.unknowns

    @property
    def energy(self):
        """Strain energy, for loads without prescribed displacements other than zero."""
        return float(self.u.ravel() @ self.load) / 2.0

    @property
    def estimate(self):
        """Recovery-based estimate of the error."""
        p = self.problem
        return estimate_error(self.field, self.u, E=p.E, nu=p.nu)

    def true_error(self, exact):
        """Energy norm of the error against an exact stress (..., 6) at points (..., 3)."""
        p = self.problem
        x, weights, own = element_stress(p.space, self.u, p.E, p.nu)
        return float(np.sqrt((weights * energy_density(exact(x) - own, p.E, p.nu)).sum()))

    @cached_property
    def field(self):
        return stress_field(self.problem.space, self.u, E=self.problem.E, nu=self.problem.nu)

    def mean(self, name):
        """Mean displacement (3,) of a surface."""
        return surface_quadrature(self.problem.space, name).mean(self.u)


@dataclass(frozen=True, kw_only=True)
class Reading:
    """A number read off a solution; ``nodes`` where a stress was read, None for a displacement."""

    value: float
    nodes: np.ndarray | None = None


@dataclass(frozen=True, kw_only=True)
class Study:
    """A quantity on three meshes: what the program says of its error, and the truth.

    trust       share of the target by which it may itself be off
    unknowns    of the three meshes
    band        of the grid convergence, on the finest of the three
    alone       estimated over true error in the energy norm, mesh by mesh, each by itself
    estimates   the same with the factor that the energies of two meshes give
    """

    quantity: str
    target: float
    trust: float
    unknowns: tuple[int, ...]
    band: GridConvergence
    alone: tuple[float, ...]
    estimates: tuple[float, ...]

    @property
    def error(self):
        return self.band.value / self.target - 1.0

    @property
    def width(self):
        return (self.band.high - self.band.low) / abs(self.target)

    def check(self):
        doubt = self.trust * abs(self.target)
        assert self.band.low - doubt <= self.target <= self.band.high + doubt, f"{self.quantity}: outside of the band"
        if abs(self.error) > 0.01:
            assert self.width <= 4.0 * abs(self.error), f"{self.quantity}: the band is too wide"
        for ratio in self.estimates:
            assert 0.5 <= ratio <= 2.0, f"{self.quantity}: the energy estimate is off"


@dataclass(frozen=True, kw_only=True)
class Benchmark:
    """One published problem.

    solve      mesh density n -> one solution per load, each with quantity -> what was read off it
    targets    quantity -> (value, unit)
    coarse     density for every run of the tests; ``series`` three for the error band; ``converged`` one above them
    within     level -> largest relative error of every quantity; levels "coarse" and "converged"
    source     of the targets
    remark     on the difference that is left
    trust      quantity -> share of the target by which it may be off: its last digit, or another model
    stress     exact stress (..., 6) at points (..., 3), where there is one
    finite_energy  False where a support is not well posed, so that there is no true error to compare with
    """

    name: str
    source: str
    solve: Callable[[int], list[tuple[Solved, dict[str, Reading]]]]
    targets: dict[str, tuple[float, str]]
    coarse: int
    series: tuple[int, int, int]
    converged: int
    within: dict[str, float]
    remark: str = ""
    trust: dict[str, float] = field(default_factory=dict)
    stress: Callable[[np.ndarray], np.ndarray] | None = None
    finite_energy: bool = True

    def __str__(self):
        return self.name

    def run(self, level):
        """Unknowns, and quantity -> value, on the mesh of a level."""
        cases = self.solve(self.coarse if level == "coarse" else self.converged)
        return cases[0][0].unknowns, {name: read.value for _, reads in cases for name, read in reads.items()}

    def check(self, level):
        _, found = self.run(level)
        assert set(found) == set(self.targets)
        for quantity, (target, _) in self.targets.items():
            assert found[quantity] == pytest.approx(target, rel=self.within[level]), f"{self.name}: {quantity}"

    def studies(self):
        """What the program says of its error on the series, quantity by quantity."""
        meshes = [self.solve(n) for n in self.series]
        best = self.solve(self.converged)
        found = []
        for case, (finest, reads) in enumerate(meshes[-1]):
            errors = [mesh[case][0].estimate for mesh in meshes]
            if not self.finite_energy:
                errors, true = errors[-1:], []
            elif self.stress is not None:
                true = [mesh[case][0].true_error(self.stress) for mesh in meshes]
            else:
                energies = [mesh[case][0].energy for mesh in (*meshes, best)]
                limit = _limit([1.0 / n for n in (*self.series, self.converged)][-3:], energies[-3:])
                true = [np.sqrt(2.0 * (limit - energy)) for energy in energies[:-1]]
            alone = tuple(float(e.total / t) for e, t in zip(errors, true, strict=self.finite_energy))
            factors = _factors([e.total for e in errors], [mesh[case][0].energy for mesh in meshes])
            for quantity, read in reads.items():
                values = [mesh[case][1][quantity].value for mesh in meshes]
                if read.nodes is None:
                    missing = relative_error(max(1.0, factors[-1]) * errors[-1].total, errors[-1].energy_norm)
                    estimate = 2.0 * missing**2 * abs(read.value)
                else:
                    beside = np.isin(finest.problem.space.cells, read.nodes).any(axis=1)
                    estimate = float(errors[-1].stress[beside].max())
                band = grid_convergence([1.0 / n for n in self.series], values, estimate=estimate)
                found.append(
                    Study(
                        quantity=quantity,
                        target=self.targets[quantity][0],
                        trust=self.trust.get(quantity, 0.0),
                        unknowns=tuple(mesh[case][0].unknowns for mesh in meshes),
                        band=band,
                        alone=alone,
                        estimates=tuple(a * f for a, f in zip(alone, factors, strict=False)),
                    )
                )
        return found


def _factors(estimates, energies):
    """Factor of every mesh by its own and the next coarser one; the first has that of the first two."""
    found = [energy_factor(estimates[:end], energies[:end]) for end in range(2, len(estimates) + 1)]
    return [factor or 1.0 for factor in (*found[:1], *found)]


def _limit(sizes, energies):
    """Strain energy extrapolated with the observed order: it rises to that of the true solution."""
    order = observed_order(sizes, energies)
    assert order is not None
    return energies[-1] + (energies[-1] - energies[-2]) / ((sizes[-2] / sizes[-1]) ** order - 1.0)
