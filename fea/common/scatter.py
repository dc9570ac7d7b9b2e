"""The scatter that a case and its materials state, as factors on the ends of a band.

Everything that a load case does in linear theory is in proportion to its loads, a safety factor to the strength, and a
link's displacement to 1/E. So the ends of a band are multiplied by the ends of what scatters, and by what grows beyond
proportion (``alula.fea.doubts.load_growth``); independent sources are taken at their worst together. Conditions are in
the material already (``alula.loads.records.conditions``): a strength's range is as warm as the strength, and a creep
modulus has none.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.source import UNKNOWN, Source, SourceKind, distinct
from alula.geometry.materials.material import Fatigue, Material
from alula.loads.case.case import Case

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Scatter:
    """Least and largest factor on a number.

    Attributes
    ----------
    low, high : float
        The factors; 1 where nothing scatters.
    sources : tuple of Source
        What scatters; empty where nothing does.
    rises : bool
        True of a number that is zero as stated, or one over it, and not in another answer: no factor tells how large it
        is there.
    """

    low: float = 1.0
    high: float = 1.0
    sources: tuple[Source, ...] = ()
    rises: bool = False

    @classmethod
    def from_zero(cls, others: Sequence[float], sources: tuple[Source, ...]) -> "Scatter":
        """Return the scatter of a number that is zero as stated.

        Parameters
        ----------
        others : sequence of float
            The number in other answers.
        sources : tuple of Source
            What makes the answers differ.

        Returns
        -------
        Scatter
            Nothing scatters where it is zero in all.
        """
        risen = max(others, default=0.0) > 0.0
        return cls(high=math.inf, sources=sources, rises=True) if risen else cls()

    def on(self, band: Band) -> Band:
        """Return a band with its ends multiplied by the factors.

        Parameters
        ----------
        band : Band
            Of a number that is not negative.

        Returns
        -------
        Band
        """
        if band.unknowable or not self.sources:
            return band
        low, high = _product(band.low, self.low), _product(band.high, self.high)
        if self.rises:
            low, high = (0.0 if low == math.inf else low), (math.inf if high == 0.0 else high)
        return replace(band, low=low, high=high, sources=distinct(band.sources, self.told))

    def times(self, other: "Scatter") -> "Scatter":
        """Return the scatter of a product.

        Parameters
        ----------
        other : Scatter
            Of the other factor.

        Returns
        -------
        Scatter
        """
        sources = distinct(self.told, other.told)
        rises = self.rises or other.rises
        return Scatter(low=self.low * other.low, high=self.high * other.high, sources=sources, rises=rises)

    def either(self, other: "Scatter") -> "Scatter":
        """Return the scatter of what goes with this number, with another one, or with both.

        Parameters
        ----------
        other : Scatter
            Of the other number.

        Returns
        -------
        Scatter
        """
        sources = tuple(replace(one, ends=UNKNOWN) for one in distinct(self.told, other.told))
        rises = self.rises or other.rises
        return Scatter(low=min(self.low, other.low), high=max(self.high, other.high), sources=sources, rises=rises)

    @property
    def told(self) -> tuple[Source, ...]:
        """The sources; a single one has the whole width."""
        if len(self.sources) != 1 or not math.isnan(self.sources[0].width):
            return self.sources
        width = self.high / self.low if self.low > 0.0 else math.inf
        return (replace(self.sources[0], width=width, ends=(self.low, self.high)),)

    @property
    def inverse(self) -> "Scatter":
        """The scatter of what goes with one over the number."""
        return replace(
            self,
            sources=tuple(one.inverse for one in self.told),
            low=1.0 / self.high,
            high=1.0 / self.low if self.low > 0.0 else math.inf,
        )


def of_sum(parts: Iterable[tuple[float, Scatter]], whole: float) -> Scatter:
    """Return the scatter of the size of a sum of vectors of which each may be longer or shorter by itself.

    By the triangle inequality the sum differs by no more than its parts together, and these may stand against it.

    Parameters
    ----------
    parts : iterable of (float, Scatter)
        Sizes of the vectors, and what each may be over what it is.
    whole : float
        Size of the sum; above 0.

    Returns
    -------
    Scatter
        Of a single part its own.
    """
    (first, *others) = known = tuple(parts)
    if not others:
        return first[1]
    differs = float(differing(known) / whole)
    sources = distinct(*(one.told for _, one in known))
    return Scatter(low=max(1.0 - differs, 0.0), high=1.0 + differs, sources=sources)


def differing(parts: Iterable[tuple[float | Real, Scatter]]) -> float | Real:
    """Return by how much the size of a sum of vectors may differ, of which each may be longer or shorter by itself.

    Parameters
    ----------
    parts : iterable of (float or ndarray, Scatter)
        As of ``of_sum``.

    Returns
    -------
    float or ndarray
        In the unit of the sizes.
    """
    found: float | Real = 0.0
    for size, one in parts:
        most = max(one.high - 1.0, 1.0 - one.low)
        found = found + (size * most if most < math.inf else 0.0 * size + math.inf)
    return found


def _product(end: float, factor: float) -> float:
    """Return an end of a band times a factor; zero and infinity stay as they are."""
    return end if end in (0.0, math.inf) else end * factor


def load_scatter(case: Case, load_case: str) -> Scatter:
    """Return what the loads of a load case may be, over what they are.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.

    Returns
    -------
    Scatter
    """
    low, high = case.load_cases[load_case].scatter
    if low == high:
        return Scatter()
    source = Source(kind=SourceKind.LOAD, detail=reason("range_of_shares", low=low, high=high))
    return Scatter(low=low, high=high, sources=(source,))


def load_over_modulus(case: Case, load_case: str, links: Iterable[str]) -> tuple[float, float]:
    """Return the least and the largest load over modulus, over what it is.

    Parameters
    ----------
    case : Case
    load_case : str
    links : iterable of str
        Whose moduli count.

    Returns
    -------
    tuple of 2 float
    """
    load, soft = load_scatter(case, load_case), [compliance_scatter(case.material_of(link)) for link in links]
    low = load.low * min((s.low for s in soft), default=1.0)
    high = load.high * max((s.high for s in soft), default=1.0)
    return low, high


def strength_scatter(material: Material) -> Scatter:
    """Return what the strength of a safety factor may be, over what it is.

    Parameters
    ----------
    material : Material

    Returns
    -------
    Scatter
    """
    return _range(SourceKind.STRENGTH, material.allowable, material.strength_range)


def fatigue_scatter(data: Fatigue | None) -> Scatter:
    """Return what the fatigue strength may be, over what it is.

    Parameters
    ----------
    data : Fatigue or None
        Of a card.

    Returns
    -------
    Scatter
    """
    return Scatter() if data is None else _range(SourceKind.STRENGTH, data.stress, data.strength_range)


def layer_scatter(material: Material) -> Scatter:
    """Return what the strength of layers may be, over what it is.

    A safety factor against tension and shear together lies between those that the least and the largest of both factors
    give.

    Parameters
    ----------
    material : Material

    Returns
    -------
    Scatter
    """
    ranges = [
        _range(SourceKind.STRENGTH, value, stated, what)
        for value, stated, what in (
            (material.strength_across_layers, material.strength_across_layers_range, "range_of_stress_across_layers"),
            (
                material.shear_strength_between_layers,
                material.shear_strength_between_layers_range,
                "range_of_stress_along_layers",
            ),
        )
        if value is not None
    ]
    return Scatter(
        low=min((one.low for one in ranges), default=1.0),
        high=max((one.high for one in ranges), default=1.0),
        sources=distinct(*(one.sources for one in ranges)),
    )


def compliance_scatter(material: Material) -> Scatter:
    """Return what 1/E may be, over what it is.

    Parameters
    ----------
    material : Material

    Returns
    -------
    Scatter
    """
    return _range(SourceKind.MODULUS, material.youngs_modulus, material.youngs_modulus_range).inverse


def _range(
    kind: SourceKind, value: float, stated: tuple[float, float] | None, what: str = "range_of_stress"
) -> Scatter:
    if stated is None:
        return Scatter()
    low, high = min(stated[0], value), max(stated[1], value)
    source = Source(kind=kind, detail=reason(what, low=low, high=high))
    return Scatter(low=low / value, high=high / value, sources=(source,))
