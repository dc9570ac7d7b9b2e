"""What a link's result says about its meshes: the error that they leave, in numbers and in words."""

from dataclasses import dataclass
from typing import Literal

from fea.convergence import GridConvergence
from fea.refinement import MeshRecord, RefinedSolid
from fea.singular import SharpPeak

Status = Literal["converged", "decided", "far", "not reached", "singular", "growing"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Discretisation:
    """How precise the deciding stress of a link is under one load case.

    status        "converged": within the accuracy on at least three meshes; "decided": not that narrow, but the
                  verdict is clear; "far": one mesh, every limit far away; "not reached": a limit of the run ended
                  the refinement first; "singular", "growing": the peak has no limit, and no safety factor
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
        """False where the peak has no limit, so that no number stands for it."""
        return self.status not in ("singular", "growing")

    @property
    def sentence(self) -> str:
        """The state of convergence, for people."""
        series = self.stress
        if self.sharp is not None:
            return self.sharp.sentence
        count = len(self.meshes)
        if self.status == "growing":
            return (
                f"the peak stress still grows as fast after {count} meshes as before ({self._values} MPa), so it has "
                f"no safety factor; {self.stopped or 'refine further'}"
            )
        if self.status == "far":
            return (
                f"one mesh of {self.meshes[-1].elements:,} elements, whose estimated error, taken fourfold, is "
                f"{series.index:.0%} of the peak: every limit is further away than twice that band"
            )
        order = "" if series.order is None else f", observed order {series.order:.1f}"
        found = (
            f"{count} meshes, the finest of {self.meshes[-1].elements:,} elements: peak {self._values} MPa{order}, "
            f"error at most {series.index:.1%} (factor {series.factor:g})"
        )
        if self.status == "converged":
            return f"{found}: converged"
        if self.status == "decided":
            return f"{found}, more than the {self.accuracy:.1%} aimed at, but the verdict is clear"
        return f"{found}, more than the {self.accuracy:.1%} asked for: {self.stopped}"

    @property
    def _values(self) -> str:
        return ", ".join(f"{value:.3g}" for value in self.stress.values)


def holds(series: GridConvergence) -> str:
    """What a band of this series says that it holds."""
    if series.kind == "one mesh":
        return "discretisation (estimated on one mesh, fourfold)"
    count = len(series.values)
    return f"discretisation (grid convergence over {count} meshes, factor {series.factor:g})"


def judged(refined: RefinedSolid, number: int, *, brittle: bool) -> Discretisation:
    """Say how precise case ``number`` of a solution is; the principal stress decides where ``brittle``."""
    case = refined.precision[number]
    stress = case.principal if brittle else case.von_mises
    status: Status
    if case.sharp is not None:
        status = "singular"
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
