"""A motion without the air in which its wings flap, and at either end of the range of their C_N.

Drive torque without friction is affine in C_N, its power likewise, and its peaks and root mean squares are convex in
it: over the range they are largest at an end.
"""

from collections.abc import Mapping
from functools import lru_cache

from alula.fea.whole.rubbed_motion import rubbed_motion
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.loads.states.flapping import in_air


@lru_cache(maxsize=4)
def air_range(moved: CaseMotion) -> AirRange | None:
    """Return a motion without air, and with the least and the largest C_N.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    AirRange or None
        None where no load case has air.
    """
    if all(load_case.flapping is None for load_case in moved.case.load_cases.values()):
        return None
    found: Mapping[float | None, CaseMotion] = {
        share: rubbed_motion(in_air(moved.case, share)) for share in (None, 0.0, 1.0)
    }
    return AirRange(stated=moved, without=found[None], least=found[0.0], largest=found[1.0])


def motion_in_air(case: Case) -> AirRange | None:
    """Return the motion of the load cases with air, and what it is without and at either end of the range of C_N.

    Parameters
    ----------
    case : Case

    Returns
    -------
    AirRange or None
        None without any, without a motion or a drive, and where the linkage does not get along it.
    """
    flapping = {name: one for name, one in case.load_cases.items() if one.flapping is not None}
    if not flapping or case.motion is None or case.drive is None:
        return None
    try:
        return air_range(rubbed_motion(case.model_copy(update={"load_cases": flapping})))
    except CaseError:  # ``alula motion`` says why
        return None
