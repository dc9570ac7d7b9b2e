"""Which entries the case file knows where, by its JSON Schema, and which one a mistyped name may have meant."""

import difflib
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import Any

from pydantic import BaseModel, TypeAdapter, ValidationError

from alula.geometry.base.units import INTERNAL_UNITS, as_text

Schema = Mapping[str, Any]
REFERS = {
    **dict.fromkeys(("link", "links", "tight_in", "coordinate", "massless"), "links"),
    **dict.fromkeys(("joint", "joints"), "joints"),
    **dict.fromkeys(("material", "pin_material"), "materials"),
    **dict.fromkeys(("at", "start", "end", "points", "held_at"), "points"),
    "part": "parts",
    "load_case": "load_cases",
}
"""Entries that name what stands elsewhere: in which table of the case, or among the points of a link."""


_LAX: dict[str, TypeAdapter[Any]] = {
    "boolean": TypeAdapter(bool),
    "integer": TypeAdapter(int),
    "number": TypeAdapter(float),
}


def alike(name: str, known: Iterable[str]) -> str:
    """Find the known name that a mistyped one may have meant.

    Parameters
    ----------
    name : str
        What stands there.
    known : iterable of str
        The names that may; one that does not print is offered to nobody.

    Returns
    -------
    str
        ``; did you mean 'width'?`` with the name most like it, or an empty text.
    """
    folded = {other.casefold(): other for other in known if other.isprintable()}
    found = difflib.get_close_matches(name[:80].casefold(), folded, n=1)
    return f"; did you mean '{folded[found[0]]}'?" if found else ""


def known_keys(model: type[BaseModel], path: Sequence[object]) -> tuple[str, ...]:
    """Return the keys of a model's tables at a path.

    Parameters
    ----------
    model : type of BaseModel
        What the file is validated against.
    path : sequence
        Keys and indices; the kind of a union stands behind its entry.

    Returns
    -------
    tuple of str
        The keys of all tables that a union leaves open there.
    """
    return tuple(dict.fromkeys(key for node in _at(model, path) for key in node.get("properties", ())))


def of_another_kind(model: type[BaseModel], path: Sequence[object], key: str) -> str:
    """Tell of a key that a table does not take, but one of another kind in its place does.

    Parameters
    ----------
    model : type of BaseModel
        What the file is validated against.
    path : sequence
        Keys and indices of the table; the kind of a union stands behind its entry.
    key : str

    Returns
    -------
    str
        Such as ``shape 'step' takes no 'width'``; "" for a key that none takes, and a table of one kind.
    """
    for node in _at(model, path):
        kind = node.get("kind")
        if kind == path[-1] and key in known_keys(model, path[:-1]):
            entry = next(name for name, entry in node["properties"].items() if entry.get("const") == kind)
            return f"{entry} '{kind}' takes no '{key}'"
    return ""


def names_tables(model: type[BaseModel], path: Sequence[object]) -> bool:
    """Say whether the user names the tables or lists at a path himself, such as ``links`` or ``links.X.points``.

    Free names of plain values (``pose.near``), and those marked so, refer to what is named elsewhere, and are held
    against that.

    Parameters
    ----------
    model : type of BaseModel
        What the file is validated against.
    path : sequence
        Keys and indices.

    Returns
    -------
    bool
        True where he does.
    """
    root = file_schema(model)
    nodes = [node for node in _at(model, path) if "x-names" not in node]
    free = [node["additionalProperties"] for node in nodes if node.get("additionalProperties")]
    return any(node.get("type") in ("object", "array") for child in free for node in options(child, root))


def as_meant(model: type[BaseModel], path: Sequence[object], value: object) -> object:
    """Return what a change sets an entry to: ``no`` is false where a truth stands, and text a number where one does.

    Parameters
    ----------
    model : type of BaseModel
        What the file is validated against.
    path : sequence
        Keys and indices of the entry.
    value : object
        As it was stated; a command line, a table of points or a program may not know of which type the entry is.

    Returns
    -------
    object
        The value itself where the entry takes no other.
    """
    if not isinstance(value, str | int | float) or isinstance(value, bool):
        return value
    read: dict[str, object] = {}
    for kind, lax in _LAX.items():
        with suppress(ValidationError):
            read[kind] = lax.validate_python(value)
    kinds = {str(node.get("type")) for node in _at(model, path)} - {"null"} if read else set()
    return read.get(kinds.pop(), value) if len(kinds) == 1 else value


def _at(model: type[BaseModel], path: Sequence[object]) -> list[Schema]:
    """Return the nodes of the schema at a path, all that a union leaves open."""
    root = file_schema(model)
    nodes = options(root, root)
    for step in path:
        nodes = [found for node in nodes for child in _children(node, step) for found in options(child, root)]
    return nodes


def _children(node: Schema, step: object) -> list[Schema]:
    if step == node.get("kind"):
        return [node]
    if isinstance(step, int) or node.get("type") == "array":
        return [*node.get("prefixItems", ()), *([node["items"]] if node.get("items") else [])]
    if step in node.get("properties", {}):
        return [node["properties"][step]]
    free = node.get("additionalProperties")
    return [free] if free else []


def options(node: Schema, root: Schema) -> list[Schema]:
    """Return what a node may be: references followed, unions taken apart; a kind stands beside its node.

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
    kinds = node.get("discriminator", {}).get("mapping")
    if kinds:
        return [{**found, "kind": kind} for kind, at in kinds.items() for found in options({"$ref": at}, root)]
    several = node.get("oneOf") or node.get("anyOf")
    return [found for option in several for found in options(option, root)] if several else [node]


@cache
def file_schema(model: type[BaseModel]) -> Schema:
    """Return the JSON Schema of a file, with defaults as the file would state them.

    Parameters
    ----------
    model : type of BaseModel
        What the file is validated against.

    Returns
    -------
    mapping
        pydantic's schema; in place of numbers in alula's units, defaults of quantities are text with a unit. What an
        entry refers to is its ``x-refers``.
    """
    schema = model.model_json_schema()
    for table in (schema, *schema.get("$defs", {}).values()):
        for name, entry in table.get("properties", {}).items():
            if name in REFERS and _is_name(entry):
                entry["x-refers"] = REFERS[name]
            if isinstance(entry.get("default"), float) and entry.get("format") in INTERNAL_UNITS:
                entry["default"] = as_text(entry["default"], entry["format"])
            elif isinstance(entry.get("default"), float) and entry.get("format") == "percentage":
                entry["default"] = f"{entry['default']:g} %"
            elif isinstance(entry.get("default"), dict):
                entry["default"] = {}  # a table whose own entries have their defaults
    return schema


def _is_name(node: Schema) -> bool:
    inside = [node[key] for key in ("items", "additionalProperties") if isinstance(node.get(key), Mapping)]
    several = (*node.get("anyOf", ()), *node.get("prefixItems", ()), *inside)
    return node.get("format") == "name" or any(_is_name(one) for one in several)
