"""No table cuts a name or a number, however narrow the terminal is."""

import io
import re
import tomllib

import pytest
from rich.cells import cell_len
from rich.console import Console
from rich.text import Text
from rocker_case import TOML
from told import print_result

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.loads.case.case_file import validate
from alula.reports.words.terminal import KEPT, say, say_table

LONG = "wing-of-the-left-side-outer-section"
COLUMNS = (("link", False), ("safety factor n\n(band)", True), ("displacement\n[mm]", True))
ROWS = [(LONG, "3.21 (2.44 to 3.21)", "0.0004321"), ("wing-of-the-left-side-inner-section", "∞", "1.204·10⁻⁷")]
WIDTHS = (12, 20, 40, 60, 80, 200)


def console(width, *, terminal):
    return Console(file=io.StringIO(), width=width, color_system=None, force_terminal=terminal)


def words(text):
    return text.split()


@pytest.mark.parametrize("terminal", [True, False])
@pytest.mark.parametrize("width", WIDTHS)
def test_every_word_of_a_table_is_there_whole(width, terminal):
    out = console(width, terminal=terminal)
    say_table(out, COLUMNS, ROWS)
    found = words(out.file.getvalue())
    for row in ROWS:
        for cell in row:
            for word in words(cell):
                assert word in found, (width, word)


@pytest.mark.parametrize("width", WIDTHS)
def test_a_line_is_wider_than_the_terminal_only_by_one_word(width):
    out = console(width, terminal=True)
    say_table(out, COLUMNS, ROWS)
    say(out, f"Two links, {LONG} and another one, move by 0.0004321 mm.")
    for line in out.file.getvalue().splitlines():
        assert cell_len(line) <= width or len(words(line)) <= 2, line


def test_in_a_log_a_row_is_a_line():
    out = console(20, terminal=False)
    say_table(out, COLUMNS, ROWS)
    lines = [line.split() for line in out.file.getvalue().splitlines()]
    assert [LONG, "3.21", "(2.44", "to", "3.21)", "0.0004321"] in lines


@pytest.mark.parametrize("width", [60, 80, 200])
def test_columns_stand_below_each_other(width):
    out = console(width, terminal=True)
    rows = [("a", "1.5"), ("名前", "22.25"), ("longer", Text("3", style="red"))]
    say_table(out, (("name", False), ("value\n[mm]", True)), rows)
    table = [line for line in out.file.getvalue().splitlines() if line]
    assert table[0].split() == ["value"]
    assert {cell_len(line) for line in table} == {cell_len(table[2])}
    assert set(table[2]) == {"─"}


def test_a_kept_space_holds_name_and_number_together():
    out = console(14, terminal=True)
    say(out, "Forces: " + "  ".join(f"{name}{KEPT}0.9520" for name in "ABC"))
    assert out.file.getvalue().splitlines() == ["Forces:", "A 0.9520", "B 0.9520", "C 0.9520"]


def test_lines_that_the_text_has_stay_and_keep_their_indent():
    out = console(20, terminal=True)
    say(out, "On the ground:\n  A: 1.000, 2.000, 3.000")
    assert out.file.getvalue().splitlines() == ["On the ground:", "  A: 1.000, 2.000,", "3.000"]


@pytest.fixture(scope="module")
def long_named():
    text = re.sub(
        r"\b(crank|coupler|rocker)\b", rf"{LONG}-\1", TOML.replace("coupler = {", 'coupler = { part = "bar",', 1)
    )
    return check_case(validate(tomllib.loads(text)), name="long", fidelity="beam")


@pytest.mark.parametrize("width", [40, 80])
def test_a_check_is_told_in_full(long_named, width):
    """The names of two links that begin alike were once cut to the same few letters, a number to its zeros."""
    links = [f"{LONG}-coupler", f"{LONG}-rocker"]
    for terminal in (True, False):
        out = console(width, terminal=terminal)
        print_result(long_named, out)
        found = words(out.file.getvalue())
        assert all(found.count(name) >= 2 for name in links)
        assert "…" not in out.file.getvalue()


def test_a_verdict_keeps_its_colour():
    out = Console(file=io.StringIO(), width=30, force_terminal=True, color_system="standard")
    say_table(out, (("check", False), ("verdict", False)), [("strength", Text(Verdict.FAIL.value, style="red"))])
    assert "\x1b[31mfail" in out.file.getvalue()
