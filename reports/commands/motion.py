"""Output of ``alula motion``: its files and what it prints."""

from pathlib import Path

from alula.fea.findings.of_motion import MotionFindings
from alula.reports.motion.whole_motion import motion_page, motion_record, motion_sections
from alula.reports.renderers.console import print_sections
from alula.reports.renderers.folder import write_sections
from alula.reports.renderers.record import as_json
from alula.reports.words.terminal import say

MOTION, ANIMATION = "motion.html", "linkage.gif"


def write_motion(found: MotionFindings, folder: Path, name: str) -> None:
    """Write ``motion.html``, ``result.json``, the tables, the figures and the animation.

    Parameters
    ----------
    found : MotionFindings
    folder : Path
        An existing folder.
    name : str
        Of the case, as the command was given it.
    """
    from alula.reports.figures.motion.motion_animation import draw_animation
    from alula.reports.turnable.moving import LINKAGE, motion_linkage
    from alula.reports.turnable.pack import data_block

    sections = motion_sections(found)
    (folder / "result.json").write_text(as_json(motion_record(found, name, sections)) + "\n", encoding="utf-8")
    draw_animation(found.moved.motion, folder / ANIMATION)
    write_sections(
        motion_page(found, name, sections),
        folder,
        MOTION,
        pictures={LINKAGE: (folder / ANIMATION).read_bytes()},
        models={LINKAGE: data_block(motion_linkage(found.moved))},
    )


def print_motion(found: MotionFindings, name: str, *, json: bool) -> None:
    """Print the result of a motion.

    Parameters
    ----------
    found : MotionFindings
    name : str
        Of the case, as the command was given it.
    json : bool
        True to print JSON.
    """
    sections = motion_sections(found)
    if json:
        print(as_json(motion_record(found, name, sections)))
        return
    from rich.console import Console

    console = Console()
    say(console, found.moved.case.title)
    print_sections(sections, console)
