"""A disk that is full or may not be written: one sentence, status 4, and the earlier result untouched."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import programs
import pytest

from alula.geometry.base.child import run as run_child
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.part import Bar, Body, Pin

resource = pytest.importorskip("resource")
BODY = Body(
    part=Bar(shape="bar", material="cfrp", width="6 mm", thickness="3 mm", eye_diameter="10 mm",
             eye_thickness="3 mm", fillet_radius="1 mm"),
    pins=(Pin(name="A", x=0.0, y=0.0, diameter=2.0), Pin(name="B", x=40.0, y=0.0, diameter=2.0)),
    ends=(),
    holes=(),
)  # fmt: skip


def small_files() -> None:
    """Let no file of this process grow beyond 20 kB: every write beyond fails as on a full disk."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))


def test_a_report_that_does_not_fit(tmp_path: Path) -> None:
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    assert programs.script("write_folder(Path(sys.argv[1]), fill('old'))", str(out)).returncode == 0
    done = programs.run(*programs.BEAM, "-o", str(out), scratch=scratch, preexec_fn=small_files)
    assert done.returncode == 4, done.stderr
    last = done.stderr.strip().splitlines()[-1]
    assert last == f"alula: output: writing to '{out}' failed (File too large); nothing was changed there"
    assert "\nPass: all 26 checks keep their limits" in done.stdout  # what was computed is told all the same
    assert programs.text_of(out) == "old"
    assert programs.hidden(tmp_path) == []
    assert programs.script("write_folder(Path(sys.argv[1]), fill('next'))", str(out)).returncode == 0
    assert programs.text_of(out) == "next"


def test_a_disk_that_is_full(tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=128k", "tmpfs", str(disk)]
    if not shutil.which("mount") or subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("only root may mount a small disk")
    try:
        assert programs.script("write_folder(Path(sys.argv[1]), fill('old'))", str(disk / "out")).returncode == 0
        done = programs.script("write_folder(Path(sys.argv[1]), fill('new' * 50_000))", str(disk / "out"))
        assert "CannotRunError: output: writing to" in done.stderr
        assert "failed (No space left on device); nothing was changed there" in done.stderr
        assert programs.text_of(disk / "out") == "old"
        assert programs.hidden(disk) == []
    finally:
        subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.parametrize(
    ("command", "name"),
    [("check", "report.html"), ("envelope", "envelope/result.json"), ("motion", "motion/result.json")],
)
def test_a_file_in_the_way_is_refused_before_anything_is_solved(tmp_path: Path, command: str, name: str) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    done = programs.inside(command, "ornithopter", "-o", str(tmp_path))
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1, done.stderr  # not a word of progress
    assert f"'{tmp_path / name}' was not written by alula, or was edited since" in done.stderr
    assert (tmp_path / name).read_text() == "mine"


def test_parts_that_do_not_fit(tmp_path: Path) -> None:
    parts, scratch = tmp_path / "parts", tmp_path / "scratch"
    done = programs.run(
        "export", "owl-wing-static", "--step", "-o", str(parts), scratch=scratch, preexec_fn=small_files
    )
    assert done.returncode == 4, done.stderr
    assert not parts.exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize("command", ["cases", "--version"], ids=["of pages", "of a line"])
def test_standard_output_on_a_full_disk(tmp_path: Path, command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also what is written at the end alone, as where nothing asks Python to write each line at once."""
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)
    with Path("/dev/full").open("w") as full:
        done = programs.run(command, scratch=tmp_path / "scratch", stdout=full)
    assert done.returncode == 4
    assert done.stderr.startswith("alula: standard output failed (No space left on device)")
    assert len(done.stderr.splitlines()) == 1


def test_a_starter_case_that_does_not_fit_leaves_no_half(tmp_path: Path) -> None:
    def tiny() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

    path = tmp_path / "case.toml"
    done = programs.run("new", str(path), scratch=tmp_path / "scratch", preexec_fn=tiny)
    assert done.returncode == 4
    assert "cannot be written (File too large)" in done.stderr
    assert not path.exists()
    assert programs.run("new", str(path), scratch=tmp_path / "scratch").returncode == 0


def test_meshing_needs_no_room_for_temporary_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "none"))  # the child's
    assert mesh_body(BODY, COARSE).volume > 0.0


READ_ONLY = """
os.chmod(sys.argv[1], int(sys.argv[2], 8))
os.chmod(sys.argv[1] + "/out", int(sys.argv[3], 8))
if os.geteuid() == 0:
    os.seteuid(65534)
try:
    write_folder(Path(sys.argv[1]) / "out", fill("new"))
except Exception as error:
    print(type(error).__name__, error)
"""


@pytest.mark.skipif(os.name == "nt", reason="permissions are POSIX")
@pytest.mark.parametrize(("parent", "own"), [("555", "755"), ("777", "555"), ("000", "755")])
def test_a_folder_that_may_not_be_written(tmp_path: Path, parent: str, own: str) -> None:
    place = tmp_path / "place"
    place.mkdir()
    assert programs.script("write_folder(Path(sys.argv[1]), fill('old'))", str(place / "out")).returncode == 0
    # The folder of this test may be closed to others, which is one more way in which a place cannot be written.
    done = programs.script(READ_ONLY, str(place), parent, own)
    place.chmod(0o755)
    (place / "out").chmod(0o755)
    assert done.stdout.startswith("CaseError output: "), (done.stdout, done.stderr)
    assert "Permission denied" in done.stdout
    assert programs.text_of(place / "out") == "old"
    assert programs.hidden(place) == []


def test_memory_that_runs_out_is_status_4(tmp_path: Path) -> None:
    code = (
        "import alula.reports.commands.cli as c, alula.fea.check.run as run\n"
        "def f(*a, **k): raise MemoryError\nrun.check_case = f\nc.main()"
    )
    command = [sys.executable, "-c", code, *programs.BEAM]
    done = subprocess.run(command, env=programs.environment(), capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 4
    assert done.stderr.startswith("alula: memory ran out; use a coarser mesh")


def test_a_child_that_floods_its_error_output_is_read_to_the_end() -> None:
    """A full pipe would block the child for ever."""
    flood = [sys.executable, "-c", "import sys; sys.stderr.write('x\\n' * 1_000_000 + 'last')"]
    assert run_child(flood, environment=programs.environment(), time_limit=60.0) == (0, "last")
