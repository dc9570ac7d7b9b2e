"""What ``alula.size`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

from alula.fea.sizing.least import Sized
from alula.fea.sizing.lightest import Lightest
from alula.fea.study.margin import margin, nearest
from alula.fea.study.numbers import VariantResult
from alula.reports.notebook.shown import Row, Table, Tabled


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
        found = self.result
        if isinstance(found, Lightest):
            solved = [(found.point(place), result) for place, result in found.solved.items()]
        else:
            solved = [({found.path: found.values[step]}, result) for step, result in sorted(found.results.items())]
        return Table(tuple(_row(values, result) for values, result in solved))

    def __str__(self) -> str:
        import io

        from rich.console import Console

        from alula.reports.commands.size import print_found

        stream = io.StringIO()
        print_found(self.result, Console(file=stream, width=120))
        return stream.getvalue().rstrip()

    def __repr__(self) -> str:
        return f"<size: {self.passing or 'nothing passes'}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def _row(values: Mapping[str, object], result: VariantResult) -> Row:
    limit = nearest(result)
    row: Row = {path: str(value) for path, value in values.items()}
    row |= {"verdict": str(result.verdict or result.state), "margin": None, "nearest": ""}
    return row if limit is None else row | {"margin": margin(limit), "nearest": f"{limit.quantity} of {limit.subject}"}
