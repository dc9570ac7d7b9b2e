"""Output of ``alula motion``: its files and what it prints."""

import json as jsonlib
from pathlib import Path

from alula.fea.findings.of_motion import MotionFindings
from alula.reports.motion.csv_tables import write_tables
from alula.reports.motion.lines import motion_lines
from alula.reports.motion.record import record


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
    from alula.reports.figures.motion.rate_figures import motion_pictures
    from alula.reports.figures.outlines.contact import contact_drawing
    from alula.reports.figures.sheet.drawing import Drawing
    from alula.reports.page.motion_pages import MOTION, motion_page

    (folder / "result.json").write_text(jsonlib.dumps(record(found, name), indent=2) + "\n", encoding="utf-8")
    write_tables(found, folder)
    pictures: dict[str, Drawing] = dict(motion_pictures(found))
    apart = found.clearance
    if apart is not None and apart.shown is not None:
        pictures["clearance"] = contact_drawing(apart)
    for title, picture in pictures.items():
        (folder / f"{title}.png").write_bytes(picture.png())
    draw_animation(found.moved.motion, folder / "linkage.gif")
    page = motion_page(found.moved, pictures, (folder / "linkage.gif").read_bytes(), name=name)
    (folder / MOTION).write_text(page, encoding="utf-8")


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
    data = record(found, name)
    print(jsonlib.dumps(data, indent=2) if json else "\n".join(motion_lines(found, data)))
