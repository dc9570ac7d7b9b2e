"""What stands on a sheet: lines, areas, pictures and texts, with places and widths in points (1/72 inch)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.sheet.letters import LINE, RISE, SHARES, extent

Real = NDArray[np.float64]
Box = tuple[float, float, float, float]
"""Left, top, right, bottom [points]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Stroke:
    """A line through points.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        [points].
    colour : str
    width : float
        [points].
    dashes : tuple of 2 float or None
        Lengths of dash and gap [points]; None for a whole line.
    circle : tuple of 3 float or None
        x, y and radius of the circle that the points are on [points]; None for any other line.
    """

    points: Real
    colour: str
    width: float
    dashes: tuple[float, float] | None
    circle: tuple[float, float, float] | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Area:
    """A filled polygon.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        [points].
    colour : str
    circle : tuple of 3 float or None
        As of a line.
    """

    points: Real
    colour: str
    circle: tuple[float, float, float] | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Raster:
    """A picture.

    Attributes
    ----------
    pixels : ndarray, shape (h, w, 3)
        From 0 to 255.
    box : tuple of 4 float
        Left, top, right, bottom [points].
    """

    pixels: NDArray[np.uint8]
    box: Box


Mark = Stroke | Area | Raster


@dataclass(frozen=True, kw_only=True)
class Writing:
    """A text.

    Attributes
    ----------
    text : str
    box : tuple of 4 float
        Left, top, right, bottom [points].
    colour : str
    size : float
        Of its letters [points].
    bold : bool
    side : str
        ``left``, ``center`` or ``right``: how its lines stand in the box.
    halo : float
        Width of the white rim of its letters [points].
    turned : bool
        True for a text that runs upwards.
    """

    text: str
    box: Box
    colour: str
    size: float
    bold: bool
    side: str
    halo: float
    turned: bool

    def lines(self) -> list[tuple[str, tuple[float, float], float]]:
        """Return its lines, from the first.

        Returns
        -------
        list of tuple
            The line, where its anchor is on its base, and its width [points]; the anchor of a text that runs upwards
            is its middle.
        """
        left, top, right, bottom = self.box
        found = []
        for k, line in enumerate(self.text.split("\n")):
            base = self.size * (RISE + LINE * k)
            at = (left + base, (top + bottom) / 2.0) if self.turned else (
                left + SHARES[self.side] * (right - left), top + base)  # fmt: skip
            found.append((line, at, extent(line, self.size, bold=self.bold)[0]))
        return found
