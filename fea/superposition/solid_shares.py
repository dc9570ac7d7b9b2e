"""What the answers of causes make of a link that is solved as a solid: the peaks of each answer.

Every answer has wrenches of its own on the link (in other air, with other friction, with pins that stand or tilt
otherwise), under which the peak may lie elsewhere and pins press otherwise. So no peak is scaled by the stress of
beams: the loads of all answers, under all pressures of pins and transfers of torque, are solved on the link's finest
mesh. What comes out are factors on the band that the link has as stated, for each number that is judged. Where the peak
of an answer lies at a place that no mesh was refined for, the fourfold estimate there counts beside the factor.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import Plates
from alula.fea.common.scatter import Scatter
from alula.fea.elements.space import DisplacementSpace
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.refine.link_task import ElasticLink, LinkTask
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.superposition.link_answers import LinkAnswers, Rule, on_band
from alula.fea.superposition.link_measure import LinkMeasure
from alula.geometry.base.errors import CannotRunError
from alula.geometry.keeping.kept import kept

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
    every = tuple(cause.every for cause in causes)
    alone = all(one.layers is None for one in refined.precision)
    found: list[dict[PeakQuantity, Scatter]] = []
    for cause, peaks in zip(
        causes, _peaks(task.link, refined.solution.space, every, alone, threads=threads), strict=True
    ):
        found.append({})
        for quantity, one in peaks.items():
            rule = cause.displacement if quantity == "displacement" else cause.stress
            factors = _factors(one.values, one.answers, rule)
            most = _elsewhere(refined, quantity, cause, one)
            found[-1][quantity] = replace(factors, high=max(factors.high, most))
    return tuple(found)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Peaks:
    """Peaks of a number in all answers of a cause.

    Attributes
    ----------
    values : ndarray, shape (k,)
        Of all answers under all pressures of pins and transfers of torque.
    answers : ndarray of int, shape (k,)
        To which each belongs; 0 as stated.
    elsewhere : float
        The largest with its error, where it is a stress of another answer; else 0.
    stated : float
        The largest as stated with its error, by the same estimate, of layers without a series of meshes.
    """

    values: Real
    answers: NDArray[np.int64]
    elsewhere: float = 0.0
    stated: float = 0.0


@kept(but=("threads",))
def _peaks(
    link: ElasticLink,
    space: DisplacementSpace,
    causes: tuple[tuple[Plates, ...], ...],
    alone: bool,  # layers have no series of meshes
    *,
    threads: int | None,
) -> tuple[dict[PeakQuantity, _Peaks], ...]:
    """Return the peaks of all answers of each cause on a mesh of the link; the rules of causes do not enter."""
    every = [(i, j, plate) for i, cause in enumerate(causes) for j, way in enumerate(cause) for plate in way]
    measure = LinkMeasure.of_loads(link, space, [plate for *_, plate in every], threads=threads)
    of_cause, answers = np.array([every[one.record][:2] for one in measure.variants]).T
    wanted: list[PeakQuantity] = ["displacement", *STRESS.values(), *(("layers",) if link.layers is not None else ())]
    found: list[dict[PeakQuantity, _Peaks]] = [{} for _ in causes]
    for quantity in wanted:
        peaks = measure.peaks(quantity)
        for number, told in enumerate(found):
            own = np.flatnonzero(of_cause == number)
            of_answers = _Peaks(values=peaks.value[own], answers=answers[own])
            largest = int(own[np.argmax(peaks.value[own])])
            if quantity != "displacement" and answers[largest] > 0:
                stated = own[answers[own] == 0]
                first = int(stated[np.argmax(peaks.value[stated])])
                loads = (largest, first) if alone and quantity == "layers" else (largest,)
                tops = [measure.ends(quantity, k, int(peaks.node[k]), float(peaks.value[k]))[1] for k in loads]
                of_answers = replace(of_answers, elsewhere=tops[0], stated=sum(tops[1:]))
            told[quantity] = of_answers
    return tuple(found)


def _elsewhere(refined: RefinedSolid, quantity: PeakQuantity, cause: LinkAnswers, peaks: _Peaks) -> float:
    """Return a peak of another answer with its error, over the upper end as stated; 0 where that is unknown.

    That end is of the link's meshes, or of the finest alone where they have no series of that number.
    """
    names = {plate.name for plate in cause.stated}
    own = [one for one, case in zip(refined.precision, refined.solution.cases, strict=True) if case.load in names]
    tops = [peaks.stated if getattr(one, quantity) is None else one.high(quantity) for one in own]
    return peaks.elsewhere / max(tops) if tops and 0.0 < max(tops) < np.inf else 0.0


def _factors(values: Real, answers: NDArray[np.int64], rule: Rule) -> Scatter:
    """What all answers make of a value; variants and plates of a pair count by the worst one, and by the best one."""
    each = [values[answers == number] for number in np.unique(answers)]
    if not each[0].max() > 0.0:
        raise CannotRunError("a link without stress has no share of one")
    return on_band(rule, [float(one.min()) for one in each], [float(one.max()) for one in each])
