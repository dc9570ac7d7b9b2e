"""Pages whose blocks work as a reader would use them.

A block of TOML begins with the comment ``# NAME.toml``; its entries change that file, or make it. Commands and Python
are run. A block of text is a file where it begins with ``# NAME.csv``; else it is printed by the block before it, but
for lines ``...`` and breaks of lines. Commands that take longer than seconds are run by ``make verify`` alone.

    python -m pages [PAGE ...]

follows pages, by default all, with patience, and writes numbers anew where the words about them stay.
"""

import re
import shlex
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

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
    renewing: bool = False
    """True: what was printed otherwise is kept in ``renewed`` or ``told``, where it would be an error."""
    renewed: dict[str, str] = field(default_factory=dict)
    """Blocks with other numbers -> with those of today."""
    told: list[str] = field(default_factory=list)
    """What was not printed, and has to be looked at."""

    def follow(self, page: Path) -> None:
        """Do what the blocks of a page say, one after the other."""
        for _, _, kind, text in FENCE.findall(page.read_text(encoding="utf-8")):
            getattr(self, kind.strip() or "nothing")(text)

    def toml(self, text: str) -> None:
        """Change a file, or make it."""
        name = re.match(r"# ([\w-]+\.toml)\b", text)
        assert name, f"a block of TOML begins with the name of its file: {text}"
        file = self.folder / name[1]
        old = file.read_text(encoding="utf-8") if file.exists() else ""
        file.write_text(edited(old, text.partition("\n")[2]), encoding="utf-8")
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
            if command[1] == "open":  # runs until it is ended; tests/browser/test_workbench_story.py follows its page
                continue
            done = programs.inside(*command[1:], folder=self.folder)
            assert done.returncode in STATUSES, f"{shlex.join(command)}\n{done.stderr}"
            self.printed += done.stdout

    def python(self, text: str) -> None:
        """Run Python."""
        self.printed, _ = programs.python(text, self.folder)

    def text(self, text: str) -> None:
        """Make a table whose name is the first line, or look for what was printed."""
        name, _, rows = text.partition("\n")
        if name.startswith("# "):
            (self.folder / name.removeprefix("# ")).write_text(rows, encoding="utf-8")
        elif self.printed is not None:
            said = " ".join(self.printed.split())
            pieces = re.split(r"(^ *(?:\.\.\.|…) *$)", text, flags=re.M)
            for i, piece in enumerate(pieces[::2]):
                if " ".join(piece.split()) in said:
                    continue
                new, wrong = renewed_numbers(piece, said), f"{piece}\nis not in\n{self.printed}"
                assert self.renewing, wrong
                pieces[2 * i] = new or piece
                self.told += [] if new else [wrong]
            if "".join(pieces) != text:
                self.renewed[text] = "".join(pieces)


_NUMBER = r"(?<![\w.])(?:[-−+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?|∞)"


def renewed_numbers(block: str, said: str) -> str | None:
    """Return a block with the numbers that were printed among the same words; None where these are not in one place."""
    pieces = re.split(f"({_NUMBER})", block.strip())
    words = (r"\s+".join(re.escape(word) for word in re.split(r"\s+", piece)) for piece in pieces[::2])
    found = re.findall(rf"(?<!\S){f'({_NUMBER})'.join(words)}(?!\S)", said)
    if len(pieces) == 1 or len(found) != 1:
        return None
    pieces[1::2] = [found[0]] if isinstance(found[0], str) else found[0]
    return block.replace(block.strip(), "".join(pieces))


def is_slow(command: list[str]) -> bool:
    """Return True for what meshes, and for studies of many variants."""
    by_hand = "--fidelity beam" in " ".join(command)
    return command[1] not in QUICK and not (command[1] in ("check", "size", "study") and by_hand)


def edited(file: str, lines: str) -> str:
    """Return a TOML file with lines changed, or added under their headings, as with an editor.

    A line takes the place of the one with its key under the same heading; a heading that is not there goes to the end.
    What a comment ``# remove [...], [...]`` names goes first.
    """
    sections = _sections(file)
    for gone in re.findall(r"\[[^\]]+\]", "".join(re.findall(r"^# remove (.+)$", lines, re.M))):
        del sections[gone]
    for heading, block in _sections(lines).items():
        here = sections.setdefault(heading, [])
        for line in block:
            key = _key(line)
            same = [i for i, old in enumerate(here) if key and _key(old) == key]
            if same:
                here[same[0]] = line
            else:
                here.insert(1 + max((i for i, old in enumerate(here) if _key(old)), default=-1), line)
    return "".join(
        f"{heading}\n" * bool(heading) + "".join(f"{line}\n" for line in block) for heading, block in sections.items()
    )


def _sections(text: str) -> dict[str, list[str]]:
    """Return the lines under every heading, those above all headings under an empty one."""
    found: dict[str, list[str]] = {"": []}
    for line in text.splitlines():
        if line.startswith("["):
            heading = line.partition("#")[0].strip()
            assert heading not in found, f"{heading} stands twice"
            found[heading] = []
        else:
            found[list(found)[-1]].append(line)
    return found


def _key(line: str) -> str:
    return "" if line.lstrip().startswith("#") else line.partition("=")[0].strip()


def main() -> None:
    """Follow pages, write them anew, and tell what has to be looked at."""
    docs = programs.ROOT / "docs"
    for page in map(Path, sys.argv[1:] or (docs / "tutorial.md", *sorted((docs / "how-to").glob("*.md")))):
        with tempfile.TemporaryDirectory() as folder:
            reader = Reader(Path(folder), patient=True, renewing=True)
            reader.follow(page)
        text = page.read_text(encoding="utf-8")
        for old, new in reader.renewed.items():
            text = text.replace(old, new)
        page.write_text(text, encoding="utf-8")
        print(f"{page.name}: {len(reader.renewed)} blocks renewed", *reader.told, sep="\n", flush=True)


if __name__ == "__main__":
    main()
