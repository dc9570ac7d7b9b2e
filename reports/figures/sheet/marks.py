"""What stands on a sheet: lines, areas, pictures and texts, with places and widths in points (1/72 inch)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    """

    points: Real
    colour: str
    width: float
    dashes: tuple[float, float] | None


@dataclass(frozen=True, kw_only=True, eq=False)
class Area:
    """A filled polygon.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        [points].
    colour : str
    """

    points: Real
    colour: str


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


@dataclass(frozen=True, kw_only=True)
class Text:
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
