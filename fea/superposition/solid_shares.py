"""What the answers of causes make of a link that is solved as a solid: the peaks of each answer.

Every answer has wrenches of its own on the link (in other air, with other friction, with pins that stand or tilt
otherwise), under which the peak may lie elsewhere and pins press otherwise. So no peak is scaled by the stress of
beams: the loads of all answers, under all pressures of pins and transfers of torque, are solved on the link's finest
mesh. The problem is linear and most of these loads are sums of a few, which their Gram matrix tells; one factorisation
serves them. What comes out are factors on the band that the link has as stated, for each number that is judged. Where
the peak of an answer lies at a place that no mesh was refined for, the fourfold estimate there counts beside the
factor.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.common.scatter import Scatter
from alula.fea.elements.supports import LineReference
from alula.fea.refine.convergence import ALONE
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.solid.solution import solve_free
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.link_answers import LinkAnswers, Plates, Rule
from alula.fea.superposition.peaks import ModeMeasures, Peaks, largest_stress
from alula.fea.superposition.unit_solutions import nodal_stress
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW, WIDE, Span

Real = NDArray[np.float64]
Shares = Mapping[PeakQuantity, Scatter]
"""By what the numbers of a link may differ."""

LEFT_OUT = 1e-5
"""Norm of the nodal forces that a mode left out may have in loads, over that of the largest mode."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Modes:
    """Fields of a link, and what they add up to under N loads.

    Attributes
    ----------
    answers : ndarray of int, shape (N,)
        Which answer each load is of, of all causes in a row.
    spans : sequence of Span
        Of the pins' pressure.
    displacement : ndarray, shape (3 nodes, modes)
        [mm]
    combination : ndarray, shape (modes, N)
    """

    answers: NDArray[np.int64]
    spans: Sequence[Span]
    displacement: Real
    combination: Real


def solid_shares(
    task: LinkTask, refined: RefinedSolid, causes: Sequence[LinkAnswers], *, threads: int | None = None
) -> tuple[Shares, ...]:
    """Return by what the numbers of a solved link may differ by causes that change what acts on it.

    Parameters
    ----------
    task : LinkTask
        What was solved.
    refined : RefinedSolid
        Its meshes; solved under what the causes hold as stated, or about that.
    causes : sequence of LinkAnswers
        At least one.
    threads : int or None, optional

    Returns
    -------
    tuple of mapping of PeakQuantity to Scatter
        Of each cause.

    Raises
    ------
    CannotRunError
        Where memory does not suffice or a solver fails.
    """
    modes = _solved(task, refined, [plates for cause in causes for plates in cause.every], threads)
    space, E, nu = refined.solution.space, refined.solution.E, refined.solution.nu
    stress = nodal_stress(space, modes.displacement, E=E, nu=nu)
    measures = ModeMeasures.of(stress)
    moved = _displacements(task, refined, modes)
    found: list[dict[PeakQuantity, Scatter]] = [
        {"displacement": _factors(moved[own], modes.answers[own], cause.displacement)}
        for cause, own in _each(causes, modes)
    ]
    wanted: list[PeakQuantity] = [*STRESS.values(), *(("layers",) if task.layers is not None else ())]
    for quantity in wanted:
        layers = task.layers if quantity == "layers" else None
        parts = measures if layers is None else ModeMeasures.of(stress, layers)
        peaks = largest_stress(parts, modes.combination, brittle=quantity == "principal", layers=layers)
        for shares, (cause, own) in zip(found, _each(causes, modes), strict=True):
            plain = _factors(peaks.value[own], modes.answers[own], cause.stress)
            most = max(plain.high, _elsewhere(task, refined, modes, quantity, peaks, cause, own))
            shares[quantity] = replace(plain, high=most)
    return tuple(found)


