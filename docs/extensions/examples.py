"""Examples of entries, out of what is run: the built-in cases, the recipes, and `docs/examples/entries/`.

A file of that folder is a stretch of a case or plan. Its first line says to what it is added, and what it shows:
``# four-bar: A fork.`` Tables of both are merged, and items of lists are added.
"""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import BaseModel

from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_text
from alula.loads.text.entries import file_schema
from docs.extensions.entries import Schema, options
from docs.extensions.links import DOCS

FOLDER = DOCS / "examples" / "entries"
STARTER = "four-bar"
"""The case from which examples are taken before all others."""
STARTER_PLAN = "study"
"""What a stretch of a plan is added to."""
NOTHING = "none"
"""What a stretch that is a whole case is added to."""
_LONGEST = 16
"""Lines of an example that is a table; a longer one is shown by its first statement alone."""
_HEADER = re.compile(r"^\[(\[?)([^\]]+)\]\]?\s*(?:#.*)?$")
_BLOCK = re.compile(r"^```toml\n(.*?)^```$", re.S | re.M)
Key = tuple[str, str]
"""Names of a table's model and of an entry."""
Place = tuple[str | int, ...]


@dataclass(frozen=True, kw_only=True)
class Example:
    """A stretch of a file.

    Attributes
    ----------
    toml : str
        The stretch, with the header of its table.
    source : str
        Where it stands, in words.
    """

    toml: str
    source: str


@dataclass(frozen=True, kw_only=True)
class Text:
    """A text that states entries.

    Attributes
    ----------
    text : str
        TOML.
    source : str
        What it is, as Markdown on a page of the reference.
    tables : dict
        The tables of the file that it belongs to, with its own.
    """

    text: str
    source: str
    tables: dict[str, Any]


def starter(name: str) -> str:
    """Return the text of what a stretch or a recipe is added to.

    Parameters
    ----------
    name : str
        A built-in case, or ``STARTER_PLAN``.

    Returns
    -------
    str
        TOML.
    """
    if name == STARTER_PLAN:
        return files("alula.loads.plans").joinpath("starter-study.toml.txt").read_text(encoding="utf-8")
    return "" if name == NOTHING else read_text(name)[0]


