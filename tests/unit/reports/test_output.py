import json
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.reports.page import output
from alula.reports.page.output import EXPORT, place, refuse_unusable, write_folder

LIST = ".alula-check.json"


def fill(files: Mapping[str, str] = {"result.json": "{}", "sub/a.png": "new"}) -> Callable[[Path], None]:
    def write(folder: Path) -> None:
        for name, text in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)

    return write


def failing(folder: Path) -> None:
    raise OSError(28, "No space left on device")


def files_of(folder: Path) -> dict[str, str]:
    """Return name -> text of every file in a folder, but for the lists of what alula wrote."""
    found = {path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if not path.is_dir()}
    return {name: path.read_text() for name, path in found.items() if not path.name.startswith(".alula-")}


def folders_of(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_dir()}


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """Return a folder with an earlier result and files of the user's own, one of them among alula's."""
    write_folder(tmp_path / "out", "check", fill({"result.json": "old", "sub/a.png": "old", "gone/b.vtu": "old"}))
    (tmp_path / "out" / "my.toml").write_text("mine")
    (tmp_path / "out" / "sub" / "notes.txt").write_text("mine")
    return tmp_path / "out"


MINE = {"my.toml": "mine", "sub/notes.txt": "mine"}


def test_a_fresh_folder_is_written_whole(tmp_path: Path) -> None:
    write_folder(tmp_path / "deep" / "out", "check", fill())
    assert files_of(tmp_path) == {"deep/out/result.json": "{}", "deep/out/sub/a.png": "new"}
    assert folders_of(tmp_path) == {"deep", "deep/out", "deep/out/sub"}


def test_what_alula_wrote_is_replaced_and_all_else_stays(out: Path) -> None:
    write_folder(out, "check", fill())
    assert files_of(out) == MINE | {"result.json": "{}", "sub/a.png": "new"}
    assert folders_of(out) == {"sub"}  # "gone" was alula's, and is empty


