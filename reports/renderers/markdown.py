"""Tables of sections as Markdown."""

from alula.reports.sections.markup import as_plain
from alula.reports.sections.section import Table


def table_lines(table: Table) -> list[str]:
    """Return a table as lines of Markdown, numbers at the right.

    Parameters
    ----------
    table : Table

    Returns
    -------
    list of str
    """
    columns = table.shown.columns
    rule = "|".join("---" if column.text else "--:" for column in columns)
    rows = [[column.head for column in columns], *(map(str, row) for row in table.shown.rows)]
    head, *lines = [f"| {' | '.join(map(cell, row))} |" for row in rows]
    return [head.replace("|  |", "| |"), f"|{rule}|", *lines]


def cell(text: str) -> str:
    """Return a text as it stands in a table or a heading of Markdown.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    plain = " ".join(as_plain(text).split()).replace("&", "&amp;").replace("<", "&lt;")
    return plain.replace("|", "\\|").replace("*", "\\*")
