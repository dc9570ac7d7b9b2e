"""Edits of TOML text in place: an entry is set, added, removed or renamed, and every other byte stays as it is.

The text is read once for where its keys and values stand; an edit puts new text at such a place. ``tomlkit``, which
writes new case files, takes eight times as long to read one as ``tomllib`` does: too long at every move of a pointer.
"""

import json
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from alula.geometry.base.errors import CaseError

Key = str | int
Path = tuple[Key, ...]
_TRIVIA = re.compile(r"(?:[ \t\r\n]+|#[^\n]*)*")
_KEY = re.compile(r"""[ \t]*([A-Za-z0-9_-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')[ \t]*""")
_STRING = re.compile(r'''"""(?:[^\\]|\\.)*?"{3,5}|\'\'\'.*?'{3,5}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*\'''', re.DOTALL)
_BARE = re.compile(r"[^,\]}#\r\n]*[^,\]}#\r\n \t]")
_LINE = re.compile(r"[^\n]*(?:\n|\Z)")


@dataclass(slots=True)
class _Item:
    """A value in the text: where it stands, with its key (an element of a list has none), and what is in it."""

    begin: int
    start: int
    end: int = 0
    inner: list[Path] = field(default_factory=list)
    comma: int | None = None
    """End of the comma after the last element."""


@dataclass(slots=True)
class _Block:
    """Whole lines: a statement, or a heading with the statements below it."""

    path: Path
    begin: int
    end: int
    section: int = 0
    start: int = 0
    """Of a statement: where its key begins."""
    array: bool = False


class _Layout:
    """Where all that valid TOML states stands in its text."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.items: dict[Path, _Item] = {}
        self.keys: list[tuple[Path, int, int]] = []
        self.statements: list[_Block] = []
        self.sections: list[_Block] = [_Block((), 0, 0)]
        counts: dict[Path, int] = {}
        at = self._after(0)
        while at < len(text):
            begin = text.rfind("\n", 0, at) + 1
            if text[at] == "[":
                array = text.startswith("[[", at)
                path, at = self._dotted(at + 1 + array, (), counts)
                if array:
                    counts[path] = counts.get(path, -1) + 1
                    path = (*path, counts[path])
                end = self._after(at, _LINE)
                self.sections.append(_Block(path, begin, end, array=array))
            else:
                start = at
                path, at = self._dotted(at, self.sections[-1].path, {})
                end = self._after(self._value(path, start, self._after(at + 1)), _LINE)
                self.statements.append(_Block(path, begin, end, len(self.sections) - 1, start))
                self.sections[-1].end = end
            at = self._after(end)

    def _after(self, at: int, what: re.Pattern[str] = _TRIVIA) -> int:
        found = what.match(self.text, at)
        return found.end() if found else at

    def _dotted(self, at: int, path: Path, counts: dict[Path, int]) -> tuple[Path, int]:
        """Read keys with dots; return the path that they lead to, and the place after them."""
        while True:
            if path in counts:
                path = (*path, counts[path])
            found = _KEY.match(self.text, at)
            if found is None:
                raise ValueError("no key")
            name = found[1].strip("'") if found[1][0] != '"' else tomllib.loads(f"key = {found[1]}")["key"]
            path = (*path, name)
            self.keys.append((path, *found.span(1)))
            at = found.end()
            if self.text[at] != ".":
                return path, at
            at += 1

    def _value(self, path: Path, begin: int, at: int) -> int:
        """Read a value; return the place after it."""
        text, item = self.text, _Item(begin, at)
        self.items[path] = item
        if text[at] in "[{":
            closing, at = "]" if text[at] == "[" else "}", self._after(at + 1)
            while text[at] != closing:
                start = at
                if closing == "}":
                    inner, at = self._dotted(at, path, {})
                    at = self._after(at + 1)
                else:
                    inner = (*path, len(item.inner))
                item.inner.append(inner)
                at = self._after(self._value(inner, start, at))
                item.comma = None
                if text[at] == ",":
                    item.comma, at = at + 1, self._after(at + 1)
            item.end = at + 1
        else:
            item.end = self._after(at, _STRING if text[at] in "\"'" else _BARE)
        return item.end


def value_at(tables: Any, path: Sequence[Key]) -> Any:
    """Return what stands at a path; None where nothing does.

    Parameters
    ----------
    tables : object
        Nested tables and lists.
    path : sequence of str and int
        Keys, and numbers in lists.

    Returns
    -------
    object
    """
    for key in path:
        known = tables if isinstance(tables, dict) else range(len(tables)) if isinstance(tables, list) else ()
        if key not in known:
            return None
        tables = tables[key]
    return tables


def literal(value: Any, like: str = "") -> str:
    """Return the TOML of a value, in one line unless it is a text of several.

    Parameters
    ----------
    value : object
        As ``tomllib`` would return it.
    like : str
        What stands in its place so far, whose quotes are kept.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For what is no value of TOML.
    """
    match value:
        case bool():
            return "true" if value else "false"
        case str() if like.startswith("'") and not like.startswith("'''") and value.isprintable() and "'" not in value:
            return f"'{value}'"
        case str() if "\n" in value and not re.search(r'[\x00-\x08\x0b-\x1f\x7f\\]|"""|"\Z', value):
            return f'"""\n{value}"""'
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case int() | float():
            return repr(value)
        case list() | tuple():
            return f"[{', '.join(map(literal, value))}]"
        case dict():
            inner = ", ".join(f"{_key(key)} = {literal(one)}" for key, one in value.items())
            return f"{{ {inner} }}" if inner else "{}"
    raise CaseError(f"edit: {type(value).__name__} is no value of TOML; write text, a number, true, false or a list")


