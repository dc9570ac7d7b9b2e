"""The tutorial and the recipes work as printed: entries are taken, commands run, and numbers are what they print."""

import re
from pathlib import Path

import pytest
from pages import Reader, edited
from programs import ROOT
from prose import FENCE, without_code

from alula.loads.case.case_file import read_case

DOCS = ROOT / "docs"
TUTORIAL = DOCS / "tutorial.md"
PAGES = [TUTORIAL, *sorted((DOCS / "how-to").glob("*.md"))]
names = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


@names
def test_a_page_works_as_printed(page: Path, tmp_path: Path) -> None:
    reader = Reader(tmp_path)
    reader.follow(page)
    for case in reader.cases:
        if "links" in case.read_text(encoding="utf-8"):
            read_case(str(case))


@pytest.mark.converged
@names
def test_slow_commands_of_a_page(page: Path, tmp_path: Path) -> None:
    Reader(tmp_path, patient=True).follow(page)


def test_cases_to_start_from_are_there() -> None:
    named = [
        name for page in PAGES for name in re.findall(r"alula new --from ([\w-]+)", page.read_text(encoding="utf-8"))
    ]
    assert named
    assert all(read_case(name).links for name in named)


def test_numbers_of_the_tutorial_are_printed_there() -> None:
    """Every number with decimals or a unit in the running text stands in a block, which the tests above run."""
    text = TUTORIAL.read_text(encoding="utf-8")
    blocks = "\n".join(block for *_, block in FENCE.findall(text))
    told = re.findall(r"(?<![\w.])\d+\.\d+|\d+(?= (?:mm|N|MPa|%|times)\b)", without_code(text))
    assert told
    assert not [number for number in told if not re.search(rf"(?<![\d.]){re.escape(number)}(?![\d.]*\d)", blocks)]


def test_a_wrong_number_is_found(tmp_path: Path) -> None:
    reader = Reader(tmp_path)
    reader.sh("alula new four-bar.toml\nalula statics four-bar.toml\n")
    reader.text("Load case lift\n...\nDrive torque on crank about O2: 92.61 N·mm\n")
    wrong = "Load case lift\n...\nDrive torque on crank about O2: 92.62 N·mm\n"
    with pytest.raises(AssertionError, match="is not in"):
        reader.text(wrong)
    reader.renewing = True
    reader.text(wrong)
    reader.text("Drive torque on rocker about O2: 92.62 N·mm\n")
    assert reader.renewed == {wrong: wrong.replace("92.62", "92.61")}
    assert len(reader.told) == 1


def test_lines_are_changed_or_added_under_their_headings() -> None:
    file = "# A\nx = 1\n\n[b]  # B\ny.z = 2\n\n# of c\n[[c]]\nlink = 1\n"
    lines = "w = 0\n[b]\ny.z = 3\ny.a = 4\n[d]\nv = 5\n"
    assert edited(file, lines) == "# A\nx = 1\nw = 0\n\n[b]\ny.z = 3\ny.a = 4\n\n# of c\n[[c]]\nlink = 1\n[d]\nv = 5\n"
