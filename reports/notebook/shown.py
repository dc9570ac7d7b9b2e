"""A table and a picture that a notebook shows and a script can use."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from alula.fea.common.verdict import Verdict
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.reports.words.numbers import number, plain

if TYPE_CHECKING:
    from pandas import DataFrame

Cell = str | float | int | None
Row = dict[str, Cell]
T = TypeVar("T")

VERDICT_COLOURS = {Verdict.PASS: "#1a7f37", Verdict.FAIL: "#b42318", Verdict.UNDECIDED: "#8a6100"}


@dataclass(frozen=True)
class Table:
    """Rows of a result, each a mapping of column names to numbers or text.

    Printed it is aligned text, in a notebook a table; ``list(table)`` is plain data, as ``pandas.DataFrame`` takes it.
    A number that is not known is NaN, and an entry that does not apply is None.

    Attributes
    ----------
    rows : tuple of mappings
        All with the same keys; the unit stands in the key, ``"x [mm]"``, or in a column of its own.
    """

    rows: tuple[Row, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self.rows[0]) if self.rows else ()

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __getitem__(self, index: int) -> Row:
        return self.rows[index]

    def __str__(self) -> str:
        cells = [self.columns, *([_text(cell) for cell in row.values()] for row in self.rows)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        right = [self._is_number(column) for column in self.columns]
        lines = [
            "  ".join(
                cell.rjust(width) if aligned else cell.ljust(width)
                for cell, width, aligned in zip(line, widths, right, strict=True)
            ).rstrip()
            for line in cells
        ]
        return "\n".join(lines) if self.rows else "(no rows)"

    def _repr_html_(self) -> str:
        if not self.rows:
            return "<p>(no rows)</p>"
        sides = {name: "right" if self._is_number(name) else "left" for name in self.columns}
        aligned = {name: f' style="text-align: {side}"' for name, side in sides.items()}
        head = "".join(f'<th scope="col"{aligned[name]}>{escape(name)}</th>' for name in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td{aligned[name]}>{_marked(cell)}</td>" for name, cell in row.items()) + "</tr>\n"
            for row in self.rows
        )
        return f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>\n</table>"

    def frame(self) -> "DataFrame":
        """Return the table as a frame of pandas, which the extra ``alula[pandas]`` installs.

        Returns
        -------
        pandas.DataFrame
            With the columns of the table; numbers that are not known and entries that do not apply are missing values.

        Raises
        ------
        CannotRunError
            Where pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise CannotRunError("frame: pandas is not installed; run pip install 'alula[pandas]'") from None
        return pandas.DataFrame(list(self.rows), columns=list(self.columns))

    def _is_number(self, column: str) -> bool:
        return not any(isinstance(row[column], str) for row in self.rows)


class Tabled:
    """A report whose tables are frames of pandas on request."""

    table: Callable[..., Table]

    def frame(self, *of: str) -> "DataFrame":
        """Return a table of the report as a frame of pandas, which the extra ``alula[pandas]`` installs.

        Parameters
        ----------
        *of : str
            As for ``table``: which one, where the report has several.

        Returns
        -------
        pandas.DataFrame
            As ``Table.frame``.

        Raises
        ------
        CaseError
            For a table that there is not.
        CannotRunError
            Where pandas is not installed.
        """
        return self.table(*of).frame()


@dataclass(frozen=True)
class Picture:
    """A picture that a notebook shows by itself.

    Attributes
    ----------
    png : bytes
        The picture as a PNG file.
    """

    png: bytes

    def _repr_png_(self) -> bytes:
        return self.png

    def __repr__(self) -> str:
        return f"Picture({len(self.png)} bytes of PNG)"

    def save(self, path: str | Path) -> None:
        """Write the picture as a PNG file.

        Parameters
        ----------
        path : str | Path
            File to write.

        Raises
        ------
        OSError
            Where the file cannot be written.
        """
        Path(path).write_bytes(self.png)


def pick(named: Mapping[str, T], name: str, what: str) -> T:
    """Return an entry by its name.

    Parameters
    ----------
    named : mapping
    name : str
        Its name.
    what : str
        What it is called in the error, such as ``link``.

    Returns
    -------
    T

    Raises
    ------
    CaseError
        For a name that does not exist; the error lists the others.
    """
    if name not in named:
        close = get_close_matches(str(name), named, n=1)
        choice = f"did you mean '{close[0]}'?" if close else f"choose one of {', '.join(named) or 'none'}"
        raise CaseError(f"there is no {what} '{name}'; {choice}")
    return named[name]


def summary(
    verdict: Verdict, title: str, lead: str, table: Table, warnings: Sequence[str], below: Sequence[str] = ()
) -> str:
    """Return a short account of a result as HTML, with all text escaped.

    Parameters
    ----------
    verdict : Verdict
    title : str
    lead : str
        Its first sentence.
    table : Table
    warnings : sequence of str
    below : sequence of str, optional
        Paragraphs below the table.

    Returns
    -------
    str
    """
    more = "".join(f"\n<p>{escape(line)}</p>" for line in below)
    told = "".join(f"<li>{escape(warning)}</li>" for warning in warnings)
    return (
        f"<p>{_marked(verdict.value, verdict.value.upper())} <b>{escape(title)}</b></p>\n<p>{escape(lead)}</p>\n"
        f"{table._repr_html_()}{more}" + (f"\n<p>Warnings:</p><ul>{told}</ul>" if told else "")
    )


def _text(cell: Cell) -> str:
    if cell is None:
        return ""
    if isinstance(cell, str):
        return cell
    return plain(cell) if 1e-4 <= abs(cell) < 1e5 and float(f"{cell:.4g}") == cell else number(cell)


def _marked(cell: Cell, shown: str = "") -> str:
    text = escape(shown or _text(cell))
    if cell in tuple(Verdict):
        return f'<b style="color: {VERDICT_COLOURS[Verdict(str(cell))]}">{text}</b>'
    return text
