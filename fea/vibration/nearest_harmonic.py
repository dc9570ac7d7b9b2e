"""How near a harmonic of the drive comes to the lowest natural frequency, told where no check asks for frequencies.

By the frame of centre lines in the stated pose alone: some 20 ms of processor time for a four-bar linkage.
"""

import math

from fea.vibration.frequency_outcomes import hertz, least_frequency, ordinal
from fea.vibration.harmonics import HIGHEST
from fea.vibration.over_motion import pose_frequencies
from geometry.base.errors import CannotRunError, CaseError
from loads.case.case import Case
from loads.records.check_spec import FrequencyCheck


def nearest_harmonic(case: Case) -> str:
    """Say which harmonic comes nearest to the lowest natural frequency in the pose, in a ratio.

    Parameters
    ----------
    case : Case

    Returns
    -------
    str
        Of the load case in which one comes nearest; "" where a check asks for frequencies, nothing drives, or no
        natural frequency is found.
    """
    if any(isinstance(check, FrequencyCheck) for check in case.checks.values()):
        return ""
    driven = {abs(one.speed): (name, one) for name, one in reversed(case.load_cases.items()) if one.speed != 0.0}
    try:
        found = pose_frequencies(case.model_copy(update={"load_cases": dict(driven.values())}), count=1)
    except (CannotRunError, CaseError):
        return ""
    nearest, told = math.inf, ""
    for history in found.values():
        frequency, driving = least_frequency(history), history.driving
        if not 0.0 < frequency.value < math.inf:
            continue
        far = [abs(math.log(n * driving / frequency.value)) for n in range(1, HIGHEST + 1)]
        harmonic = 1 + far.index(min(far))
        ratio = harmonic * driving / frequency.value
        if abs(math.log(ratio)) < nearest:
            nearest = abs(math.log(ratio))
            told = (
                f"in this pose the {ordinal(harmonic)} harmonic of {60.0 * driving:.4g} rpm is at {ratio:.3g} of the "
                f"lowest natural frequency, {hertz(frequency)}"
            )
    return told
