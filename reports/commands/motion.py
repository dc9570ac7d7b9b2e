"""Output of ``alula motion`` and ``alula envelope``: their files and what they print."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from rich.console import Console

from alula.fea.findings.of_motion import MotionFindings
from alula.fea.motion.envelope_result import EnvelopeResult
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell, write
from alula.reports.motion.envelope import envelope_headline, envelope_page, envelope_record, envelope_sections
from alula.reports.motion.whole_motion import motion_page, motion_record, motion_sections
from alula.reports.renderers.console import print_sections, verdict_line
from alula.reports.renderers.folder import write_sections
from alula.reports.sections.section import Section
from alula.reports.words.terminal import say

MOTION, ANIMATION = "motion.html", "linkage.gif"
ENVELOPE = "envelope.html"


def tell_motion(found: MotionFindings, name: str, output: Path | None = None, *, json: bool = False) -> None:
    """Print a motion, and write ``motion.html``, ``result.json``, the tables, the figures and the animation.

    Parameters
    ----------
    found : MotionFindings
    name : str
        Of the case, as the command was given it.
    output : Path, optional
        The output folder; the files go to its subfolder ``motion``.
    json : bool, optional
        True to print JSON.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    sections = motion_sections(found)
    record = partial(motion_record, found, name, sections)

    def fill(folder: Path) -> None:
        from alula.reports.figures.motion.motion_animation import draw_animation
        from alula.reports.turnable.moving import LINKAGE, motion_linkage
        from alula.reports.turnable.pack import data_block

        progress("Drawing figures and the animation ...")
        draw_animation(found.moved.motion, folder / ANIMATION)
        write_sections(
            motion_page(found, sections),
            folder,
            MOTION,
            pictures={LINKAGE: (folder / ANIMATION).read_bytes()},
            models={LINKAGE: data_block(motion_linkage(found.moved))},
        )

    tell(sections, json=json, record=record, title=found.moved.case.title)
    write("motion", output, record, fill, what="\nTables and figures", json=json)


def tell_envelope(result: EnvelopeResult, output: Path | None = None, *, json: bool = False) -> None:
    """Print an envelope, and write ``envelope.html``, ``result.json``, curves, VTU files and stress plots.

    VTU file and picture show the worst pose under the worst load case.

    Parameters
    ----------
    result : EnvelopeResult
    output : Path, optional
        The output folder; the files go to its subfolder ``envelope``.
    json : bool, optional
        True to print JSON.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    sections = envelope_sections(result)
    record = partial(envelope_record, result, sections)

    def show(sections: Sequence[Section], console: Console) -> None:
        verdict_line(result.verdict, result.case.title, console)
        for line in envelope_headline(result):
            say(console, line)
        print_sections(sections, console)

    def fill(folder: Path) -> None:
        from alula.reports.figures.motion.envelope_figures import stress_pictures
        from alula.reports.page.export import write_vtu
        from alula.reports.turnable.moving import LINKAGE, envelope_linkage
        from alula.reports.turnable.pack import data_block

        progress("Rendering the stress plots ...")
        plots, warnings = stress_pictures(result, result.links)
        for warning in warnings:
            progress(f"Warning: {warning}")
        (folder / "pictures").mkdir()
        for name, plot in plots.items():
            (folder / "pictures" / f"stress-{name}.png").write_bytes(plot.png())
        progress("Drawing the envelope ...")
        write_sections(
            envelope_page(result, sections),
            folder,
            ENVELOPE,
            pictures={f"stress-{name}": plot for name, plot in plots.items()},
            models={LINKAGE: data_block(envelope_linkage(result))},
        )
        (folder / "vtu").mkdir()
        for name, link in result.links.items():
            write_vtu(folder / "vtu" / f"{name}.vtu", link.displacement, link.field)

    tell(sections, json=json, record=record, show=show)
    write("envelope", output, record, fill, what="Curves, pictures and fields", json=json)
