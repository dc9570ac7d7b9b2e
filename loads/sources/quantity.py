"""Numbers with dimensions, which expressions calculate with."""

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import TYPOGRAPHY, registry
from alula.geometry.base.usual_units import ROOTS, USUAL
from alula.loads.text.explain import printable

Dimensions = tuple[tuple[str, Fraction], ...]
ANGLE: Dimensions = (("radian", Fraction(1)),)
_UNIT_NAME = r"[A-Za-zµμ°Ω%]+(?![\w.(])(?:(?:\^|\*\*)(?:-?[1-4](?![\d.])|0\.5(?!\d)))?"
_USUAL: dict[str, tuple[float, Dimensions]] = {
    unit: (root, tuple((name, Fraction(power)) for name, power in ROOTS[dimension].items()))
    for dimension, units in USUAL.items()
    for unit, (_, root) in units.items()
} | {
    "%": (0.01, ()),
    "Hz": (1.0, (("second", Fraction(-1)),)),
    "N*mm*s": (1.0, (("gram", Fraction(1)), ("meter", Fraction(2)), ("second", Fraction(-1)))),
}
"""The units of ``USUAL``, and those of published figures that no entry of a case has."""
UNIT = re.compile(rf"{_UNIT_NAME}(?:[*/]{_UNIT_NAME})*")
"""A unit without spaces; a name before a dot, a bracket or a letter is none."""


@dataclass(frozen=True, kw_only=True)
class Value:
    """A number with its dimensions, in pint's root units (m, g, s, rad, K, A ...).

    Attributes
    ----------
    magnitude : float
        The number.
    dimensions : tuple
        (root unit, exponent) in alphabetical order; empty for a pure number.
    """

    magnitude: float
    dimensions: Dimensions = ()

    @staticmethod
    def of(number: float, unit: str = "") -> "Value":
        """Return so many of a unit.

        Parameters
        ----------
        number : float
            How many.
        unit : str
            The unit; a pure number without.

        Returns
        -------
        Value
            The quantity.

        Raises
        ------
        CaseError
            For text that is no unit.
        """
        factor, dimensions = unit_of(unit)
        return Value(magnitude=float(number) * factor, dimensions=dimensions)

    def to(self, unit: str) -> float:
        """Return the number of the given units.

        Parameters
        ----------
        unit : str
            The unit.

        Returns
        -------
        float
            The number.

        Raises
        ------
        CaseError
            Where the unit measures something else.
        """
        factor, dimensions = unit_of(unit)
        if dimensions != self.dimensions:
            raise CaseError(
                f"a quantity in {describe(self.dimensions)} cannot be given in {printable(unit) or 'pure numbers'}; "
                "correct the unit or the expression"
            )
        return self.magnitude / factor


def describe(dimensions: Dimensions) -> str:
    """Put dimensions into words.

    Parameters
    ----------
    dimensions : tuple
        (root unit, exponent) of each.

    Returns
    -------
    str
        Such as ``gram meter second^-2``.
    """
    return " ".join(n if e == 1 else f"{n}^{e}" for n, e in dimensions) or "pure numbers"


@lru_cache(maxsize=512)
def unit_of(text: str) -> tuple[float, Dimensions]:
    """Read a unit.

    Parameters
    ----------
    text : str
        Such as ``N/mm^2``; empty for a pure number.

    Returns
    -------
    factor : float
        So many root units are one of it.
    dimensions : tuple
        (root unit, exponent) of each.

    Raises
    ------
    CaseError
        For text that is no unit, and for units with a zero of their own.
    """
    if not text:
        return 1.0, ()
    return _USUAL.get(text) or _by_pint(text)


def _by_pint(text: str) -> tuple[float, Dimensions]:
    plain = text.translate(TYPOGRAPHY).replace("%", "percent")
    try:
        if not UNIT.fullmatch(plain) or len(plain) > 64:
            raise ValueError
        units = registry()
        factor, root = units.get_root_units(plain)
        dimensions = tuple(sorted((name, Fraction(e).limit_denominator(12)) for name, e in root._units.items()))
        # Temperatures with a zero of their own and decibels do not follow from a factor.
        proportional = units.Quantity(0.0, plain).to_root_units().magnitude == 0.0
    except Exception:  # pint raises a dozen unrelated types for bad unit text
        raise CaseError(
            f"'{printable(text)}' is no unit; write units without spaces (N/mm^2) and operators between spaces"
        ) from None
    if not proportional:
        raise CaseError(f"'{printable(text)}' has a zero of its own and cannot be calculated with; use kelvin")
    return float(factor), dimensions
