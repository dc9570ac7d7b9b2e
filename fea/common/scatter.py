"""The scatter that a case and its materials state, as factors on the ends of a band.

Everything that a load case does in linear theory is in proportion to its loads, a safety factor to the strength, and a
link's displacement to 1/E. So the ends of a band are multiplied by the ends of what scatters, and by what grows beyond
proportion (``fea.check.load_growth``); independent sources are taken at their worst together. Conditions are in the
material already (``loads.records.conditions``): a strength's range is as warm as the strength, and a creep modulus has
none.
"""

import math
from dataclasses import dataclass

from fea.common.band import Band
from geometry.parts.material import Material
from loads.case.case import Case


@dataclass(frozen=True, kw_only=True)
class Scatter:
    """Least and largest factor on a number, and its source for people; no source where nothing scatters."""

    low: float = 1.0
    high: float = 1.0
    holds: tuple[str, ...] = ()

    def on(self, band: Band) -> Band:
        """Return a band (of a number that is not negative) with its ends multiplied by the factors."""
        if band.unknowable or not self.holds:
            return band
        return Band(
            value=band.value,
            low=_product(band.low, self.low),
            high=_product(band.high, self.high),
            holds=(*band.holds, *self.holds),
        )

    def times(self, other: "Scatter") -> "Scatter":
        """Return the scatter of a product."""
        return Scatter(low=self.low * other.low, high=self.high * other.high, holds=(*self.holds, *other.holds))

    @property
    def inverse(self) -> "Scatter":
        """The scatter of what goes with one over the number."""
        return Scatter(low=1.0 / self.high, high=1.0 / self.low, holds=self.holds)


def _product(end: float, factor: float) -> float:
    """End of a band times a factor; nothing stays nothing, and what no load breaks stays unbroken."""
    return end if end in (0.0, math.inf) else end * factor


def load_scatter(case: Case, load_case: str) -> Scatter:
    """Return what the loads of a load case may be, over what they are."""
    low, high = case.load_cases[load_case].scatter
    if low == high:
        return Scatter()
    return Scatter(low=low, high=high, holds=(f"stated scatter of the load, {low:.0%} to {high:.0%}",))


def strength_scatter(material: Material) -> Scatter:
    """Return what the strength of a safety factor may be, over what it is."""
    return _range("strength", material.allowable, material.strength_range)


def compliance_scatter(material: Material) -> Scatter:
    """Return what 1/E may be, over what it is."""
    return _range("modulus", material.youngs_modulus, material.youngs_modulus_range).inverse


def _range(what: str, value: float, stated: tuple[float, float] | None) -> Scatter:
    if stated is None:
        return Scatter()
    low, high = min(stated[0], value), max(stated[1], value)
    return Scatter(low=low / value, high=high / value, holds=(f"stated {what}, {low:.4g} to {high:.4g} MPa",))
