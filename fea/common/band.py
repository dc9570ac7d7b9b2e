"""A number with its error band."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import UNKNOWN, Source, distinct


@dataclass(frozen=True, kw_only=True)
class Band:
    """A value, the interval that it may lie in, and the sources of error that this interval covers.

    Attributes
    ----------
    value, low, high : float
        The value and the ends of its interval; all NaN where no number stands for the quantity.
    sources : tuple of Source
        What the interval covers.
    without : Reason or str
        Why the interval covers no error of the model, or the value is not known; "" where it covers one.
    """

    value: float
    low: float
    high: float
    sources: tuple[Source, ...] = ()
    without: Reason | str = ""

    def __post_init__(self) -> None:
        """Refuse a band that does not hold its value."""
        endless = bool(self.without) and math.isnan(self.low) and math.isnan(self.high)
        if not (self.low <= self.value <= self.high or self.unknowable or endless):
            raise ValueError(f"the band {self.low:g} to {self.high:g} does not hold its value {self.value:g}")

    @property
    def unknowable(self) -> bool:
        """True where no number stands for the quantity, such as a peak that grows without limit."""
        return math.isnan(self.value) and math.isnan(self.low) and math.isnan(self.high)

    @property
    def least_alone(self) -> bool:
        """True of a number of which only is known that it is at least so large."""
        return self.value == self.low < self.high == math.inf

    @property
    def told(self) -> "Band":
        """The band as others read it: without ends (NaN) where it covers no error of the model."""
        return replace(self, low=math.nan, high=math.nan) if self.without else self

    @classmethod
    def unknown(cls, without: Reason | str = "") -> "Band":
        """Return a band of what has no value; every check of it is undecided.

        Parameters
        ----------
        without : Reason or str
            Why there is no value.

        Returns
        -------
        Band
        """
        return cls(value=math.nan, low=math.nan, high=math.nan, without=without)

    @classmethod
    def exact(cls, value: float, without: Reason | str = "") -> "Band":
        """Return a band of no width.

        Parameters
        ----------
        value : float
        without : Reason or str
            Why nothing is known of the model's error.

        Returns
        -------
        Band
        """
        return cls(value=value, low=value, high=value, without=without)

    @classmethod
    def at_least(cls, low: float, sources: tuple[Source, ...] = ()) -> "Band":
        """Return the band of a number that is at least so large.

        Parameters
        ----------
        low : float
        sources : tuple of Source, optional

        Returns
        -------
        Band
        """
        return cls(value=low, low=low, high=math.inf, sources=sources)

    @classmethod
    def around(cls, value: float, others: tuple[float, ...], *sources: Source) -> "Band":
        """Return the band from the least to the largest of a value and its variants.

        Parameters
        ----------
        value : float
        others : tuple of float
            The variants.
        sources : Source
            What makes the variants differ.

        Returns
        -------
        Band
        """
        return cls(value=value, low=min(value, *others), high=max(value, *others), sources=sources)

    @classmethod
    def largest(cls, bands: Sequence["Band"]) -> "Band":
        """Return the band of the largest of several numbers, each within its band.

        Parameters
        ----------
        bands : sequence of Band
            At least one.

        Returns
        -------
        Band
            Not known where one of them is not.
        """
        return cls._outermost(bands, max)

    @classmethod
    def least(cls, bands: Sequence["Band"]) -> "Band":
        """Return the band of the least of several numbers, each within its band.

        Parameters
        ----------
        bands : sequence of Band
            At least one.

        Returns
        -------
        Band
            Not known where one of them is not.
        """
        return cls._outermost(bands, min)

    @classmethod
    def _outermost(cls, bands: Sequence["Band"], of: Callable[[Iterable[float]], float]) -> "Band":
        lost = next((band for band in bands if band.unknowable), None)
        if lost is not None:
            return cls.unknown(lost.without)
        value, low, high = map(of, zip(*((band.value, band.low, band.high) for band in bands), strict=True))
        sources = distinct(*(band.sources for band in bands))
        if len(bands) > 1:  # what a source makes of the outermost is what that is over the outermost without it
            sources = tuple(replace(one, ends=cls._made(one, bands, (low, high), of)) for one in sources)
        return cls(value=value, low=low, high=high, sources=sources)

    @staticmethod
    def _made(
        source: Source, bands: Sequence["Band"], ends: tuple[float, float], of: Callable[[Iterable[float]], float]
    ) -> tuple[float, float]:
        own = [next((one.ends for one in band.sources if one == source), (1.0, 1.0)) for band in bands]
        if any(not 0.0 < end < math.inf for one in own for end in one):
            return UNKNOWN
        without = (
            of(band.low / one[0] for band, one in zip(bands, own, strict=True)),
            of(band.high / one[1] for band, one in zip(bands, own, strict=True)),
        )
        if any(not 0.0 < end < math.inf for end in without):
            return UNKNOWN
        return ends[0] / without[0], ends[1] / without[1]

    def inverse(self, numerator: float) -> "Band":
        """Return ``numerator`` divided by the number: strength over stress gives a safety factor.

        Parameters
        ----------
        numerator : float
            A number that is not negative.

        Returns
        -------
        Band
        """
        if self.unknowable:
            return self
        value, low, high = (_ratio(numerator, x) for x in (self.value, self.high, self.low))
        return replace(self, value=value, low=low, high=high, sources=tuple(one.inverse for one in self.sources))

    def times(self, factor: float) -> "Band":
        """Return ``factor`` times the number.

        Parameters
        ----------
        factor : float
            A number that is not negative.

        Returns
        -------
        Band
        """
        return replace(self, value=factor * self.value, low=factor * self.low, high=factor * self.high)

    @property
    def texts(self) -> tuple[Reason | str, ...]:
        """What the band covers, and why no error of the model where that is so, for people and files."""
        missing = reason("covers_no_model_error" if self.sources else "covers_nothing", why=self.without)
        return (*(source.text for source in self.sources), *((missing,) if self.without else ()))


def _ratio(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator > 0.0 else float("inf")
