"""What the range of C_N of wings that flap makes of the numbers of a check, by hand calculation.

Statics, frame and the hand calculation of every link are done again at the ends of the range. Over the number as
stated, these are shares by which bands of all models are widened.

Forces without friction are affine in C_N. Hence stress, displacement and the inverse of a buckling factor are convex in
it: their largest is at an end, and for the least the ends and the stated C_N give a bound
(``alula.fea.common.alternatives``).
"""

from collections.abc import Mapping

from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.source import SourceKind, air_source
from alula.fea.doubts.other_case import Doubt
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.standing.case_statics import CaseStatics, alone, solve_case_statics
from alula.loads.states.flapping import in_air


def air_doubt(statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> Doubt | None:
    """Calculate a load case over the range of its C_N.

    Parameters
    ----------
    statics : CaseStatics
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it at the stated C_N.

    Returns
    -------
    Doubt or None
        None where C_N has no range.
    """
    air = statics.case.load_cases[load_case].flapping
    if air is None or air.ends[0] == air.ends[1]:
        return None
    shares = (0.0, 1.0) if air.normal_coefficient not in air.ends else (0.0, 0.5, 1.0)
    others = [solve_case_statics(in_air(alone(statics.case, load_case), share)) for share in shares]
    stated = [other.case.load_cases[load_case].flapping for other in others]
    coefficients = (air.normal_coefficient, *(one.normal_coefficient for one in stated if one is not None))
    return Doubt.over(statics, load_case, moved, air_source(*air.ends), others, coefficients=coefficients)


def air_warnings(moved: Mapping[str, LargeDisplacement]) -> list[Reason]:
    """Return what the reader must know about the range of C_N.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> what became of it.

    Returns
    -------
    list of Reason
    """
    return [
        under_load_cases([load_case], reason("with_normal_coefficient", coefficient=coefficient, why=other.reason))
        for load_case, one in moved.items()
        if (air := one.by(SourceKind.AIR))
        for coefficient, other in zip(air.coefficients[1:], air.others, strict=True)
        if other.gives_way and not one.gives_way
    ]