def _key(name: Key) -> str:
    return str(name) if re.fullmatch(r"[A-Za-z0-9_-]+", str(name)) else json.dumps(str(name), ensure_ascii=False)


def _dots(path: Sequence[Key]) -> str:
    return ".".join(_key(key) for key in path if isinstance(key, str))


def _of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)


def _lines(key: str, value: Any) -> list[str]:
    """Return the lines that state an entry: points of a link one a line, all else in one."""
    if isinstance(value, dict) and value and all(isinstance(one, list) for one in value.values()):
        return [f"{key}.{_key(name)} = {literal(one)}" for name, one in value.items()]
    return [f"{key} = {literal(value)}"]


def _section(path: Path, value: dict[str, Any], array: bool = False) -> list[str]:
    """Return the lines of a heading and of what stands below it."""
    lines = [f"[[{_dots(path)}]]" if array else f"[{_dots(path)}]"]
    for key, one in value.items():
        if array or not _of_tables(one):
            lines += _lines(_key(key), one)
    for key, one in value.items():
        for table in one if _of_tables(one) and not array else ():
            lines += _section((*path, key), table, array=True)
    return lines


def _below(path: Path, above: Path) -> bool:
    return path[: len(above)] == above


class TomlText:
    """The text of a TOML file that is edited entry by entry.

    Attributes
    ----------
    tables : dict of str to object
        What the text is meant to state, as ``tomllib`` would read it. Tables are copied where they change.

    Parameters
    ----------
    text : str
        Valid TOML, without a byte order mark.
    tables : dict of str to object
        What it states.
    """

    def __init__(self, text: str, tables: dict[str, Any]) -> None:
        self.tables = tables
        self._text = text
        self._newline = "\r\n" if "\r\n" in text else "\n"
        self._splices: dict[tuple[int, int], str] = {}
        self._layout: _Layout | None = None

    @property
    def text(self) -> str:
        """The text with all edits made."""
        if self._splices:
            parts, at = [], 0
            for (start, end), new in sorted(self._splices.items()):
                parts += [self._text[at:start], new]
                at = end
            self._text = "".join([*parts, self._text[at:]])
            self._splices, self._layout = {}, None
        return self._text

    def put(self, path: Sequence[Key], value: Any) -> None:
        """Set an entry, or remove it where the value is None. Missing tables are made; a list grows by one at its end.

        Parameters
        ----------
        path : sequence of str and int
            Keys, and numbers in lists.
        value : object
            What shall stand there.

        Raises
        ------
        CaseError
            Where the path leads through a value, or beyond the end of a list.
        """
        path, value = tuple(path), _plain(value)
        old = value_at(self.tables, path)
        if not path:
            raise CaseError("edit: the path of an entry has at least one key; state which entry is meant")
        if value is None:
            self.remove(path)
        elif old is None:
            self._add(path, value)
        elif type(old) is type(value) and old == value:
            return
        elif isinstance(old, dict) and isinstance(value, dict):
            for key in [key for key in old if key not in value]:
                self.remove((*path, key))
            for key, one in value.items():
                self.put((*path, key), one)
        elif isinstance(old, list) and isinstance(value, list) and old and value:
            for index in range(len(old) - 1, len(value) - 1, -1):
                self.remove((*path, index))
            for index, one in enumerate(value):
                self.put((*path, index), one)
        elif (item := self._read().items.get(path)) is not None:
            self._splice(item.start, item.end, literal(value, self._text[item.start : item.end]))
            self._keep(path, value)
        else:
            self.remove(path)
            self._add(path, value)

    def remove(self, path: Sequence[Key]) -> None:
        """Remove an entry, if it is there; comments on lines of their own stay.

        Parameters
        ----------
        path : sequence of str and int
            Keys, and numbers in lists.
        """
        path = tuple(path)
        if value_at(self.tables, path) is None:
            return
        layout = self._read(fresh=True)
        if (above := layout.items.get(path[:-1])) is not None and path in above.inner:
            self._remove_inner(above, path)
        else:
            gone = [one for one in layout.sections if one.path and _below(one.path, path)]
            loose = [
                one for one in layout.statements if _below(one.path, path) and layout.sections[one.section] not in gone
            ]
            self._cut([(one.begin, one.end) for one in (*gone, *loose)])
        self._keep(path, None)
        self._prune(path[:-1])

    def rename(self, path: Sequence[Key], to: str) -> None:
        """Give the key of an entry another name, at every place that has it.

        Parameters
        ----------
        path : sequence of str and int
            Keys, and numbers in lists.
        to : str
            The new key.
        """
        path = tuple(path)
        for one, start, end in self._read(fresh=True).keys:
            if one == path:
                self._splice(start, end, _key(to))
        above = value_at(self.tables, path[:-1])
        renamed = {to if key == path[-1] else key: value for key, value in above.items()}
        self._keep(path[:-1], renamed)
        self._read(fresh=True)

    def line(self, path: Sequence[Key]) -> int | None:
        """Return the line on which an entry, or the nearest one that holds it, begins.

        Parameters
        ----------
        path : sequence of str and int
            Keys, and numbers in lists.

        Returns
        -------
        int or None
            From 1; None where nothing is found.
        """
        layout, path = self._read(fresh=True), tuple(path)
        while path:
            places = [one.begin for one in layout.sections if one.path and one.path == path]
            places += [layout.items[path].begin] if path in layout.items else []
            places = places or [start for one, start, _ in layout.keys if one == path]
            if places:
                return self._text.count("\n", 0, min(places)) + 1
            path = path[:-1]
        return None

    def _read(self, fresh: bool = False) -> _Layout:
        """Return where all stands; after ``fresh``, edits of values that wait are made."""
        if fresh and self._splices:
            self._text = self.text
        if self._layout is None:
            self._layout = _Layout(self.text)
        return self._layout

    def _splice(self, start: int, end: int, new: str) -> None:
        self._splices[start, end] = new if self._newline == "\n" else new.replace("\n", "\r\n")

    def _keep(self, path: Path, value: Any) -> None:
        self.tables = _with(self.tables, path, value)

    def _prune(self, path: Path) -> None:
        """Forget tables that have no entry left, and that no heading and no braces state."""
        layout = self._read(fresh=True)
        while path and value_at(self.tables, path) in ({}, []):
            if path in layout.items or any(one.path == path for one in layout.sections):
                return
            self._keep(path, None)
            path = path[:-1]

    def _cut(self, spans: list[tuple[int, int]]) -> None:
        """Remove whole lines; of the empty lines around them one stays."""
        text = self._text
        for start, end in spans:
            blank = re.compile(r"[ \t]*\r?\n").match(text, end)
            if blank and re.search(r"(?:\A|\n)[ \t]*\r?\n\Z", text[max(0, start - 80) : start]):
                end = blank.end()
            self._splices[start, end] = ""

    def _remove_inner(self, above: _Item, path: Path) -> None:
        """Remove an entry of an inline table or an element of a list, with its comma."""
        text, items, at = self._text, self._read().items, above.inner.index(path)
        item = items[path]
        line = text.rfind("\n", 0, item.begin) + 1
        rest = re.compile(r"[ \t]*,?[ \t]*(?:#[^\n]*)?\r?\n").match(text, item.end)
        if rest and not text[line : item.begin].strip() and text[above.start] == "[":
            self._splices[line, rest.end()] = ""
        elif len(above.inner) == 1:
            self._splices[above.start + 1, above.end - 1] = ""
        elif at:
            self._splices[items[above.inner[at - 1]].end, item.end] = ""
        else:
            self._splices[item.begin, items[above.inner[1]].begin] = ""

    def _add(self, path: Path, value: Any) -> None:
        """Add an entry below the deepest table or list that is there."""
        depth = next(n for n in range(len(path) - 1, -1, -1) if n == 0 or value_at(self.tables, path[:n]) is not None)
        above, key, there = path[:depth], path[depth], value_at(self.tables, path[:depth])
        if not isinstance(there, dict | list):
            raise CaseError(f"edit {_told(path)}: '{_told(above)}' is a value, so nothing can be set below it")
        if isinstance(there, list) != isinstance(key, int) or (isinstance(key, int) and key != len(there)):
            raise CaseError(f"edit {_told(path)}: '{_told(above)}' has no entry '{key}'; correct the path")
        nested = value
        for one in reversed(path[depth + 1 :]):
            nested = [nested] if one == 0 else {one: nested}
        layout = self._read(fresh=True)
        if above in layout.items:
            self._add_inner(layout.items[above], key, nested)
        elif isinstance(key, int):
            self._add_section(above, _section(above, nested, array=True))
        else:
            self._add_entry(above, key, nested, path, value)
        self._keep((*above, key), nested)
        self._read(fresh=True)

    def _add_inner(self, above: _Item, key: Key, value: Any) -> None:
        """Add to an inline table or to a list that stands in the text as one."""
        text = self._text
        new = literal(value) if isinstance(key, int) else f"{_key(key)} = {literal(value)}"
        if not above.inner:
            space = " " if text[above.start] == "{" else ""
            self._splice(above.start + 1, above.end - 1, f"{space}{new}{space}")
            return
        last = self._read().items[above.inner[-1]]
        line = text.rfind("\n", 0, last.begin) + 1
        if text[line : last.begin].strip() or line <= above.start:
            self._splice(last.end, last.end, f", {new}")
        else:  # one a line
            end = re.compile(r"[^\r\n]*").match(text, above.comma or last.end)
            rest = end[0] if end and not above.comma else ""
            place = end.end() if end else last.end
            comma = "," if above.comma else ""
            ahead = "" if above.comma else ","
            self._splice(place - len(rest), place, f"{ahead}{rest}\n{text[line : last.begin]}{new}{comma}")

    def _add_entry(self, above: Path, key: str, value: Any, path: Path, leaf: Any) -> None:
        """Add to a table with a heading, with dotted keys, or that only headings below it state."""
        layout, text = self._read(), self._text
        own = next((n for n, one in enumerate(layout.sections) if one.path == above), None)
        below = [one for one in layout.statements if _below(one.path, above) and len(one.path) > len(above)]
        dotted = [one for one in below if len(layout.sections[one.section].path) < len(above)]
        headed = any(one.path[:-1] == above and not one.array for one in layout.sections[1:])
        table = isinstance(value, dict) and (not above or headed or not (own is not None or dotted))
        if table or (_of_tables(value) and not dotted) or (own is None and not dotted):
            made = [] if not _of_tables(leaf) or len(path) == len(above) + 1 else [f"[{_dots(path[:-1])}]"]
            tables = leaf if _of_tables(leaf) else [leaf if isinstance(leaf, dict) else {str(path[-1]): leaf}]
            path = path if isinstance(leaf, dict) or _of_tables(leaf) else path[:-1]
            lines = (line for one in tables for line in _section(path, one, array=_of_tables(leaf)))
            self._add_section(above, [*made, *lines])
            return
        new = f"{_key(key)} = {literal(value)}"
        if dotted:
            last = dotted[-1]
            end = next(end for one, start, end in layout.keys if one == above and start >= last.start)
            new = f"{text[last.start : end]}.{new}"
        else:
            inside = [one for one in layout.statements if one.section == own]
            last = inside[-1] if inside else layout.sections[own or 0]
        self._insert(last.end, f"{text[last.begin : last.start] if last.start else ''}{new}\n")

    def _add_section(self, above: Path, lines: list[str]) -> None:
        """Add a heading and its lines after all that stands below a table, or at the end of the file."""
        text, layout = self._text, self._read()
        ends = [one.end for one in layout.sections[1:] if above and _below(one.path, above)]
        place = max(ends, default=len(text))
        comment = re.compile(r"(?:[ \t]*#[^\n]*(?:\n|\Z))*").match(text, place)
        if comment and not text.startswith("[", comment.end()):
            place = comment.end()
        array = lines[0].startswith("[[")
        gap = "" if array or not text[:place].strip() or text[:place].endswith(("\n\n", "\n\r\n")) else "\n"
        self._insert(place, gap + "".join(f"{line}\n" for line in lines))

    def _insert(self, place: int, new: str) -> None:
        ahead = "\n" if place and self._text[place - 1] != "\n" else ""
        self._splice(place, place, ahead + new)


def _told(path: Sequence[Key]) -> str:
    return ".".join(map(str, path))


def _plain(value: Any) -> Any:
    """Return a value without entries that are None."""
    if isinstance(value, dict):
        return {str(key): _plain(one) for key, one in value.items() if one is not None}
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def _with(tables: Any, path: Path, value: Any) -> Any:
    """Return tables with another value at a path, or without it where that is None; what changes is copied."""
    if not path:
        return value
    key, rest = path[0], path[1:]
    if isinstance(tables, list) and isinstance(key, int):
        inner = _with(tables[key], rest, value) if key < len(tables) else value
        return [*tables[:key], *([] if inner is None else [inner]), *tables[key + 1 :]]
    inner = _with(tables.get(key, {}), rest, value)
    return {one: kept for one, kept in tables.items() if one != key} if inner is None else {**tables, key: inner}
