"""Closed streams and pipes, poor encodings and environments, odd paths: the verdict's status, and no fault."""

import json
import os
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import programs
import pytest
import rocker_case

from alula.reports.commands import ending

STATICS = ("statics", "four-bar")
"""It prints letters beyond ASCII."""


def shell(redirection: str, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Run the command with a shell's redirection behind it."""
    command = ["bash", "-c", f'"$@" {redirection}', "bash", *programs.COMMAND, *arguments]
    return subprocess.run(
        command, env=programs.environment(**more), capture_output=True, timeout=300, check=False, errors="replace"
    )


@pytest.mark.parametrize("redirection", [">&-", "2>&-", "<&-", ">&- 2>&- <&-"])
def test_closed_streams(redirection: str) -> None:
    done = shell(redirection, "synth", "--json")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    if redirection.startswith(">"):
        assert done.stdout == ""
    else:
        assert set(json.loads(done.stdout)["lengths"]) == {"a", "b", "c", "d"}


@pytest.mark.parametrize(("encoding", "command"), [("ascii", (*STATICS, "--json")), ("latin-1", STATICS)])
def test_poor_encodings(encoding: str, command: tuple[str, ...]) -> None:
    poor = shell("", *command, LC_ALL="C", PYTHONIOENCODING=encoding)
    assert poor.returncode == 0, poor.stderr
    assert "fault" not in poor.stderr
    if "--json" in command:
        told, other = (json.loads(text) for text in (poor.stdout, programs.inside(*command).stdout))
        for one in (told, other):
            del one["provenance"]["date"]
        assert told == other


def test_a_reader_that_reads_no_further_ends_the_run_as_the_shell_says() -> None:
    done = shell("| head -1; exit ${PIPESTATUS[0]}", "schema")
    assert done.stdout == "{\n"
    assert done.returncode in (0, 141)  # 0 where all was written before the reader went
    assert done.stderr == ""
    late = shell("| (exec <&-; sleep 2); exit ${PIPESTATUS[0]}", "schema")
    assert late.returncode == 141
    assert late.stderr == ""


def test_a_home_that_cannot_be_written(tmp_path: Path) -> None:
    home = tmp_path / "file"
    home.write_text("no folder")
    settings = {"HOME": str(home), "XDG_CONFIG_HOME": "", "XDG_CACHE_HOME": "", "MPLCONFIGDIR": ""}
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    settings["TMPDIR"] = str(scratch)
    done = shell("", "synth", "-o", str(tmp_path / "out"), **settings)
    assert done.returncode == 0
    assert done.stderr == ""
    assert list(scratch.iterdir()) == []
    # One folder for all processes: children that are killed left theirs.
    text = (
        "from alula.reports.commands import ending\n"
        "from alula.geometry.base import child\n"
        "ending.run(lambda: print(child.environment()['MPLCONFIGDIR']))\n"
    )
    environment = programs.environment(**settings)
    told = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=False)
    assert Path(told.stdout.strip()).parent == scratch, told.stderr
    assert list(scratch.iterdir()) == []


def test_a_home_that_can_be_written_keeps_matplotlibs_caches(tmp_path: Path, monkeypatch) -> None:
    for name in ("XDG_CONFIG_HOME", "XDG_CACHE_HOME", "MPLCONFIGDIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "new"))
    ending.place_for_matplotlib()
    assert "MPLCONFIGDIR" not in os.environ
    monkeypatch.setenv("MPLCONFIGDIR", "mine")
    monkeypatch.setenv("HOME", "/dev/null")
    ending.place_for_matplotlib()
    assert os.environ["MPLCONFIGDIR"] == "mine"


PLAIN = {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
"""A locale of ASCII alone, which Python would else take for UTF-8."""


@pytest.mark.parametrize(
    "prefix",
    [
        "TERM=dumb NO_COLOR=1 COLUMNS=20",
        "TMPDIR=/nonexistent/folder",
        "-u HOME -u TMPDIR -u TERM -u LANG",
    ],
)
def test_poor_environments(prefix: str, tmp_path: Path) -> None:
    """The verdict and every number and name of the table are those of a plain run, and nothing is left behind."""
    tmp_path.chmod(0o555)
    poor = shell_in(tmp_path, f'env {prefix} "$@"', *STATICS)
    assert poor.returncode == 0, poor.stderr
    assert "\x1b" not in poor.stdout
    assert "Traceback" not in poor.stderr
    lost = {word for word in programs.inside(*STATICS).stdout.split() if word.isalnum()} - set(poor.stdout.split())
    assert not lost
    assert list(tmp_path.iterdir()) == []


def test_a_current_folder_that_is_gone(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    done = shell_in(folder, 'rmdir "$PWD"; "$@"', "synth", "--json")
    assert done.returncode == 0, done.stderr
    written = shell_in(tmp_path, 'mkdir gone && cd gone && rmdir "$PWD"; "$@"', "synth", "-o", "out")
    assert written.returncode == 4
    assert written.stderr.splitlines()[-1].startswith("alula: the current folder failed (No such file or directory)")


def test_names_beyond_ascii_in_a_locale_of_ascii(tmp_path: Path) -> None:
    """gmsh was handed a path that is no UTF-8 for Python there; a link's own file cannot be named (both status 4)."""
    text = files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8")
    for old, new in (("links.rocker", 'links."Ärmel"'), ('"rocker"', '"Ärmel"'), ("rocker =", '"Ärmel" =')):
        text = text.replace(old, new)
    (tmp_path / "größe.toml").write_text(text, encoding="utf-8")
    done = shell_in(tmp_path, '"$@"', "statics", "größe.toml", "--json", **PLAIN)
    assert done.returncode == 0, done.stderr
    assert "Ärmel" in json.dumps(json.loads(done.stdout), ensure_ascii=False)
    done = shell_in(tmp_path, '"$@"', "export", "größe.toml", "--step", "-o", "teile", **PLAIN)
    assert done.returncode == 4
    assert done.stderr.startswith("alula: a name with '\\xc4' cannot be a file name in this locale, whose enc")
    assert not (tmp_path / "teile").exists()
    (tmp_path / "größe.toml").write_text(rocker_case.TOML, encoding="utf-8")
    done = shell_in(tmp_path, '"$@"', "export", "größe.toml", "--step", "-o", "größe", **PLAIN)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in (tmp_path / "größe").glob("[!.]*")] == ["rocker.step"]


@pytest.mark.parametrize("kind", ["folder", "pipe", "device"])
@pytest.mark.parametrize("command", ["check", "motion"])
def test_a_case_that_is_no_file_is_refused_at_once(kind: str, command: str, tmp_path: Path) -> None:
    path = {"folder": tmp_path, "pipe": tmp_path / "pipe", "device": Path("/dev/zero")}[kind]
    if kind == "pipe":
        os.mkfifo(path)
        done = shell_in(tmp_path, 'timeout 60 "$@"', command, str(path))
    else:
        done = programs.inside(command, str(path))
    assert done.returncode == 2
    assert done.stdout == ""
    what = "it is a folder" if kind == "folder" else "it is no regular file"
    assert done.stderr.startswith(f"alula: case '{path}': {what}")
    assert len(done.stderr.splitlines()) == 1


def shell_in(folder: Path, script: str, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a script of the shell in a folder, the command standing for "$@"."""
    command = ["bash", "-c", script, "bash", *programs.COMMAND, *arguments]
    return subprocess.run(
        command, cwd=folder, env=programs.environment(**more), capture_output=True, timeout=300, check=False, text=True
    )
