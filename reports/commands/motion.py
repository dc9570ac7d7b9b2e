"""Output of ``alula motion``: its files and what it prints."""

import json as jsonlib
from pathlib import Path

from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.clearance import clearance
from alula.reports.motion.csv_tables import write_tables
from alula.reports.motion.lines import motion_lines
from alula.reports.motion.record import record


def write_motion(result: CaseMotion, folder: Path, name: str) -> None:
    """Write ``motion.html``, ``result.json``, the tables, the figures and the animation.

    Parameters
    ----------
    result : CaseMotion
    folder : Path
        An existing folder.
    name : str
        Of the case, as the command was given it.
    """
    from alula.reports.figures.motion.motion_animation import draw_animation
    from alula.reports.figures.motion.rate_figures import draw_figures
    from alula.reports.figures.outlines.contact import contact_drawing
    from alula.reports.page.motion_pages import MOTION, motion_page

    (folder / "result.json").write_text(jsonlib.dumps(record(result, name), indent=2) + "\n", encoding="utf-8")
    write_tables(result, folder)
    drawn = draw_figures(result, folder)
    apart = clearance(result.case)
    if apart is not None and apart.shown is not None:
        drawn.append(folder / "clearance.png")
        drawn[-1].write_bytes(contact_drawing(apart))
    draw_animation(result.motion, folder / "linkage.gif")
    pictures = {path.stem: path.read_bytes() for path in drawn}
    page = motion_page(result, pictures, (folder / "linkage.gif").read_bytes(), name=name)
    (folder / MOTION).write_text(page, encoding="utf-8")


def print_motion(result: CaseMotion, name: str, *, json: bool) -> None:
    """Print the result of a motion.

    Parameters
    ----------
    result : CaseMotion
    name : str
        Of the case, as the command was given it.
    json : bool
        True to print JSON.
    """
    data = record(result, name)
    print(jsonlib.dumps(data, indent=2) if json else "\n".join(motion_lines(result, data)))
