"""The pages on the case file and on the plan of a study: every entry, from the models, with an example that is run."""

import re
from collections.abc import Iterator

from pydantic import BaseModel

from alula.geometry.base.units import EXAMPLES, INTERNAL_UNITS
from alula.loads.case.case import Case
from alula.loads.plans.plan import StudyPlan
from alula.loads.text.entries import file_schema
from docs.extensions.entries import Entry, EntryTable, tables
from docs.extensions.examples import Example, examples

_INTRODUCTION = """# The case file

A case file is [TOML](https://toml.io/en/v1.0.0). `alula new my-case.toml` writes one to begin with, and
`alula check my-case.toml` names the first entry that is wrong, with the remedy. `--set links.rocker.layer=2` changes an
entry by its path. This page has the entries at the top of the file; each table in it has a page of its own.
[All entries](all.md) lists their paths.

In a path, `NAME` is a name of your own. What is not *needed* may be left out. `alula schema` prints the same as a JSON
Schema, for editors.

## Quantities

A number with a dimension is text with its unit; a bare number is refused. Any unit of the dimension will do.

| dimension | for example | in alula |
|---|---|---|
{dimensions}

A *name* is made of letters, digits, `-`, `_`, `+` and spaces, at most 64; it begins with a letter or a digit. A
*percentage* is text such as `"5 %"`, or a number such as `0.05`.
"""
_PLAN = """# The plan of a study

`alula study plan.toml -o out` computes what a plan states, and `alula new --study plan.toml` writes one to begin with.
Quantities are stated as in [the case file](case-file/index.md).
"""


def pages() -> dict[str, str]:
    """Return the pages.

    Returns
    -------
    dict of str to str
        Path from the folder of generated pages -> Markdown.
    """
    root = file_schema(Case)
    top, *others = tables(root)
    inner: dict[str, list[EntryTable]] = {}
    for table in others:
        inner.setdefault(table.paths[0].partition(".")[0], []).append(table)
    found = examples(Case)
    rows = [f'| {name} | `"{EXAMPLES[name]}"` | {_unit(unit)} |' for name, unit in INTERNAL_UNITS.items()]
    introduction = _INTRODUCTION.format(dimensions="\n".join(rows))
    tree = "\n".join(["```{toctree}", ":hidden:", "", *(f"{name} <{name}>" for name in inner), "all", "```"])
    written = {
        "case-file/index.md": "\n\n".join(
            [
                introduction,
                "## The top of the file",
                *_sections([top], found, inner),
                tree,
            ]
        ),
        "case-file/all.md": _all([top, *others]),
        "study-plan.md": _plan(),
    }
    for name, group in inner.items():
        head = f"# Case file: {name}\n\n{next(e for e in top.entries if e.name == name).text}"
        written[f"case-file/{name}.md"] = "\n\n".join([head, *_tables(group, found)])
    return {path: text.rstrip() + "\n" for path, text in written.items()}


def _plan() -> str:
    """Return the page on the plan of a study."""
    top, *inner = tables(file_schema(StudyPlan))
    found = {key: _moved(example) for key, example in examples(StudyPlan).items()}
    return "\n\n".join([_PLAN, "## The top of the file", *_sections([top], found), *_tables(inner, found)])


def _moved(example: Example) -> Example:
    """Return an example with links from the folder above that of the pages on the case file."""
    return Example(toml=example.toml, source=example.source.replace("](../../", "](../"))


def _tables(group: list[EntryTable], found: dict[tuple[str, str], Example]) -> Iterator[str]:
    """Yield the sections of tables, each with those of its entries."""
    for table in group:
        places = ", ".join(f"`{path}`" for path in dict.fromkeys(table.paths))
        mark = f", `{table.mark}`" if table.mark else ""
        yield f"({_label(table.name)})=\n## {title(table.name)}: {places}{mark}\n\n{table.text}"
        yield from _sections([table], found)


