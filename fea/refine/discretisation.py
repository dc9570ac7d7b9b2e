"""What a link's result says about its meshes: the error that they leave, in numbers, and why no more is known."""

import math
from dataclasses import dataclass
from typing import Literal

from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.refine.convergence import SERIES, GridConvergence
from alula.fea.refine.link_series import NOT_RESOLVED, Measure
from alula.fea.refine.refinement import NONE_DECIDES, MeshRecord, RefinedSolid
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
    stopped : Reason or None
        Why refinement ended before its aim; None where it did not.
    """

    status: MeshStatus
    accuracy: float
    stress: GridConvergence
    displacement: GridConvergence
    meshes: tuple[MeshRecord, ...]
    sharp: SharpPeak | None
    stopped: Reason | None

    @property
    def known(self) -> bool:
        """False where no number stands for the peak."""
        return self.status not in UNKNOWN

    @property
    def reason(self) -> Reason:
        """The state of convergence."""
        series, finest, count = self.stress, self.meshes[-1], len(self.meshes)
        remedy = reason("refine_further") if self.stopped is None else reason("refinement_ended", why=self.stopped)
        if self.status == "unresolved":
            return reason("mesh_too_coarse", error=finest.error, limit=NOT_RESOLVED, remedy=remedy)
        if self.sharp is not None:
            return self.sharp.reason
        if self.status == "edge":
            return reason("sharp_edge_bears_much", least=LOADED, wanted=SERIES, made=count, remedy=remedy)
        if self.status == "growing":
            return reason("peak_still_grows", made=count, values=series.values, step=series.step, remedy=remedy)
        if self.status == "far":
            return reason("one_mesh_was_enough", elements=finest.elements, error=series.index)
        found = reason(
            "error_of_meshes",
            made=count,
            elements=finest.elements,
            values=series.values,
            order=series.order,
            error=series.index,
            rule=series.rule,
        )
        if self.status == "converged":
            return reason("meshes_converged", found=found)
        if self.status == "decided":
            return reason("meshes_decided", found=found, aim=self.accuracy)
        return reason("meshes_stopped", found=found, aim=self.accuracy, why=self.stopped)


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
    """
    if series.kind == "one mesh":
        detail = reason("estimated_on_one_mesh")
    elif series.kind == "two meshes":
        detail = reason("two_meshes", rule=series.rule)
    else:
        detail = reason("grid_convergence", meshes=len(series.values), rule=series.rule)
    if sharp_edges:
        detail = reason("without_sharp_edges", found=detail, edges=sharp_edges, most=LOADED)
    width = series.high / series.low if series.low > 0.0 else math.inf
    return Source(kind=SourceKind.DISCRETISATION, detail=detail, width=width)


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
    stopped = refined.stopped or (NONE_DECIDES if number in refined.beyond else None)
    status: MeshStatus
    if case.unreliable == "coarse":
        status = "unresolved"
    elif case.sharp is not None:
        status = "singular"
    elif case.unreliable == "edge":
        status = "edge"
    elif stress.kind == "growing":
        status = "growing"
    elif refined.far and number not in refined.beyond:
        status = "far"
    elif len(stress.values) >= 3 and stress.index <= refined.accuracy:
        status = "converged"
    else:
        status = "not reached" if stopped else "decided"
    return Discretisation(
        status=status,
        accuracy=refined.accuracy,
        stress=stress,
        displacement=case.displacement,
        meshes=refined.meshes,
        sharp=case.sharp,
        stopped=stopped,
    )
