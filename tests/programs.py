"""Programs that tests start, watch and kill: the command itself and small ones that write an output folder."""

import io
import json
import os
import subprocess
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import chdir, contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any
from unittest.mock import patch

from alula.reports.commands import ending
from alula.reports.commands.cli import app

ROOT = Path(__file__).resolve().parents[1]
COMMAND = [sys.executable, "-P", "-c", "from alula.reports.commands.cli import main; main()"]
"""As the installed command: the current folder is not on the path, where Python 3.13.0 stumbles over a missing one."""
BEAM = ("check", "knee", "--fidelity", "beam")
"""The whole check that takes least."""
WRITING = (
    "import json, os, sys\n"
    "from pathlib import Path\n"
    "from alula.reports.page import output\n"
    "def write_folder(folder, fill):\n"
    "    output.write_folder(folder, 'check', fill)\n"
    "def fill(text):\n"
    "    def write(folder):\n"
    "        (folder / 'report.html').write_text(text)\n"
    "        (folder / 'pictures').mkdir()\n"
    "        for i in range(3):\n"
    "            (folder / 'pictures' / f'{i}.png').write_text(text)\n"
    "        record = {'schema_version': 1, 'verdict': 'pass', 'text': text}\n"
    "        (folder / 'result.json').write_text(json.dumps(record))\n"
    "    return write\n"
)
"""A program that can write an output folder of five files, each holding the same text."""


def environment(scratch: Path | None = None, **more: str) -> dict[str, str]:
    """Return an environment in which the program finds its modules; ``scratch`` takes its temporary files."""
    own = {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    return os.environ | own | ({} if scratch is None else {"TMPDIR": str(scratch)}) | more


@contextmanager
def start(*arguments: str, scratch: Path, **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Start the command, its temporary files in a folder of their own; it is killed at the end of the block."""
    scratch.mkdir(exist_ok=True)
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL}
    with subprocess.Popen([*COMMAND, *arguments], env=environment(scratch), text=True, **(pipes | options)) as process:
        try:
            yield process
        finally:
            process.kill()


def run(*arguments: str, scratch: Path, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run the command to its end."""
    with start(*arguments, scratch=scratch, **options) as process:
        out, told = process.communicate(timeout=300)
    return subprocess.CompletedProcess(process.args, process.returncode, out, told)


def inside(*arguments: str, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command in this process, which spares the imports: for what needs no process of its own."""
    out, told, status = io.StringIO(), io.StringIO(), None
    with (
        redirect_stdout(out), redirect_stderr(told), chdir(folder or "."),
        patch.object(ending, "end_cleanly_on_signals"),
    ):  # fmt: skip
        try:
            ending.run(lambda: app(list(arguments), prog_name="alula", standalone_mode=False))
        except SystemExit as stop:
            status = stop.code
    assert isinstance(status, int)
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), told.getvalue())


def python(text: str, folder: Path) -> tuple[str, str]:
    """Run a script of a page in this process and a folder, and return what it prints and what it tells of errors.

    As in an interpreter of its own, a file that is left open is none of them.
    """
    out, told = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(told), chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        exec(compile(text, "<page>", "exec"), {"__name__": "__main__"})
    return out.getvalue(), told.getvalue()


def script(text: str, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run a program that can write an output folder."""
    command = [sys.executable, "-c", WRITING + text, *arguments]
    return subprocess.run(
        command, env=environment(), capture_output=True, text=True, timeout=300, check=False, **options
    )


def ended(pid: int) -> bool:
    """Say whether a process has ended, also where nobody has asked for its status yet; by /proc where there is one."""
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return Path("/proc/self/stat").exists()  # it ended between the two questions
    except ProcessLookupError:
        return True


def text_of(folder: Path) -> str:
    """Return the text in every file of a folder written by ``WRITING``; asserts that it is whole and of one run.

    "none" where there is no result; what is hidden and what the user put there do not count.
    """
    if not (folder / "result.json").exists():
        return "none"
    files = [folder / "report.html", *(folder / "pictures" / f"{i}.png" for i in range(3))]
    record = json.loads((folder / "result.json").read_text())
    assert {file.read_text() for file in files} == {record["text"]}
    assert sorted(p.name for p in (folder / "pictures").glob("*.png")) == ["0.png", "1.png", "2.png"]
    return str(record["text"])


def is_whole(folder: Path) -> bool:
    """Return True for a report with all that it consists of, False where there is no folder; asserts the rest."""
    if not folder.exists():
        return False
    assert (folder / "report.html").read_text(encoding="utf-8").rstrip().endswith("</html>")
    assert json.loads((folder / "result.json").read_text(encoding="utf-8"))["verdict"] in ("pass", "fail", "undecided")
    pictures = list((folder / "pictures").iterdir())
    assert pictures
    assert all(picture.read_bytes().endswith(b"IEND\xaeB`\x82") for picture in pictures)
    return True


def hidden(folder: Path) -> list[str]:
    """Return what is hidden in a folder and in those in it, but for the lists of the files that alula wrote."""
    return [path.name for path in folder.rglob(".*") if not (path.name.startswith(".alula-") and path.is_file())]


def gone(scratch: Path, within: float = 60.0) -> bool:
    """Return True if every temporary file of the program vanishes in time: its children remove theirs."""
    deadline = time.monotonic() + within
    while time.monotonic() < deadline:
        if not any(path.name.startswith("alula-") for path in scratch.iterdir()):
            return True
        time.sleep(0.1)
    return False
