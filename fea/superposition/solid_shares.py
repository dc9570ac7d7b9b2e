"""What the answers of causes make of a link that is solved as a solid: the peaks of each answer.

Every answer has wrenches of its own on the link (in other air, with other friction, with pins that stand or tilt
otherwise), under which the peak may lie elsewhere and pins press otherwise. So no peak is scaled by the stress of
beams: the loads of all answers, under all pressures of pins and transfers of torque, are solved on the link's finest
mesh. What comes out are factors on the band that the link has as stated, for each number that is judged. Where the peak
of an answer lies at a place that no mesh was refined for, the fourfold estimate there counts beside the factor.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.scatter import Scatter
from alula.fea.elements.space import DisplacementSpace
from alula.fea.refine.link_series import STRESS, CasePrecision, PeakQuantity
from alula.fea.refine.link_task import ElasticLink, LinkTask
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.superposition.link_answers import LinkAnswers, Rule
from alula.fea.superposition.link_measure import LinkMeasure, StatePeaks
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.kept import kept

Real = NDArray[np.float64]
Shares = Mapping[PeakQuantity, Scatter]
"""By what the numbers of a link may differ."""


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
    solved = tuple(one.load for one in refined.solution.cases)
    return _shares(task.link, refined.solution.space, solved, refined.precision, tuple(causes), threads=threads)


@kept(but=("threads",))
def _shares(
    link: ElasticLink,
    space: DisplacementSpace,
    solved: tuple[str, ...],
    precision: tuple[CasePrecision, ...],
    causes: tuple[LinkAnswers, ...],
    *,
    threads: int | None,
) -> tuple[Shares, ...]:
    """As ``solid_shares``, of a link on its finest mesh; ``solved`` are the names of loads whose precision is given."""
    every = [(i, j, plate) for i, cause in enumerate(causes) for j, way in enumerate(cause.every) for plate in way]
    measure = LinkMeasure.of_loads(link, space, [plate for *_, plate in every], threads=threads)
    of_cause, answers = np.array([every[one.record][:2] for one in measure.variants]).T
    wanted: list[PeakQuantity] = ["displacement", *STRESS.values(), *(("layers",) if link.layers is not None else ())]
    found: list[dict[PeakQuantity, Scatter]] = [{} for _ in causes]
    for quantity in wanted:
        peaks = measure.peaks(quantity)
        for number, cause in enumerate(causes):
            own = np.flatnonzero(of_cause == number)
            rule = cause.displacement if quantity == "displacement" else cause.stress
            factors, largest = _factors(peaks.value[own], answers[own], rule), int(own[np.argmax(peaks.value[own])])
            if quantity != "displacement" and answers[largest] > 0:
                most = _elsewhere(measure, zip(precision, solved, strict=True), quantity, peaks, cause, largest)
                factors = replace(factors, high=max(factors.high, most))
            found[number][quantity] = factors
    return tuple(found)


def _elsewhere(
    measure: LinkMeasure,
    precision: Iterable[tuple[CasePrecision, str]],
    quantity: PeakQuantity,
    peaks: StatePeaks,
    cause: LinkAnswers,
    largest: int,
) -> float:
    """Return a peak of another answer with its error, over the upper end as stated; 0 where that is unknown."""
    names = {plate.name for plate in cause.stated}
    tops = [one.high(quantity) for one, load in precision if load in names]
    if not tops or not 0.0 < max(tops) < np.inf:
        return 0.0
    return measure.ends(quantity, largest, int(peaks.node[largest]), float(peaks.value[largest]))[1] / max(tops)


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
