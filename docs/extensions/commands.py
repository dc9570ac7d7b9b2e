"""The page on the command line, from the commands themselves."""

from collections.abc import Iterator
from typing import Any

import typer

from alula.reports.commands.cli import app


def page() -> str:
    """Return the page.

    Returns
    -------
    str
        Markdown: a section for every command, with a table of its arguments and options.
    """
    group = typer.main.get_command(app)
    context = group.make_context("alula", ["cases"], resilient_parsing=True)
    head = f"# The command line\n\n{group.help}\n\n{_options(group, context)}"
    return "\n\n".join([head, *_commands(group, context, "alula")]) + "\n"


def _commands(group: Any, context: Any, path: str) -> Iterator[str]:
    """Yield the section of every command of a group; a hidden one is what the group itself does."""
    for name, command in sorted(group.commands.items(), key=lambda item: not item[1].hidden):
        inner = type(context)(command, info_name=name, parent=context)
        full = path if command.hidden else f"{path} {name}"
        if hasattr(command, "commands"):
            yield from _commands(command, inner, full)
            continue
        arguments = [parameter for parameter in command.params if parameter.param_type_name == "argument"]
        usage = " ".join([full, *(_name(parameter) for parameter in arguments), "[OPTIONS]"])
        yield f"## {full}\n\n{command.help}\n\n```text\n{usage}\n```\n\n{_options(command, inner)}"


def _name(argument: Any) -> str:
    return argument.name.upper() if argument.required else f"[{argument.name.upper()}]"


def _options(command: Any, context: Any) -> str:
    """Return the table of arguments and options, in the words of ``--help``."""
    rows = ["| | |\n|---|---|"]
    for parameter in command.params:
        record = parameter.get_help_record(context)
        if record is not None:
            names = _name(parameter) if parameter.param_type_name == "argument" else record[0]
            text = record[1].replace("|", r"\|").replace("<", r"\<").replace("*", r"\*").replace("  [", r" \[")
            rows.append(f"| `{names}` | {text} |")
    return "\n".join(rows)
