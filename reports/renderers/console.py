"""Sections on the terminal: paragraphs and tables; no pictures, no notes on how to read."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from alula.fea.common.verdict import Verdict
from alula.reports.sections.markup import as_plain
from alula.reports.sections.section import Beside, Cell, Command, Folded, Group, Items, Mark, Part, Section, Table, Text
from alula.reports.words.terminal import say, say_command, say_table

if TYPE_CHECKING:
    from rich.console import Console
    from rich.text import Text as Styled

VERDICT_COLOURS = {Verdict.PASS: "green", Verdict.FAIL: "red", Verdict.UNDECIDED: "yellow"}


def verdict_line(verdict: Verdict, title: str, console: "Console") -> None:
    """Print the verdict, in its colour, and the title of the case.

    Parameters
    ----------
    verdict : Verdict
    title : str
    console : rich.console.Console
    """
    from rich.text import Text as Styled

    badge = (f" {verdict.value.upper()} ", f"bold reverse {VERDICT_COLOURS[verdict]}")
    say(console, Styled.assemble(badge, f" {title}"))


def print_sections(sections: Iterable[Section], console: "Console") -> None:
    """Print sections.

    Parameters
    ----------
    sections : iterable of Section
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    for section in sections:
        if section.title and any(_told(part) for part in section.parts):
            say(console, "")
            say(console, section.title, style="bold")
            print_parts(section.parts, console)


def print_parts(parts: Iterable[Part], console: "Console") -> None:
    """Print parts of a section.

    Parameters
    ----------
    parts : Iterable[Part]
    console : Console
    """
    for part in parts:
        if isinstance(part, Text) and "note" not in part.kind:
            say(console, as_plain(part.text), style="yellow" if part.kind == "apart" else "")
        elif isinstance(part, Items) and "note" not in part.kind:
            style = "yellow" if part.kind == "warnings" else ""
            for item in part.items:
                say(console, as_plain(f"- {item}" if isinstance(item, str) else f"{item[0]}: {item[1]}"), style=style)
        elif isinstance(part, Table):
            print_table(part, console)
        elif isinstance(part, Command):
            say_command(console, part.text, part.command)
        elif isinstance(part, Beside) or (isinstance(part, Folded) and part.told):
            print_parts(part.parts, console)
        elif isinstance(part, Group) and any(map(_told, part.parts)):
            say(console, "")
            say(console, as_plain(f"{part.title} {part.remark}".rstrip()), style="italic")
            print_parts(part.parts, console)


def print_table(table: Table, console: "Console") -> None:
    """Print a table, and below it what it says of some of its rows.

    Parameters
    ----------
    table : Table
    console : Console
    """
    table = table.shown
    columns = [(as_plain(column.head), not column.text) for column in table.columns]
    say_table(
        console,
        columns,
        [[_styled(cell) for cell in row] for row in table.rows],
        title=as_plain(table.caption),
        whole=table.kind == "whole",
    )
    for text in dict.fromkeys(table.below.values()):
        say(console, as_plain(text))


def _styled(cell: Cell) -> "str | Styled":
    if not isinstance(cell, Mark) or not cell.kind:
        return as_plain(str(cell))
    from rich.text import Text as Styled

    return Styled(cell.text, style=VERDICT_COLOURS[Verdict(cell.kind)])


def _told(part: Part) -> bool:
    """Whether a console tells anything of a part."""
    if isinstance(part, Beside | Group) or (isinstance(part, Folded) and part.told):
        return any(map(_told, part.parts))
    return isinstance(part, Table | Command) or (isinstance(part, Text | Items) and "note" not in part.kind)
