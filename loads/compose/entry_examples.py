"""Examples for the tables and entries of the case file, as the built-in cases state them, in its JSON Schema."""

import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from functools import cache
from itertools import product
from typing import Any

from alula.geometry.materials.material import library
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_text
from alula.loads.text.entries import Schema, file_schema, options

STARTER = "four-bar"
"""The case from which examples are taken before all others."""


@cache
def schema_with_examples() -> Schema:
    """Return the JSON Schema of the case file with examples.

    Returns
    -------
    mapping
        ``file_schema``; a table has under ``examples`` one that a built-in case states, and each of its entries a
        value. Entries that name a material have those of the library.
    """
    schema: dict[str, Any] = deepcopy(dict(file_schema(Case)))
    found: dict[str, dict[str, Any]] = {}
    entries: dict[tuple[str, str], Any] = {}
    for name in (STARTER, *(other for other in built_in_cases() if other != STARTER)):
        for title, table in _tables(schema, tomllib.loads(read_text(name)[0]), schema):
            found.setdefault(title, table)
            for key, value in table.items():
                entries.setdefault((title, key), value)
    for title, table in schema["$defs"].items():
        if title in found:
            table["examples"] = [found[title]]
    for table in (schema, *schema["$defs"].values()):
        for key, entry in table.get("properties", {}).items():
            if entry.get("x-refers") == "materials":
                entry["examples"] = list(library())
            elif (table["title"], key) in entries and "$ref" not in entry:
                entry["examples"] = [entries[table["title"], key]]
    return schema


def _tables(node: Schema, value: Any, root: Schema) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield title and content of the tables in a value that have a model."""
    if isinstance(value, list):
        lists = [found for found in options(node, root) if found.get("type") == "array"]
        inside = [found.get("items") or found["prefixItems"][0] for found in lists]  # all of a list of tables are alike
        for item, child in product(value, inside[:1]):
            yield from _tables(child, item, root)
    if not isinstance(value, dict):
        return
    fitting = [found for found in options(node, root) if _fits(found, value)]
    if not fitting:
        return
    found = fitting[0]
    if "properties" in found and "title" in found:
        yield found["title"], value
    for key, inner in value.items():
        child = found.get("properties", {}).get(key) or found.get("additionalProperties")
        if isinstance(child, Mapping):
            yield from _tables(child, inner, root)


def _fits(node: Schema, table: dict[str, Any]) -> bool:
    """Return whether a table may be what a node describes, by its keys and its kind."""
    if "properties" not in node:
        return isinstance(node.get("additionalProperties"), Mapping)
    stated = all(
        key in table and child["const"] == table[key]
        for key, child in node["properties"].items()
        if "const" in child and key in node.get("required", ())
    )
    return stated and set(node.get("required", ())) <= set(table) <= set(node["properties"])
