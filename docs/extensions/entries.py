"""Tables and entries of a file, as its JSON Schema has them: kind, unit, default, rules and description of each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

Schema = Mapping[str, Any]
ANY_NAME = "NAME"
"""Stands in a path for a name that the user chooses."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One entry of a table.

    Attributes
    ----------
    name : str
        Its key.
    kind : str
        What it holds, in words.
    dimensions : tuple of str
        Dimensions of its quantities, such as ``"length"``.
    needed : bool
        True where it may not be left out.
    default : object
        Its value where it is left out, as a file states it; None where nothing stands in its place, or another entry.
    rules : tuple of str
        In words.
    text : str
        Description, Markdown.
    tables : tuple of str
        Names of the tables that it holds.
    """

    name: str
    kind: str
    dimensions: tuple[str, ...]
    needed: bool
    default: object
    rules: tuple[str, ...]
    text: str
    tables: tuple[str, ...]


@dataclass(kw_only=True)
class EntryTable:
    """A table with its entries.

    Attributes
    ----------
    name : str
        Of its model.
    text : str
        Description, Markdown.
    paths : list of str
        Where it stands, such as ``links.NAME.eyes.NAME``.
    mark : str
        The entry that tells it from others at the same place, such as ``type = "pins"``; empty where none does.
    entries : tuple of Entry
        In the order of the model.
    """

    name: str
    text: str
    paths: list[str] = field(default_factory=list)
    mark: str = ""
    entries: tuple[Entry, ...] = ()


def options(node: Schema, root: Schema) -> list[Schema]:
    """Return what a node may be: references followed, unions taken apart, without null.

    Parameters
    ----------
    node, root : mapping
        A node, and the schema that it belongs to.

    Returns
    -------
    list of mapping
        Nodes that are neither.
    """
    if "$ref" in node:
        return options(root["$defs"][node["$ref"].rpartition("/")[2]], root)
    several = node.get("oneOf") or node.get("anyOf")
    if several:
        return [found for option in several for found in options(option, root)]
    return [] if node.get("type") == "null" else [node]


def tables(root: Schema) -> list[EntryTable]:
    """Return the tables of a schema.

    Parameters
    ----------
    root : mapping
        The schema.

    Returns
    -------
    list of EntryTable
        Each once, from the outside in; the root itself first.
    """
    found: dict[str, EntryTable] = {}

    def walk(node: Schema, path: str) -> None:
        for option in options(node, root):
            if "properties" in option and "title" in option:
                name = option["title"]
                known = name in found
                table = found.setdefault(name, EntryTable(name=name, text=option.get("description", "")))
                table.paths.append(path)
                if known:
                    continue
                table.mark = _mark(option)
                table.entries = tuple(_entries(option, root))
                for key, child in option["properties"].items():
                    walk(child, f"{path}.{key}".lstrip("."))
            for child in _children(option):
                walk(child, f"{path}.{ANY_NAME}" if option.get("type") == "object" else path)

    walk(root, "")
    return list(found.values())


def _children(node: Schema) -> list[Schema]:
    """Return the nodes of what a list holds, and of what stands under names of the user's."""
    free = [node[key] for key in ("items", "additionalProperties") if isinstance(node.get(key), dict)]
    return [*node.get("prefixItems", ()), *free]


def _mark(table: Schema) -> str:
    """Return the entry whose only value tells a table from others."""
    told = [(key, child["const"]) for key, child in table["properties"].items() if "const" in child]
    return next((f'{key} = "{value}"' for key, value in told if isinstance(value, str)), "")


def _entries(table: Schema, root: Schema) -> Iterator[Entry]:
    for name, node in table["properties"].items():
        text = node.get("description", "")
        yield Entry(
            name=name,
            kind=_kind(node, root),
            dimensions=tuple(dict.fromkeys(_dimensions(node, root))),
            needed=name in table.get("required", ()),
            default=node.get("default"),
            rules=tuple(dict.fromkeys(_rules(node, root))),
            text="Tells this table from the others at its place." if "const" in node and not text else text,
            tables=tuple(dict.fromkeys(_tables(node, root))),
        )


def _kind(node: Schema, root: Schema) -> str:
    """Return in words what a node holds."""
    found = [_kind_of_option(option, root) for option in options(node, root)]
    return " or ".join(dict.fromkeys(found))


def _kind_of_option(node: Schema, root: Schema) -> str:
    choices = [node["const"]] if "const" in node else node.get("enum")
    if choices:
        return " or ".join(f'`"{choice}"`' if isinstance(choice, str) else f"`{choice}`" for choice in choices)
    match node.get("type"):
        case "string":
            return str(node.get("format", "text"))
        case "boolean":
            return "true or false"
        case "integer":
            return "whole number"
        case "number":
            return "number"
        case "array" if "prefixItems" in node:
            return "[" + ", ".join(_kind(item, root) for item in node["prefixItems"]) + "]"
        case "array":
            kind = _kind(node["items"], root)
            return "list of tables" if kind == "table" else f"list of {kind}"
        case "object" if "properties" in node:
            return "table"
        case "object" if isinstance(node.get("additionalProperties"), dict):
            kind = _kind(node["additionalProperties"], root)
            return "tables by name" if kind == "table" else f"table: name = {kind}"
    return "any value"


def _inside(node: Schema, root: Schema) -> Iterator[Schema]:
    """Yield what an entry holds and what is in that, but for what is in tables with entries of their own."""
    for option in options(node, root):
        yield option
        for child in _children(option):
            yield from _inside(child, root)


def _dimensions(node: Schema, root: Schema) -> Iterator[str]:
    yield from (found["format"] for found in _inside(node, root) if "format" in found)


def _tables(node: Schema, root: Schema) -> Iterator[str]:
    yield from (found["title"] for found in _inside(node, root) if "properties" in found and "title" in found)


def _rules(node: Schema, root: Schema) -> Iterator[str]:
    """Yield the rules of an entry in words; those on what is inside a list or table begin with *each*."""
    outer = [*options(node, root), node]
    for found in [*_inside(node, root), node]:
        each = "" if found in outer else "each "
        for key, words in _RULES.items():
            if key in found:
                yield each + words.format(found[key])
        least, most = (
            found.get("minItems", found.get("minProperties")),
            found.get("maxItems", found.get("maxProperties")),
        )
        if "prefixItems" not in found and (least or most):
            yield each + " and ".join([f"at least {least}"] * bool(least) + [f"at most {most}"] * bool(most))


_RULES = {
    "x-rule": "{}",
    "minimum": "at least {:g}",
    "exclusiveMinimum": "above {:g}",
    "maximum": "at most {:g}",
    "exclusiveMaximum": "below {:g}",
    "maxLength": "at most {} characters",
}
