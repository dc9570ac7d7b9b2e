"""The page on the functions for Python: those of `alula.__all__`, and what they return."""

import ast
import inspect
from collections.abc import Iterator

import alula
from alula.fea.common.band import Band
from alula.fea.common.verdict import Verdict
from alula.reports.notebook.shown import ShownPicture, ShownTable

CASE = "Case"
"""The one name of ``alula.__all__`` that is a class."""
HELD = (ShownTable, ShownPicture, Band, Verdict)
"""What the reports hold."""


def page() -> str:
    """Return the page.

    Returns
    -------
    str
        reStructuredText, whose directives Sphinx fills with the docstrings.
    """
    parts = [_title("Python", "="), ".. automodule:: alula", _title("Functions", "-")]
    parts += [f"{_title(name, '^')}\n\n.. autofunction:: alula.{name}" for name in alula.__all__ if name != CASE]
    parts += [_title("A case", "-"), _class("alula", CASE, ":members:", ":member-order: bysource")]
    parts.append(_title("What they return", "-"))
    for module, name in returned():
        parts.append(_class(module, name, ":members:", ":member-order: bysource"))
    parts += [_class(kind.__module__, kind.__name__, ":members:", ":member-order: bysource") for kind in HELD]
    return "\n\n".join(parts) + "\n"


def returned() -> list[tuple[str, str]]:
    """Return the records that the functions return, as `alula/__init__.py` imports them for type checkers.

    Returns
    -------
    list of (str, str)
        Module and name.
    """
    tree = ast.parse(inspect.getsource(alula))
    imported = {
        alias.asname or alias.name: node.module or ""
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    return [(imported[name], name) for name in dict.fromkeys(_return_names(tree)) if name in imported and name != CASE]


def _return_names(tree: ast.Module) -> Iterator[str]:
    """Yield the names in the return types of the public functions."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name in alula.__all__ and node.returns is not None:
            stated = str(node.returns.value) if isinstance(node.returns, ast.Constant) else ast.unparse(node.returns)
            yield from stated.split(" | ")


def _title(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}"


def _class(module: str, name: str, *options: str) -> str:
    """Return the section of a class."""
    directive = f".. autoclass:: {module}.{name}"
    return "\n".join([_title(name.rstrip("()"), "^"), "", directive, *(f"   {option}" for option in options)])
