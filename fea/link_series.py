"""One link on successive meshes: what is kept of each, and how precise the finest one's numbers are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.convergence import LEAST_RATIO, GridConvergence, grid_convergence
from fea.error_estimate import ErrorEstimate, estimate_error
from fea.singular import SharpPeak, loaded_edge, sharp_peak
from fea.solid import SolidSolution
from fea.stress import stress_field
from fea.target_sizes import LocalGoal
from geometry.mesh import ReentrantEdge

DISPLACEMENT_ORDER = 3.0
"""Of the displacements of quadratic elements."""
CHORD = 2.0
"""Relative error of a bending stiffness over that of the volume, on a mesh whose straight sides cut corners."""
_EDGE = (6.0 * np.sqrt(2.0)) ** (1.0 / 3.0)  # edge of a regular tetrahedron over the cube root of its volume
_NEIGHBOURS = 8


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseFigures:
    """One case on one mesh: nodal stresses (n,) [MPa], its estimated error, largest displacement [mm]."""

    von_mises: NDArray[np.float64]
    principal: NDArray[np.float64]
    estimate: ErrorEstimate
    displacement: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Level:
    """What is kept of one mesh.

    nodes      (n, 3) [mm]; cells (m, b)
    centres    (m, 3) of the elements [mm], volumes (m,) [mm³]
    chord      relative difference of volume between mesh and geometry
    figures    of every case, in the order of the solution's cases
    """

    nodes: NDArray[np.float64]
    cells: NDArray[np.int64]
    centres: NDArray[np.float64]
    volumes: NDArray[np.float64]
    chord: float
    figures: tuple[CaseFigures, ...]

    def size(self, place: NDArray[np.float64], radius: float = 0.0) -> float:
        """Mean element edge [mm] of the elements within a radius of a place, at least of the nearest few."""
        distance = np.linalg.norm(self.centres - place, axis=1)
        near = distance <= max(radius, float(np.partition(distance, _NEIGHBOURS)[_NEIGHBOURS]))
        return float(_EDGE * np.cbrt(self.volumes[near].mean()))

    @property
    def mean_size(self) -> float:
        """Element edge [mm] of the mean volume."""
        return float(_EDGE * np.cbrt(self.volumes.mean()))

    def around(self, nodal: NDArray[np.float64], place: NDArray[np.float64], radius: float) -> int:
        """Node of the largest value within a radius of a place, at least the nearest node."""
        distance = np.linalg.norm(self.nodes - place, axis=1)
        return int(np.argmax(np.where(distance <= max(radius, float(distance.min())), nodal, -np.inf)))


@dataclass(frozen=True, kw_only=True, eq=False)
class CasePrecision:
    """How far the numbers of one solved case are from their limits on ever finer meshes.

    edge    the stress where a sharp edge bears most; None without an edge that bears much
    sharp   the singular peak that the case has there; None where there is none
    """

    von_mises: GridConvergence
    principal: GridConvergence
    displacement: GridConvergence
    edge: GridConvergence | None
    sharp: SharpPeak | None


def level_of(solution: SolidSolution, volume: float) -> Level:
    """Condense a solution on a mesh of a body of that volume [mm³]."""
    space, figures = solution.space, []
    weights = np.empty(0)
    for case in solution.cases:
        field = stress_field(space, case.displacement, E=solution.E, nu=solution.nu)
        weights = field.weights.sum(axis=1)
        figures.append(
            CaseFigures(
                von_mises=field.von_mises,
                principal=field.principal[:, 0],
                estimate=estimate_error(field, case.displacement, E=solution.E, nu=solution.nu),
                displacement=case.displacement_max,
            )
        )
    return Level(
        nodes=space.nodes,
        cells=space.cells,
        centres=space.nodes[space.cells[:, :4]].mean(axis=1),
        volumes=weights,
        chord=abs(float(weights.sum()) / volume - 1.0),
        figures=tuple(figures),
    )


def precision(levels: Sequence[Level], edges: Sequence[ReentrantEdge], *, section: float) -> tuple[CasePrecision, ...]:
    """Judge every case on the meshes so far, coarse to fine.

    edges     re-entrant edges of the body
    section   smaller dimension of the link's section [mm]
    """
    return tuple(_case(levels, number, edges, section) for number in range(len(levels[-1].figures)))


def goals(
    level: Level, allowed: float, *, brittle: bool, edges: Sequence[ReentrantEdge], section: float
) -> list[LocalGoal]:
    """Peaks, of the principal stress where ``brittle``, that are to be resolved to a relative estimate ``allowed``.

    To these come sharp edges that bear much stress, so that their growth shows.
    """
    found = []
    for figures in level.figures:
        stress = figures.principal if brittle else figures.von_mises
        edge = loaded_edge(edges, level.nodes, figures.von_mises, section)
        nodes = {int(np.argmax(stress))} | ({edge[1]} if edge else set())
        found += [
            LocalGoal(
                location=level.nodes[node],
                value=float(stress[node]),
                stress=stress[level.cells].max(axis=1),
                estimate=figures.estimate.stress,
                allowed=allowed,
            )
            for node in nodes
            if stress[node] > 0.0
        ]
    return found


def _case(levels: Sequence[Level], number: int, edges: Sequence[ReentrantEdge], section: float) -> CasePrecision:
    last = levels[-1]
    stresses = [level.figures[number].von_mises for level in levels]
    found = loaded_edge(edges, last.nodes, stresses[-1], section)
    edge_series = sharp = None
    if found is not None:
        edge, node = found
        edge_series = _series(levels, number, stresses, node)
        sharp = sharp_peak(
            edge,
            edges,
            place=last.nodes[node],
            **_at_maximum(levels, stresses, node),
            nodes=last.nodes,
            von_mises=stresses[-1],
            section=section,
        )
    principal = [level.figures[number].principal for level in levels]
    return CasePrecision(
        von_mises=_series(levels, number, stresses, int(np.argmax(stresses[-1]))),
        principal=_series(levels, number, principal, int(np.argmax(principal[-1]))),
        displacement=_displacement(levels, number),
        edge=edge_series,
        sharp=sharp,
    )


def _series(levels: Sequence[Level], number: int, nodal: Sequence[NDArray[np.float64]], node: int) -> GridConvergence:
    """Series of a nodal stress about a node of the finest mesh."""
    last = levels[-1]
    place = last.nodes[node]
    radius = levels[0].size(place)
    chosen = _falling([level.size(place, 1.5 * radius) for level in levels])
    values = [float(nodal[i][levels[i].around(nodal[i], place, radius)]) for i, _ in chosen]
    error = float(last.figures[number].estimate.stress[(last.cells == node).any(axis=1)].max())
    return grid_convergence([size for _, size in chosen], values, estimate=error + CHORD * last.chord * abs(values[-1]))


def _at_maximum(levels: Sequence[Level], nodal: Sequence[NDArray[np.float64]], node: int) -> dict[str, list[float]]:
    """Largest values about a node of the finest mesh, and the sizes of the elements just there."""
    place = levels[-1].nodes[node]
    radius = levels[0].size(place)
    nodes = [level.around(values, place, radius) for level, values in zip(levels, nodal, strict=True)]
    return {
        "sizes": [level.size(level.nodes[number]) for level, number in zip(levels, nodes, strict=True)],
        "values": [float(values[number]) for values, number in zip(nodal, nodes, strict=True)],
    }


def _displacement(levels: Sequence[Level], number: int) -> GridConvergence:
    """Series of the largest displacement; η² of the energy is missing, hence of the displacement; it counts twice."""
    chosen = _falling([level.mean_size for level in levels])
    last = levels[-1].figures[number]
    missing = 2.0 * last.estimate.relative**2 + CHORD * levels[-1].chord
    return grid_convergence(
        [size for _, size in chosen],
        [levels[i].figures[number].displacement for i, _ in chosen],
        estimate=missing * last.displacement,
        formal_order=DISPLACEMENT_ORDER,
    )


def _falling(sizes: Sequence[float]) -> list[tuple[int, float]]:
    """Levels, up to the finest, whose sizes are far enough apart to count in a series."""
    chosen = [(len(sizes) - 1, sizes[-1])]
    for number in range(len(sizes) - 2, -1, -1):
        if sizes[number] >= LEAST_RATIO * chosen[0][1]:
            chosen.insert(0, (number, sizes[number]))
    return chosen
