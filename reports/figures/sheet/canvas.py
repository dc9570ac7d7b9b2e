"""A sheet of lines, areas, pictures and text, which is asked for as PNG or as SVG.

Pillow draws it, at a tenth of matplotlib's processor time for the pictures of a report. Places are in points
(1/72 inch) from the upper left corner, x to the right, y down. What is drawn stays listed until it is asked for as PNG;
later lines and areas cover earlier ones, and text covers all.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.reports.figures.sheet.drawing import Plotted
from alula.reports.figures.sheet.letters import SHARES, SIZE, extent
from alula.reports.figures.sheet.marks import Area, Box, Mark, Raster, Stroke, Writing
from alula.reports.figures.sheet.style import INK
from alula.reports.figures.sheet.svg import as_svg

Real = NDArray[np.float64]


class Canvas:
    """A sheet.

    Attributes
    ----------
    width : float
        [points].
    height : float
        [points].
    marks : list of Stroke, Area or Raster
    texts : list of Writing
    plotted : list of Plotted
        Its curves, in the units of their axes.
    """

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        self.marks: list[Mark] = []
        self.texts: list[Writing] = []
        self.plotted: list[Plotted] = []

    def line(
        self, points: ArrayLike, colour: str, width: float = 1.0, dashes: tuple[float, float] | None = None
    ) -> None:
        """Draw a line through points.

        Parameters
        ----------
        points : array, shape (n, 2)
        colour : str
        width : float, optional
            [points].
        dashes : tuple of 2 float, optional
            Lengths of dash and gap [points]; by default the line is whole.
        """
        at = np.asarray(points, dtype=np.float64)
        self.marks.append(Stroke(points=at, colour=colour, width=width, dashes=dashes))

    def area(self, points: ArrayLike, colour: str, edge: str | None = None, width: float = 1.0) -> None:
        """Fill a polygon.

        Parameters
        ----------
        points : array, shape (n, 2)
        colour : str
        edge : str, optional
            Colour of a line about it.
        width : float, optional
            Of that line [points].
        """
        at = np.asarray(points, dtype=np.float64)
        self.marks.append(Area(points=at, colour=colour))
        if edge is not None:
            self.line(np.vstack([at, at[:2]]), edge, width)

    def ring(self, at: ArrayLike, radius: float, colour: str, width: float) -> None:
        """Draw a circle.

        Parameters
        ----------
        at : array, shape (2,)
            Its middle.
        radius : float
            [points].
        colour : str
        width : float
            Of the line [points].
        """
        points, circle = _circle(at, radius)
        self.marks.append(Stroke(points=points, colour=colour, width=width, dashes=None, circle=circle))

    def disc(self, at: ArrayLike, radius: float, colour: str, edge: str | None = None, width: float = 1.0) -> None:
        """Fill a circle.

        Parameters
        ----------
        at : array, shape (2,)
            Its middle.
        radius : float
            [points].
        colour : str
        edge : str, optional
            Colour of a line about it.
        width : float, optional
            Of that line [points].
        """
        points, circle = _circle(at, radius)
        self.marks.append(Area(points=points, colour=colour, circle=circle))
        if edge is not None:
            self.ring(at, radius, edge, width)

    def arrow(self, start: ArrayLike, end: ArrayLike, colour: str, width: float = 1.5) -> None:
        """Draw an arrow; a short one is all head.

        Parameters
        ----------
        start : array, shape (2,)
        end : array, shape (2,)
            Where its tip is.
        colour : str
        width : float, optional
            Of its shaft [points].
        """
        a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
        length = float(np.linalg.norm(b - a))
        if length == 0.0:
            return
        way = (b - a) / length
        neck, across = b - min(length, 4.6 * width) * way, 1.7 * width * np.array([-way[1], way[0]])
        self.line([a, neck], colour, width)
        self.area([b, neck + across, neck - across], colour)

    def picture(self, pixels: NDArray[Any], box: Box) -> None:
        """Put a picture into a box.

        Parameters
        ----------
        pixels : array, shape (h, w, 3) or (h, w, 4)
            From 0 to 255.
        box : tuple of 4 float
            Left, top, right, bottom [points].
        """
        self.marks.append(Raster(pixels=np.ascontiguousarray(pixels[..., :3], dtype=np.uint8), box=box))

    def write(
        self,
        text: str,
        at: ArrayLike,
        *,
        anchor: str = "center middle",
        colour: str = INK,
        size: float = SIZE,
        bold: bool = False,
        halo: float = 0.0,
        turned: bool = False,
    ) -> Writing:
        """Write a text of one or more lines.

        Parameters
        ----------
        text : str
        at : array, shape (2,)
            Where its anchor is.
        anchor : str, optional
            ``left``, ``center`` or ``right``, then ``top``, ``middle`` or ``bottom`` of its box.
        colour : str, optional
        size : float, optional
            Of its letters [points].
        bold : bool, optional
        halo : float, optional
            Width of the white rim of its letters [points].
        turned : bool, optional
            True for a text that runs upwards.

        Returns
        -------
        Writing
        """
        side, level = anchor.split()
        wide, tall = extent(text, size, bold=bold)
        if turned:
            wide, tall = tall, wide
        x, y = np.asarray(at, dtype=np.float64)
        left, top = x - wide * SHARES[side], y - tall * SHARES[level]
        box = (float(left), float(top), float(left + wide), float(top + tall))
        written = Writing(text=text, box=box, colour=colour, size=size, bold=bold, side=side, halo=halo, turned=turned)
        self.texts.append(written)
        return written

    def png(self) -> bytes:
        """Return the sheet as PNG, without a date, so that equal sheets are equal bytes.

        Returns
        -------
        bytes
        """
        from alula.reports.figures.sheet.pixels import as_pixels

        return as_pixels(self.width, self.height, self.marks, self.texts)

    def svg(self, alt: str = "") -> str:
        """Return the sheet as SVG, an element of a page.

        Parameters
        ----------
        alt : str, optional
            What it shows, for who does not see it.

        Returns
        -------
        str
        """
        return as_svg(self.width, self.height, self.marks, self.texts, alt)

    element = svg
    """Of a page."""


def faint(colour: str, share: float) -> str:
    """Return a colour mixed with white.

    Parameters
    ----------
    colour : str
        As ``#rrggbb``.
    share : float
        Of the colour in the mixture.

    Returns
    -------
    str
    """
    parts = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(255 + share * (part - 255)):02x}" for part in parts)


def _circle(at: ArrayLike, radius: float) -> tuple[Real, tuple[float, float, float]]:
    """Return points on a circle, and the circle."""
    turn = 2.0 * np.pi * np.arange(50) / 48  # beyond the whole, so that its ends meet
    x, y = np.asarray(at, dtype=np.float64)
    return np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)]), (float(x), float(y), float(radius))
