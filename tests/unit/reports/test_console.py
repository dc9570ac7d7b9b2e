import io
import shlex

import pytest
from rich.console import Console
from solved import by_hand
from told import print_result


def printed(result, width=80):
    stream = io.StringIO()
    print_result(result, Console(file=stream, width=width, color_system=None))
    return stream.getvalue()


def test_the_verdict_comes_first(result):
    assert printed(result).splitlines()[0].split()[0] == "PASS"


def test_nothing_is_wider_than_80_columns_or_shortened(result):
    text = printed(result)
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80
    assert "…" not in text


@pytest.mark.parametrize(
    "part",
    [
        "A 0.9520",
        "Drive torque on AE: −130.6 N·mm (clockwise)",
        "they differ by more than 3 % on GF",
        "(+7.1 %)",
        "M 33.75 N·mm",
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
        assert any(line.split()[:2] == [name, link.fidelity] for line in lines)


def test_a_command_is_one_line_that_a_shell_takes_and_nothing_is_told_twice():
    """The command was broken at 80 columns, so that its copy ran half; the reason stood in two paragraphs."""
    changes = ("parts.bar.material=aluminium-6061-t6", "links.rocker.end_patch=8 mm")
    text = printed(by_hand("four-bar", *changes))
    [line] = [line for line in text.splitlines() if line.startswith("  alula size")]
    assert len(line) > 80
    words = shlex.split(line)
    assert words[:3] == ["alula", "size", "four-bar"]
    assert words[words.index("--set") + 1 :: 2] == list(changes)
    aluminium = " ".join(printed(by_hand("four-bar", "parts.bar.material=aluminium-6061-t6")).split())
    assert aluminium.lower().count("hand calculation is not calibrated for this link: its patch") == 1
