"""A sheet of lines, areas, pictures and text, and the sheet as PNG.

Pillow draws it, at a tenth of matplotlib's processor time for the pictures of a report. Places are in points
(1/72 inch) from the upper left corner, x to the right, y down. What is drawn stays listed until it is asked for as PNG;
later lines and areas cover earlier ones, and text covers all.
"""

import io
from functools import cache
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.reports.figures.sheet.marks import Area, Box, Raster, Stroke, Text
from alula.reports.figures.sheet.style import DPI, INK

Real = NDArray[np.float64]

SIZE = 9.0
"""Of letters [points]."""
_FINE = 2
"""Lines and areas are drawn this much larger and averaged, which makes their edges smooth."""
_SHARES = {"left": 0.0, "center": 0.5, "right": 1.0, "top": 0.0, "middle": 0.5, "bottom": 1.0}
_LINE, _RISE = 1.2, 0.77
"""Height from line to line of a text, and from its top to the base of its first line, in sizes of its letters."""


class Canvas:
    """A sheet.

    Attributes
    ----------
    width : float
        [points].
    height : float
        [points].
    marks : list of Stroke, Area or Raster
    texts : list of Text
    """

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        self.marks: list[Stroke | Area | Raster] = []
        self.texts: list[Text] = []

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
        self.line(_circle(at, radius), colour, width)

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
        self.area(_circle(at, radius), colour)
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
    ) -> Text:
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
        Text
        """
        side, level = anchor.split()
        wide, tall = extent(text, size, bold=bold)
        if turned:
            wide, tall = tall, wide
        x, y = np.asarray(at, dtype=np.float64)
        left, top = x - wide * _SHARES[side], y - tall * _SHARES[level]
        box = (float(left), float(top), float(left + wide), float(top + tall))
        written = Text(text=text, box=box, colour=colour, size=size, bold=bold, side=side, halo=halo, turned=turned)
        self.texts.append(written)
        return written

    def png(self) -> bytes:
        """Return the sheet as PNG, without a date, so that equal sheets are equal bytes.

        Returns
        -------
        bytes
        """
        from PIL import Image, ImageDraw

        wide, tall = (round(length * DPI / 72.0) for length in (self.width, self.height))
        fine = Image.new("RGB", (wide * _FINE, tall * _FINE), "white")
        draw = ImageDraw.Draw(fine)
        for mark in self.marks:
            _mark(fine, draw, mark)
        sheet = fine.reduce(_FINE)
        for text in self.texts:
            _write(sheet, text)
        stream = io.BytesIO()
        sheet.save(stream, format="PNG", dpi=(DPI, DPI))
        return stream.getvalue()


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


def extent(text: str, size: float = SIZE, *, bold: bool = False) -> tuple[float, float]:
    """Return width and height of a text.

    Parameters
    ----------
    text : str
    size : float, optional
        Of its letters [points].
    bold : bool, optional

    Returns
    -------
    tuple of 2 float
        [points].
    """
    lines = text.split("\n")
    pixels = max(_font(size, bold).getlength(line) for line in lines)
    return float(pixels) * 72.0 / DPI, size * (1.0 + _LINE * (len(lines) - 1))


@cache
def _font(size: float, bold: bool) -> Any:
    """Return a font that comes with matplotlib, which need not be imported for it."""
    from PIL import ImageFont

    home = find_spec("matplotlib")
    assert home is not None
    assert home.origin is not None
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    path = Path(home.origin).parent / "mpl-data" / "fonts" / "ttf" / name
    return ImageFont.truetype(str(path), size * DPI / 72.0, layout_engine=ImageFont.Layout.BASIC)


def _circle(at: ArrayLike, radius: float) -> Real:
    turn = 2.0 * np.pi * np.arange(50) / 48  # beyond the whole, so that its ends meet
    return np.asarray(at) + radius * np.column_stack([np.cos(turn), np.sin(turn)])


def _mark(image: Any, draw: Any, mark: Stroke | Area | Raster) -> None:
    scale = _FINE * DPI / 72.0
    if isinstance(mark, Raster):
        from PIL import Image

        # On whole pixels of the sheet, so that a picture of that size stays as it is.
        left, top, right, bottom = mark.box
        left, top, wide, tall = (round(length * DPI / 72.0) for length in (left, top, right - left, bottom - top))
        wide, tall = max(wide, 1), max(tall, 1)
        sized = Image.fromarray(mark.pixels).resize((wide, tall), Image.Resampling.LANCZOS)
        image.paste(sized.resize((_FINE * wide, _FINE * tall), Image.Resampling.NEAREST), (_FINE * left, _FINE * top))
        return
    at = mark.points * scale
    if isinstance(mark, Area):
        draw.polygon(at.ravel().tolist(), fill=mark.colour)
        return
    width = max(1, round(mark.width * scale))
    for piece in [at] if mark.dashes is None else _dashed(at, *(length * scale for length in mark.dashes)):
        draw.line(piece.ravel().tolist(), fill=mark.colour, width=width, joint="curve")


def _dashed(points: Real, dash: float, gap: float) -> list[Real]:
    """Return the dashes of the straight pieces of a line."""
    found: list[Real] = []
    for a, b in pairwise(points):
        length = float(np.linalg.norm(b - a))
        starts = np.arange(0.0, length, dash + gap)
        found += [a + np.outer([start, min(start + dash, length)], (b - a) / length) for start in starts]
    return found


def _write(sheet: Any, text: Text) -> None:
    from PIL import Image, ImageDraw

    scale, font = DPI / 72.0, _font(text.size, text.bold)
    left, top, right, bottom = (side * scale for side in text.box)
    along = _SHARES[text.side]
    rows = [(line, text.size * scale * (_RISE + _LINE * k)) for k, line in enumerate(text.text.split("\n"))]
    if text.turned:
        wide, tall = round(bottom - top), round(right - left)
        mask = Image.new("L", (wide, tall + round(0.3 * text.size * scale)))
        turned = ImageDraw.Draw(mask)
        for line, base in rows:
            turned.text((wide / 2.0, base), line, fill=255, font=font, anchor="ms")
        sheet.paste(text.colour, (round(left), round(top)), mask.transpose(Image.Transpose.ROTATE_90))
        return
    draw = ImageDraw.Draw(sheet)
    anchor = {"left": "ls", "center": "ms", "right": "rs"}[text.side]
    for rim in (True, False) if text.halo > 0.0 else (False,):
        for line, base in rows:
            more = {"stroke_width": text.halo * scale / 2.0, "fill": "white", "stroke_fill": "white"} if rim else {}
            draw.text((left + along * (right - left), top + base), line,
                      **({"fill": text.colour, "font": font, "anchor": anchor} | more))  # fmt: skip
