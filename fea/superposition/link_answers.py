"""What may act on a link in place of what is stated, by one cause, and what its answers make of a number.

A cause is measured by hand and on solids alike: it tells what acts on the link in each of its answers, and by which
rule the numbers found under these become an interval (``docs/theory/bands.md``).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from alula.fea.common.link_loads import Plates
from alula.fea.common.scatter import Scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import Source

Rule = Callable[[float, Sequence[float]], Scatter]
"""From a number as stated, and in every other answer, to the least and the largest factor on it."""


def widest(sources: tuple[Source, ...]) -> Rule:
    """Return the rule of what is sought among alternatives: the least and the largest, and what may lie beyond.

    Parameters
    ----------
    sources : tuple of Source
        Of the cause.

    Returns
    -------
    callable
    """

    def rule(value: float, others: Sequence[float]) -> Scatter:
        if not value > 0.0:
            return Scatter.from_zero(others, sources)
        low, high = sought([1.0, *(one / value for one in others)])
        return Scatter(low=max(low, 0.0), high=high, sources=sources)

    return rule


def on_band(rule: Rule, least: Sequence[float], most: Sequence[float]) -> Scatter:
    """Return what all answers make of a number that each of them tells within a band.

    Parameters
    ----------
    rule : callable
    least, most : sequence of float
        Ends of the band in every answer, as stated first.

    Returns
    -------
    Scatter
        On the ends of the band as stated. Where its lower end is 0, as of an idle plate, nothing is known of the least.
    """
    low, high = (rule(value, others) for value, *others in (least, most))
    return replace(high, low=min(low.low, 1.0) if least[0] > 0.0 else 0.0, high=max(high.high, 1.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkAnswers:
    """What one cause may make of the loads on a link under a load case.

    Attributes
    ----------
    stated : tuple of LinkLoads
        As stated, of the link or of each plate of a pair.
    others : tuple of tuple of LinkLoads
        In each other answer.
    stress, displacement : callable
        The rules by which numbers of answers become an interval.
    """

    stated: Plates
    others: tuple[Plates, ...]
    stress: Rule
    displacement: Rule

    @property
    def every(self) -> tuple[Plates, ...]:
        """All answers, as stated first."""
        return (self.stated, *self.others)
