"""Output of ``alula envelope``: its files and what it prints."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from alula.fea.motion.envelope_result import EnvelopeResult
from alula.reports.motion.envelope import envelope_headline, envelope_page, envelope_record, envelope_sections
from alula.reports.page.output import MARK, write_folder
from alula.reports.renderers.console import print_sections, verdict_line
from alula.reports.renderers.folder import write_sections
from alula.reports.renderers.record import as_json as record_json
from alula.reports.words.terminal import say

if TYPE_CHECKING:
    from rich.console import Console

ENVELOPE = "envelope.html"


def write_envelope(
    result: EnvelopeResult, target: Path, *, progress: Callable[[str], None] = lambda message: None
) -> None:
    """Write ``envelope.html``, ``result.json``, ``envelope.csv`` and ``envelope.png``, VTU files and stress plots.

    VTU file and picture show the worst pose under the worst load case.

    Parameters
    ----------
    result : EnvelopeResult
    target : Path
        The output folder; the files go to its subfolder ``envelope``.
    progress : callable, optional
        Receives messages.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    from alula.reports.figures.motion.envelope_figures import stress_pictures
    from alula.reports.page.export import write_vtu
    from alula.reports.turnable.moving import LINKAGE, envelope_linkage
    from alula.reports.turnable.pack import data_block

    def fill(folder: Path) -> None:
        (folder / MARK).write_text(as_json(result) + "\n", encoding="utf-8")
        progress("Rendering the stress plots ...")
        plots, warnings = stress_pictures(result, result.links)
        for warning in warnings:
            progress(f"Warning: {warning}")
        (folder / "pictures").mkdir()
        for name, plot in plots.items():
            (folder / "pictures" / f"stress-{name}.png").write_bytes(plot.png())
        progress("Drawing the envelope ...")
        write_sections(
            envelope_page(result, envelope_sections(result)),
            folder,
            ENVELOPE,
            pictures={f"stress-{name}": plot for name, plot in plots.items()},
            models={LINKAGE: data_block(envelope_linkage(result))},
        )
        (folder / "vtu").mkdir()
        for name, link in result.links.items():
            write_vtu(folder / "vtu" / f"{name}.vtu", link.displacement, link.field)

    write_folder(target, "envelope", fill)


def as_json(result: EnvelopeResult) -> str:
    """Return the result as the text of ``result.json``.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    str
    """
    return record_json(envelope_record(result, envelope_sections(result)))


def print_envelope(result: EnvelopeResult, console: "Console") -> None:
    """Print the result of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    verdict_line(result.verdict, result.case.title, console)
    say(console, envelope_headline(result))
    print_sections(envelope_sections(result), console)
