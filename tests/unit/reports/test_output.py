import json
from pathlib import Path

import pytest

from geometry.errors import CannotRunError, CaseError
from reports.output import is_result, write_folder

RESULT = json.dumps({"schema_version": 1, "verdict": "pass"})


def fill(text: str = "new"):
    def write(folder: Path) -> None:
        (folder / "result.json").write_text(RESULT)
        (folder / "sub").mkdir()
        (folder / "sub" / "picture.png").write_text(text)

    return write


def left_behind(parent: Path) -> list[str]:
    return [p.name for p in parent.iterdir() if p.name.startswith(".")]


def test_a_fresh_folder_is_written_whole(tmp_path: Path) -> None:
    write_folder(tmp_path / "deep" / "out", fill())
    assert (tmp_path / "deep" / "out" / "sub" / "picture.png").read_text() == "new"
    assert is_result(tmp_path / "deep" / "out")
    assert left_behind(tmp_path / "deep") == []


def test_an_earlier_result_is_replaced_with_nothing_of_it_left(tmp_path: Path) -> None:
    write_folder(tmp_path / "out", fill())
    (tmp_path / "out" / "stale.vtu").write_text("old")
    write_folder(tmp_path / "out", fill("newer"))
    assert not (tmp_path / "out" / "stale.vtu").exists()
    assert (tmp_path / "out" / "sub" / "picture.png").read_text() == "newer"
    assert left_behind(tmp_path) == []


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), RuntimeError("crash"), KeyboardInterrupt()])
def test_a_failure_leaves_the_earlier_result_untouched(tmp_path: Path, error: BaseException) -> None:
    write_folder(tmp_path / "out", fill())

    def half(folder: Path) -> None:
        (folder / "result.json").write_text('{"schema_version": 1, "verd')
        raise error

    with pytest.raises((CannotRunError, RuntimeError, KeyboardInterrupt)):
        write_folder(tmp_path / "out", half)
    assert (tmp_path / "out" / "sub" / "picture.png").read_text() == "new"
    assert is_result(tmp_path / "out")
    assert left_behind(tmp_path) == []


def test_a_folder_with_other_files_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("precious")
    with pytest.raises(CaseError, match="holds other files"):
        write_folder(tmp_path / "out", fill())
    assert (tmp_path / "out" / "thesis.tex").read_text() == "precious"


def test_a_file_or_link_in_the_way_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "link").symlink_to(tmp_path)
    for name in ("file", "link"):
        with pytest.raises(CaseError, match="is not a folder"):
            write_folder(tmp_path / name, fill())


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    write_folder(tmp_path / "out", fill())
    assert is_result(tmp_path / "out")


def test_a_place_that_cannot_be_written_is_explained(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(CannotRunError, match="cannot be written"):
        write_folder(tmp_path / "file" / "out", fill())
