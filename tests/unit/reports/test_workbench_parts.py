"""STEP files dropped on the page to work in, and what leaves it as a file."""

import re
import tomllib
from pathlib import Path

import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.imported import read
from alula.geometry.imported.read import part_facts
from alula.loads.case.case_file import read_text, validate
from alula.reports.workbench import out, parts

STEP = Path(__file__).parents[2] / "data" / "step"
BELL_CRANK = (STEP / "bell_crank.step").read_bytes()


def test_a_dropped_part_makes_a_case_with_its_bores(tmp_path: Path) -> None:
    """The entries that the page is given hold in a case: a link of the file, with each bore at its own point."""
    found = parts.dropped("C:\\drawings\\bell crank.STEP", BELL_CRANK, tmp_path)
    assert found["file"] == "bell crank.step"
    assert (tmp_path / "bell crank.step").read_bytes() == BELL_CRANK
    assert found["size"] == pytest.approx([49.5, 39.5, 12.0], abs=1e-6)
    case = tomllib.loads(read_text("four-bar")[0])
    bores = {bore["point"]: bore for bore in found["bores"]}
    case["parts"]["dropped"] = found["table"]
    case["links"]["rocker"] = {
        "part": "dropped",
        "points": {"O4": found["link"]["points"]["A"], "B": found["link"]["points"]["B"]},
    }
    case["parts"]["dropped"]["bores"] = {"O4": bores["A"]["bore"], "B": bores["B"]["bore"]}
    case["load_cases"]["lift"]["forces"][0]["at"] = "B"
    for joint, point in (("O4", "A"), ("B", "B")):
        case["joints"][joint]["pin_diameter"] = f"{bores[point]['diameter']} mm"
    rocker = validate(case, str(tmp_path)).links["rocker"]
    x, y = bores["B"]["at"]
    assert rocker.points["B"] == pytest.approx((x, y))


def test_no_file_is_written_over(tmp_path: Path) -> None:
    """Another content under the same name gets a name of its own; the same content stands once."""
    mine = bytes(len(BELL_CRANK))
    (tmp_path / "arm.step").write_bytes(mine)
    (tmp_path / "arm-2.step").symlink_to(tmp_path / "nowhere")
    assert parts.dropped("arm.step", BELL_CRANK, tmp_path)["file"] == "arm-3.step"
    assert parts.dropped("arm.step", BELL_CRANK, tmp_path)["file"] == "arm-3.step"
    assert (tmp_path / "arm.step").read_bytes() == mine
    assert sorted(file.name for file in tmp_path.iterdir()) == ["arm-2.step", "arm-3.step", "arm.step"]


@pytest.mark.parametrize(
    ("name", "data", "told"),
    [
        ("arm.stl", BELL_CRANK, "no STEP file by its name"),
        ("arm.step", b"MZ\x90 not a part", "does not begin with 'ISO-10303-21;'"),
        ("arm.step", b"", "is empty"),
        ("arm.step", BELL_CRANK[:-200], "cut off"),
        ("two.step", (STEP / "two_solids.step").read_bytes(), "holds 2 solids"),
    ],
)
def test_what_is_no_part_leaves_nothing(name: str, data: bytes, told: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=told) as found:
        parts.dropped(name, data, tmp_path)
    assert str(found.value).startswith(f"'{name}'"), "not where it was looked into"
    assert not list(tmp_path.iterdir())


def test_a_part_without_bores_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "part_entries", lambda found: "")
    with pytest.raises(CaseError, match="no bore was found"):
        parts.dropped("arm.step", BELL_CRANK, tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_too_large_is_not_even_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "LARGEST_FILE", len(BELL_CRANK) - 1)
    monkeypatch.setattr(parts, "inspect_file", None)
    with pytest.raises(CaseError, match="MB that are read"):
        parts.dropped("arm.step", BELL_CRANK, tmp_path)
    assert not list(tmp_path.iterdir())
    assert parts.LARGEST_FILE < read.LARGEST_FILE


def test_the_page_refuses_no_file_that_is_taken() -> None:
    page = Path(parts.__file__).parent / "page" / "drop.js"
    assert f"const LARGEST = {parts.LARGEST_FILE / 1e6:.0f}; // MB" in page.read_text(encoding="utf-8")


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="cannot be written"):
        parts.dropped("arm.step", BELL_CRANK, tmp_path / "gone")


@pytest.mark.parametrize(
    ("name", "kept"),
    [
        ("../../etc/arm.step", "arm.step"),
        ("..step", ""),
        (".hidden.stp", "hidden.stp"),
        ('<img src="x">.step', "img src-x.step"),
        ("a" * 300 + ".STEP", "a" * 80 + ".step"),
        ("/.step", ""),
    ],
)
def test_names_of_files_are_plain(name: str, kept: str) -> None:
    if not kept:
        with pytest.raises(CaseError):
            parts.plain_file_name(name)
    else:
        assert parts.plain_file_name(name) == kept


def test_a_link_leaves_as_a_solid_with_its_bores(tmp_path: Path) -> None:
    """What is handed out as STEP is read back: two bores of the pins' diameter, as far apart as the points."""
    file = tmp_path / "crank.step"
    file.write_bytes(out.step(read_text("four-bar")[0], str(tmp_path / "mine.toml"), "crank"))
    first, second = part_facts(file).bores
    assert (first.diameter, second.diameter) == pytest.approx((3.0, 3.0))
    assert abs(second.centre[0] - first.centre[0]) == pytest.approx(40.0)
    with pytest.raises(CaseError, match="there is no link 'nobody'; the case has base, crank"):
        out.step(read_text("four-bar")[0], str(tmp_path / "mine.toml"), "nobody")


def test_the_report_is_that_of_the_check(tmp_path: Path) -> None:
    """Of the text, not of a file: by hand the four-bar is undecided; under a hundred times its load it fails."""
    text = read_text("four-bar")[0]
    assert _verdict(out.report(text.replace("-5 N", "-500 N"), str(tmp_path / "mine.toml"), "beam")) == "fail"
    with pytest.raises(CaseError, match="TOML"):
        out.report("[links", str(tmp_path / "mine.toml"), "beam")
    assert not list(tmp_path.iterdir())


def _verdict(page: bytes) -> str:
    found = re.search(r'class="verdict (\w+)"', page.decode())
    assert found is not None
    return found[1]