def _each(causes: Sequence[LinkAnswers], modes: _Modes) -> Iterator[tuple[LinkAnswers, NDArray[np.int64]]]:
    """Yield each cause with the numbers of its loads, as stated first."""
    first = 0
    for cause in causes:
        yield cause, np.flatnonzero((modes.answers >= first) & (modes.answers < first + len(cause.every)))
        first += len(cause.every)


def _elsewhere(
    task: LinkTask,
    refined: RefinedSolid,
    modes: _Modes,
    quantity: PeakQuantity,
    peaks: Peaks,
    cause: LinkAnswers,
    own: NDArray[np.int64],
) -> float:
    """Return the largest peak of another answer with its error, over the upper end as stated; 0 where none leads."""
    names = {plate.name for plate in cause.stated}
    precision = zip(refined.precision, refined.solution.cases, strict=True)
    tops = [one.high(quantity) for one, case in precision if case.load in names]
    largest = int(own[np.argmax(peaks.value[own])])
    stated = modes.answers[own[0]]
    if modes.answers[largest] == stated or not tops or not 0.0 < max(tops) < np.inf:
        return 0.0
    sensitivity = task.layers.sensitivity if quantity == "layers" and task.layers is not None else 1.0
    error = sensitivity * _error(refined, modes, largest, int(peaks.node[largest]))
    contact = 1.0 - CONTACT_SHORTFALL if modes.spans[largest] == NARROW.span else 1.0
    return (float(peaks.value[largest]) + error) / contact / max(tops)


def _solved(task: LinkTask, refined: RefinedSolid, ways: Sequence[Plates], threads: int | None) -> _Modes:
    space = refined.solution.space
    numbers, spans, columns = zip(*_loads(task, refined, ways), strict=True)
    memory.require(
        8.0 * len(columns) * (4.0 * space.unknowns + 6.0 * len(space.nodes)),
        f"the stress under {len(ways)} answers of what is in doubt at {len(space.nodes):,} nodes",
        None,
    )
    loads = np.array(columns)
    size = np.linalg.norm(loads, axis=1)
    loads /= size[:, None]
    values, vectors = np.linalg.eigh(loads @ loads.T)  # the loads are sums of the eigenvectors' sums of loads
    kept = values > LEFT_OUT**2 * values[-1]
    free = solve_free(space, (vectors[:, kept].T @ loads).T, E=task.E, nu=task.nu, threads=threads)
    return _Modes(
        answers=np.array(numbers),
        spans=spans,
        displacement=free.displacement,
        combination=(size[:, None] * vectors[:, kept]).T,
    )


def _loads(task: LinkTask, refined: RefinedSolid, ways: Sequence[Plates]) -> Iterator[tuple[int, Span, Real]]:
    """Yield number of the answer, span of the pressure and load vector, of all variants."""
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


def _factors(values: Real, answers: NDArray[np.int64], rule: Rule) -> Scatter:
    """What all answers make of a value; variants and plates of a pair count by the worst one, and by the best one.

    Where the best one is 0 as stated, as of an idle plate, nothing is known of the low end.
    """
    each = [values[answers == number] for number in np.unique(answers)]
    if not each[0].max() > 0.0:
        raise CannotRunError("a link without stress has no share of one")
    ends = [
        rule(float(first), list(map(float, rest)))
        for first, *rest in ([one.min() for one in each], [one.max() for one in each])
    ]
    low = min(ends[0].low, 1.0) if each[0].min() > 0.0 else 0.0
    return replace(ends[1], low=low, high=max(ends[1].high, 1.0))


def _error(refined: RefinedSolid, modes: _Modes, load: int, node: int) -> float:
    """Fourfold estimate of the error of stress beside a node, on the finest mesh alone [MPa]."""
    solution = refined.solution
    field = (modes.displacement @ modes.combination[:, load]).reshape(-1, 3)
    estimate = estimate_error(
        stress_field(solution.space, field, E=solution.E, nu=solution.nu), field, E=solution.E, nu=solution.nu
    )
    beside = (solution.space.cells == node).any(axis=1)
    return ALONE * float(estimate.stress[beside].max())
