"""The buckling factors of a link that is no beam, by its solid on one mesh."""

import math
from dataclasses import dataclass

from alula.fea.buckling.solid_holding import SolidHolding
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.nonlinear.large_displacement import LEAST_LINEAR
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.refine.link_series import CHORD
from alula.fea.refine.link_task import LinkTask
from alula.fea.solid.buckling_factor import BucklingProblem
from alula.fea.solid.solution import SolidCase, SolidSolution
from alula.fea.solid.stress import stress_field
from alula.geometry.base.errors import CannotRunError
from alula.geometry.keeping.kept import NotKept, kept
from alula.loads.records.bearing import WIDE

LARGEST_ERROR = 0.5
"""Share of a factor that a mesh may miss before the factor counts as unknown."""
TOO_COARSE = reason("mesh_too_coarse_for_buckling", error=LARGEST_ERROR)


@dataclass(frozen=True, kw_only=True)
class SolidBuckling:
    """Factors on a load case at which a link's solid buckles; infinite where none does, NaN where they are not known.

    Attributes
    ----------
    value : float
        Its rigid motions are taken by joints that stay where they are.
    least : float
        The least where the joints of a driven or a bonded link move as well.
    most : float
        Joints hold it as well as they can; infinite where the value is 3 or more, so that the link cannot fail.
    error : float
        Share of the factors by which the mesh may miss them.
    holding : Reason or str
        How joints hold it for ``value``; "" where they are not known.
    without : Reason or str
        Why they are not known; "" where they are.
    """

    value: float
    least: float
    most: float
    error: float
    holding: Reason | str = ""
    without: Reason | str = ""

    @classmethod
    def unknown(cls, why: Reason | str) -> "SolidBuckling":
        """Return what stands for factors that were not found.

        Parameters
        ----------
        why : Reason or str
            A text is that of an error.

        Returns
        -------
        SolidBuckling
        """
        return cls(value=math.nan, least=math.nan, most=math.nan, error=math.nan, without=why)


def link_buckling(solution: SolidSolution, task: LinkTask, chord: float) -> dict[str, SolidBuckling]:
    """Return the buckling factors of a link under each of its load cases.

    They are those under the pressure over 180°, with the first way in which the torque enters: the resultants decide,
    and not the stress beside the pins. The factor exceeds the true one by the square of the mode's error in the energy
    norm (Strang & Fix, An Analysis of the Finite Element Method, 1973, section 6.3), and the stress adds that of its
    own; the larger of both counts twice, as for displacements (``alula.fea.refine.link_series``).

    Parameters
    ----------
    solution : SolidSolution
        On one mesh.
    task : LinkTask
        With the way in which joints hold the link.
    chord : float
        Relative difference of volume between mesh and geometry.

    Returns
    -------
    dict of str to SolidBuckling
        By load case; empty where beams stand for the link.
    """
    return {} if task.holding is None else _buckling(solution, task.loads, task.holding, chord)


@kept()
def _buckling(
    solution: SolidSolution, loads: tuple[LinkLoads, ...], holding: SolidHolding, chord: float
) -> dict[str, SolidBuckling] | NotKept[dict[str, SolidBuckling]]:
    """As ``link_buckling``, of a link that joints hold; limits do not enter."""
    chosen = {case.load: case for case in reversed(solution.cases) if case.span == WIDE.span}
    try:
        problem = BucklingProblem(
            solution.space,
            holding.places,
            E=solution.E,
            nu=solution.nu,
            halved=all(case.symmetric for case in chosen.values()),
        )
        return {one.name: _factors(solution, problem, one, holding, chosen[one.name], chord) for one in loads}
    except CannotRunError as error:
        return NotKept({one.name: SolidBuckling.unknown(str(error)) for one in loads})


def _factors(
    solution: SolidSolution,
    problem: BucklingProblem,
    loads: LinkLoads,
    holding: SolidHolding,
    solved: SolidCase,
    chord: float,
) -> SolidBuckling:
    prestress = problem.prestress(solved.displacement, loads)
    stress = stress_field(solution.space, solved.displacement, E=solution.E, nu=solution.nu)
    found = [problem.least(prestress, conditions) for conditions in (holding.value, *holding.alone)]
    errors = [estimate_error(stress, solved.displacement, E=solution.E, nu=solution.nu).relative]
    for buckled in (buckled for buckled in found if math.isfinite(buckled.factor)):
        field = stress_field(solution.space, buckled.mode, E=solution.E, nu=solution.nu)
        errors.append(estimate_error(field, buckled.mode, E=solution.E, nu=solution.nu).relative)
    error = 2.0 * max(errors) ** 2 + CHORD * chord
    if error > LARGEST_ERROR:
        return SolidBuckling.unknown(TOO_COARSE)
    most = math.inf
    if holding.most is not None and found[0].factor < LEAST_LINEAR:
        most = problem.least(prestress, holding.most).factor
    return SolidBuckling(
        value=found[0].factor,
        least=min(buckled.factor for buckled in found),
        most=max(most, found[0].factor),
        error=error,
        holding=holding.how,
    )
