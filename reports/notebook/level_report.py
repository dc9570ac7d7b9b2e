"""What ``alula.check`` returns of a case with a level."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from alula.fea.common.verdict import Verdict
from alula.fea.level.check_level import LevelResult
from alula.reports.level.folder import write_level
from alula.reports.level.page import level_sections
from alula.reports.notebook.check_report import CheckReport
from alula.reports.notebook.shown import ShownTable, Tabled, summary, table_of
from alula.reports.sections.section import Section


@dataclass(frozen=True)
class LevelReport(Tabled):
    """All tests of a level, as ``alula check`` makes them.

    Attributes
    ----------
    result : LevelResult
        The record that the numbers come from.
    """

    result: LevelResult

    @property
    def verdict(self) -> Verdict:
        """Of the level: the worst of its tests."""
        return self.result.verdict

    @property
    def headline(self) -> str:
        """The level and the verdict of each test."""
        each = ", ".join(f"{name} {test.verdict}" for name, test in self.result.tests.items())
        return f"{self.result.level.title}: {self.verdict} ({each})."

    @property
    def tests(self) -> Mapping[str, CheckReport]:
        """The check of each test by its name."""
        return {name: CheckReport(test.result) for name, test in self.result.tests.items()}

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """All that is told of it, as on the page of ``alula check``."""
        return level_sections(self.result)

    def table(self, of: str = "tests") -> ShownTable:
        """Return a table of the result.

        Parameters
        ----------
        of : str, optional
            ``tests``: what each test says, with value, band, limit and verdict.

        Returns
        -------
        ShownTable

        Raises
        ------
        CaseError
            For another table; those of a test are of ``tests[name]``.
        """
        return table_of(self.sections, of)

    def write(self, folder: str | Path, *, progress: Callable[[str], None] = lambda message: None) -> None:
        """Write a report for each test and ``result.json`` of the level into a folder, as ``alula check -o`` does.

        Parameters
        ----------
        folder : str or path
            The output folder.
        progress : callable, optional
            Receives messages.

        Raises
        ------
        CaseError, CannotRunError
            As ``CheckReport.write``.
        """
        from alula.fea.findings.of_check import with_findings
        from alula.reports.page.output import folder_named

        write_level(self.result.of_each(with_findings), folder_named(folder), progress=progress)

    def __str__(self) -> str:
        return f"{self.headline}\n\n{self.table()}"

    def __repr__(self) -> str:
        return f"<tests of {self.result.case.title!r}: {self.verdict}>"

    def _repr_html_(self) -> str:
        return summary(self.verdict, self.result.case.title, self.headline, self.table(), (), [])
