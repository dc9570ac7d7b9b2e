"""The series of sections as CSV files."""

import csv
import io
import math
from collections.abc import Iterable
from typing import Any

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
    writer.writerows([_written(cell, series.digits) for cell in row] for row in series.rows())
    return stream.getvalue()


def _written(cell: Any, digits: int | None) -> Any:
    if digits is None or not isinstance(cell, float):
        return cell
    return f"{cell:.{digits}g}" if math.isfinite(cell) else ""


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
