"""What ``alula.claims`` returns."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

from alula.fea.claims.audit import ClaimResult
from alula.reports.notebook.shown import Table, Tabled
from alula.reports.sections.published import claims_section, count


@dataclass(frozen=True)
class ClaimsReport(Tabled):
    """Published figures re-derived, as ``alula claims`` does.

    Attributes
    ----------
    result : tuple of ClaimResult
        A record per figure.

    Examples
    --------
    >>> import alula
    >>> found = alula.claims("four-bar-synthesis")
    >>> print(found.headline)
    19 claims: 13 hold, 4 do not hold, 2 do not follow, 0 cannot be re-derived.
    """

    result: tuple[ClaimResult, ...]

    @property
    def headline(self) -> str:
        """Number of figures of each finding, in one sentence."""
        return count(self.result)

    @property
    def findings(self) -> Mapping[str, int]:
        """Number of figures by finding: ``"holds"``, ``"does-not-hold"``, ``"does-not-follow"``, ..."""
        return Counter(result.finding.value for result in self.result)

    def table(self) -> Table:
        """Return the figures: name, published value, ours, finding, source, note."""
        return Table(tuple(claims_section(self.result).data["claims"]))

    def __str__(self) -> str:
        return self.headline

    def __repr__(self) -> str:
        return f"<{self.headline.rstrip('.')}>"

    def _repr_html_(self) -> str:
        return f"<p>{escape(self.headline)}</p>\n{self.table()._repr_html_()}"
