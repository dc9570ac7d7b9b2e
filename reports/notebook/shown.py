"""A table and a picture that a notebook shows and a script can use."""

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from alula.fea.common.verdict import Verdict
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.version import extra_command
from alula.reports.sections.markup import as_plain
from alula.reports.sections.section import Part, Section, parts_of
from alula.reports.sections.section import Table as Told
from alula.reports.words.numbers import number, plain

if TYPE_CHECKING:
    from pandas import DataFrame

Cell = str | float | int | None
Row = dict[str, Cell]
T = TypeVar("T")

VERDICT_COLOURS = {Verdict.PASS: "#1a7f37", Verdict.FAIL: "#b42318", Verdict.UNDECIDED: "#8a6100"}


class OldNames(dict[str, Cell]):
    """A row that knows the names which its columns had before, for one version."""

    renamed: Mapping[str, str]

    def __missing__(self, name: str) -> Cell:
        """Return the entry of an old name, with a warning; raises ``KeyError`` for a name that never was."""
        if name not in self.renamed:
            raise KeyError(name)
        new = self.renamed[name]
        warnings.warn(f"the column {name!r} is called {new!r} now", DeprecationWarning, stacklevel=2)
        return self[new]


@dataclass(frozen=True)
class ShownTable:
    """Rows of a result, each a mapping of column names to numbers or text.

    Printed it is aligned text, in a notebook a table, both with the digits and bands of the report; ``list(table)`` is
    plain data, as ``pandas.DataFrame`` takes it. A number that is not known is NaN, and an entry that does not apply is
    None.

    Attributes
    ----------
    rows : tuple of mappings
        All with the same keys; the unit stands in the key, ``"x [mm]"``, or in a column of its own. The ends of a band
        are columns of their own, ``"safety factor low"`` and ``"safety factor high"``.
    heads : tuple of (str, bool)
        Of the columns that are shown, and whether they hold numbers; by default those of the rows.
    cells : tuple of tuple of str
        Their texts.
    """

    rows: tuple[Row, ...]
    heads: tuple[tuple[str, bool], ...] = ()
    cells: tuple[tuple[str, ...], ...] = ()

    @classmethod
    def of(cls, tables: Sequence[Told], renamed: Mapping[str, str] = MappingProxyType({})) -> "ShownTable":
        """Return tables of sections, those of one name, as one.

        Parameters
        ----------
        tables : sequence of alula.reports.sections.section.Table
        renamed : mapping of str to str, optional
            Names that columns had before -> their names now.

        Returns
        -------
        ShownTable
        """
        found = [record for table in tables for record in table.records]
        names = dict.fromkeys(name for record in found for name in record)
        rows = []
        for record in found:
            row = OldNames((name, record.get(name)) for name in names)
            row.renamed = renamed
            rows.append(row)
        under = {name: False for table in tables for name, _ in table.under}
        heads = under | {as_plain(column.head): not column.text for table in tables for column in table.shown.columns}
        cells = []
        for table in tables:
            for cell_row in table.shown.rows:
                own = dict(table.under)
                own |= {as_plain(c.head): as_plain(str(x)) for c, x in zip(table.shown.columns, cell_row, strict=True)}
                cells.append(tuple(own.get(head, "") for head in heads))
        return cls(tuple(rows), tuple(heads.items()), tuple(cells))

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

    def _shown(self) -> tuple[tuple[tuple[str, bool], ...], Sequence[Sequence[str]]]:
        """Return heads and cells as they are shown."""
        if self.heads:
            return self.heads, self.cells
        heads = tuple((name, not any(isinstance(row[name], str) for row in self.rows)) for name in self.columns)
        return heads, [[_text(cell) for cell in row.values()] for row in self.rows]

    def __str__(self) -> str:
        heads, cells = self._shown()
        rows = [[head for head, _ in heads], *cells]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = [
            "  ".join(
                cell.rjust(width) if number else cell.ljust(width)
                for cell, width, (_, number) in zip(row, widths, heads, strict=True)
            ).rstrip()
            for row in rows
        ]
        return "\n".join(lines) if self.rows else "(no rows)"

    def _repr_html_(self) -> str:
        if not self.rows:
            return "<p>(no rows)</p>"
        heads, cells = self._shown()
        sides = [f' style="text-align: {"right" if number else "left"}"' for _, number in heads]
        head = "".join(
            f'<th scope="col"{side}>{escape(name)}</th>' for (name, _), side in zip(heads, sides, strict=True)
        )
        body = "".join(
            "<tr>"
            + "".join(f"<td{side}>{_marked(cell)}</td>" for cell, side in zip(row, sides, strict=True))
            + "</tr>\n"
            for row in cells
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
            raise CannotRunError(f"frame: pandas is not installed; run {extra_command('pandas')}") from None
        return pandas.DataFrame(list(self.rows), columns=list(self.columns))


def table_of(sections: Iterable[Section], name: str, renamed: Mapping[str, str] = MappingProxyType({})) -> ShownTable:
    """Return a table of sections by its name.

    Parameters
    ----------
    sections : iterable of Section
    name : str
    renamed : mapping of str to str, optional
        As of ``ShownTable.of``.

    Returns
    -------
    ShownTable

    Raises
    ------
    CaseError
        For a table that there is not; the error lists the others.
    """
    found: dict[str, list[Told]] = {}
    every: Iterable[Part] = (part for section in sections for part in parts_of(section.parts))
    for part in every:
        if isinstance(part, Told) and part.key:
            found.setdefault(part.key, []).append(part)
    return ShownTable.of(pick(found, name, "table"), renamed)


class Tabled:
    """A report that shows itself as its first table, and whose tables are frames of pandas on request."""

    table: Callable[..., ShownTable]

    def __str__(self) -> str:
        return str(self.table())

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def frame(self, *of: str) -> "DataFrame":
        """Return a table of the report as a frame of pandas, which the extra ``alula[pandas]`` installs.

        Parameters
        ----------
        *of : str
            As for ``table``: which one, where the report has several.

        Returns
        -------
        pandas.DataFrame
            As ``ShownTable.frame``.

        Raises
        ------
        CaseError
            For a table that there is not.
        CannotRunError
            Where pandas is not installed.
        """
        return self.table(*of).frame()


@dataclass(frozen=True)
class ShownPicture:
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
        return f"ShownPicture({len(self.png)} bytes of PNG)"

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
    verdict: Verdict, title: str, lead: str, table: ShownTable, warnings: Sequence[str], below: Sequence[str] = ()
) -> str:
    """Return a short account of a result as HTML, with all text escaped.

    Parameters
    ----------
    verdict : Verdict
    title : str
    lead : str
        Its first sentence.
    table : ShownTable
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
