"""Closed streams, poor encodings, closed pipes, a home that cannot be written: the verdict's status, and no fault."""

import json
import subprocess
from pathlib import Path

import programs
import pytest

CHECK = ("check", "four-bar-synthesis", "--fidelity", "beam")


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
        assert json.loads(done.stdout)["schema_version"] == 1


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_poor_encodings(encoding: str) -> None:
    settings = {"LC_ALL": "C", "PYTHONIOENCODING": encoding}
    plain, poor = (shell("", *CHECK, "--json", **more) for more in ({}, settings))
    assert poor.returncode == plain.returncode, poor.stderr
    assert json.loads(poor.stdout)["checks"] == json.loads(plain.stdout)["checks"]
    shown = shell("", *CHECK, **settings)
    assert shown.returncode == plain.returncode, shown.stderr
    assert "fault" not in shown.stderr


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
    done = shell("", "synth", "-o", str(tmp_path / "out"), **settings)
    assert done.returncode == 0
    assert done.stderr == ""
