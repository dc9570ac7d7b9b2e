"""What commands have in common: how they begin, show what they found, and put it into a folder."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from alula.loads.case.case import Case
    from alula.reports.sections.section import Section


@contextmanager
def begun(
    command: str,
    case: str,
    overrides: Sequence[str] | None,
    output: Path | None,
    *,
    threads: int,
    memory: str | None = None,
    names: "Callable[[Case], Iterable[str]] | None" = None,
) -> "Iterator[Case]":
    """Read the case of a command, whose threads and memory are limited, and refuse a folder that cannot be written.

    Parameters
    ----------
    command : str
        Its name.
    case : str
        As the command was given it.
    overrides : sequence of str or None
        Other values for its entries.
    output : Path or None
        The folder that the user named, if any.
    threads : int
        Threads per library, and child processes at a time.
    memory : str, optional
        Memory of this process with its unit.
    names : callable, optional
        Returns the files that the command will write of a case.

    Yields
    ------
    Case

    Raises
    ------
    CaseError, CannotRunError
        As ``read_case``, ``limited`` and ``refuse_unusable``.
    """
    from alula.loads.case.case_file import read_case
    from alula.reports.page.output import MARK, refuse_unusable
    from alula.reports.words.limits import limited

    with limited(threads, memory):
        parsed = read_case(case, overrides or ())
        refuse_unusable(output, command, (MARK,) if names is None else names(parsed))
        yield parsed


def tell(
    sections: "Sequence[Section]",
    *,
    json: bool = False,
    record: Callable[[], Mapping[str, Any]] | None = None,
    title: str = "",
    show: "Callable[[Sequence[Section], Console], None] | None" = None,
) -> None:
    """Print sections; before any folder is written, so that a full disk does not hide the verdict.

    Parameters
    ----------
    sections : sequence of Section
    json : bool, optional
        True to print their record.
    record : callable, optional
        Returns it; without it, the entries of the sections.
    title : str, optional
        Printed above them.
    show : callable, optional
        Prints them in another way.
    """
    from alula.reports.renderers.record import as_brief_record, as_json

    if json:
        print(as_json(as_brief_record(sections) if record is None else record()), flush=True)
        return
    from rich.console import Console

    from alula.reports.renderers.console import print_sections
    from alula.reports.words.terminal import say

    console = Console()
    if title:
        say(console, title)
    (show or print_sections)(sections, console)


def write(
    command: str,
    output: Path | None,
    record: Callable[[], Mapping[str, Any]],
    fill: Callable[[Path], object],
    *,
    what: str,
    json: bool = False,
) -> None:
    """Write ``result.json`` and more into the folder of a command, where one is named, and say where it is.

    Parameters
    ----------
    command : str
        Its name.
    output : Path or None
        The folder that the user named, if any.
    record : callable
        Returns what ``result.json`` holds.
    fill : callable
        Writes the other files into the folder that it is given.
    what : str
        What was written.
    json : bool, optional
        True where standard output is JSON, so that nothing is said there.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    from alula.reports.page.output import MARK, write_folder
    from alula.reports.renderers.record import as_json

    if output is None:
        return

    def every(folder: Path) -> None:
        (folder / MARK).write_text(as_json(record()) + "\n", encoding="utf-8")
        fill(folder)

    write_folder(output, command, every)
    if not json:
        print(f"{what}: {output / command}")


def text_of(sections: "Iterable[Section]", width: int = 120) -> str:
    """Return sections as a terminal shows them.

    Parameters
    ----------
    sections : iterable of Section
    width : int, optional
        Of the terminal.

    Returns
    -------
    str
    """
    import io

    from rich.console import Console

    from alula.reports.renderers.console import print_sections

    stream = io.StringIO()
    print_sections(sections, Console(file=stream, width=width))
    return stream.getvalue().strip()
