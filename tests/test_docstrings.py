"""Docstrings have numpydoc's sections, so that editors and documentation tools show what goes in and what comes out.

A public function or method with parameters names each of them under Parameters, and has Returns or Yields unless it
returns None. A record (dataclass) names each of its fields under Attributes. Nothing is asked of properties and of
functions without parameters, whose summary says it all; of commands, whose docstring is their ``--help``; of names with
two underscores; and of pydantic models, whose fields carry docstrings of their own for the JSON Schema. What overrides
a method may begin with "As ``Base.method``" instead of repeating its sections.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def section(docstring: str, title: str) -> list[str] | None:
    """Return the names that a section lists, or None where there is no such section.

    A section is a title underlined with hyphens and ends at the next one. Its entries, ``name : type`` or
    ``name, name``, are not indented; what is said about them is.
    """
    lines = docstring.splitlines()
    starts = [i for i, line in enumerate(lines[1:]) if re.fullmatch("-{3,}", line) and lines[i].strip()]
    for start, end in zip(starts, [*starts, len(lines)][1:], strict=True):
        if lines[start] == title:
            entries = [line for line in lines[start + 2 : end] if line and not line[0].isspace()]
            return [name.strip(" *") for line in entries for name in re.split(r"\s*:(?:\s|$)", line)[0].split(",")]
    return None


def decorators(node: ast.FunctionDef | ast.ClassDef) -> set[str]:
    """Return the last names of a definition's decorators."""
    called = [d.func if isinstance(d, ast.Call) else d for d in node.decorator_list]
    return {d.attr if isinstance(d, ast.Attribute) else ast.unparse(d) for d in called}


def definitions(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, ast.FunctionDef | ast.ClassDef]]:
    """Yield the public functions and classes of a module, and the methods of those classes, with their names."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield prefix + node.name, node
            if isinstance(node, ast.ClassDef):
                yield from definitions(node.body, f"{prefix}{node.name}.")


def wrong_names(docstring: str, title: str, names: list[str]) -> Iterator[str]:
    """Yield what a section lacks of these names, and what it has besides."""
    listed = section(docstring, title)
    if listed is None:
        yield f"no section {title}"
        return
    yield from (f"{title} lacks {name}" for name in names if name not in listed)
    yield from (f"{title} names {name}, which there is not" for name in listed if name not in names)


def function_defects(function: ast.FunctionDef, *, method: bool) -> Iterator[str]:
    """Yield what a function's docstring lacks."""
    arguments = function.args
    named = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    named += [extra for extra in (arguments.vararg, arguments.kwarg) if extra]
    names = [argument.arg for argument in named]
    if method and "staticmethod" not in decorators(function):
        names = names[1:]
    if not names or decorators(function) & {"property", "cached_property", "command", "callback", "overload"}:
        return
    docstring = ast.get_docstring(function) or ""
    if method and re.match(rf"As ``\w+\.{function.name}``", docstring):
        return
    yield from wrong_names(docstring, "Parameters", names)
    silent = function.returns is None or ast.unparse(function.returns) in {"None", "NoReturn", "Never"}
    if not silent and section(docstring, "Returns") is None and section(docstring, "Yields") is None:
        yield "no section Returns or Yields"


def record_defects(record: ast.ClassDef) -> Iterator[str]:
    """Yield what a dataclass's docstring lacks."""
    fields = [n for n in record.body if isinstance(n, ast.AnnAssign) and "ClassVar" not in ast.unparse(n.annotation)]
    names = [n.target.id for n in fields if isinstance(n.target, ast.Name) and not n.target.id.startswith("_")]
    if "dataclass" in decorators(record) and names:
        yield from wrong_names(ast.get_docstring(record) or "", "Attributes", names)


def source_defects(source: str) -> list[str]:
    """Return one line for each defect of the docstrings in a source text."""
    found = []
    for name, node in definitions(ast.parse(source).body):
        wrong = record_defects(node) if isinstance(node, ast.ClassDef) else function_defects(node, method="." in name)
        found += [f"{node.lineno} {name}: {defect}" for defect in wrong]
    return found


def defects(folder: str) -> list[str]:
    """Return one line for each defect of the docstrings in a sub-package's files."""
    return [
        f"{file.relative_to(ROOT)}:{defect}"
        for file in sorted((ROOT / folder).glob("*.py"))
        for defect in source_defects(file.read_text(encoding="utf-8"))
    ]


def folders() -> list[str]:
    """Return the sub-packages of the product."""
    files = [file for top in ("geometry", "loads", "fea", "reports") for file in (ROOT / top).rglob("*.py")]
    return sorted({str(file.parent.relative_to(ROOT)) for file in files})


@pytest.mark.parametrize("folder", folders())
def test_docstrings_name_what_goes_in_and_comes_out(folder):
    assert defects(folder) == []


def test_the_public_face_does_so_too():
    assert source_defects((ROOT / "alula/__init__.py").read_text(encoding="utf-8")) == []


GOOD = '''
@dataclass
class Part:
    """A part.

    Attributes
    ----------
    width, height : float
        In mm.
    """

    width: float
    height: float
    _cache: dict

    @property
    def area(self) -> float:
        """Area [mm²]."""

    def cut(self, at: float, *others: float) -> None:
        """Cut it.

        Parameters
        ----------
        at : float
            Place [mm].
        *others : float
            More places [mm].
        """


def mass(part: Part, density: float) -> float:
    """Return the mass [t].

    Parameters
    ----------
    part : Part
    density
        In t/mm³.

    Returns
    -------
    float
        The mass.
    """


def version() -> str:
    """Return the version."""


class Bar(Part):
    """A bar."""

    def cut(self, at: float) -> None:
        """As ``Part.cut``, with a saw."""


@app.command()
def check(case: str) -> int:
    """Check a case."""


def _private(x: int) -> int:
    return x
'''


def test_good_docstrings_pass():
    assert source_defects(GOOD) == []


@pytest.mark.parametrize(
    ("before", "after", "defect"),
    [
        ("width, height : float", "width : float", "Part: Attributes lacks height"),
        ("    height: float\n", "", "Part: Attributes names height, which there is not"),
        ("*others : float", "other : float", "Part.cut: Parameters lacks others"),
        ("    Returns\n    -------", "    Gives\n    -----", "mass: no section Returns or Yields"),
        ("    Parameters\n    ----------\n    part", "    Given\n    -----\n    part", "mass: no section Parameters"),
        ("density: float)", "rho: float)", "mass: Parameters lacks rho"),
        ("    part : Part\n", "      part : Part\n", "mass: Parameters lacks part"),
        ("As ``Part.cut``", "As ``Part.saw``", "Bar.cut: no section Parameters"),
    ],
)
def test_a_defect_is_found(before, after, defect):
    assert any(line.endswith(defect) for line in source_defects(GOOD.replace(before, after, 1)))
