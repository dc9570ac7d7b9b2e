"""What ``alula.tolerance`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from alula.fea.tolerance.result import Probability, ToleranceNumber, ToleranceResult
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, pick, table_of
from alula.reports.study.tolerance import names, tolerance_sections


@dataclass(frozen=True)
class ToleranceReport(Tabled):
    """Samples of a case within its tolerances, as ``alula tolerance`` draws them.

    Attributes
    ----------
    result : ToleranceResult
        The record that the numbers come from, with every number of every sample.
    """

    result: ToleranceResult

    @property
    def passes(self) -> Probability:
        """Probability that every check that is covered passes: ``value``, ``low`` and ``high`` at 95 % confidence."""
        return self.result.certain

    @property
    def numbers(self) -> Mapping[str, ToleranceNumber]:
        """Every number that was sampled, by quantity, subject and load case."""
        return dict(zip(names(self.result), self.result.numbers, strict=True))

    def table(self, of: str = "numbers") -> ShownTable:
        """Return a table of ``alula tolerance``.

        Parameters
        ----------
        of : str, optional
            ``numbers``: nominal value, 1 %, median and 99 % of the samples, limit, probability to pass; or ``causes``,
            the Sobol' indices of what matters.

        Returns
        -------
        ShownTable
        """
        return table_of(tolerance_sections(self.result), of, {"sense": "limit sense"})

    def plot_spread(self, number: str) -> ShownPicture:
        """Draw how a number spreads over the samples, with its limit.

        Parameters
        ----------
        number : str
            A name of ``numbers``.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a number that there is not.
        """
        from alula.reports.figures.study.tolerance_pictures import spread_picture

        return ShownPicture(spread_picture(pick(self.numbers, number, "number")).png())

    def __repr__(self) -> str:
        return f"<{self.result.samples} samples of {len(self.result.tolerances)} tolerances>"
