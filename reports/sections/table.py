"""Numbers as they are told, and tables of them: the same digits wherever one stands."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Self

from alula.fea.common.band import Band
from alula.reports.sections.markup import as_plain
from alula.reports.words.numbers import band, chance, fixed, number, percent, plain
from alula.reports.words.terminal import KEPT


@dataclass(frozen=True)
class Number:
    """A number as it is told: the same digits wherever it stands.

    Attributes
    ----------
    value : float, Band or None
        In the unit of ``result.json``; None where there is none.
    unit : str
        Of the number that is told; "" for a pure number, and where the table's column has it.
    digits : int or None
        Significant ones; None for 4, and 3 of a band.
    decimals : int or None
        In place of significant digits.
    stated : bool
        A number of the case: told as it was written.
    share : bool
        Told as a signed percentage.
    probable : bool
        A probability: told as a percentage.
    beside : float
        A number of which this one is a part: below its rounding error it is 0.
    factor : float
        Of the unit of ``result.json`` in that of the number told.
    sense : str
        Of a limit: ``≥`` or ``≤``, told before it.
    derived : bool
        True for what does not stand in ``result.json`` itself but follows from what does.
    """

    value: float | Band | None
    unit: str = ""
    digits: int | None = None
    decimals: int | None = field(default=None, kw_only=True)
    stated: bool = field(default=False, kw_only=True)
    share: bool = field(default=False, kw_only=True)
    probable: bool = field(default=False, kw_only=True)
    beside: float = field(default=0.0, kw_only=True)
    factor: float = field(default=1.0, kw_only=True)
    sense: str = field(default="", kw_only=True)
    derived: bool = field(default=False, kw_only=True)

    @property
    def shown(self) -> float | Band | None:
        """The value in the unit that is told."""
        if self.value is None or self.factor == 1.0:
            return self.value
        return self.value.times(self.factor) if isinstance(self.value, Band) else self.value * self.factor

    @property
    def figures(self) -> str:
        """Its digits, without the unit."""
        value = self.shown
        if value is None:
            return "–"
        if isinstance(value, Band):
            return band(value, self.digits or 3)
        value = float(value)
        if self.stated:
            return plain(value)
        if self.share:
            return percent(value)
        if self.probable:
            return chance(value)
        if self.decimals is not None and math.isfinite(value):
            return fixed(value, self.decimals)
        return number(value, self.digits or 4, self.beside)

    def __str__(self) -> str:
        """With its unit, where it is known."""
        value = self.value.value if isinstance(self.value, Band) else self.value
        known = value is not None and not math.isnan(value)
        figures = f"{self.sense}{KEPT}{self.figures}" if self.sense else self.figures
        return f"{figures} {self.unit}" if self.unit and known else figures


@dataclass(frozen=True)
class Mark:
    """A verdict in a table, in its colour.

    Attributes
    ----------
    text : str
    kind : str
        ``pass``, ``fail``, ``undecided``; "" for what is not applicable.
    """

    text: str
    kind: str = ""

    def __str__(self) -> str:
        return self.text


Cell = str | Number | Mark


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes
    ----------
    title : str
    unit : str
        Of all its numbers; "" for pure numbers, for text, and where each number has its own.
    role : str
        What its cells are on a narrow page, on which a row is no row: ``what``, ``who``, ``under``, ``value``,
        ``limit``, ``found`` or ``note``; "" elsewhere.
    text : bool
        True for text, which stands at the left.
    wraps : bool
        True for text of which lines may break.
    hidden : bool
        True for one that notebooks alone have.
    """

    title: str
    unit: str = ""
    role: str = field(default="", kw_only=True)
    text: bool = field(default=False, kw_only=True)
    wraps: bool = field(default=False, kw_only=True)
    hidden: bool = field(default=False, kw_only=True)

    @property
    def head(self) -> str:
        """Title and unit."""
        return f"{self.title} [{self.unit}]" if self.unit else self.title


def words(title: str, *, role: str = "", wraps: bool = False, hidden: bool = False) -> Column:
    """Return a column of text.

    Parameters
    ----------
    title : str
    role : str
    wraps : bool
    hidden : bool

    Returns
    -------
    Column
    """
    return Column(title, text=True, role=role, wraps=wraps, hidden=hidden)