def stretches() -> Iterator[tuple[str, Text]]:
    """Yield the files of `docs/examples/entries/`.

    Yields
    ------
    str
        What the file is added to.
    Text
        The file, with the tables of both.
    """
    for file in sorted(FOLDER.glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        first = re.match(r"# ([\w-]+): (.+)\n", text)
        assert first, f"{file.name}: its first line names no case; write for example '# {STARTER}: A fork.'"
        added = "" if first[1] == NOTHING else f" Added to `{first[1]}`."
        source = f"{first[2]}{added} [{file.name}](../../examples/entries/{file.name})"
        tables = merged(tomllib.loads(starter(first[1])), tomllib.loads(text))
        yield first[1], Text(text=text, source=source, tables=tables)


def recipes() -> Iterator[Text]:
    """Yield the blocks of TOML of the recipes, which the tests follow.

    Yields
    ------
    Text
        A block, with the tables of its file after the whole recipe.
    """
    for file in sorted((DOCS / "how-to").glob("*.md")):
        page = file.read_text(encoding="utf-8")
        title = page.partition("\n")[0].strip("# ")
        tables = {
            target: tomllib.loads(starter(STARTER_PLAN if study else name or STARTER))
            for study, name, target in re.findall(r"alula new (--study )?(?:--from ([\w-]+) )?([\w-]+\.toml)", page)
        }
        blocks = [(re.match(r"# ([\w-]+\.toml)\b", block), block) for block in _BLOCK.findall(page)]
        for name, block in blocks:
            if name:
                tables[name[1]] = merged(tables.get(name[1], {}), tomllib.loads(block))
        for name, block in blocks:
            if name:
                yield Text(text=block, source=f"[{title}](../../how-to/{file.name})", tables=tables[name[1]])


def merged(one: Any, other: Any) -> Any:
    """Return tables with all that another has: tables are merged, items of lists added, and the other's values win.

    Parameters
    ----------
    one, other
        What TOML holds.

    Returns
    -------
    Any
        A new table; the two stay as they are.
    """
    if isinstance(one, dict) and isinstance(other, dict):
        return {**one, **{key: merged(one[key], value) if key in one else value for key, value in other.items()}}
    if isinstance(one, list) and isinstance(other, list) and any(isinstance(item, dict) for item in one):
        return [*one, *other]
    return other


@cache
def examples(model: type[BaseModel] = Case) -> dict[Key, Example]:
    """Find for every entry of a file the first place that states it.

    Parameters
    ----------
    model : type of BaseModel
        ``Case`` or ``StudyPlan``.

    Returns
    -------
    dict of (str, str) to Example
        By the model's name and the entry's.
    """
    found: dict[Key, Example] = {}
    for text in _cases() if model is Case else _plans():
        for key, example in of_text(text, model).items():
            found.setdefault(key, example)
    return found


def _cases() -> Iterator[Text]:
    first, *others = sorted(built_in_cases(), key=lambda name: (name != STARTER, name))
    yield _built_in(first)
    yield from recipes()
    yield from (_built_in(name) for name in others)
    yield from (stretch for base, stretch in stretches() if base != STARTER_PLAN)


def _built_in(name: str) -> Text:
    text = read_text(name)[0]
    return Text(text=text, source=f"Built-in case `{name}`", tables=tomllib.loads(text))


def _plans() -> Iterator[Text]:
    text = starter(STARTER_PLAN)
    yield Text(text=text, source="`alula new --study`", tables=tomllib.loads(text))
    yield from (stretch for base, stretch in stretches() if base == STARTER_PLAN)


def of_text(text: Text, model: type[BaseModel]) -> dict[Key, Example]:
    """Find the stretches of a text that state entries.

    Parameters
    ----------
    text : Text
        The text.
    model : type of BaseModel
        What its file is validated against.

    Returns
    -------
    dict of (str, str) to Example
        Of every entry the first.
    """
    kinds: dict[Place, Key] = {}
    root = file_schema(model)
    _find(root, root, text.tables, (), kinds)
    named = {_without_numbers(place): key for place, key in reversed(kinds.items())}
    found: dict[Key, Example] = {}
    for place, toml in _statements(text.text):
        for end in range(1, len(place) + 1):
            key = named.get(place[:end])
            if key is not None:
                found.setdefault(key, Example(toml=toml, source=text.source))
    return found


def _without_numbers(place: Place) -> Place:
    return tuple(step for step in place if isinstance(step, str))


def _find(node: Schema, root: Schema, value: Any, place: Place, kinds: dict[Place, Key]) -> None:
    """Note of every place in a value which entry of which model it is."""
    for option in options(node, root):
        if isinstance(value, dict) and option.get("type") == "object":
            known = option.get("properties")
            if known is None:
                for key, child in value.items() if isinstance(option.get("additionalProperties"), dict) else ():
                    _find(option["additionalProperties"], root, child, (*place, key), kinds)
            elif set(value) <= set(known) and all(known[k].get("const", v) == v for k, v in value.items()):
                for key, child in value.items():
                    kinds.setdefault((*place, key), (option.get("title", ""), key))
                    _find(known[key], root, child, (*place, key), kinds)
        elif isinstance(value, list) and option.get("type") == "array":
            inner = [*option.get("prefixItems", ())] or [option.get("items", {})] * len(value)
            for number, (child, item) in enumerate(zip(inner, value, strict=False)):
                _find(child, root, item, (*place, number), kinds)


def _statements(text: str) -> Iterator[tuple[Place, str]]:
    """Yield what every statement states, and its text below the header of its table; a header comes with its table."""
    lines = text.splitlines()
    above: Place = ()
    header, number = "", 0
    while number < len(lines):
        line = lines[number]
        if head := _HEADER.match(line):
            header = line.partition("#")[0].strip()
            above = _keys(tomllib.loads(f"[{head[2]}]"))
            body = _table(lines[number + 1 :])
            if 0 < len(body) <= _LONGEST:
                yield above, "\n".join([header, *body])
        elif line.strip() and not line.lstrip().startswith("#"):
            end = number + 1
            while True:
                statement = "\n".join(lines[number:end])
                try:
                    stated = tomllib.loads(statement)
                    break
                except tomllib.TOMLDecodeError:
                    end += 1
            toml = f"{header}\n{statement}" if header else statement
            for place in _places(stated):
                yield (*above, *place), toml
            number = end - 1
        number += 1


def _table(lines: list[str]) -> list[str]:
    """Return the lines of a table: up to the next header, without comments of their own and empty lines."""
    body: list[str] = []
    for line in lines:
        if _HEADER.match(line):
            break
        body.append(line)
    return [line for line in body if line.strip() and not line.lstrip().startswith("#")]


def _keys(nested: dict[str, Any]) -> Place:
    """Return the keys of a header."""
    found: list[str] = []
    while nested:
        [(key, nested)] = nested.items()
        found.append(key)
    return tuple(found)


def _places(value: Any, place: Place = ()) -> Iterator[Place]:
    """Yield every place inside of a value, lists passed over."""
    if isinstance(value, dict):
        for key, child in value.items():
            yield (*place, key)
            yield from _places(child, (*place, key))
    elif isinstance(value, list):
        for child in value:
            yield from _places(child, place)
