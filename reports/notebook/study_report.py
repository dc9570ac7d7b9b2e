"""What ``alula.study`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from alula.fea.study.store import Store
from alula.reports.notebook.shown import Picture, Row, Table, Tabled
from alula.reports.study.rows import nearest_text, study_rows


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

    def table(self) -> Table:
        """Return one row a point: what varies, the verdict, the margin of the check that is nearest to its limit, mass.

        Returns
        -------
        Table
            ``margin`` is 1 where the worse end of that check's band is at its limit, and larger on the safe side.
        """
        rows: list[Row] = []
        with Store.reading(self.folder) as store:
            for row in study_rows(store):
                found: Row = {path: str(value) for path, value in row.parameters.items()}
                found |= {"verdict": row.outcome, "margin": row.margin, "nearest": nearest_text(row)}
                rows.append(found | {"mass [g]": row.mass})
        return Table(tuple(rows))

    @property
    def pictures(self) -> Mapping[str, Picture]:
        """What ``alula study show`` draws of the variants, by the title of each picture."""
        from alula.reports.figures.study.choice import pictures
        from alula.reports.study.columns import read_study

        with Store.reading(self.folder) as store:
            drawn, _ = pictures(read_study(store))
        return {one.title: Picture(one.png) for one in drawn}

    def __str__(self) -> str:
        return str(self.table())

    def __repr__(self) -> str:
        told = ", ".join(f"{count} {name}" for name, count in self.counts.items())
        return f"<study of {sum(self.counts.values())} points: {told}>"

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()
