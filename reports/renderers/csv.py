"""The series of sections as CSV files."""

import csv
import io
from collections.abc import Iterable

from alula.reports.sections.section import Section, Series


def as_csv(series: Series) -> str:
    """Return a series as CSV: titles with units, then a line for each value.

    Parameters
    ----------
    series : Series

    Returns
    -------
    str
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(series.columns)
    writer.writerows(series.rows())
    return stream.getvalue()


def files_of(sections: Iterable[Section]) -> dict[str, str]:
    """Return the CSV files of sections by their names.

    Parameters
    ----------
    sections : iterable of Section

    Returns
    -------
    dict of str to str
    """
    return {series.file: as_csv(series) for section in sections for series in section.series}
