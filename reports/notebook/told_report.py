"""What ``alula.statics`` and ``alula.materials`` return: sections as they are."""

from collections.abc import Sequence
from dataclasses import dataclass

from alula.reports.notebook.shown import ShownTable, Tabled, table_of
from alula.reports.sections.section import Section, Table, parts_of


@dataclass(frozen=True)
class ToldReport(Tabled):
    """What a command tells, with its tables.

    Attributes
    ----------
    title : str
    sections : sequence of Section
    first : str
        Name of the table that is shown by itself; that of its first section where left out.
    """

    title: str
    sections: Sequence[Section]
    first: str = ""

    def table(self, of: str = "") -> ShownTable:
        """Return a table.

        Parameters
        ----------
        of : str, optional
            Its name, such as ``joints`` of statics; the one that matters most when left out.

        Returns
        -------
        ShownTable

        Raises
        ------
        CaseError
            For a table that there is not; the error lists the others.
        """
        if name := of or self.first:
            return table_of(self.sections, name)
        every = (part for section in self.sections for part in parts_of(section.parts))
        return ShownTable.of([next(part for part in every if isinstance(part, Table))])

    def __str__(self) -> str:
        from rich.console import Console

        from alula.reports.renderers.console import print_sections

        console = Console(width=_WIDE, no_color=True, force_terminal=False)
        with console.capture() as printed:
            print_sections(self.sections, console)
        return printed.get().strip("\n")

    def __repr__(self) -> str:
        return f"<{self.title}>"


_WIDE = 160
"""Columns of a text that no terminal breaks."""
