"""Pages whose blocks work as a reader would use them.

A block of TOML begins with the comment ``# NAME.toml``: its entries change that file, or make it. Commands and Python
are run. A block of text is a file where it begins with ``# NAME.csv``; else it is printed by the block before it, but
for lines ``...`` and breaks of lines. Commands that take longer than seconds are run by ``make verify`` alone.
"""

import json
import re
import shlex
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import programs
from prose import FENCE

STATUSES = {0, 1, 3}
QUICK = ("new", "statics", "inspect", "export", "materials", "schema")


@dataclass
class Reader:
    """Someone who follows a page in a folder of his own."""

    folder: Path
    patient: bool = False
    """True: the slow commands are run too."""
    printed: str | None = None
    """What the last block printed; None where it was not run."""
    cases: list[Path] = field(default_factory=list)

    def follow(self, page: Path) -> None:
        """Do what the blocks of a page say, one after the other."""
        for _, _, kind, text in FENCE.findall(page.read_text(encoding="utf-8")):
            getattr(self, kind.strip() or "nothing")(text)

    def toml(self, text: str) -> None:
        """Change a file, or make it."""
        name = re.match(r"# ([\w-]+\.toml)\n", text)
        assert name, f"a block of TOML begins with the name of its file: {text}"
        file = self.folder / name[1]
        old = tomllib.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        file.write_text(written(merged(old, tomllib.loads(text))), encoding="utf-8")
        self.cases.append(file)

    def sh(self, text: str) -> None:
        """Run commands."""
        commands = [shlex.split(line, comments=True) for line in re.sub(r"\\\n *", "", text).splitlines()]
        if not self.patient and any(is_slow(command) for command in commands if command):
            self.printed = None
            return
        self.printed = ""
        for command in filter(None, commands):
            assert command[0] == "alula", command
            done = programs.inside(*command[1:], folder=self.folder)
            assert done.returncode in STATUSES, f"{shlex.join(command)}\n{done.stderr}"
            self.printed += done.stdout

    def python(self, text: str) -> None:
        """Run Python."""
        done = subprocess.run(
            [sys.executable, "-c", text],
            cwd=self.folder,
            env=programs.environment(),
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        self.printed = done.stdout

    def text(self, text: str) -> None:
        """Make a table whose name is the first line, or look for what was printed."""
        name, _, rows = text.partition("\n")
        if name.startswith("# "):
            (self.folder / name.removeprefix("# ")).write_text(rows, encoding="utf-8")
        elif self.printed is not None:
            said = " ".join(self.printed.split())
            for piece in re.split(r"^ *(?:\.\.\.|…) *$", text, flags=re.M):
                assert " ".join(piece.split()) in said, f"{piece}\nis not in\n{self.printed}"


def is_slow(command: list[str]) -> bool:
    """Return True for what meshes, and for studies of many variants."""
    by_hand = "--fidelity beam" in " ".join(command)
    return command[1] not in QUICK and not (command[1] in ("check", "size", "study") and by_hand)


def merged(old: Any, new: Any) -> Any:
    """Return tables with the entries of others; a load takes the place of one at the same point of the same link."""
    if isinstance(old, dict) and isinstance(new, dict):
        return old | {key: merged(old[key], value) if key in old else value for key, value in new.items()}
    if isinstance(old, list) and isinstance(new, list) and all(isinstance(item, dict) for item in (*old, *new)):
        places = [_place(item) for item in new if _place(item)]
        return [*(item for item in old if _place(item) not in places), *new]
    return new


def _place(item: dict[str, Any]) -> dict[str, Any]:
    return {key: item[key] for key in ("link", "at", "start", "end") if key in item}


def written(table: dict[str, Any]) -> str:
    """Return a table as TOML."""
    return "".join(f"{json.dumps(key)} = {_value(value)}\n" for key, value in table.items())


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_value(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False)
