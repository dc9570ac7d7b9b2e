"""The kept mistakes: each puts one wrong piece of code in place of a right one, and some tests have to notice it.

The tables beside this file hold them, one for each kind of mistake:

file    the module, from the root of the checkout
before  what stands there, in one place only
after   what is planted in its stead
wrong   what the program then does
tests   those that notice: each of them fails
"""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]


@dataclass(frozen=True, kw_only=True)
class Mistake:
    """One mistake of a table.

    kind    name of the table
    """

    kind: str
    file: str
    before: str
    after: str
    wrong: str
    tests: tuple[str, ...]

    def planted(self, text: str) -> str:
        """Return the text of the module with the mistake; its place has to be there, and only once."""
        count = text.count(self.before)
        if count != 1:
            raise ValueError(f"{self.file} has {count} places of {self.before!r}, but one is needed ({self.wrong})")
        return text.replace(self.before, self.after)

    def __str__(self) -> str:
        """Say which it is."""
        return f"{self.file}: {self.wrong}"


def kept() -> Iterator[Mistake]:
    """Yield every mistake of every table."""
    for path in sorted(FOLDER.glob("*.toml")):
        for entry in tomllib.loads(path.read_text(encoding="utf-8"))["mistakes"]:
            yield Mistake(kind=path.stem, **{**entry, "tests": tuple(entry["tests"])})
