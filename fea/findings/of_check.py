"""What a report tells of a check besides the check itself: what would change it, its motion, air, the nearest harmonic.

It is found once, before anything is told. A check by itself, of which a study runs thousands, leaves it out.
"""

from dataclasses import replace

from alula.fea.outcomes.result import CheckResult
from alula.fea.sizing.changes import changes
from alula.fea.vibration.harmonics import nearest_harmonic
from alula.fea.whole.air_range import motion_in_air
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import Motion
from alula.loads.states.clearance import way_of


def with_findings(result: CheckResult) -> CheckResult:
    """Return a check with what a report tells besides.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    CheckResult
        With ``changes``, ``motion``, ``in_air`` and ``harmonic``.
    """
    found = replace(result, changes=changes(result), motion=_motion(result), in_air=motion_in_air(result.case))
    return with_harmonic(found)


def with_harmonic(result: CheckResult) -> CheckResult:
    """Return a check with what its caveats say of vibration.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    CheckResult
        With ``harmonic``.
    """
    return replace(result, harmonic=nearest_harmonic(result.case))


def _motion(result: CheckResult) -> Motion | None:
    """Return the motion of a case that was checked; None without one, and where the linkage does not get along it."""
    case = result.case
    if result.clearance is not None and result.clearance.motion is not None:
        return result.clearance.motion
    if not case.sweeps:
        return None
    try:
        return way_of(case, result.pose)
    except CaseError:
        return None
