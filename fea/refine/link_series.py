"""One link on successive meshes: what is kept of each, and how precise the finest one's numbers are."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fea.refine.convergence import LEAST_RATIO, GridConvergence, grid_convergence
from fea.refine.error_estimate import ErrorEstimate, energy_factor, estimate_error, relative_error
from fea.refine.singular import ON_EDGE, SharpPeak, edge_distance, loaded_edge, sharp_peak
from fea.refine.target_sizes import LocalGoal
from fea.solid.solution import SolidSolution
from fea.solid.stress import stress_field
from geometry.meshing.mesh import ReentrantEdge
from loads.records.bearing import CONTACT_SHORTFALL, NARROW, Span

DISPLACEMENT_ORDER = 3.0
"""Of the displacements of quadratic elements."""
CHORD = 2.0
"""Relative error of a bending stiffness over that of the volume, on a mesh whose straight sides cut corners."""
NOT_RESOLVED = 0.3
"""Relative error in the energy norm above which nothing is said: estimates and orders are asymptotic. Curved elements
25 diameters long left a tube 55 % too stiff, where a band of the estimate (0.53, hence 28 %) would have missed it."""
_EDGE = (6.0 * np.sqrt(2.0)) ** (1.0 / 3.0)  # edge of a regular tetrahedron over the cube root of its volume
_NEIGHBOURS = 8
AROUND = 1.5
"""Radius about a peak, in sizes of the first mesh, in which a series measures its sizes and the next mesh is finer."""


Quantity = Literal["von_mises", "principal", "displacement"]
Doubt = Literal["", "coarse", "edge"]


@dataclass(frozen=True, kw_only=True)
class Eye:
    """The disc about a pin within which its pressure rules: centre (x, y) and radius [mm]; drawn out along a slot."""

    x: float
    y: float
    radius: float
    slot: float = 0.0

    def holds(self, nodes: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie in it."""
        along = np.maximum(np.abs(nodes[:, 0] - self.x) - self.slot / 2.0, 0.0)
        return np.asarray(np.hypot(along, nodes[:, 1] - self.y) <= self.radius)


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseFigures:
    """One case on one mesh.

    von_mises, principal  nodal stresses (n,) [MPa]
    estimate              of its error; ``energy`` its strain energy [N mm]
    displacement          the largest [mm]
    span                  of the pins' pressure [degrees]
    """

    von_mises: NDArray[np.float64]
    principal: NDArray[np.float64]
    estimate: ErrorEstimate
    energy: float
    displacement: float
    span: Span


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

    edge        the stress where a sharp edge bears most; None without an edge that bears much
    sharp       the singular peak that the case has there; None where there is none
    doubt       why there is no band: "coarse" where the mesh resolves nothing; "edge" where a sharp edge bears much and
                the meshes do not tell yet whether its stress has a limit, which leaves displacements alone
    in_contact  quantity -> largest stress in the eyes [MPa], with what contact adds to the narrow pressure's; 0 under
                the wide one
    """

    von_mises: GridConvergence
    principal: GridConvergence
    displacement: GridConvergence
    edge: GridConvergence | None
    sharp: SharpPeak | None
    doubt: Doubt
    in_contact: Mapping[Quantity, float]

    def series(self, quantity: Quantity) -> GridConvergence:
        """The series of a quantity."""
        found: GridConvergence = getattr(self, quantity)
        return found

    def known(self, quantity: Quantity) -> bool:
        """False where no number stands for the quantity."""
        if self.doubt == "coarse" or self.series(quantity).kind == "growing":
            return False
        return quantity == "displacement" or (self.sharp is None and self.doubt == "")

    def low(self, quantity: Quantity) -> float:
        """Lower end of the band, not below zero."""
        return max(self.series(quantity).low, 0.0) if self.known(quantity) else -math.inf

    def high(self, quantity: Quantity) -> float:
        """Upper end of the band: of the meshes and, for what an eye bears, of pin contact on top."""
        if not self.known(quantity):
            return math.inf
        series = self.series(quantity)
        contact = self.in_contact.get(quantity, 0.0)
        return max(series.high, contact * series.high / series.value if series.value > 0.0 else 0.0)


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
                energy=case.strain_energy,
                displacement=case.displacement_max,
                span=case.span,
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


def precision(
    levels: Sequence[Level], edges: Sequence[ReentrantEdge], *, section: float, eyes: Sequence[Eye]
) -> tuple[CasePrecision, ...]:
    """Judge every case on the meshes so far, coarse to fine.

    edges     re-entrant edges of the body; ``eyes`` of its pins
    section   smaller dimension of the link's section [mm]
    """
    return tuple(_case(levels, number, edges, section, eyes) for number in range(len(levels[-1].figures)))


def energy_errors(levels: Sequence[Level]) -> tuple[float, ...]:
    """Relative error in the energy norm of the worst case on each mesh, by the estimate and the energies so far."""
    return tuple(
        max(_energy_error(levels, number, end) for number in range(len(levels[-1].figures)))
        for end in range(1, len(levels) + 1)
    )


def _energy_error(levels: Sequence[Level], number: int, end: int) -> float:
    """Relative error of a case on mesh ``end``; the factor of the first mesh is that of the first two."""
    figures = [level.figures[number] for level in levels]
    pair = figures[max(0, end - 2) : max(2, end)]
    factor = energy_factor([f.estimate.total for f in pair], [f.energy for f in pair])
    estimate = figures[end - 1].estimate
    return relative_error((factor or 1.0) * estimate.total, estimate.energy_norm)


def goals(
    levels: Sequence[Level],
    allowed: float,
    *,
    brittle: bool,
    edges: Sequence[ReentrantEdge],
    section: float,
    ratios: Sequence[float],
) -> list[LocalGoal]:
    """Peaks, of the principal stress where ``brittle``, that are to be resolved to a relative estimate ``allowed``.

    To these come sharp edges that bear much stress, so that their growth shows.

    ratios   of the sizes about each case's peak, last mesh over next one
    """
    found, level = [], levels[-1]
    for figures, ratio in zip(level.figures, ratios, strict=True):
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
                ratio=ratio,
                radius=AROUND * levels[0].size(level.nodes[node]),
            )
            for node in nodes
            if stress[node] > 0.0
        ]
    return found


def _case(
    levels: Sequence[Level], number: int, edges: Sequence[ReentrantEdge], section: float, eyes: Sequence[Eye]
) -> CasePrecision:
    last = levels[-1]
    stresses = [level.figures[number].von_mises for level in levels]
    found = loaded_edge(edges, last.nodes, stresses[-1], section)
    edge_series = sharp = None

    def series(nodal: Sequence[NDArray[np.float64]], node: int) -> GridConvergence:
        on_edge = bool(edges) and edge_distance(edges, last.nodes[[node]]).min() <= ON_EDGE * section
        return _series(levels, number, nodal, node, sharp=on_edge)

    if found is not None:
        edge, node = found
        edge_series = series(stresses, node)
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
        von_mises=series(stresses, int(np.argmax(stresses[-1]))),
        principal=series(principal, int(np.argmax(principal[-1]))),
        displacement=_displacement(levels, number),
        edge=edge_series,
        sharp=sharp,
        doubt=_doubt(levels, number, edge_series),
        in_contact=_in_contact(last, number, eyes),
    )


def _doubt(levels: Sequence[Level], number: int, edge: GridConvergence | None) -> Doubt:
    # What the energies take off the estimate may be chance; what they add counts.
    if max(_energy_error(levels, number, len(levels)), levels[-1].figures[number].estimate.relative) > NOT_RESOLVED:
        return "coarse"
    return "edge" if edge is not None and edge.kind in ("one mesh", "two meshes", "growing") else ""


def _in_contact(level: Level, number: int, eyes: Sequence[Eye]) -> dict[Quantity, float]:
    """Largest stresses in the eyes over what contact leaves of them, under the narrow pressure."""
    figures = level.figures[number]
    if figures.span != NARROW.span or not eyes:
        return {}
    inside = np.any([eye.holds(level.nodes) for eye in eyes], axis=0)
    share = 1.0 - CONTACT_SHORTFALL
    return {
        "von_mises": float(figures.von_mises[inside].max()) / share,
        "principal": float(figures.principal[inside].max()) / share,
    }


def _series(
    levels: Sequence[Level], number: int, nodal: Sequence[NDArray[np.float64]], node: int, *, sharp: bool
) -> GridConvergence:
    """Series of a nodal stress about a node of the finest mesh; ``sharp`` where that lies on a re-entrant edge."""
    last = levels[-1]
    place = last.nodes[node]
    radius = levels[0].size(place)
    chosen = _falling([level.size(place, AROUND * radius) for level in levels])
    values = [float(nodal[i][levels[i].around(nodal[i], place, radius)]) for i, _ in chosen]
    error = float(last.figures[number].estimate.stress[(last.cells == node).any(axis=1)].max())
    missing = error + CHORD * last.chord * abs(values[-1])
    return grid_convergence([size for _, size in chosen], values, estimate=missing, sharp=sharp)


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
    """Series of the largest displacement; η² of the energy is missing, hence of the displacement; it counts twice.

    Where the energies find more error than the estimate, theirs counts.
    """
    chosen = _falling([level.mean_size for level in levels])
    last = levels[-1].figures[number]
    error = max(last.estimate.relative, _energy_error(levels, number, len(levels)))
    missing = 2.0 * error**2 + CHORD * levels[-1].chord
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
