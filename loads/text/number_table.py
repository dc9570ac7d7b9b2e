"""A table of numbers in a CSV file: columns with name and unit in the head, one state a row.

Spreadsheets and laboratories write such files in several ways; what can be told apart is read right. The separator is
a semicolon, a tab or a comma, whichever of these the head has first in this order. Where it is no comma, a comma in a
number is a decimal one, provided that no other number of the file has a point.
"""

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import TYPOGRAPHY, parse
from alula.loads.text.explain import printable
from alula.loads.text.file_text import file_text

Real = NDArray[np.float64]

SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas"}
MOST_COLUMNS = 1_000
_HEAD = "cycle [%],Fy [N]"
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, kw_only=True, eq=False)
class NumberTable:
    """Columns of numbers.

    Attributes
    ----------
    name : str
        Of the file, for sentences.
    units : mapping of str to str
        Column -> its unit, in the order of the file.
    values : mapping of str to array (n,)
        Column -> its numbers, in its unit.
    rows : tuple of int
        Line of the file in which each of the n rows stands, from 1.
    """

    name: str
    units: Mapping[str, str]
    values: Mapping[str, Real]
    rows: tuple[int, ...]

    def column(self, name: str) -> str:
        """Return the name of a column that there is.

        Parameters
        ----------
        name : str

        Returns
        -------
        str

        Raises
        ------
        CaseError
            With the names that there are.
        """
        if name not in self.units:
            known = ", ".join(map(printable, self.units))
            raise CaseError(f"'{self.name}' has no column '{printable(name)}'; its columns are {known}")
        return name

    def quantity(self, name: str, dimension: str, body_weight: float | None = None) -> Real:
        """Return a column in alula's unit of a dimension.

        Parameters
        ----------
        name : str
            Of the column.
        dimension : str
            A key of ``INTERNAL_UNITS``.
        body_weight : float, optional
            What the unit ``body_weight`` stands for [N]; it is refused where left out.

        Returns
        -------
        array (n,)

        Raises
        ------
        CaseError
            For a unit of something else, and for a number beyond all sizes.
        """
        unit = self.units[self.column(name)]
        found = np.empty(len(self.rows))
        for i, value in enumerate(self.values[name].tolist()):
            try:
                found[i] = parse(f"{value!r} {unit}", dimension, body_weight)
            except PydanticCustomError as error:
                raise self.wrong(self.rows[i], name, error.message()) from None
        return found

    def wrong(self, row: int, column: str, rule: str) -> CaseError:
        """Return the error about a cell.

        Parameters
        ----------
        row : int
            Line of the file.
        column : str
            Name of the column.
        rule : str
            What is wrong, and the remedy.

        Returns
        -------
        CaseError
        """
        return CaseError(f"'{self.name}', row {row}, column {printable(column)}: {rule}")

    def rising(self, name: str) -> None:
        """Refuse a column whose numbers do not grow from row to row.

        Parameters
        ----------
        name : str
            Of the column.

        Raises
        ------
        CaseError
            With the first row that does not come after the one above.
        """
        values = self.values[self.column(name)]
        for i in np.flatnonzero(np.diff(values) <= 0.0)[:1]:
            raise self.wrong(
                self.rows[i + 1],
                name,
                f"{values[i + 1]:g} does not come after {values[i]:g} in the row above; put the rows in order, and "
                "leave out what stands there twice",
            )

    def between(self, name: str, at: Real) -> "NumberTable":
        """Return the table at other places of a column, linear between its rows.

        Parameters
        ----------
        name : str
            A column that rises.
        at : array (k,)
            Values of it, in its unit.

        Returns
        -------
        NumberTable
            Of k rows; each has the line of the row at or before its place.
        """
        along = self.values[self.column(name)]
        before = np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(along) - 1)
        values = {column: np.interp(at, along, of) for column, of in self.values.items()}
        return replace(self, values=values, rows=tuple(self.rows[i] for i in before))


