"""Output of ``alula motion``: its files and what it prints."""

from functools import partial
from pathlib import Path

from alula.fea.findings.of_motion import MotionFindings
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell, write
from alula.reports.motion.whole_motion import motion_page, motion_record, motion_sections
from alula.reports.renderers.folder import write_sections

MOTION, ANIMATION = "motion.html", "linkage.gif"


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
            motion_page(found, name, sections),
            folder,
            MOTION,
            pictures={LINKAGE: (folder / ANIMATION).read_bytes()},
            models={LINKAGE: data_block(motion_linkage(found.moved))},
        )

    tell(sections, json=json, record=record, title=found.moved.case.title)
    write("motion", output, record, fill, what="\nTables and figures", json=json)
