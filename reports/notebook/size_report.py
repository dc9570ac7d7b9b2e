"""What ``alula.size`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

from alula.fea.sizing.least import Sized
from alula.fea.sizing.lightest import Lightest
from alula.reports.commands.telling import text_of
from alula.reports.notebook.shown import Table, Tabled, table_of
from alula.reports.study.size import SOLVED, size_section


@dataclass(frozen=True)
class SizeReport(Tabled):
    """The least size that passes, or the best values of several entries, as ``alula size`` finds them.

    Attributes
    ----------
    result : Sized or Lightest
        The record that the numbers come from, with every variant that the model that decides solved.
    """

    result: Sized | Lightest

    @property
    def passing(self) -> Mapping[str, object] | None:
        """Entry -> the value that passes over its whole band, the least (or best) one; None where none does."""
        found = self.result
        if isinstance(found, Lightest):
            return None if found.best is None else found.point(found.best)
        return None if found.passing is None else {found.path: found.values[found.passing]}

    @property
    def failing(self) -> Mapping[str, object] | None:
        """Entry -> the value next to those that pass which fails, of a single entry; None where none does."""
        found = self.result
        if isinstance(found, Lightest) or found.failing is None:
            return None
        return {found.path: found.values[found.failing]}

    def table(self) -> Table:
        """Return one row a variant that was solved: its values, the verdict, the check nearest to its limit.

        Returns
        -------
        Table
            ``margin`` is 1 where the worse end of that check's band is at its limit, and larger on the safe side.
        """
        return table_of([size_section(self.result)], SOLVED)

    def __str__(self) -> str:
        return text_of([size_section(self.result)])

    def __repr__(self) -> str:
        return f"<size: {self.passing or 'nothing passes'}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"
