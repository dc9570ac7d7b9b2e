"""``alula open``: what it refuses, and the whole way from an edit to its verdict, in processes of its own."""

import os
import signal
import socket
import time
from pathlib import Path
from unittest.mock import patch

import programs
import pytest
import served

from alula.loads.case.case_file import read_text
from alula.reports.commands import open as command


@pytest.mark.parametrize(
    ("case", "told"),
    [
        ("nowhere/mine.toml", "there is no such file"),
        ("mine.json", "there is no such file"),
        ("four-bar", "alula new my-case.toml --from four-bar"),
        (".", "it is a folder"),
        ("empty.toml", "the file is empty"),
        ("binary.toml", "it is not UTF-8 text"),
    ],
)
def test_bad_input_ends_in_one_sentence(tmp_path, case, told):
    (tmp_path / "empty.toml").touch()
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe")
    done = programs.inside("open", case, "--no-browser", folder=tmp_path)
    assert done.returncode == 2
    assert told in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not done.stdout


def test_a_port_in_use_is_told(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = programs.inside("open", "--port", str(port), "--no-browser", folder=tmp_path)
    assert done.returncode == 2
    assert f"--port {port}: it cannot be had" in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("shows", [True, False, OSError("no such program")])
def test_without_a_browser_the_address_does(capsys, shows):
    answer = {"side_effect": shows} if isinstance(shows, OSError) else {"return_value": shows}
    with patch("webbrowser.open", **answer) as asked:
        command.show("http://127.0.0.1:1/x/")
    asked.assert_called_once_with("http://127.0.0.1:1/x/")
    assert ("open the address above" in capsys.readouterr().err) is (shows is not True)


def test_an_edit_is_answered_and_the_end_takes_all_with_it(tmp_path: Path, monkeypatch):
    """From a file to the verdict of an edit; then Ctrl-C, which ends all processes and keeps what was not saved."""
    case = tmp_path / "mine.toml"
    case.write_text(read_text("four-bar")[0], encoding="utf-8")
    monkeypatch.setenv("ALULA_CACHE", str(tmp_path / "cache"))
    with programs.start("open", str(case), "--no-browser", scratch=tmp_path / "scratch") as process:
        assert process.stdout is not None
        bench = served.Workbench(process.stdout.readline().removeprefix("The page:").strip())
        with bench.events(patience=60) as events:
            longer = {"op": "set", "path": ["links", "crank", "points", "A"], "value": ["41 mm", "0 mm"]}
            assert bench.post("edit", revision=0, operations=[longer], gesture="")[0] == 200
            drawn = events.next("drawn", revision=1)
            [crank] = [link for link in drawn["links"] if link["name"] == "crank"]
            assert [41.0, 0.0] in [point["local"] for point in crank["points"]]
            assert events.next("verdict", revision=1, stage="linear")["verdict"] in ("pass", "fail", "undecided")
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
            started = [int(pid) for pid in children.read_text().split()] if children.exists() else []
            began = time.monotonic()
            process.send_signal(signal.SIGINT)
            assert process.wait(10) == 130
            assert time.monotonic() - began < 3.0
        assert process.stderr is not None
        assert process.stderr.read() == "alula: interrupted\n"
    assert len(started) >= 2 or os.name != "posix"
    assert all(programs.ended(pid) for pid in started)
    [draft] = (tmp_path / "cache").rglob("draft.json")
    assert "41 mm" in draft.read_text(encoding="utf-8")
    assert "41 mm" not in case.read_text(encoding="utf-8")
