"""Options that several commands have in common."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

CaseArgument = Annotated[str, typer.Argument(help="Path to a case file, or the name of a built-in case.")]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="<entry=value>",
        help='Override an entry of the case, such as --set parts.tube.outer_diameter="6 mm".',
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the result as JSON instead of a table.")]
ThreadsOption = Annotated[
    int, typer.Option(metavar="<number>", min=1, max=256, help="Threads per library, and child processes at a time.")
]
VariantsOption = Annotated[
    int | None,
    typer.Option(
        metavar="<number>",
        min=1,
        max=256,
        help="Variants at a time, each computed by a process of one thread; default: one a core.",
    ),
]
WorkersOption = Annotated[int | None, typer.Option(metavar="<number>", min=1, max=256, hidden=True)]
"""What ``VariantsOption`` was called; it warns, and goes with the version after 0.2."""
VaryOption = Annotated[
    list[str] | None,
    typer.Option(
        metavar="<entry=values>",
        help='An entry and its values: parts.bar.thickness="2 mm..8 mm/7", "2 mm..8 mm by 1 mm", "2 mm, 3 mm".',
    ),
]
LinkOption = Annotated[
    list[str] | None,
    typer.Option(
        metavar="<entry=formula>",
        help='An entry that follows: parts.tube.eye_thickness="outer_diameter + 2*fillet_radius".',
    ),
]
AccuracyOption = Annotated[
    str | None, typer.Option(metavar="<percent>", help='Discretisation error of solids, such as "5 %".')
]
MemoryOption = Annotated[
    str | None,
    typer.Option(metavar="<memory>", help='Memory limit, such as "4 GB"; default: the free memory of the system.'),
]


def folder_option(text: str, *names: str) -> Any:
    """Return the option that names a folder to write into; an empty name is refused, which would mean the current one.

    Parameters
    ----------
    text : str
        Its help.
    *names : str
        Of the option; ``-o`` and ``--output`` unless given.

    Returns
    -------
    object
        As ``typer.Option`` returns it.
    """
    return typer.Option(*(names or ("-o", "--output")), help=text, parser=_folder, metavar="<path>")


def _folder(text: str | Path) -> Path:
    from alula.reports.page.output import folder_named

    return folder_named(text)


def refuse_closed(folder: Path) -> None:
    """Refuse a folder that the system does not let anyone look into; one that is missing is another's to refuse.

    Parameters
    ----------
    folder : Path
        That is read.

    Raises
    ------
    CaseError
        For a folder that may not be entered, or below one, and for a name that cannot be one.
    """
    from alula.geometry.base.errors import CaseError
    from alula.loads.text.explain import printable

    try:
        os.stat(os.path.join(folder, "."))
    except (FileNotFoundError, NotADirectoryError):
        pass
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise CaseError(
            f"'{printable(str(folder))}' cannot be looked into ({why}); check its permissions or name another folder"
        ) from None


def at_a_time(threads: int | None, workers: int | None) -> int | None:
    """Return how many variants are computed at a time, with a warning where the old name of the option says so.

    Parameters
    ----------
    threads, workers : int, optional
        Of the options.

    Returns
    -------
    int or None

    Raises
    ------
    CaseError
        Where both are given.
    """
    from alula.geometry.base.errors import CaseError
    from alula.reports.commands.ending import progress

    if workers is None:
        return threads
    if threads is not None:
        raise CaseError("--workers: it is the old name of --threads, which is given too; leave --workers out")
    progress("Warning: --workers is called --threads now; the old name goes with the next version.")
    return workers


def stated(options: Sequence[str] | None, name: str) -> dict[str, str]:
    """Read options of the form ``entry=text``.

    Parameters
    ----------
    options : sequence of str or None
    name : str
        Of the option, for messages.

    Returns
    -------
    dict of str to str

    Raises
    ------
    CaseError
        For text of another form, and an entry that is stated twice.
    """
    from alula.geometry.base.errors import CaseError
    from alula.loads.text.explain import printable

    found: dict[str, str] = {}
    for option in options or ():
        path, sign, text = option.partition("=")
        path, text = path.strip(), text.strip().strip('"')
        if not (sign and path and text):
            raise CaseError(f"{name} '{printable(option)}': write it as entry=..., for example parts.bar.thickness=...")
        if path in found:
            raise CaseError(f"{name} '{printable(path)}': the entry is stated twice; state it once")
        found[path] = text
    return found
