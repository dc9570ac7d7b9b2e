"""What ``alula.study`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from alula.fea.study.store import Store
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, table_of
from alula.reports.study.columns import read_study
from alula.reports.study.page import pictures_of
from alula.reports.study.rows import study_rows
from alula.reports.study.sections import points_table, study_sections


@dataclass(frozen=True)
class StudyReport(Tabled):
    """The variants of a case that a folder holds.

    Attributes
    ----------
    folder : Path
        Of ``study.sqlite``, which pandas reads as well (``docs/studies.md``).
    counts : mapping of str to int
        Points by verdict, or by state where there is none.
    """

    folder: Path
    counts: Mapping[str, int]

    def table(self, of: str = "points") -> ShownTable:
        """Return a table of ``alula study show``.

        Parameters
        ----------
        of : str, optional
            ``points``: one row a point, with what varies, the verdict, the check that is nearest to its limit and the
            mass; ``entries``, what varies; ``limits``, what limits how many points; where more than two quantities
            vary ``sensitivity``.

        Returns
        -------
        ShownTable
            ``margin`` is 1 where the worse end of that check's band is at its limit, and larger on the safe side.
        """
        with Store.reading(self.folder) as store:
            if of == "points":
                return ShownTable.of([points_table(list(study_rows(store)))], {"nearest": "nearest to its limit"})
            return table_of(study_sections(read_study(store)), of)

    @property
    def pictures(self) -> Mapping[str, ShownPicture]:
        """What ``alula study show`` draws of the variants, by the title of each picture."""
        with Store.reading(self.folder) as store:
            found = pictures_of(study_sections(read_study(store)))
        return {one.alt: ShownPicture(one.draw().png()) for one in found if one.draw is not None}

    def __repr__(self) -> str:
        told = ", ".join(f"{count} {name}" for name, count in self.counts.items())
        return f"<study of {sum(self.counts.values())} points: {told}>"
