"""What README prints works as printed: every command in an empty folder, the Python, the lines of a case."""

import re
import shlex
import subprocess
import textwrap
import tomllib
from pathlib import Path
from typing import Any

import programs
import pytest

from alula.loads.case.case_file import read_case

README = (programs.ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = [(kind, textwrap.dedent(text)) for kind, text in re.findall(r"^ *```(\w*)\n(.*?)^ *```$", README, re.S | re.M)]
PROSE = re.sub(r"^ *```.*?^ *```$", "", README, flags=re.S | re.M)
SHELL = [line for kind, text in BLOCKS if not kind for line in text.splitlines()]
COMMANDS = [line for line in SHELL if line.startswith("alula ")] + re.findall(r"`(alula [^`]+)`", PROSE)
CHANGES = re.findall(r"`(--set [^`]+)`", PROSE)
"""Changes that the text proposes for the case of its own, without the command before them."""
VERDICTS = {0, 1, 3}
FAILS = "check owl-wing-static -o"
"""README says of it that the verdict is *fail*."""


def words(command: str) -> list[str]:
    return shlex.split(command, comments=True)[1:]


def is_slow(command: str) -> bool:
    """Whether ``make verify`` runs it: it computes or draws for seconds, and has tests of its own in ``make test``."""
    return words(command)[0] in (
        "check",
        "envelope",
        "claims",
        "tolerance",
        "size",
        "study",
        "motion",
        "inspect",
        "frequencies",
    )


def serves(command: str) -> bool:
    """Whether it runs until it is ended; these have tests of their own."""
    return words(command)[0] in ("open", "mcp")


def writes_a_case(command: str) -> bool:
    return words(command)[0] == "new" and "--list" not in words(command)


def reads_a_part(command: str) -> bool:
    return words(command)[0] == "inspect" or "--from-step" in words(command)


def in_order(commands: list[str]) -> list[str]:
    return sorted(commands, key=lambda command: not writes_a_case(command) or reads_a_part(command))


def needed(command: str) -> list[str]:
    """Commands whose files another reads: cases, the STEP files, the study that is shown."""
    shows = words(command)[:2] == ["study", "show"]
    return [
        other
        for other in in_order(COMMANDS)
        if (writes_a_case(other) and not reads_a_part(other))
        or (shows and words(other)[0] == "study" and words(other)[1] != "show")
        or (reads_a_part(command) and words(other)[0] == "export")
    ]


def run(folder: Path, command: str) -> subprocess.CompletedProcess[str]:
    """Run a line as a reader's shell does, with alula among the programs."""
    programs_folder = folder.with_name(f"{folder.name}-bin")
    programs_folder.mkdir(exist_ok=True)
    alula = programs_folder / "alula"
    alula.write_text(f'#!/bin/sh\nexec {shlex.join(programs.COMMAND)} "$@"\n', encoding="utf-8")
    alula.chmod(0o755)
    path = programs.environment()["PATH"]
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=programs.environment(PATH=f"{programs_folder}:{path}"),
        capture_output=True,
        text=True,
        timeout=3600,
        check=False,
    )


def check(folder: Path, command: str, *, own_process: bool = True) -> None:
    """Run a command and compare its status with what README says of it, and its files with those that it names."""
    before = set(folder.rglob("*"))
    told = words(command)
    done = run(folder, command) if own_process else programs.inside(*told, folder=folder)
    verdicts = {1} if FAILS in command else VERDICTS
    assert done.returncode in (verdicts if told[0] in ("check", "envelope") else {0}), f"{command}\n{done.stderr}"
    assert "Traceback" not in done.stderr
    if "--json" in told or told[0] == "schema":
        assert done.stdout.startswith("{")
    else:
        assert done.stdout.strip()
    written = {str(file.relative_to(folder)) for file in set(folder.rglob("*")) - before}
    comment = command.partition("#")[2]
    named = re.findall(r"\bout/[\w./]+", comment) + re.findall(r"in (parts)\b", comment)
    assert set(named) <= written, command
    assert bool(written) == (writes_a_case(command) or told[0] == "export" or "-o" in told)


def test_there_are_commands_and_all_of_them_are_run() -> None:
    assert len(COMMANDS) >= 15
    printed = re.findall(r"^alula [a-z]+ ?", README, re.M) + re.findall(r"`alula [a-z]+", README)
    assert len(printed) - printed.count("alula imports ") == len(COMMANDS)
    assert {line.split()[0] for line in SHELL if line.strip()} == {"alula", "make"}


def test_quick_commands(tmp_path: Path) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    for command in in_order([command for command in COMMANDS if not is_slow(command) and not serves(command)]):
        check(folder, command, own_process=False)
    own = words(next(command for command in reversed(COMMANDS) if writes_a_case(command)))[-1]
    assert CHANGES
    for change in CHANGES:
        assert read_case(str(folder / own), [shlex.split(change)[1]]) != read_case(str(folder / own))


@pytest.mark.converged
@pytest.mark.parametrize("command", [command for command in COMMANDS if is_slow(command)])
def test_slow_commands(command: str, tmp_path: Path) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    for first in needed(command):
        check(folder, first)
    check(folder, command)


@pytest.mark.converged
def test_what_size_says_of_the_starter(tmp_path: Path) -> None:
    [block] = [text for kind, text in BLOCKS if kind == "text" and text.startswith("Least ")]
    [starter, command] = [line for line in SHELL if " my-case.toml " in line and words(line)[0] in ("new", "size")]
    run(tmp_path, starter)
    assert " ".join(block.split()) in " ".join(run(tmp_path, command).stdout.split())


SNIPPETS = [(text, BLOCKS[i + 1][1]) for i, (kind, text) in enumerate(BLOCKS) if kind == "python"]


@pytest.mark.parametrize(("snippet", "printed"), SNIPPETS)
def test_a_snippet(snippet: str, printed: str, tmp_path: Path) -> None:
    out, told = programs.python(snippet, tmp_path)
    assert told == ""
    assert [line.rstrip() for line in out.splitlines()] == printed.splitlines()


def test_the_lines_of_a_case_are_those_of_the_starter() -> None:
    text = (programs.ROOT / "loads/cases/four-bar.toml").read_text(encoding="utf-8")
    starter = tomllib.loads(text)
    fragments = [tomllib.loads(text) for kind, text in BLOCKS if kind == "toml"]
    assert fragments
    for fragment in fragments:
        _is_part_of(fragment, starter)


def _is_part_of(fragment: Any, whole: Any) -> None:
    if isinstance(fragment, dict):
        for key, value in fragment.items():
            _is_part_of(value, whole[key])
    else:
        assert fragment == whole