def test_a_folder_of_other_files_takes_a_result_too(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious")
    write_folder(tmp_path, "check", fill())
    assert files_of(tmp_path) == {"thesis.tex": "precious", "result.json": "{}", "sub/a.png": "new"}


def test_the_folder_itself_is_the_same_one(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It may be the folder where the user stands: a folder in its place would leave the shell in one that is gone."""
    monkeypatch.chdir(out / "sub")
    write_folder(Path(".."), "check", fill())
    assert Path("a.png").read_text() == "new"


def test_commands_keep_each_others_results(tmp_path: Path) -> None:
    for command in ("check", "motion", "envelope", "synth", EXPORT):
        write_folder(tmp_path, command, fill({"result.json" if command != EXPORT else "AE.step": command}))
    write_folder(tmp_path, "check", fill({"result.json": "again"}))
    assert files_of(tmp_path) == {
        "result.json": "again", "motion/result.json": "motion", "envelope/result.json": "envelope",
        "synth/result.json": "synth", "AE.step": "export",
    }  # fmt: skip


def test_parts_of_another_case_stay(tmp_path: Path) -> None:
    """And those that were edited, as far as they are not to be written again."""
    write_folder(tmp_path, EXPORT, fill({"AE.step": "owl", "GF.step": "owl"}))
    (tmp_path / "GF.step").write_text("in CAD")
    write_folder(tmp_path, EXPORT, fill({"crank.step": "four-bar"}))
    write_folder(tmp_path, EXPORT, fill({"AE.step": "owl again"}))
    assert files_of(tmp_path) == {"AE.step": "owl again", "GF.step": "in CAD", "crank.step": "four-bar"}
    with pytest.raises(CaseError, match=r"GF\.step' was not written by alula, or was edited since"):
        write_folder(tmp_path, EXPORT, fill({"GF.step": "owl again"}))


@pytest.mark.parametrize("step", range(5))
def test_parts_of_another_case_stay_where_the_disk_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: int
) -> None:
    write_folder(tmp_path, EXPORT, fill({"AE.step": "owl", "GF.step": "owl"}))
    move, left = output._move, [step]

    def failing(source: Path, to: Path) -> None:
        left[0] -= 1
        if left[0] < 0:  # so that only the next run takes back what was moved
            raise OSError(5, "Input/output error")
        move(source, to)

    monkeypatch.setattr(output, "_move", failing)
    with pytest.raises(CannotRunError, match="restores" if step else "nothing was changed"):
        write_folder(tmp_path, EXPORT, fill({"AE.step": "again", "crank.step": "four-bar"}))
    monkeypatch.undo()
    refuse_unusable(tmp_path, EXPORT)
    assert files_of(tmp_path) == {"AE.step": "owl", "GF.step": "owl"}


def unlisted(out: Path) -> None:
    """Leave the folder as versions without a list did."""
    (out / LIST).unlink()


def edited(out: Path) -> None:
    (out / "sub" / "a.png").write_text("with my remarks")


def foreign(out: Path) -> None:
    (out / "late.png").write_text("mine")


def linked(out: Path) -> None:
    """A link to a file that is just as alula's was."""
    (out / "result.json").rename(out.parent / "elsewhere.json")
    (out / "result.json").symlink_to(out.parent / "elsewhere.json")


def linked_folder(out: Path) -> None:
    (out / "sub").rename(out.parent / "elsewhere")
    (out / "sub").symlink_to(out.parent / "elsewhere")


def dangling(out: Path) -> None:
    (out / "late.png").symlink_to(out.parent / "nothing")


def folder_in_the_way(out: Path) -> None:
    (out / "late.png").mkdir()


def file_in_the_way(out: Path) -> None:
    (out / "late").write_text("mine")


def no_list(out: Path) -> None:
    (out / LIST).write_text("mine")


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        (unlisted, "result.json"), (edited, "sub/a.png"), (foreign, "late.png"), (linked, "result.json"),
        (linked_folder, "sub"), (dangling, "late.png"), (folder_in_the_way, "late.png"), (file_in_the_way, "late"),
        (no_list, LIST),
    ],
)  # fmt: skip
def test_what_would_be_lost_is_refused_before_and_after_solving(
    out: Path, changed: Callable[[Path], None], name: str
) -> None:
    """Before: for the names that are known by then."""
    new = {"result.json": "{}", "sub/a.png": "new", "late.png": "new", "late/deep/c.png": "new"}
    changed(out)
    before = {path: path.lstat().st_mtime_ns for path in out.parent.rglob("*") if not path.is_dir()}
    for attempt in (lambda: refuse_unusable(out, "check", new), lambda: write_folder(out, "check", fill(new))):
        with pytest.raises(CaseError) as refused:
            attempt()
        assert f"'{out / name}'" in str(refused.value)
        assert "rename it or choose another folder" in str(refused.value)
        assert {path: path.lstat().st_mtime_ns for path in out.parent.rglob("*") if not path.is_dir()} == before


@pytest.mark.parametrize("changed", [edited, foreign, linked, linked_folder, dangling, folder_in_the_way])
def test_a_file_that_changes_while_the_run_fills_its_folder_is_seen(out: Path, changed: Callable[[Path], None]) -> None:
    def meanwhile(folder: Path) -> None:
        fill({"result.json": "{}", "late.png": "new"})(folder)
        changed(out)

    with pytest.raises(CaseError, match="rename it or choose another folder"):
        write_folder(out, "check", meanwhile)
    assert (out / "result.json").read_text() == "old"
    assert (out / "sub" / "a.png").read_text() == ("with my remarks" if changed is edited else "old")


