"""What the friction that may be makes of the numbers of a check, by hand calculation.

Statics, frame and the hand calculation of every link are done again at the ends of what may be. Over the number as
stated, these are shares by which bands of all models are widened.

Two degrees before a linkage locks itself joint forces double where a coefficient grows by a quarter: no
slope tells. The ends are the least friction that may be, and the largest (``alula.fea.standing.rubbing``); the
coefficients of all joints are at the same end together. Where the linkage locks itself, no band of joint forces has an
end.
"""

from collections.abc import Mapping

from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.source import SourceKind, friction_source
from alula.fea.doubts.other_case import Doubt
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.standing.case_statics import CaseStatics, at_friction_ends
from alula.loads.case.joint_rules import friction_ranges


def friction_doubt(statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> Doubt | None:
    """Calculate a load case at both ends of what friction may be.

    Parameters
    ----------
    statics : CaseStatics
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it with the stated friction.

    Returns
    -------
    Doubt or None
        None where no joint rubs. Without end where the linkage locks itself with some of that friction.
    """
    others = at_friction_ends(statics, load_case)
    if not others:
        return None
    source, solved = friction_source(friction_ranges(statics.case)), [one for one in others if one is not None]
    return Doubt.over(statics, load_case, moved, source, solved, endless=len(solved) < len(others))


def friction_warnings(moved: Mapping[str, LargeDisplacement]) -> list[Reason]:
    """Return what the reader must know about the doubt in friction.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> what became of it.

    Returns
    -------
    list of Reason
    """
    return [
        under_load_cases([load_case], reason("locks_with_most_friction", friction=rubs.source.detail))
        for load_case, one in moved.items()
        if (rubs := one.by(SourceKind.FRICTION)) and rubs.endless
    ]
