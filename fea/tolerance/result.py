"""What tolerances do to a case: probabilities, distributions, what matters, and the worst corner."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason
from alula.fea.outcomes.result import CheckResult
from alula.fea.outcomes.unchecked import caveats
from alula.loads.text.caveat import Caveat, Topic

Real = NDArray[np.float64]

CONFIDENCE = 0.95


@dataclass(frozen=True, kw_only=True)
class Probability:
    """A share of samples, and where the probability behind it lies.

    Attributes
    ----------
    count, samples : int
    low, high : float
        Ends of the 95 % confidence interval of Clopper and Pearson.
    """

    count: int
    samples: int
    low: float
    high: float

    @property
    def value(self) -> float:
        """The share of the samples."""
        return self.count / self.samples

    @classmethod
    def of(cls, hits: NDArray[np.bool_]) -> "Probability":
        """Return the probability that independent samples tell.

        Parameters
        ----------
        hits : ndarray of bool, shape (samples,)

        Returns
        -------
        Probability
        """
        from scipy.stats import binomtest

        count = int(np.count_nonzero(hits))
        ends = binomtest(count, len(hits)).proportion_ci(CONFIDENCE, method="exact")
        return cls(count=count, samples=len(hits), low=float(ends.low), high=float(ends.high))


@dataclass(frozen=True, kw_only=True, eq=False)
class ToleranceNumber:
    """One number in all samples, and what it is held against.

    Attributes
    ----------
    check : str
        Name of the check; "" for a number that nothing is asked of.
    subject, load_case, quantity, unit : str
        As of ``VariantNumber``.
    limit : float
        NaN without check.
    at_least : bool
        True where it must be at least the limit.
    nominal : tuple of 3 float
        Value, low and high end of its band in the nominal case.
    values, low, high : ndarray, shape (samples,)
        The same in every sample; NaN in samples without equilibrium, and where no model tells.
    certain, possible : Probability or None
        That it keeps its limit over its whole band, and that it does not miss it over its whole band; None without
        check.
    first, total : ndarray, shape (tolerances,)
        Sobol' indices of the share of the limit that is used (of a torque itself), among samples with equilibrium: the
        part of its variance that a tolerance makes by itself, and with all that it does together with others. NaN where
        nothing varies, and where a few samples next to a dead point make all of the variance.
    """

    check: str = ""
    subject: str
    load_case: str
    quantity: str
    unit: str
    limit: float = np.nan
    at_least: bool = True
    nominal: tuple[float, float, float]
    values: Real
    low: Real
    high: Real
    certain: Probability | None = None
    possible: Probability | None = None
    first: Real
    total: Real

    def percentiles(self, *shares: float) -> Real:
        """Return percentiles of the values, without samples that have none.

        Parameters
        ----------
        *shares : float
            Such as 50 for the median.

        Returns
        -------
        ndarray, shape (len(shares),)
        """
        known = self.values[np.isfinite(self.values)]
        return np.percentile(known, shares) if known.size else np.full(len(shares), np.nan)

    @property
    def title(self) -> str:
        """What it is, for people: ``safety factor of crank``, ``drive torque``."""
        return self.quantity if self.subject == "the drive" else f"{self.quantity} of {self.subject}"

    @property
    def closeness(self) -> float:
        """How near the nominal band comes to the limit, above 1 where it misses it; NaN where that is not known."""
        ends = (self.limit, self.nominal[1]) if self.at_least else (self.nominal[2], self.limit)
        return ends[0] / ends[1] if ends[1] > 0.0 else np.nan


@dataclass(frozen=True, kw_only=True, eq=False)
class WorstCorner:
    """All tolerances at the ends that hurt a number most, by the sign of its slopes.

    Attributes
    ----------
    number : int
        Of the ``numbers`` the one that is closest to its limit.
    value, low, high : float
        There; NaN where the corner has no equilibrium.
    deviations : mapping of str to tuple of float
        Tolerance -> deviations [mm, rad, N, share].
    """

    number: int
    value: float
    low: float
    high: float
    deviations: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True, kw_only=True, eq=False)
class ToleranceResult:
    """A case under its tolerances.

    Attributes
    ----------
    nominal : CheckResult
    tolerances : tuple of str
        The g entries that vary, each by itself.
    samples, seed : int
    deviations : ndarray, shape (samples, d)
        Of the d variables; a place has two.
    numbers : tuple of ToleranceNumber
        Of the checks first, then the drive's torque.
    apart, dead : Probability
        Of samples that do not assemble, and of those at a dead point of the drive. They count as failed.
    certain, possible : Probability
        That every check that is covered passes, and that none fails.
    corner : WorstCorner or None
        None where no check is covered.
    left_out : tuple of Reason
        Checks that the samples do not cover; they are in no probability.
    notes : tuple of Reason
        What the numbers do not cover.
    timings : mapping of str to float
        Stage -> seconds.
    """

    nominal: CheckResult
    tolerances: tuple[str, ...]
    samples: int
    seed: int
    deviations: Real
    numbers: tuple[ToleranceNumber, ...]
    apart: Probability
    dead: Probability
    certain: Probability
    possible: Probability
    corner: WorstCorner | None
    left_out: tuple[Reason, ...]
    notes: tuple[Reason, ...]
    timings: Mapping[str, float]

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        """What the nominal verdict stands on besides; the tolerances are what is looked at here."""
        return tuple(one for one in caveats(self.nominal.case) if one.topic is not Topic.TOLERANCES)
