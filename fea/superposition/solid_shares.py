"""What the ways of sharing couples between layers make of a link that is solved as a solid: the peaks of each way.

Every way has wrenches of its own on the link, under which the peak may lie elsewhere and pins press otherwise. So no
peak is scaled by the stress of beams: the loads of all ways, under all pressures of pins and transfers of torque, are
solved on the link's finest mesh. The problem is linear and most of these loads are sums of a few, which their
Gram matrix tells; one factorisation serves them. What comes out are factors on the band that the link
has with tight pins, for each number that is judged. Where the peak of a way lies at a place that no mesh was refined
for, the fourfold estimate there counts beside the factor.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import COUPLES
from alula.fea.elements.supports import LineReference
from alula.fea.refine.convergence import ALONE
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.solid.solution import solve_free
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.peaks import ModeMeasures, largest_stress
from alula.fea.superposition.unit_solutions import nodal_stress
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW, WIDE, Span

Real = NDArray[np.float64]
Shares = Mapping[PeakQuantity, Scatter]
"""By what the numbers of a link may differ."""
Plates = tuple[LinkLoads, ...]
"""What acts on a link, or on each plate of a pair, in one way of sharing."""

LEFT_OUT = 1e-5
"""Norm of the nodal forces that a mode left out may have in loads, over that of the largest mode."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Modes:
    """Fields of a link, and what they add up to under N loads.

    Attributes
    ----------
    ways : ndarray of int, shape (N,)
        Which way of sharing each load is of; 0 with tight pins.
    spans : sequence of Span
        Of the pins' pressure.
    displacement : ndarray, shape (3 nodes, modes)
        [mm]
    combination : ndarray, shape (modes, N)
    """

    ways: NDArray[np.int64]
    spans: Sequence[Span]
    displacement: Real
    combination: Real


def solid_shares(
    task: LinkTask, refined: RefinedSolid, ways: Sequence[Plates], *, threads: int | None = None
) -> Shares:
    """Return by what the numbers of a solved link may differ since nobody states how pins share couples.

    Parameters
    ----------
    task : LinkTask
        What was solved.
    refined : RefinedSolid
        Its meshes; solved under what the first of ``ways`` holds, or about that.
    ways : sequence of Plates
        What acts on the link: with tight pins first, then in every way of sharing.
    threads : int or None, optional

    Returns
    -------
    mapping of PeakQuantity to Scatter

    Raises
    ------
    CannotRunError
        Where memory does not suffice or a solver fails.
    """
    modes = _solved(task, refined, ways, threads)
    space, E, nu = refined.solution.space, refined.solution.E, refined.solution.nu
    stress = nodal_stress(space, modes.displacement, E=E, nu=nu)
    names = {plate.name for plate in ways[0]}
    own = [one for one, case in zip(refined.precision, refined.solution.cases, strict=True) if case.load in names]
    measures = ModeMeasures.of(stress)
    found: dict[PeakQuantity, Scatter] = {"displacement": _factors(_displacements(task, refined, modes), modes.ways)}
    wanted: list[PeakQuantity] = [*STRESS.values(), *(("layers",) if task.layers is not None else ())]
    for quantity in wanted:
        layers = task.layers if quantity == "layers" else None
        parts = measures if layers is None else ModeMeasures.of(stress, layers)
        peaks = largest_stress(parts, modes.combination, brittle=quantity == "principal", layers=layers)
        plain = _factors(peaks.value, modes.ways)
        tops = [one.high(quantity) for one in own]
        largest = int(np.argmax(peaks.value))
        most = plain.high
        if modes.ways[largest] and tops and np.isfinite(max(tops)) and max(tops) > 0.0:
            sensitivity = layers.sensitivity if layers is not None else 1.0
            error = sensitivity * _error(refined, modes, largest, int(peaks.node[largest]))
            contact = 1.0 - CONTACT_SHORTFALL if modes.spans[largest] == NARROW.span else 1.0
            most = max(most, (float(peaks.value[largest]) + error) / contact / max(tops))
        found[quantity] = Scatter(low=plain.low, high=most, sources=COUPLES)
    return found


def _solved(task: LinkTask, refined: RefinedSolid, ways: Sequence[Plates], threads: int | None) -> _Modes:
    space = refined.solution.space
    numbers, spans, columns = zip(*_loads(task, refined, ways), strict=True)
    memory.require(
        8.0 * len(columns) * (4.0 * space.unknowns + 6.0 * len(space.nodes)),
        f"the stress of {len(ways)} ways of sharing couples at {len(space.nodes):,} nodes",
        None,
    )
    loads = np.array(columns)
    size = np.linalg.norm(loads, axis=1)
    loads /= size[:, None]
    values, vectors = np.linalg.eigh(loads @ loads.T)  # the loads are sums of the eigenvectors' sums of loads
    kept = values > LEFT_OUT**2 * values[-1]
    free = solve_free(space, (vectors[:, kept].T @ loads).T, E=task.E, nu=task.nu, threads=threads)
    return _Modes(
        ways=np.array(numbers),
        spans=spans,
        displacement=free.displacement,
        combination=(size[:, None] * vectors[:, kept]).T,
    )


def _loads(task: LinkTask, refined: RefinedSolid, ways: Sequence[Plates]) -> Iterator[tuple[int, Span, Real]]:
    """Yield number of the way, span of the pressure and load vector, of all variants."""
    every = [(number, plate.chosen(None)) for number, plates in enumerate(ways) for plate in plates]
    tractions = LinkTractions.of(refined.solution.space, [plate for _, plate in every], density=task.density)
    for number, plate in every:
        for variant in tractions.variants(plate, (WIDE, NARROW), TRANSFERS):
            yield number, variant.span, variant.load


def _displacements(task: LinkTask, refined: RefinedSolid, modes: _Modes) -> Real:
    """Largest displacements (N,) relative to the line through the link's first and last pin [mm]."""
    reference = LineReference(refined.solution.space, task.line)
    fields = np.array([reference.relative(mode.reshape(-1, 3)).ravel() for mode in modes.displacement.T])
    moved = [modes.combination.T @ fields[:, axis::3] for axis in range(3)]
    return np.asarray(np.sqrt(sum(part**2 for part in moved)).max(axis=1))


def _factors(values: Real, ways: NDArray[np.int64]) -> Scatter:
    """Least and largest value of all ways over those with tight pins; plates of a pair count by the worse one."""
    tight, other = values[ways == 0], values[ways != 0]
    if not tight.min() > 0.0:
        raise CannotRunError("a link without stress shares no couples")
    low, high = float(other.min() / tight.min()), float(other.max() / tight.max())
    return Scatter(low=min(low, 1.0), high=max(high, 1.0), sources=COUPLES)


def _error(refined: RefinedSolid, modes: _Modes, load: int, node: int) -> float:
    """Fourfold estimate of the error of stress beside a node, on the finest mesh alone [MPa]."""
    solution = refined.solution
    field = (modes.displacement @ modes.combination[:, load]).reshape(-1, 3)
    estimate = estimate_error(
        stress_field(solution.space, field, E=solution.E, nu=solution.nu), field, E=solution.E, nu=solution.nu
    )
    beside = (solution.space.cells == node).any(axis=1)
    return ALONE * float(estimate.stress[beside].max())