@pytest.mark.parametrize("name", ["../victim", "/victim", "sub/../../victim", "link/victim"])
def test_a_list_of_files_elsewhere_harms_nothing(out: Path, name: str) -> None:
    """A folder from somebody else: its list, or the one of a run that was killed, names a file that is not in it."""
    victim = out.parent / "victim"
    (out / "link").symlink_to(out.parent)
    victim.write_text("old")
    name = str(victim) if name == "/victim" else name
    files = json.loads((out / LIST).read_text())["files"]
    (out / LIST).write_text(json.dumps({"files": {name: files["result.json"]}}))
    for old in ("result.json", "sub/a.png", "gone/b.vtu"):
        (out / old).unlink()
    with pytest.raises(CaseError, match="rename it or choose another folder"):
        write_folder(out, "check", fill())
    (out / LIST).unlink()
    digest = files["result.json"]
    (out / ".alula-work").mkdir()
    (out / ".alula-work" / "list.json").write_text(json.dumps({"files": {name: digest}, "kept": []}))
    write_folder(out, "check", fill())
    assert not (out / ".alula-work").exists()
    assert victim.read_text() == "old"


@pytest.mark.parametrize("told", ['{"files": {}, "kept": []}', '{"fil'])
def test_nothing_is_put_back_behind_a_link(out: Path, told: str) -> None:
    (out / "link").symlink_to(out.parent)
    (out / ".alula-work" / "old" / "link").mkdir(parents=True)
    (out / ".alula-work" / "old" / "link" / "planted").write_text("x")
    (out / ".alula-work" / "list.json").write_text(told)
    write_folder(out, "check", fill())
    assert not (out / ".alula-work").exists()
    assert not (out.parent / "planted").exists()


@pytest.mark.parametrize("link", ["old", "new", "new/sub"])
def test_a_leftover_that_leads_elsewhere_moves_nothing(out: Path, link: str) -> None:
    """A folder from somebody else: a part of what a killed run left is a link."""
    elsewhere = out.parent / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "precious").write_text("mine")
    listed = json.loads((out / LIST).read_text())["files"]
    (out / ".alula-work" / link).parent.mkdir(parents=True)
    (out / ".alula-work" / link).symlink_to(elsewhere)
    (out / ".alula-work" / "list.json").write_text(json.dumps({"files": listed, "kept": []}))
    with pytest.raises(CannotRunError):
        write_folder(out, "check", failing)
    assert files_of(elsewhere) == {"precious": "mine"}
    assert {name: files_of(out).get(name) for name in MINE} == MINE


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_leftover_whose_list_is_a_pipe_is_not_waited_for(out: Path) -> None:
    (out / ".alula-work").mkdir()
    os.mkfifo(out / ".alula-work" / "list.json")
    write_folder(out, "check", fill())
    assert files_of(out) == MINE | {"result.json": "{}", "sub/a.png": "new"}
    assert not (out / ".alula-work").exists()


def test_a_fresh_folder_is_made_again_where_a_failing_run_removes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two runs into one folder that neither found there: what the second computed was lost."""
    lock, left = output.locked, [None]

    def removed(folder: Path, *, wait: bool = True) -> int | None:
        if left:
            left.pop()
            folder.rmdir()
        return lock(folder, wait=wait)

    monkeypatch.setattr(output, "locked", removed)
    write_folder(tmp_path / "deep" / "out", "check", fill())
    assert files_of(tmp_path) == {"deep/out/result.json": "{}", "deep/out/sub/a.png": "new"}


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), RuntimeError("crash"), KeyboardInterrupt()])
def test_a_failure_leaves_the_earlier_result_untouched(out: Path, error: BaseException) -> None:
    before = files_of(out)

    def half(folder: Path) -> None:
        (folder / "result.json").write_text('{"schema_version": 1, "verd')
        raise error

    with pytest.raises((CannotRunError, RuntimeError, KeyboardInterrupt)):
        write_folder(out, "check", half)
    assert files_of(out) == before
    with pytest.raises((CannotRunError, RuntimeError, KeyboardInterrupt)):
        write_folder(out.parent / "deep" / "fresh", "motion", half)
    assert list(out.parent.iterdir()) == [out]


def test_a_disk_that_fails_before_the_first_move_keeps_nothing(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It said that the next run restores what was there, and kept the new files in a hidden folder until then."""
    before = files_of(out)
    monkeypatch.setattr(output, "_flush", failing)
    with pytest.raises(CannotRunError, match="nothing was changed there"):
        write_folder(out, "check", fill())
    assert files_of(out) == before
    assert folders_of(out) == {"sub", "gone"}