def numbers(values: Iterable[float | Band | None], digits: int | None = None, **more: Any) -> list[Number]:
    """Return the cells of a column of numbers.

    Parameters
    ----------
    values : iterable of float, Band or None
    digits : int, optional
        As of ``Number``.
    **more
        As of ``Number``, for all of them.

    Returns
    -------
    list of Number
    """
    return [
        Number(value if value is None or isinstance(value, Band) else float(value), digits=digits, **more)
        for value in values
    ]


@dataclass(frozen=True, kw_only=True)
class Table:
    """Rows of cells.

    Attributes
    ----------
    key : str
        Its name for notebooks; "" for one that is on pages and consoles alone.
    columns : tuple of Column
    rows : tuple of tuple of Cell
    caption : str
    below : mapping of int to str
        A line of text below some rows, by their places.
    apart : frozenset of int
        Rows that stand out.
    under : tuple of (str, str)
        What is the same in all rows and told above the table, such as the load case, as columns for notebooks.
    kind : str
        ``checks`` for one that a narrow page shows as cards, ``keep`` for one that is not broken in print, or "".
    """

    key: str = ""
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    caption: str = ""
    below: Mapping[int, str] = field(default_factory=dict)
    apart: frozenset[int] = frozenset()
    under: tuple[tuple[str, str], ...] = ()
    kind: str = ""

    @classmethod
    def of(cls, columns: Sequence[Column | None], rows: Iterable[Sequence[Cell | None]], **more: Any) -> Self:
        """Return a table without the columns that are None, and without their cells.

        Parameters
        ----------
        columns : sequence of Column or None
        rows : iterable of sequence of Cell or None
            As long as ``columns``.
        **more
            As of the class.

        Returns
        -------
        Table
        """
        kept = [i for i, column in enumerate(columns) if column is not None]
        cells = tuple(tuple("" if row[i] is None else row[i] for i in kept) for row in rows)
        return cls(columns=tuple(columns[i] for i in kept), rows=cells, **more)  # type: ignore[misc, arg-type]

    @classmethod
    def by_columns(cls, columns: Mapping[Column, Iterable[Cell] | None], **more: Any) -> Self:
        """Return a table that is given column by column.

        Parameters
        ----------
        columns : mapping of Column to iterable of Cell
            Column -> its cells, as many as those of the others; one with None in place of cells is left out.
        **more
            As of the class.

        Returns
        -------
        Table
        """
        kept = {column: cells for column, cells in columns.items() if cells is not None}
        return cls(columns=tuple(kept), rows=tuple(zip(*kept.values(), strict=True)), **more)

    @property
    def shown(self) -> Self:
        """The table without the columns that notebooks alone have."""
        kept = [i for i, column in enumerate(self.columns) if not column.hidden]
        if len(kept) == len(self.columns):
            return self
        rows = tuple(tuple(row[i] for i in kept) for row in self.rows)
        return replace(self, columns=tuple(self.columns[i] for i in kept), rows=rows)

    @property
    def records(self) -> list[dict[str, str | float | None]]:
        """Rows as plain data for notebooks: of a band value, ``low`` and ``high``; a cell's own unit in ``unit``."""
        return [self._record(row) for row in self.rows]

    def _record(self, row: tuple[Cell, ...]) -> dict[str, str | float | None]:
        found: dict[str, str | float | None] = dict(self.under)
        for i, (column, cell) in enumerate(zip(self.columns, row, strict=True)):
            name, every = as_name(column), [one for one in (other[i] for other in self.rows) if isinstance(one, Number)]
            if column.text or not every:
                found[name] = str(cell) if column.text or str(cell) else None
                continue
            value = cell.shown if isinstance(cell, Number) else None
            ends = value.told if isinstance(value, Band) else None
            single = float(value) if isinstance(value, float | int) else None
            found[name] = ends.value if ends else single
            if any(isinstance(one.value, Band) for one in every):
                found[f"{name} low"] = ends.low if ends else single
                found[f"{name} high"] = ends.high if ends else single
            if isinstance(cell, Number) and cell.sense:
                found[f"{name} sense"] = cell.sense
            if any(one.unit for one in every):
                found[f"{name} unit"] = cell.unit if isinstance(cell, Number) else ""
        return found


def as_name(column: Column) -> str:
    """Return the name of a column for a script: without marks, without what its cells show anyway.

    Parameters
    ----------
    column : Column

    Returns
    -------
    str
    """
    return as_plain(column.head).replace(" (band)", "")
