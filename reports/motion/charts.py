"""Charts over a motion as pictures of sections."""

from collections.abc import Callable
from typing import Any

from alula.reports.sections.section import Picture


def chart(name: str, what: str, figure: Callable[[], Any], more: str = "") -> Picture:
    """Return a figure of matplotlib as a picture.

    Parameters
    ----------
    name : str
        Of its file, without ending.
    what : str
        What it shows, which is told below it as well.
    figure : callable
        Draws it.
    more : str, optional
        What is told below it besides.

    Returns
    -------
    Picture
    """

    def draw() -> Any:
        from alula.reports.figures.motion.motion_figures import DPI
        from alula.reports.figures.sheet.chart import Chart

        return Chart(figure(), dpi=DPI)

    return Picture(name=name, alt=what, caption=f"{what}.{f' {more}' if more else ''}", draw=draw)
