"""What ``alula.tolerance`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from alula.fea.tolerance.result import Probability, ToleranceNumber, ToleranceResult
from alula.reports.notebook.shown import Picture, Row, Table, Tabled, pick


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
        return {one.title + (f", {one.load_case}" if one.load_case else ""): one for one in self.result.numbers}

    def table(self) -> Table:
        """Return one row a number: nominal value, 1 %, median and 99 % of the samples, limit, probability to pass."""
        rows: list[Row] = []
        for name, one in self.numbers.items():
            low, median, high = (float(value) for value in one.percentiles(1.0, 50.0, 99.0))
            row: Row = {"number": name, "unit": one.unit, "nominal": one.nominal[0], "1 %": low, "median": median}
            asked = one.certain is not None
            row |= {"99 %": high, "sense": ("≥" if one.at_least else "≤") if asked else ""}
            row |= {"limit": one.limit if asked else None, "passes": one.certain.value if one.certain else None}
            rows.append(row)
        return Table(tuple(rows))

    def plot_spread(self, number: str) -> Picture:
        """Draw how a number spreads over the samples, with its limit.

        Parameters
        ----------
        number : str
            A name of ``numbers``.

        Returns
        -------
        Picture

        Raises
        ------
        CaseError
            For a number that there is not.
        """
        from alula.reports.figures.study.tolerance_pictures import spread_picture

        return Picture(spread_picture(pick(self.numbers, number, "number")))

    def __str__(self) -> str:
        return str(self.table())

    def __repr__(self) -> str:
        return f"<{self.result.samples} samples of {len(self.result.tolerances)} tolerances>"

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()
