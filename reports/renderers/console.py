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


def print_sections(sections: Iterable[Section], console: "Console", *, said: Iterable[str] = ()) -> None:
    """Print sections.

    Parameters
    ----------
    sections : iterable of Section
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    said : iterable of str, optional
        Paragraphs that were told before; reasons in them are not told again.
    """
    said = list(said)
    for section in sections:
        if section.title and any(_told(part) for part in section.parts):
            say(console, "")
            say(console, section.title, style="bold")
            print_parts(section.parts, console, said)


def print_parts(parts: Iterable[Part], console: "Console", said: list[str]) -> None:
    """Print parts of a section; a table of which another of them has every row is left out.

    Parameters
    ----------
    parts : Iterable[Part]
    console : Console
    said : list of str
        Paragraphs that were told before, and will be here: no table tells them again below its rows.
    """
    parts = tuple(parts)
    whole = [one for part in parts if isinstance(part, Folded) and part.told for one in part.parts]
    for part in parts:
        if isinstance(part, Table) and any(_holds(one, part) for one in whole):
            continue
        if isinstance(part, Text) and "note" not in part.kind:
            said.append(as_plain(part.text))
            say(console, said[-1], style="yellow" if part.kind == "apart" else "")
        elif isinstance(part, Items) and "note" not in part.kind:
            style = "yellow" if part.kind == "warnings" else ""
            for item in part.items:
                title, text = ("-", item) if isinstance(item, str) else (f"{item[0]}:", item[1])
                again = not isinstance(item, str) and _said(as_plain(text), said)
                said.append(as_plain(f"{title} {'as told above.' if again else text}"))
                say(console, said[-1], style=style)
        elif isinstance(part, Table):
            print_table(part, console, said)
        elif isinstance(part, Command):
            say_command(console, part.text, part.command)
        elif isinstance(part, Beside) or (isinstance(part, Folded) and part.told):
            print_parts(part.parts, console, said)
        elif isinstance(part, Group) and any(map(_told, part.parts)):
            say(console, "")
            say(console, as_plain(f"{part.title} {part.remark}".rstrip()), style="italic")
            print_parts(part.parts, console, said)


def _holds(whole: Part, table: Table) -> bool:
    """Whether a part is a table that has all rows of another one."""
    return isinstance(whole, Table) and whole.columns == table.columns and all(row in whole.rows for row in table.rows)


def print_table(table: Table, console: "Console", said: list[str] | None = None) -> None:
    """Print a table, and below it what it says of some of its rows.

    Parameters
    ----------
    table : Table
    console : Console
    said : list of str, optional
        What was told before, and will be here: it is not told again.
    """
    full, below, table = table, table.below, table.shown
    columns = [(as_plain(column.head), not column.text) for column in table.columns]
    say_table(
        console,
        columns,
        [[_styled(cell) for cell in row] for row in table.rows],
        title=as_plain(table.caption),
        whole=table.kind == "whole",
    )
    said = [] if said is None else said
    for row, text in below.items():
        if not _said(as_plain(text), said):
            said.append(as_plain(f"{_name(full, row)}{text}"))
            say(console, said[-1])


def _name(table: Table, row: int) -> str:
    """Return what a paragraph below a table begins with: the name of the check that it is about, and of its link."""
    cells = zip(table.columns, map(str, table.rows[row]), strict=True)
    names = [cell for column, cell in cells if column.role == "who" or (column.head, column.hidden) == ("check", True)]
    return f"{', '.join(names)}: " if names and table.kind == "checks" else ""


def _said(text: str, said: Iterable[str]) -> bool:
    """Whether a text was told before, with or without a capital."""
    return any(text[1:] in one for one in said)


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
