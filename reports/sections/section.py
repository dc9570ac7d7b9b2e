"""What a reader is told of one feature: a section of numbers, tables, sentences and pictures, made from a result.

Console, page, notebook, ``result.json`` and CSV show sections and know no feature: ``alula.reports.renderers``.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.reports.sections.markup import as_plain
from alula.reports.sentences import told
from alula.reports.words.numbers import band, chance, fixed, number, percent, plain, sentence

KEPT = "\u00a0"
"""A space at which no line is broken, such as between a name and its number."""


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


@dataclass(frozen=True)
class Text:
    """A paragraph.

    Attributes
    ----------
    text : str
        With the marks of ``alula.reports.sections.markup``.
    kind : str
        "" for what was found; ``note`` for how it is to be read, which the page alone tells; ``small`` and ``lead`` as
        they are set on the page; ``apart`` for a warning.
    numbers : tuple of Number
        Those that stand in it.
    """

    text: str
    kind: str = ""
    numbers: tuple[Number, ...] = ()


def say(template: str, kind: str = "", /, **facts: object) -> Text:
    """Return a paragraph that knows its numbers.

    Parameters
    ----------
    template : str
        With places such as ``{torque}``.
    kind : str, optional
        As of ``Text``.
    **facts
        Text, ``Number``, reasons.

    Returns
    -------
    Text
        With a capital at its beginning and a full stop at its end.
    """
    written = {name: told(fact) if isinstance(fact, Reason) else str(fact) for name, fact in facts.items()}
    numbers = tuple(fact for fact in facts.values() if isinstance(fact, Number))
    return Text(sentence(template.format(**written)), kind, numbers)


def paragraph(*pieces: object, kind: str = "") -> Text:
    """Return a paragraph that is put together from pieces, and knows its numbers.

    Parameters
    ----------
    *pieces
        Text, ``Number``, reasons.
    kind : str, optional
        As of ``Text``.

    Returns
    -------
    Text
        With a capital at its beginning and a full stop at its end.
    """
    written = "".join(told(piece) if isinstance(piece, Reason) else str(piece) for piece in pieces)
    return Text(sentence(written), kind, tuple(piece for piece in pieces if isinstance(piece, Number)))


@dataclass(frozen=True)
class Items:
    """A list of texts, or of titles with a text each.

    Attributes
    ----------
    items : tuple of str or of (str, str)
    kind : str
        "" for what was found, ``note`` for what the page alone tells, ``columns`` for two columns, ``warnings``.
    """

    items: tuple[str | tuple[str, str], ...]
    kind: str = ""


@dataclass(frozen=True, kw_only=True)
class Picture:
    """A picture, and the model that a reader can turn in its place.

    Attributes
    ----------
    name : str
        Of its file, without ending; "" for a model alone.
    alt : str
        What it shows, for those who do not see it.
    caption : str
    draw : callable or None
        Returns the drawing; None for one that is rendered elsewhere, and given to the renderer by its name.
    model : str
        Name of the model; "" without one.
    kind : str
        ``half`` for one that stands beside another, ``map`` for a small one, or "".
    """

    name: str = ""
    alt: str = ""
    caption: str
    draw: Callable[[], Any] | None = None
    model: str = ""
    kind: str = ""


@dataclass(frozen=True)
class Folded:
    """Parts that a page shows when a reader opens them.

    Attributes
    ----------
    title : str
    parts : tuple of Part
    opened : bool
        True where the page shows them from the start.
    told : bool
        True where a console tells them too.
    """

    title: str
    parts: "tuple[Part, ...]"
    opened: bool = False
    told: bool = False


@dataclass(frozen=True)
class Beside:
    """Parts that stand beside one another where there is room.

    Attributes
    ----------
    parts : tuple of Part
    kind : str
        ``pair`` for a picture and what is told beside it, ``columns`` for tables.
    """

    parts: "tuple[Part, ...]"
    kind: str = "pair"


@dataclass(frozen=True)
class Group:
    """Parts under a heading of their own.

    Attributes
    ----------
    title : str
    parts : tuple of Part
    key : str
        Its place on the page; "" for one to which nothing leads.
    remark : str
        Small, after the title.
    """

    title: str
    parts: "tuple[Part, ...]"
    key: str = ""
    remark: str = ""


@dataclass(frozen=True)
class Command:
    """A command that a reader may run: on a line of its own, which a shell takes as it is copied.

    Attributes
    ----------
    text : str
        What it is for.
    command : str
    """

    text: str
    command: str


Part = Text | Items | Table | Picture | Folded | Beside | Group | Command


@dataclass(frozen=True, kw_only=True)
class Series:
    """Columns of numbers for a file, too long to be told.

    Attributes
    ----------
    file : str
        Its name.
    columns : mapping of str to array, shape (n,)
        Title with unit -> values.
    digits : int or None
        Significant ones, with nothing in place of what is unknown or unbounded; None for numbers in full.
    """

    file: str
    columns: Mapping[str, ArrayLike]
    digits: int | None = None

    @classmethod
    def below(cls, file: str, cases: Mapping[str, Mapping[str, ArrayLike]], digits: int = 12) -> Self:
        """Return the series of several load cases below one another, in the first column their names.

        Parameters
        ----------
        file : str
        cases : mapping of str to mapping of str to array, shape (n,)
            Load case -> title with unit -> values; a column that one lacks is empty there.
        digits : int, optional
            As of the class.

        Returns
        -------
        Series
        """
        counts = {name: len(np.asarray(next(iter(columns.values())))) for name, columns in cases.items()}
        found: dict[str, ArrayLike] = {"load case": [name for name, count in counts.items() for _ in range(count)]}
        for title in dict.fromkeys(title for columns in cases.values() for title in columns):
            every = [columns.get(title, np.full(counts[name], np.nan)) for name, columns in cases.items()]
            found[title] = np.concatenate([np.asarray(values) for values in every])
        return cls(file=file, columns=found, digits=digits)

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """Yield one tuple for each value of the columns."""
        return zip(*(np.asarray(values).tolist() for values in self.columns.values()), strict=True)


@dataclass(frozen=True, kw_only=True)
class Section:
    """What a reader is told of one feature.

    Attributes
    ----------
    key : str
        Its place on the page.
    title : str
        "" for one that has entries of ``result.json`` alone.
    short : str
        Its title in the contents; "" for one that is not listed there.
    parts : tuple of Part
    data : mapping
        Its entries of ``result.json``, which are put together with those of the other sections.
    series : tuple of Series
        Its tables in files.
    not_covered : tuple of (str, str)
        What it leaves out: title and sentences.
    """

    key: str
    title: str = ""
    short: str = ""
    parts: tuple[Part, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    series: tuple[Series, ...] = ()
    not_covered: tuple[tuple[str, str], ...] = ()


def parts_of(parts: Iterable[Part]) -> Iterator[Part]:
    """Yield all parts, those within others after what holds them.

    Parameters
    ----------
    parts : iterable of Part

    Yields
    ------
    Part
    """
    for part in parts:
        yield part
        if isinstance(part, Folded | Beside | Group):
            yield from parts_of(part.parts)


def merged(records: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return entries of several sections as one record.

    Parameters
    ----------
    records : iterable of mapping

    Returns
    -------
    dict
        Mappings under one name are put together.

    Raises
    ------
    ValueError
        For an entry that two records give.
    """
    found: dict[str, Any] = {}
    for record in records:
        for key, value in record.items():
            if key not in found:
                found[key] = dict(value) if isinstance(value, Mapping) else value
            elif isinstance(value, Mapping) and isinstance(found[key], Mapping):
                found[key] = merged((found[key], value))
            else:
                raise ValueError(f"two sections give the entry {key}")
    return found
