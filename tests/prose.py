"""What a person reads: Markdown outside of code, sentences in the strings of modules, case files, templates."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from programs import ROOT

GENERATED = ROOT / "docs" / "generated"
"""Pages of the site that are made from the program and are not kept."""
PACKAGES = ("geometry", "loads", "fea", "reports")
CUT = "\N{OBJECT REPLACEMENT CHARACTER}"
"""Stands for what was cut out, so that the letters beside it are not taken for a word."""
FENCE = re.compile(r"^( *)(`{3,}|~{3,})([^\n]*)\n(.*?)^\1\2 *$", re.S | re.M)
INDENTED = re.compile(r"(?<=\n\n)(?: {4,}[^\n]*\n)+")
"""Code by indentation: lists of ours leave no empty line before one that is indented."""
NO_WORDS = re.compile(
    r"<!--.*?-->|</?[a-z][^>]*>"  # comments, tags
    r"|``.+?``|`[^`]+`"  # code
    r"|\$\$.*?\$\$|\$[^$\n]+\$"  # formulas
    r"|\{[\w:-]+\}"  # roles of MyST
    r"|(?<=\])\([^)]*\)|^\[[^\]]+\]: [^\n]*$"  # targets of links
    r"|\w+://[^\s)>]+|[^\s(]+@[^\s)]+"
    r"|[^\s(]*[/\\_=][^\s)]*|\b[\w-]+\.(?:md|py|toml|json|csv|html|step|msh|inp|vtu|png)\b",  # paths, names, formulas
    re.S | re.M,
)
TEMPLATE = re.compile(r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}", re.S)
TOKEN = re.compile(rf"[^\W_{CUT}]+(?:['’][a-z]+)?|{CUT}\w*")
NAMES = re.compile(r"^ *(?:\*{0,2}\w+(?:, \*{0,2}\w+)*) : .*$", re.M)
"""Line of a docstring that names a parameter and its type."""
SENTENCE = re.compile(r"[^\W\d_]{2,}[,;:]? [^\W\d_]+[,;:]? [^\W\d_]{2,}")
"""Three words, which tell a sentence from a key."""


def markdown_files() -> list[Path]:
    """Return every Markdown file of the project."""
    below = [file for folder in ("docs", "benchmarks") for file in (ROOT / folder).rglob("*.md")]
    return sorted([*ROOT.glob("*.md"), *(file for file in below if GENERATED not in file.parents)])


def without_code(markdown: str) -> str:
    """Return Markdown with as many lines and without its blocks of code."""
    for block in (FENCE, INDENTED):
        markdown = block.sub(lambda found: "\n" * found[0].count("\n"), markdown)
    return markdown


def words(text: str) -> Iterator[tuple[int, str]]:
    """Yield every word of a text without code, with the number of its line from 0."""
    prose = NO_WORDS.sub(lambda found: CUT + "\n" * found[0].count("\n"), text)
    for number, line in enumerate(prose.split("\n")):
        yield from ((number, token) for token in TOKEN.findall(line) if CUT not in token)


def _strings(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield every string of a module with its line; what a run puts into it is cut out."""
    inside: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            inside.update(node.values)
            parts = [part.value if isinstance(part, ast.Constant) else CUT for part in node.values]
            yield node.lineno, "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in inside:
            yield node.lineno, node.value


def _of_module(text: str) -> Iterator[tuple[int, str]]:
    """Yield docstrings, errors, descriptions of entries and all else that may be a sentence."""
    for line, string in _strings(ast.parse(text)):
        if SENTENCE.search(string):
            yield line, NAMES.sub("", string)


def _of_case(text: str) -> Iterator[tuple[int, str]]:
    """Yield the comments of a TOML file and its strings that are sentences."""
    for number, line in enumerate(text.splitlines(), 1):
        strings = [string for string in re.findall(r'"([^"]+)"', line) if SENTENCE.search(string)]
        yield number, " ".join([*strings, line.partition("# ")[2]])


def texts() -> Iterator[tuple[Path, int, str]]:
    """Yield all prose that a person reads: its file, its first line, and the text without blocks of code."""
    for file in markdown_files():
        yield file, 1, without_code(file.read_text(encoding="utf-8"))
    for file in [
        *(ROOT / "alula").glob("*.py"),
        *(file for package in PACKAGES for file in (ROOT / package).rglob("*") if "__pycache__" not in file.parts),
    ]:
        read = _of_module if file.suffix == ".py" else _of_case if ".toml" in file.name else None
        if read:
            yield from ((file, line, text) for line, text in read(file.read_text(encoding="utf-8")))
        elif file.suffix == ".jinja":
            yield file, 1, TEMPLATE.sub(CUT, file.read_text(encoding="utf-8"))
    for file in sorted(set((ROOT / "docs").rglob("*.py")) - set(GENERATED.rglob("*.py"))):
        text = file.read_text(encoding="utf-8")
        yield from ((file, line, found) for line, found in _of_module(text))
        yield file, 1, re.sub(r"^(?!# ).*$", "", text, flags=re.M)
