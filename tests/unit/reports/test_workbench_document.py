"""The document of the page to work in: edits of any built-in case change the lines concerned, and nothing else."""

import difflib
import tomllib
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

import pytest
from solved import ALIKE

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import built_in_cases
from alula.reports.workbench.editing.document import Document

CASES = [name for name in built_in_cases() if name not in ALIKE]


def source(name: str) -> str:
    return files("alula.loads.cases").joinpath(f"{name}.toml").read_bytes().decode()


def entries(tables: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    """Every entry below some tables, with its path."""
    inner = tables.items() if isinstance(tables, dict) else enumerate(tables) if isinstance(tables, list) else ()
    for key, value in inner:
        yield (*path, key), value
        yield from entries(value, (*path, key))


def changed(before: str, after: str) -> list[str]:
    """Lines that are in one of two texts alone, with - or + before them."""
    told = difflib.unified_diff(before.splitlines(True), after.splitlines(True), n=0)
    return [line for line in told if line[0] in "+-" and line[:3] not in ("+++", "---")]


def edited(document: Document, operation: dict[str, Any]) -> list[str]:
    """Lines that one edit changes; its undo gives the same bytes."""
    before = document.text
    document.apply([operation], None)
    after, stated = document.text, document.tables()
    assert tomllib.loads(after.removeprefix("\ufeff")) == stated
    document.undo()
    assert document.text == before
    return changed(before, after)


@pytest.mark.parametrize("name", CASES)
def test_a_value_that_is_set_changes_its_own_line(name: str) -> None:
    document = Document("\ufeff" + source(name).replace("\n", "\r\n"))
    chosen = [(path, value) for path, value in entries(document.tables()) if isinstance(value, str | float | int)]
    for path, value in chosen[::7]:
        lines = edited(document, {"op": "set", "path": path, "value": "90 mm" if isinstance(value, str) else 7})
        assert len(lines) == 2 or "\n" in str(value)
        assert all(line.endswith("\r\n") for line in lines)


@pytest.mark.parametrize("name", CASES)
def test_an_entry_is_added_and_removed_anywhere(name: str) -> None:
    document = Document(source(name))
    for path, value in list(entries(document.tables()))[::11]:
        if len(path) == 2 and path[0] == "materials":
            continue  # parts are made of it
        assert all(
            line[0] == "-" or "]" in line or "}" in line for line in edited(document, {"op": "remove", "path": path})
        )
        if isinstance(value, dict):
            lines = edited(document, {"op": "set", "path": (*path, "new"), "value": {"at": ["1 mm", "2 mm"]}})
            assert len([line for line in lines if line.strip("+- \n")]) <= 2
        if isinstance(value, list):
            edited(document, {"op": "append", "path": path, "value": value[0]})


def test_comments_style_and_order_stay() -> None:
    document = Document(source("owl-wing-static"))
    document.apply([{"op": "set", "path": ["links", "CH", "points", "H"], "value": ["130 mm", "0 mm"]}], None)
    document.apply([{"op": "set", "path": ["pose", "near", "CF"], "value": "201 deg"}], None)
    assert changed(source("owl-wing-static"), document.text) == [
        '-points.H = ["124 mm", "0 mm"]    # the free tip: a plain tube end\n',
        '+points.H = ["130 mm", "0 mm"]    # the free tip: a plain tube end\n',
        '-near = { AE = "143 deg", CF = "200 deg", CH = "142 deg", ED = "200 deg" }\n',
        '+near = { AE = "143 deg", CF = "201 deg", CH = "142 deg", ED = "200 deg" }\n',
    ]


def test_new_entries_are_written_as_those_beside_them() -> None:
    document = Document(source("four-bar"))
    document.apply(
        [
            {"op": "set", "path": ["links", "crank", "points", "C"], "value": ["9 mm", "0 mm"]},
            {"op": "set", "path": ["joints", "C"], "value": {"links": ["crank", "arm"]}},
            {"op": "set", "path": ["links", "arm"], "value": {"part": "bar", "points": {"C": ["0 mm", "0 mm"]}}},
            {"op": "append", "path": ["load_cases", "lift", "forces"], "value": {"link": "arm", "at": "C"}},
            {"op": "set", "path": ["load_cases", "two", "forces"], "value": [{"link": "arm"}]},
            {"op": "set", "path": ["washer"], "value": "1 mm"},
        ],
        None,
    )
    assert [line[1:] for line in changed(source("four-bar"), document.text) if line.strip("+\n")] == [
        'washer = "1 mm"\n',
        'points.C = ["9 mm", "0 mm"]\n',
        *("[links.arm]\n", 'part = "bar"\n', 'points.C = ["0 mm", "0 mm"]\n'),
        'C = { links = ["crank", "arm"] }\n',
        *("[[load_cases.lift.forces]]\n", 'link = "arm"\n', 'at = "C"\n'),
        *("[load_cases.two]\n", "[[load_cases.two.forces]]\n", 'link = "arm"\n'),
    ]


ODD = """# odd but legal
"a b".'c' = 1 # one
list = [ # of lines
  { x = 1, 'y' = "2" }, # first
  { x = 2 }, # second
]
text = '''
a = [ "no", }'''
[ d . "e" ]   # spaces
f = 'C:\\dir'
[[g]]
[[g.h]]
k = {}
[g.h.m]
n = []
[[g]]
[d]
o = 1979-05-27T07:32:00Z"""


def test_odd_but_legal_writings() -> None:
    for text in (ODD, ODD + "\n", ODD.replace("\n", "\r\n")):
        document = Document(text)
        for path, value in list(entries(document.tables())):
            if not isinstance(value, dict):
                edited(document, {"op": "set", "path": path, "value": 5})
            edited(document, {"op": "remove", "path": path})
            if isinstance(value, dict):
                edited(document, {"op": "set", "path": (*path, "new"), "value": {"q": {"r": [1, "two", {"s": True}]}}})
            if isinstance(value, list):
                edited(document, {"op": "append", "path": path, "value": {"t": 1}})
    document = Document(ODD)
    document.apply([{"op": "set", "path": ["d", "e", "f"], "value": "D:\\x"}], None)
    assert changed(ODD, document.text) == ["-f = 'C:\\dir'\n", "+f = 'D:\\x'\n"]


def test_a_list_of_lines_grows_by_a_line() -> None:
    for text in ("a = [\n  1,\n  2\n]", "a = [\n  1,\n  2 # two\n]", "a = [\n  1,\n  2, # two\n]"):
        document = Document(text)
        document.apply([{"op": "append", "path": ["a"], "value": 3}], None)
        assert document.tables() == {"a": [1, 2, 3]}
        assert document.text.startswith(text[:13])
        assert len(document.text.splitlines()) == 5


def test_braces_with_dotted_keys_are_refused_where_they_would_be_written_anew() -> None:
    document = Document("a = { b.c = 1, d = 2 }")
    assert edited(document, {"op": "set", "path": ["a", "b", "c"], "value": 3})[1] == "+a = { b.c = 3, d = 2 }"
    for path in (["a", "b", "e"], ["a", "b", "c"]):
        with pytest.raises(CaseError, match="write it in the text"):
            document.apply([{"op": "set", "path": path, "value": 5 if path[-1] == "e" else None}], None)


def test_edits_of_one_gesture_are_one_step() -> None:
    document = Document("a = 1\n")
    for n in (2, 3, 4):
        document.apply([{"op": "set", "path": ["a"], "value": n}], None, "drag")
    document.replace("a = 5\n", "typing")
    document.undo("drag")  # the last change is not of it
    assert document.revision == 4
    document.undo()
    assert document.text == "a = 4\n"
    document.undo()
    assert document.text == "a = 1\n"
    assert not document.can_undo
    document.undo()
    document.redo()
    assert (document.text, document.can_redo, document.revision) == ("a = 4\n", True, 7)
    document.apply([{"op": "set", "path": ["a"], "value": 6}], None, "drag")  # after a redo a gesture begins anew
    document.undo()
    assert document.text == "a = 4\n"


@pytest.mark.parametrize(
    "operation",
    [
        {"op": "set", "path": ["pose", "angle", "x"], "value": 1},
        {"op": "set", "path": ["load_cases", "lift", "forces", 7, "at"], "value": "P"},
        {"op": "set", "path": [], "value": 1},
        {"op": "set", "path": ["pose", "angle"], "value": ["\ud800"]},
        {"op": "set", "path": ["title"], "value": [None]},
        {"op": "nothing"},
        {},
    ],
)
def test_what_cannot_be_edited_is_refused_and_nothing_changes(operation: dict[str, Any]) -> None:
    document = Document(source("four-bar"))
    with pytest.raises(CaseError, match=r"\A[^\n]+\Z"):
        document.apply([{"op": "remove", "path": ["motion"]}, operation], None)
    assert (document.text, document.revision, document.can_undo) == (source("four-bar"), 0, False)


def test_text_that_is_no_toml_is_kept_and_its_line_is_told() -> None:
    document = Document("a = 1\nb = = 2\n")
    with pytest.raises(CaseError, match="line 2") as refused:
        document.apply([{"op": "set", "path": ["a"], "value": 2}], None)
    assert document.line_of(str(refused.value)) == 2
    document.replace("a = 1\nb = [2,\n\n")
    with pytest.raises(CaseError) as refused:
        document.tables()
    assert document.line_of(str(refused.value)) == 2


def test_the_line_of_an_entry_that_a_sentence_names() -> None:
    document = Document("\ufeff" + source("four-bar"))
    lines = source("four-bar").splitlines()
    for problem, line in {
        "links.crank.points.A: it is wrong": 'points.A = ["40 mm", "0 mm"]',
        "links.crank.points: it is wrong": 'points.O2 = ["0 mm", "0 mm"]',
        "links.crank.colour: this key is unknown": "[links.crank]",
        "joints.B: link 'x' does not exist": 'B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }',
        "joints.B.pin_diameter: it": 'B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }',
        "pose.near: 2 assemblies fit it": 'near = { coupler = "20 deg", rocker = "57 deg" }',
        "parts.bar.width (it is '6 mmm'): \"mmm\" is not a unit of length": 'width = "8 mm"',
        "load_cases.lift.forces.0.force.1: no": 'force = ["0 N", "-5 N"]',
    }.items():
        found = document.line_of(problem)
        assert lines[(found or 0) - 1] == line, problem
    assert document.line_of("the disk is full") is None
