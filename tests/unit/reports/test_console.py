import io
import shlex

import pytest
from rich.console import Console
from solved import told
from told import print_result, printed, section, tables

from alula.reports.renderers.console import print_sections


def test_the_verdict_comes_first(result):
    assert printed(result).splitlines()[0].split()[0] == "PASS"


def test_nothing_is_wider_than_80_columns_or_shortened(result):
    stream = io.StringIO()
    print_result(result, Console(file=stream, width=80, color_system=None, force_terminal=True))
    text = stream.getvalue()
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80
    assert "…" not in text


@pytest.mark.parametrize(
    "part",
    [
        "A AG → AE 0.5011 0.8095 0.9520",
        "Drive torque on AE about A: −130.6 N·mm (clockwise;",
        "They differ by more than 3 % at x = 35.0 mm",
        "35.0 −0.05100 −0.04740 +7.1 %",
        "Moment at the root M = W L / 2 = 33.75 N·mm",
        "equations 6, 9 and 13",
        "Warning: the pose is close to a dead point",
        "Load case idle",
    ],
)
def test_what_a_reader_needs_is_there(result, part):
    assert part in " ".join(printed(result).split())


def test_every_link_has_its_safety_factor(result):
    lines = printed(result).splitlines()
    for name, link in result.load_cases["weight"].links.items():
        assert any(line.split()[:3] == [name, "weight", link.model] for line in lines)


def test_a_table_of_the_worst_is_not_told_where_that_of_all_is(result):
    stream = io.StringIO()
    print_sections([section(result, "checks")], Console(file=stream, width=200, color_system=None))
    worst, every = tables(result, "checks")
    assert len(worst.rows) < len(every.rows)
    assert len([line for line in stream.getvalue().splitlines() if "≥" in line or "≤" in line]) == len(every.rows)


def test_a_command_is_one_line_that_a_shell_takes_and_nothing_is_told_twice():
    """The command was broken at 80 columns, so that its copy ran half; the reason stood in two paragraphs."""
    changes = ("parts.bar.material=aluminium-6061-t6", "links.rocker.end_patch=8 mm")
    text = printed(told("four-bar", *changes))
    [line] = [line for line in text.splitlines() if line.startswith("  alula size")]
    assert len(line) > 80
    words = shlex.split(line)
    assert words[:3] == ["alula", "size", "four-bar"]
    assert words[words.index("--set") + 1 :: 2] == list(changes)
    aluminium = " ".join(printed(told("four-bar", "parts.bar.material=aluminium-6061-t6")).split())
    assert aluminium.lower().count("hand calculation is not calibrated for this link: its patch") == 1
    assert "What would change it Safety factor of rocker (undecided): as told above." in aluminium


def test_what_stands_below_the_checks_names_its_check():
    text = " ".join(printed(told("four-bar-synthesis")).split())
    assert "clearance, the linkage: Link c and link a come nearest" in text
    assert "clearance, the linkage: Links c and b, 5 mm apart" in text
