"""Fits of ISO 286: how much wider than its pin a hole may be, by the code of the fit, such as H8/f7.

Tolerances and deviations follow from the formulas from which the standard's tables were made. The tables are rounded by
hand: deviations to the nearest step and tolerances up come nearest to them, and ``rounding`` holds what is left.

References
----------
ISO 286-1:2010, Geometrical product specifications: ISO code system for tolerances on linear sizes, part 1, clause 5 and
tables 1, 2 and 4; the formulas are those of ISO 286-1:1988, annex A.
"""

import itertools
import math
import re
from dataclasses import dataclass
from functools import lru_cache

from alula.geometry.base.errors import CaseError

STEPS = (1.0, 3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0)
"""Ends of the diameter steps [mm]; the first one holds all that is smaller, too."""
LARGEST = STEPS[-1]
GRADES = {5: 7.0, 6: 10.0, 7: 16.0, 8: 25.0, 9: 40.0, 10: 64.0, 11: 100.0, 12: 160.0}
"""Grade IT -> its tolerance in tolerance units i."""
DEVIATIONS = {"d": (16.0, 0.44), "e": (11.0, 0.41), "f": (5.5, 0.41), "g": (2.5, 0.34), "h": (0.0, 1.0)}
"""Letter of a shaft -> factor and exponent of its fundamental deviation, factor · D^exponent [µm]."""
RUNNING = "H8/f7"
"""The fit that ``running`` stands for: a pin that turns freely in a reamed hole."""
EXACT = 0.002
"""By how much the tables depart from the formulas, up to IT8 and 315 mm [mm]."""
COARSE, COARSE_AND_SMALL = 0.05, 0.16
"""The same for coarser grades and larger diameters, and for coarser ones up to 3 mm: shares of the largest clearance.
The tables' own rounding, as measured over all grades, letters and steps (``tests/validation/test_fits.py``)."""
_CODE = re.compile(r"H\s?([1-9]\d?)\s?/\s?([d-h])\s?([1-9]\d?)", re.ASCII)


@dataclass(frozen=True, kw_only=True)
class FitLimits:
    """The limits of a hole and its pin.

    Attributes
    ----------
    hole : tuple of 2 float
        Lower and upper deviation of the hole's diameter from the nominal one [mm].
    shaft : tuple of 2 float
        The same of the pin's diameter [mm].
    rounding : float
        By how much the standard's tables may depart from these numbers [mm].
    """

    hole: tuple[float, float]
    shaft: tuple[float, float]
    rounding: float

    @property
    def clearance(self) -> tuple[float, float]:
        """Least and largest diameter of the hole less that of the pin [mm]."""
        return self.hole[0] - self.shaft[1], self.hole[1] - self.shaft[0]

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest clearance that the tables may leave [mm]."""
        low, high = self.clearance
        return max(low - self.rounding, 0.0), high + self.rounding


def parse_fit(code: str) -> tuple[int, str, int]:
    """Read the code of a fit.

    Parameters
    ----------
    code : str
        Such as ``"H8/f7"``.

    Returns
    -------
    tuple of (int, str, int)
        Grade of the hole, letter and grade of the pin.

    Raises
    ------
    CaseError
        For any but a hole H with a pin d to h, of grades 5 to 12.
    """
    found = _CODE.fullmatch(code.strip())
    hole, shaft = (int(found[1]), int(found[3])) if found else (0, 0)
    if found is None or hole not in GRADES or shaft not in GRADES:
        raise CaseError(
            f'the fit must be that of a hole H and a pin d to h, of grades 5 to 12, such as "{RUNNING}"; in place of '
            'another one state clearance = ["0.01 mm", "0.05 mm"], its least and its largest'
        )
    return hole, found[2], shaft


@lru_cache(maxsize=1024)
def fit(code: str, diameter: float) -> FitLimits:
    """Return the limits of a fit.

    Parameters
    ----------
    code : str
        Such as ``"H8/f7"``.
    diameter : float
        Nominal diameter [mm].

    Returns
    -------
    FitLimits

    Raises
    ------
    CaseError
        As ``parse_fit``, and for a diameter for which the formulas do not hold.

    Examples
    --------
    >>> [round(1000 * limit) for limit in fit("H7/h6", 25.0).clearance]  # µm
    [0, 34]
    """
    hole, letter, shaft = parse_fit(code)
    if not 0.0 < diameter <= LARGEST:
        raise CaseError(
            f"its fits are known up to {LARGEST:g} mm, but the pin has {diameter:g} mm; state clearance = "
            '["0.1 mm", "0.3 mm"], its least and its largest'
        )
    factor, exponent = DEVIATIONS[letter]
    upper = -_rounded(factor * _mean(diameter) ** exponent)
    lower = upper - tolerance(shaft, diameter)
    limits = (0.0, tolerance(hole, diameter))
    share = 0.0
    if max(hole, shaft) > 8 or diameter > 315.0:
        share = COARSE if diameter > 3.0 else COARSE_AND_SMALL
    return FitLimits(hole=limits, shaft=(lower, upper), rounding=max(EXACT, share * (limits[1] - lower)))


def tolerance(grade: int, diameter: float) -> float:
    """Return the tolerance of a grade.

    Parameters
    ----------
    grade : int
        5 to 12.
    diameter : float
        Nominal diameter, up to 500 mm.

    Returns
    -------
    float
        [mm]
    """
    mean = _mean(diameter)
    return _rounded(GRADES[grade] * (0.45 * math.cbrt(mean) + 0.001 * mean), up=1.0 - 1e-9)


def _mean(diameter: float) -> float:
    """Return the geometric mean of the diameter step [mm]."""
    low, high = next(step for step in itertools.pairwise(STEPS) if diameter <= step[1])
    return math.sqrt(low * high)


def _rounded(microns: float, up: float = 0.5) -> float:
    """Return a length [mm], given in µm and rounded to 1, 5 or 10 µm by its size as the standard has it."""
    step = 1.0 if microns <= 100.0 else 5.0 if microns <= 200.0 else 10.0
    return 1e-3 * step * math.floor(microns / step + up)
