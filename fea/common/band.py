"""A number with its error band."""

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True, kw_only=True)
class Band:
    """A value, the interval that it may lie in, and what that interval holds; all NaN where nothing is known.

    holds    the sources of error that low and high cover, each in a few words
    without  why the number has no band of its own, or is not known; "" where the band holds something
    """

    value: float
    low: float
    high: float
    holds: tuple[str, ...]
    without: str = ""

    def __post_init__(self) -> None:
        """Refuse a band that does not hold its value."""
        if not (self.low <= self.value <= self.high or self.unknowable):
            raise ValueError(f"the band {self.low:g} to {self.high:g} does not hold its value {self.value:g}")

    @property
    def unknowable(self) -> bool:
        """True where no number stands for the quantity, such as a peak that grows without limit."""
        return math.isnan(self.value) and math.isnan(self.low) and math.isnan(self.high)

    @classmethod
    def unknown(cls, without: str = "") -> "Band":
        """Return a band of what has no value; every check of it is undecided."""
        return cls(value=math.nan, low=math.nan, high=math.nan, holds=(), without=without)

    @classmethod
    def exact(cls, value: float, without: str = "") -> "Band":
        """Return a band of no width."""
        return cls(value=value, low=value, high=value, holds=(), without=without)

    @classmethod
    def around(cls, value: float, others: tuple[float, ...], *holds: str) -> "Band":
        """Return the band from the least to the largest of a value and its variants."""
        return cls(value=value, low=min(value, *others), high=max(value, *others), holds=holds)

    def inverse(self, numerator: float) -> "Band":
        """Return ``numerator`` divided by the number: strength over stress gives a safety factor."""
        if self.unknowable:
            return self
        return Band(
            value=_ratio(numerator, self.value),
            low=_ratio(numerator, self.high),
            high=_ratio(numerator, self.low),
            holds=self.holds,
            without=self.without,
        )

    def times(self, factor: float) -> "Band":
        """Return ``factor`` times the number.

        Parameters
        ----------
        factor : float
            A number that is not negative.
        """
        return replace(self, value=factor * self.value, low=factor * self.low, high=factor * self.high)

    @property
    def told(self) -> tuple[str, ...]:
        """What the band holds, or that it holds nothing and why, for people and files."""
        return (f"nothing: {self.without}",) if self.without else self.holds


def _ratio(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator > 0.0 else float("inf")
