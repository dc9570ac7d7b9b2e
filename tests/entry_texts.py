"""Write ``geometry/base/entry_texts.toml``: the texts that stand below the entries of records in the sources."""

import ast
import inspect
import json
import textwrap
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from alula.geometry.base.model import CaseModel
from alula.loads.case.case import Case
from alula.loads.plans.plan import StudyPlan

FILE = Path(__file__).resolve().parents[1] / "geometry" / "base" / "entry_texts.toml"
FILES = Case, StudyPlan
"""What a user may write; by them all records are imported."""


def records(base: type[CaseModel] = CaseModel) -> Iterator[type[CaseModel]]:
    """Yield the program's records that derive from a class."""
    for record in base.__subclasses__():
        if record.__module__.startswith(("alula.geometry.", "alula.loads.")):
            yield record
            yield from records(record)


def texts(record: type) -> Iterator[tuple[str, str]]:
    """Yield each entry of a record with the text below it."""
    [body] = ast.parse(textwrap.dedent(inspect.getsource(record))).body
    assert isinstance(body, ast.ClassDef)
    for entry, below in pairwise(body.body):
        match entry, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                yield name, inspect.cleandoc(text)


def collected() -> str:
    """Return what the file shall hold: a table for each record, a line for each entry."""
    lines = ["# What stands below the entries of records in the sources; `make texts` writes it."]
    for name, record in sorted({f"{record.__module__}.{record.__name__}": record for record in records()}.items()):
        if found := {entry: text for entry, text in texts(record) if entry in record.model_fields}:
            lines += ["", f'["{name}"]']
            lines += [f"{entry} = {json.dumps(text, ensure_ascii=False)}" for entry, text in found.items()]
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    FILE.write_text(collected(), encoding="utf-8")
