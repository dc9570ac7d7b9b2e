"""How a command shows what it found: sections on the terminal, or their record on standard output."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from alula.reports.sections.section import Section


def tell(sections: "Sequence[Section]", *, json: bool = False) -> None:
    """Print sections; before any folder is written, so that a full disk does not hide the verdict.

    Parameters
    ----------
    sections : sequence of Section
    json : bool, optional
        True to print their record.
    """
    if json:
        print(json_of(sections), flush=True)
        return
    from rich.console import Console

    from alula.reports.renderers.console import print_sections

    print_sections(sections, Console())


def json_of(sections: "Iterable[Section]") -> str:
    """Return the entries of sections, of a result that states its units itself, as JSON.

    Parameters
    ----------
    sections : Iterable[Section]

    Returns
    -------
    str
    """
    from alula.geometry.base.version import result_stamp
    from alula.reports.renderers.record import as_json, finite
    from alula.reports.sections.section import merged

    return as_json(finite(result_stamp() | merged(section.data for section in sections), {}))


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