def title(model: str) -> str:
    """Return the name of a model in words.

    Parameters
    ----------
    model : str
        Such as ``EyeSizes``.

    Returns
    -------
    str
        Such as ``Eye sizes``.
    """
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", model.removesuffix("Spec")).lower()
    return words.capitalize().replace("Step", "STEP")


def _sections(
    group: list[EntryTable], found: dict[tuple[str, str], Example], inner: dict[str, list[EntryTable]] | None = None
) -> Iterator[str]:
    """Yield the section of every entry."""
    for table in group:
        for entry in table.entries:
            example = found[table.name, entry.name]
            yield f"({_label(table.name, entry.name)})=\n### {entry.name}"
            yield "\n".join(["{.facts}", *_facts(table, entry)])
            yield entry.text
            if inner and entry.name in inner:
                yield f"Its entries: [{entry.name}]({entry.name}.md)."
            yield f"```toml\n{example.toml}\n```"
            yield f"{{.source}}\n{example.source}"


def _facts(table: EntryTable, entry: Entry) -> Iterator[str]:
    """Yield path, kind, default and rules as lines of a list of fields."""
    yield ":Path: " + ", ".join(f"`{path}.{entry.name}`".replace("`.", "`") for path in dict.fromkeys(table.paths))
    kind = entry.kind.replace("[", r"\[").replace("]", r"\]")
    units = [f'`"{EXAMPLES[name]}"`' for name in entry.dimensions if name in EXAMPLES]
    inside = [f"[{title(name)}](#{_label(name)})" for name in entry.tables]
    more = [f"such as {', '.join(units)}"] * bool(units) + [f"see {', '.join(inside)}"] * bool(inside)
    yield f":Holds: {'; '.join([kind, *more])}"
    if entry.needed:
        yield ":Needed: always"
    elif entry.default not in (None, "", [], {}):
        yield f":Default: `{_toml(entry.default)}`"
    if entry.rules:
        yield f":Rule: {', '.join(entry.rules)}"


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return f'"{value}"'
        case list() | tuple():
            return "[" + ", ".join(map(_toml, value)) + "]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _all(group: list[EntryTable]) -> str:
    """Return the page that lists all entries."""
    lines = {}
    for table in group:
        for entry in table.entries:
            kind = entry.kind.replace("|", r"\|").replace("[", r"\[")
            needed = "needed" if entry.needed else ""
            for path in dict.fromkeys(table.paths):
                full = f"{path}.{entry.name}".lstrip(".")
                mark = f" ({table.mark})" if table.mark else ""
                lines[f"{full}{mark}"] = f"| [{full}](#{_label(table.name, entry.name)}){mark} | {kind} | {needed} |"
    rows = "\n".join(lines.values())
    return f"# All entries of the case file\n\n| path | holds | |\n|---|---|---|\n{rows}"


def _label(table: str, entry: str = "") -> str:
    return f"entry-{table}-{entry}".rstrip("-").lower().replace("_", "-")


def _unit(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³").replace("*", "·")


def missing(model: type[BaseModel]) -> dict[str, list[str]]:
    """Say what the pages lack.

    Parameters
    ----------
    model : type of BaseModel
        ``Case`` or ``StudyPlan``.

    Returns
    -------
    dict of str to list of str
        What is missing -> entries: a description, an example, an example of a unit.
    """
    entries = [(table, entry) for table in tables(file_schema(model)) for entry in table.entries]
    dimensions = {*EXAMPLES, "name", "percentage"}
    return {
        "description": [
            f"{t.name}.{e.name}" for t, e in entries if not e.text or re.fullmatch(r"[a-z ]+ with its unit", e.text)
        ],
        "example": [f"{t.name}.{e.name}" for t, e in entries if (t.name, e.name) not in examples(model)],
        "unit": [f"{t.name}.{e.name}" for t, e in entries if not set(e.dimensions) <= dimensions],
    }
