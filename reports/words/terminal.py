"""Paragraphs and tables on the terminal, broken at spaces alone: no name and no number is ever cut.

A word that is wider than the terminal stands whole on a line of its own. A table that does not fit, with its cells
broken at their spaces, is told row by row, one entry a line. Where standard output is no terminal, the rows of a table
are lines of a log: they are as wide as they need to be.
"""

import itertools
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.text import Text

KEPT = "\u00a0"
"""A space at which no line is broken, such as between a name and its number; printed as a space."""
_GAP = 2
_INDENT = 2


def say(console: "Console", text: "str | Text", *, style: str = "") -> None:
    """Print text whose lines break at spaces.

    Parameters
    ----------
    console : Console
    text : str | Text
    style : str, optional
        Of rich.
    """
    from rich.text import Text

    for line in _wrapped(Text(text, style=style) if isinstance(text, str) else text, console.width):
        _put(console, line)


def shortened(console: "Console", text: str, lines: int) -> str:
    """Return a text that takes no more than some lines, with an ellipsis in place of the words that it loses.

    Parameters
    ----------
    console : Console
    text : str
    lines : int
        At least one.

    Returns
    -------
    str
    """
    words = text.split(" ")
    while len(words) > 1 and height(console, text) > lines:
        words.pop()
        text = f"{' '.join(words).rstrip(' ,;:.')} ..."
    return text


def height(console: "Console", text: str) -> int:
    """Return how many lines ``say`` prints of a text.

    Parameters
    ----------
    console : Console
    text : str

    Returns
    -------
    int
    """
    from rich.text import Text

    return len(_wrapped(Text(text), console.width))


def say_command(console: "Console", text: str, command: str) -> None:
    """Print what a command is for, and below it the command on a line of its own, which a shell takes as it is copied.

    Parameters
    ----------
    console : Console
    text : str
    command : str
        It is never broken; what is wider than the terminal the terminal itself carries over.
    """
    from rich.text import Text

    say(console, text)
    _put(console, Text(f"{' ' * _INDENT}{command}"))


def say_table(
    console: "Console",
    columns: Sequence[tuple[str, bool]],
    rows: Sequence[Sequence["str | Text"]],
    *,
    title: str = "",
    whole: bool = False,
) -> None:
    """Print a table.

    Parameters
    ----------
    console : Console
    columns : sequence of tuple
        Title, and True for alignment to the right.
    rows : sequence of Sequence
        Cells.
    title : str, optional
        Printed above.
    whole : bool, optional
        True for rows that are as wide as they need to be on any terminal.
    """
    from rich.text import Text

    cells = [[Text(cell) if isinstance(cell, str) else cell for cell in row] for row in rows]
    heads = [Text(head) for head, _ in columns]
    room = console.width if console.is_terminal and not whole else None
    widths = _widths([heads, *cells], room)
    _put(console, Text())
    if title:
        say(console, title, style="italic")
    if widths is None:
        _told_row_by_row(console, [" ".join(head.split()) for head, _ in columns], cells)
        return
    right = [aligned for _, aligned in columns]
    for line in _lines(heads, widths, right, last=True):
        _put(console, line)
    _put(console, Text("─" * (sum(widths) + _GAP * (len(widths) - 1))))
    for row in cells:
        for line in _lines(row, widths, right, last=False):
            _put(console, line)
    _put(console, Text())


def _put(console: "Console", line: "Text") -> None:
    """Print one line as it is; what is wider than the terminal the terminal itself carries over."""
    line.plain = line.plain.replace(KEPT, " ")
    line.rstrip()
    console.print(line, soft_wrap=True)


def _wrapped(text: "Text", width: int) -> "list[Text]":
    """Return the lines of a text, none wider than ``width`` but for a word that is."""
    found: list[Text] = []
    for line in text.split("\n", allow_blank=True):
        found += line.divide(_breaks(line.plain, width))
    for line in found:
        line.rstrip()
    return found


def _breaks(line: str, width: int) -> list[int]:
    """Return where in a line further ones begin."""
    from rich.cells import cell_len

    found, start = [], 0
    for word in re.finditer(r" *[^ ]+ *", line):
        if word.start() > start and cell_len(line[start : word.end()].rstrip(" ")) > width:
            found.append(word.start())
            start = word.start()
    return found


def _widths(rows: Sequence[Sequence["Text"]], room: int | None) -> list[int] | None:
    """Return the columns' widths: those of their cells where there is room, else narrower; None where words do not fit.

    The widest column that has a space left to be broken at gives way first.
    """
    from rich.cells import cell_len

    def widest(texts: list[str]) -> int:
        return max((cell_len(text) for text in texts), default=0)

    columns = [[text.plain for text in column] for column in zip(*rows, strict=True)]
    widths = [widest([line for text in column for line in text.split("\n")]) for column in columns]
    least = [widest([word for text in column for word in re.split("[ \n]", text)]) for column in columns]
    gaps = _GAP * (len(widths) - 1)
    while room is not None and sum(widths) + gaps > room:
        free = [i for i in range(len(widths)) if widths[i] > least[i]]
        if not free:
            return None
        widths[max(free, key=lambda i: widths[i])] -= 1
    return widths


def _lines(row: Sequence["Text"], widths: list[int], right: list[bool], *, last: bool) -> "list[Text]":
    """Return the lines of one row; the shorter cells end at its last line where ``last``, else begin at the first."""
    from rich.text import Text

    cells = [_wrapped(cell, width) for cell, width in zip(row, widths, strict=True)]
    tall = max(map(len, cells))
    if last:
        cells = [[Text()] * (tall - len(cell)) + cell for cell in cells]
    found = []
    for parts in itertools.zip_longest(*cells, fillvalue=Text()):
        line = Text()
        for part, width, aligned in zip(parts, widths, right, strict=True):
            pad = " " * (width - part.cell_len)
            line.append(" " * _GAP if line.plain else "")
            line.append_text(Text.assemble(pad, part) if aligned else Text.assemble(part, pad))
        found.append(line)
    return found


def _told_row_by_row(console: "Console", heads: list[str], rows: Sequence[Sequence["Text"]]) -> None:
    from rich.text import Text

    for row in rows:
        for i, (head, cell) in enumerate(zip(heads, row, strict=True)):
            indent = " " * _INDENT if i else ""
            text = Text.assemble(f"{head}:{KEPT}", cell)
            for j, line in enumerate(_wrapped(text, console.width - _INDENT - len(indent))):
                _put(console, Text.assemble(indent + " " * (_INDENT if j else 0), line))
        _put(console, Text())