def read_number_table(folder: str, file: str, head: str = _HEAD) -> NumberTable:
    """Read a table of numbers.

    Parameters
    ----------
    folder : str
        That a relative path counts from: the case's.
    file : str
        Path of the CSV file, at most 1 MiB of UTF-8 text, with or without a byte order mark.
    head : str, optional
        An example of its first line, for sentences.

    Returns
    -------
    NumberTable

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong, with row and column.
    """
    if not file.strip() or "\0" in file:
        raise CaseError("a table needs the name of its file; name it, relative to the case file")
    path = Path(folder) / file
    text = file_text(
        str(path),
        "table",
        missing="there is no such file; name it relative to the folder of the case file",
        empty=f"the file is empty; write a head such as '{head}', and rows below it",
    )
    return number_table(text, printable(path.name), head)


def number_table(text: str, name: str, head: str = _HEAD) -> NumberTable:
    """Return the table that the text of a CSV file states.

    Lines that begin with # and empty ones are left out.

    Parameters
    ----------
    text : str
    name : str
        What sentences call the file.
    head : str, optional
        As for ``read_number_table``.

    Returns
    -------
    NumberTable

    Raises
    ------
    CaseError
        As ``read_number_table``.
    """
    lines = re.split(r"\r\n|\n|\r", text)
    kept = [i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith("#")]
    first = lines[kept[0]] if kept else ""
    separator = next((sign for sign in SEPARATORS if sign in first), "")
    if len(kept) < 3 or not separator:
        raise CaseError(
            f"'{name}': it needs a head such as '{head}', with columns separated by "
            f"{', '.join(SEPARATORS.values())}, and at least two rows below it"
        )
    try:
        cells = [next(csv.reader([lines[i]], delimiter=separator, strict=True)) for i in kept]
    except csv.Error as error:
        raise CaseError(f"'{name}': it is not valid CSV ({error}); correct it") from None
    units, rows = _head(cells[0], name, head), tuple(i + 1 for i in kept[1:])
    table = NumberTable(name=name, units=units, values={}, rows=rows)
    points = any("." in cell for row in cells[1:] for cell in row)
    numbers = np.empty((len(rows), len(units)))
    for i, (row, stated) in enumerate(zip(rows, cells[1:], strict=True)):
        if len(stated) != len(units):
            more = len(stated) > len(units) and separator == ","
            commas = "; numbers with decimal commas need semicolons or tabs between columns" if more else ""
            raise CaseError(
                f"'{name}', row {row}: it has {len(stated)} values for {len(units)} columns{commas}; correct that row"
            )
        for j, (column, cell) in enumerate(zip(units, stated, strict=True)):
            numbers[i, j] = _number(table, row, column, cell, commas=separator != "," and not points)
    return replace(table, values=dict(zip(units, numbers.T, strict=True)))


def _head(cells: list[str], name: str, example: str) -> dict[str, str]:
    """Return the unit of every column."""
    found: dict[str, str] = {}
    for number, cell in enumerate(cells, 1):
        match = re.fullmatch(r"\s*(\S.*?)\s*\[\s*(\S[^\[\]]*?)\s*\]\s*", cell)
        if match is None:
            raise CaseError(
                f"'{name}', column {number}: its head '{printable(cell.strip())}' is no name with a unit in brackets; "
                f"write a head such as '{example}'"
            )
        if match[1] in found:
            raise CaseError(f"'{name}', column {number}: '{printable(match[1])}' is there twice; rename one of them")
        found[match[1]] = match[2]
    if len(found) > MOST_COLUMNS:
        raise CaseError(
            f"'{name}': it has {len(found)} columns, more than {MOST_COLUMNS}; leave out what is not needed"
        )
    return found


def _number(table: NumberTable, row: int, column: str, cell: str, *, commas: bool) -> float:
    """Return the number in a cell."""
    plain = cell.translate(TYPOGRAPHY).strip()
    if not plain:
        raise table.wrong(row, column, "the cell is empty; fill the gap, or leave the row out")
    if "," in plain and not commas:
        raise table.wrong(
            row,
            column,
            f"the comma in '{printable(plain)}' may part decimals or thousands; write decimal points and nothing "
            "between thousands, or decimal commas throughout and semicolons between columns",
        )
    plain = plain.replace(",", ".")
    if _NUMBER.fullmatch(plain) is None or not math.isfinite(float(plain)):
        raise table.wrong(row, column, f"'{printable(plain)}' is not one finite number; state it without its unit")
    return float(plain)
