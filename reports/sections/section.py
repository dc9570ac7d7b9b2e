"""What a reader is told of one feature: a section of numbers, tables, sentences and pictures, made from a result.

Console, page, notebook, ``result.json`` and CSV show sections and know no feature: ``alula.reports.renderers``.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from alula.fea.common.reason import Reason
from alula.reports.sections.table import Cell, Column, Mark, Number, Table, words
from alula.reports.sentences import told
from alula.reports.words.numbers import sentence
from alula.reports.words.terminal import KEPT

__all__ = [
    "KEPT", "Beside", "Cell", "Column", "Command", "Folded", "Group", "Items", "Mark", "Number", "Part", "Picture",
    "Section", "Series", "Table", "Text", "merged", "paragraph", "parts_of", "say", "under_load_cases", "words",
]  # fmt: skip


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


def under_load_cases(parts: Mapping[str, Iterable[Part]]) -> tuple[Part, ...]:
    """Return what is told of each load case, under a heading of its own where there are several.

    Parameters
    ----------
    parts : mapping of str to iterable of Part
        Load case -> what is told of it.

    Returns
    -------
    tuple of Part
    """
    if len(parts) > 1:
        return tuple(Group(f"Load case {name}", tuple(own)) for name, own in parts.items())
    return tuple(part for own in parts.values() for part in own)


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
    running : str
        What it puts at the foot of every printed sheet.
    """

    key: str
    title: str = ""
    short: str = ""
    parts: tuple[Part, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    series: tuple[Series, ...] = ()
    not_covered: tuple[tuple[str, str], ...] = ()
    running: str = ""


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
