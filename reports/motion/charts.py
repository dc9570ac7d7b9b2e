"""Charts over a motion as pictures of sections."""

from collections.abc import Callable
from typing import Any

from alula.reports.sections.section import Picture


def figures() -> Any:
    """Return the functions that draw a motion, with matplotlib, which is imported where a picture is drawn."""
    from alula.reports.figures.motion import motion_figures

    return motion_figures


def chart(name: str, what: str, figure: Callable[[], Any]) -> Picture:
    """Return a figure of matplotlib as a picture.

    Parameters
    ----------
    name : str
        Of its file, without ending.
    what : str
        What it shows, which is told below it as well.
    figure : callable
        Draws it.

    Returns
    -------
    Picture
    """

    def draw() -> Any:
        from alula.reports.figures.sheet.chart import Chart

        return Chart(figure(), dpi=figures().DPI)

    return Picture(name=name, alt=what, caption=f"{what}.", draw=draw)