@pytest.mark.parametrize("error", [OSError(5, "Input/output error"), KeyboardInterrupt()])
@pytest.mark.parametrize("step", range(7))
def test_a_failure_between_two_moves_takes_the_others_back(
    out: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, step: int
) -> None:
    before, left = files_of(out), [step]
    move = output._move

    def failing(source: Path, to: Path) -> None:
        left[0] -= 1
        if left[0] == -1:
            raise error
        move(source, to)

    monkeypatch.setattr(output, "_move", failing)
    with pytest.raises((CannotRunError, KeyboardInterrupt)):
        write_folder(out, "check", fill())
    assert left[0] < 0
    assert files_of(out) == before
    assert folders_of(out) == {"sub", "gone"}
    write_folder(out, "check", fill())
    assert files_of(out) == MINE | {"result.json": "{}", "sub/a.png": "new"}


@pytest.mark.parametrize(
    ("refused", "name", "folder"),
    [
        # moving the new picture in fails, and putting the earlier field back
        ({("out", "sub/a.png"), ("out", "gone/b.vtu")}, "gone/b.vtu", "gone"),
        # moving the new record in fails, and moving the new picture out
        ({("out", "result.json"), ("new", "sub/a.png")}, "sub/a.png", "sub"),
    ],
)
def test_what_cannot_be_taken_back_at_once_is_taken_back_by_the_next_run(
    out: Path, monkeypatch: pytest.MonkeyPatch, refused: set[tuple[str, str]], name: str, folder: str
) -> None:
    """And what the user put or changed there by then is left alone."""
    before, move = files_of(out), output._move

    def failing(source: Path, to: Path) -> None:
        if any(to.as_posix().endswith("/".join(part)) for part in refused):
            raise OSError(5, "Input/output error")
        move(source, to)

    monkeypatch.setattr(output, "_move", failing)
    with pytest.raises(CannotRunError, match="the next run into it restores what was there"):
        write_folder(out, "check", fill())
    monkeypatch.undo()
    (out / folder).mkdir(exist_ok=True)
    (out / name).write_text("mine")
    with pytest.raises(CaseError, match="was not written by alula, or was edited since"):
        refuse_unusable(out, "check")
    assert files_of(out) == before | {name: "mine"}


def test_a_file_or_link_in_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "link").symlink_to(tmp_path)
    (tmp_path / "dangling").symlink_to(tmp_path / "none")
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "motion").symlink_to(tmp_path)
    leads = f"is a symbolic link, and alula writes through none; give '{re.escape(str(tmp_path.resolve()))}' itself$"
    for name, command, told in (
        ("file", "check", "exists and is not a folder"),
        ("link", "motion", leads),
        ("dangling", "check", "is a symbolic link, and alula writes through none; choose another name$"),
        ("real", "motion", leads),
    ):
        for attempt in (refuse_unusable, lambda folder, command: write_folder(folder, command, fill())):
            with pytest.raises(CaseError, match=told):
                attempt(tmp_path / name, command)


@pytest.mark.skipif(os.name == "nt", reason="permissions are POSIX")
def test_a_place_that_cannot_be_written_is_explained(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    for attempt in (refuse_unusable, lambda folder, command: write_folder(folder, command, fill())):
        with pytest.raises(CaseError, match="cannot be written"):  # what the user named is his input
            attempt(tmp_path / "file" / "out", "check")


def test_the_place_of_each_command(tmp_path: Path) -> None:
    assert [place(tmp_path, c).name for c in ("motion", "envelope", "synth")] == ["motion", "envelope", "synth"]
    assert place(tmp_path, "check") == place(tmp_path, EXPORT) == tmp_path
