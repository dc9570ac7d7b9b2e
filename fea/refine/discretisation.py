"""What a link's result says about its meshes: the error that they leave, in numbers and in words."""

from dataclasses import dataclass
from typing import Literal

from fea.common.source import Source, SourceKind
from fea.refine.convergence import GridConvergence
from fea.refine.link_series import NOT_RESOLVED
from fea.refine.refinement import SERIES, MeshRecord, RefinedSolid
from fea.refine.singular import LOADED, SharpPeak

Status = Literal["converged", "decided", "far", "not reached", "unresolved", "edge", "singular", "growing"]
UNKNOWN: tuple[Status, ...] = ("unresolved", "edge", "singular", "growing")


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """How precise the deciding stress of a link is under one load case.

    status        "converged": within the accuracy on at least three meshes; "decided": not that narrow, but the
                  verdict is clear; "far": one mesh, every limit far away; "not reached": a limit of the run ended
                  the refinement first. Without safety factor: "unresolved": the mesh is too coarse for any estimate;
                  "edge": a sharp edge bears much and too few meshes tell whether its stress has a limit; "singular",
                  "growing": the peak has no limit
    accuracy      that was aimed at, relative
    stress        series of the deciding stress; ``displacement`` of the largest displacement
    meshes        of the link, coarse to fine
    sharp         the singular peak
    stopped       why refinement ended before its aim; "" where it did not
    """

    status: Status
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
                f"the mesh resolves nothing: its error is estimated at {self.meshes[-1].error:.0%} in the energy norm, "
                f"and estimates mean nothing above {NOT_RESOLVED:.0%}, so there are no numbers; {self._remedy}"
            )
        if self.sharp is not None:
            return self.sharp.sentence
        if self.status == "edge":
            return (
                f"a sharp inner edge bears at least {LOADED:.0%} of the peak, and meshes ({count}, where at least "
                f"{SERIES} are needed) do not tell yet whether its stress has a limit, so there is no safety factor; "
                f"state the real fillet_radius; {self._remedy}"
            )
        if self.status == "growing":
            return (
                f"the peak stress still grows as fast after {count} meshes as before ({self._values} MPa), by "
                f"{series.step:.0%} of itself in the last step, so it has no safety factor; {self._remedy}"
            )
        if self.status == "far":
            return (
                f"one mesh of {self.meshes[-1].elements:,} elements, whose estimated error, taken fourfold, is "
                f"{series.index:.0%} of the peak: every limit is further away than twice that band"
            )
        order = "" if series.order is None else f", observed order {series.order:.1f}"
        found = (
            f"{count} meshes, the finest of {self.meshes[-1].elements:,} elements: peak {self._values} MPa{order}, "
            f"error at most {series.index:.1%} ({series.rule})"
        )
        if self.status == "converged":
            return f"{found}: converged"
        if self.status == "decided":
            return f"{found}, more than the {self.accuracy:.1%} aimed at, but the verdict is clear"
        return f"{found}, more than the {self.accuracy:.1%} asked for: {self.stopped}"

    @property
    def _remedy(self) -> str:
        return f"refinement ended since {self.stopped}" if self.stopped else "refine further"

    @property
    def _values(self) -> str:
        return ", ".join(f"{value:.3g}" for value in self.stress.values)


def discretisation_source(series: GridConvergence, *, sharp_edges: int = 0) -> Source:
    """Return the source of error that a band of this series covers.

    Parameters
    ----------
    series : GridConvergence
    sharp_edges : int
        Of the link, where the band is of a stress.
    """
    if series.kind == "one mesh":
        text = "estimated on one mesh, fourfold"
    elif series.kind == "two meshes":
        width = "fourfold estimate" if series.multiple is not None else f"factor {series.factor:g}"
        text = f"two meshes, no observed order: {width}"
    else:
        text = f"grid convergence over {len(series.values)} meshes, {series.rule}"
    if sharp_edges:
        text += f"; without the stress at sharp edges ({sharp_edges}), below {LOADED:.0%} of the peak and without limit"
    return Source(kind=SourceKind.DISCRETISATION, detail=text)


def judged(refined: RefinedSolid, number: int, *, brittle: bool) -> Discretisation:
    """Say how precise case ``number`` of a solution is; the principal stress decides where ``brittle``."""
    case = refined.precision[number]
    stress = case.principal if brittle else case.von_mises
    status: Status
    if case.doubt == "coarse":
        status = "unresolved"
    elif case.sharp is not None:
        status = "singular"
    elif case.doubt == "edge":
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
