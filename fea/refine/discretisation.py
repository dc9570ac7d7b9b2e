"""What a link's result says about its meshes: the error that they leave, in numbers and in words."""

import math
from dataclasses import dataclass
from typing import Literal

from alula.fea.common.source import Source, SourceKind
from alula.fea.refine.convergence import SERIES, GridConvergence
from alula.fea.refine.link_series import NOT_RESOLVED, Measure
from alula.fea.refine.refinement import MeshRecord, RefinedSolid
from alula.fea.refine.singular import LOADED, SharpPeak

MeshStatus = Literal["converged", "decided", "far", "not reached", "unresolved", "edge", "singular", "growing"]
UNKNOWN: tuple[MeshStatus, ...] = ("unresolved", "edge", "singular", "growing")


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """How precise the deciding stress of a link is under one load case.

    Attributes
    ----------
    status : MeshStatus
        "converged": within the accuracy on at least three meshes; "decided": not that narrow, but clear of every limit;
        "far": one mesh, every limit far away; "not reached": a limit of the run ended the refinement first. Without
        safety factor: "unresolved": the mesh is too coarse for any estimate; "edge": a sharp edge bears much and too
        few meshes tell whether its stress has a limit; "singular", "growing": the peak has no limit.
    accuracy : float
        That was aimed at, relative.
    stress : GridConvergence
        Series of the deciding stress.
    displacement : GridConvergence
        Of the largest displacement.
    meshes : tuple of MeshRecord
        Of the link, coarse to fine.
    sharp : SharpPeak or None
        The singular peak.
    stopped : str
        Why refinement ended before its aim; "" where it did not.
    """

    status: MeshStatus
    accuracy: float
    stress: GridConvergence
    displacement: GridConvergence
    meshes: tuple[MeshRecord, ...]
    sharp: SharpPeak | None
    stopped: str

    @property
    def known(self) -> bool:
        """False where no number stands for the peak."""
        return self.status not in UNKNOWN

    @property
    def sentence(self) -> str:
        """The state of convergence, for people."""
        series = self.stress
        count = len(self.meshes)
        if self.status == "unresolved":
            return (
                f"mesh too coarse: estimated error {_percent(self.meshes[-1].error)} in the energy norm, limit "
                f"{_percent(NOT_RESOLVED)}. No stress is reported; {self._remedy}"
            )
        if self.sharp is not None:
            return self.sharp.sentence
        if self.status == "edge":
            return (
                f"a sharp inner edge bears at least {_percent(LOADED)} of the peak stress. Showing whether that "
                f"stress has a limit takes {SERIES} meshes, this run made {count}. No safety factor is reported; state "
                "the real fillet_radius (of a pocket: floor_radius; of a part from CAD: round it there); "
                f"{self._remedy}"
            )
        if self.status == "growing":
            return (
                f"the peak stress still grows after {count} meshes ({self._values} MPa), by {_percent(series.step)} in "
                f"the last step. No safety factor is reported; {self._remedy}"
            )
        if self.status == "far":
            return (
                f"one mesh of {self.meshes[-1].elements:,} elements was enough: its error ({_percent(series.index)}, "
                "with a fourfold margin) keeps clear of every limit"
            )
        order = "" if series.order is None else f", observed order {series.order:.1f}"
        meshes = "one mesh" if count == 1 else f"{count} meshes, the finest"
        found = (
            f"{meshes} of {self.meshes[-1].elements:,} elements: peak {self._values} MPa{order}, "
            f"error at most {_percent(series.index)} ({series.rule})"
        )
        if self.status == "converged":
            return f"{found}: converged"
        if self.status == "decided":
            return f"{found}, more than the {_percent(self.accuracy)} aimed at, but no limit lies within it"
        return f"{found}, more than the {_percent(self.accuracy)} asked for: {self.stopped}"

    @property
    def _remedy(self) -> str:
        return f"refinement ended because {self.stopped}" if self.stopped else "refine further"

    @property
    def _values(self) -> str:
        return ", ".join(f"{value:.3g}" for value in self.stress.values)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %"


def discretisation_source(series: GridConvergence, *, sharp_edges: int = 0) -> Source:
    """Return the source of error that a band of this series covers.

    Parameters
    ----------
    series : GridConvergence
        Of the number that has the band.
    sharp_edges : int, optional
        Number of re-entrant edges, where the band is of a stress.

    Returns
    -------
    Source
        With its words for people.
    """
    if series.kind == "one mesh":
        text = "estimated on one mesh, fourfold"
    elif series.kind == "two meshes":
        text = f"two meshes, no observed order: {series.rule}"
    else:
        text = f"grid convergence over {len(series.values)} meshes, {series.rule}"
    if sharp_edges:
        text += f"; without the stress at sharp edges ({sharp_edges}), below {LOADED:.0%} of the peak and without limit"
    width = series.high / series.low if series.low > 0.0 else math.inf
    return Source(kind=SourceKind.DISCRETISATION, detail=text, width=width)


def judged(refined: RefinedSolid, number: int, measure: Measure) -> Discretisation:
    """Say how precise a case of a solution is.

    Parameters
    ----------
    refined : RefinedSolid
        The link on its meshes.
    number : int
        Of the case among ``refined.precision``.
    measure : Measure
        The stress that decides.

    Returns
    -------
    Discretisation
        How precise it is.
    """
    case = refined.precision[number]
    stress = case.series(measure)
    status: MeshStatus
    if case.unreliable == "coarse":
        status = "unresolved"
    elif case.sharp is not None:
        status = "singular"
    elif case.unreliable == "edge":
        status = "edge"
    elif stress.kind == "growing":
        status = "growing"
    elif refined.far:
        status = "far"
    elif len(stress.values) >= 3 and stress.index <= refined.accuracy:
        status = "converged"
    else:
        status = "not reached" if refined.stopped else "decided"
    return Discretisation(
        status=status,
        accuracy=refined.accuracy,
        stress=stress,
        displacement=case.displacement,
        meshes=refined.meshes,
        sharp=case.sharp,
        stopped=refined.stopped,
    )
