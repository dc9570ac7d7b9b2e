"""A sheet as PNG, drawn by Pillow at a tenth of matplotlib's processor time."""

import struct
import zlib
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.sheet.letters import font
from alula.reports.figures.sheet.marks import Area, Mark, Raster, Writing
from alula.reports.figures.sheet.style import DPI

Real = NDArray[np.float64]
_FINE = 2
"""Lines and areas are drawn this much larger and averaged, which makes their edges smooth."""
_ANCHORS = {"left": "ls", "center": "ms", "right": "rs"}


def as_pixels(width: float, height: float, marks: Iterable[Mark], texts: Iterable[Writing]) -> bytes:
    """Return a sheet as PNG, without a date, so that equal sheets are equal bytes.

    Parameters
    ----------
    width, height : float
        [points].
    marks : iterable of Stroke, Area or Raster
    texts : iterable of Writing

    Returns
    -------
    bytes
    """
    from PIL import Image, ImageDraw

    wide, tall = (round(length * DPI / 72.0) for length in (width, height))
    fine = Image.new("RGB", (wide * _FINE, tall * _FINE), "white")
    draw = ImageDraw.Draw(fine)
    for mark in marks:
        _mark(fine, draw, mark)
    sheet = fine.reduce(_FINE)
    for text in texts:
        _write(sheet, text)
    return _packed(np.asarray(sheet))


def _packed(pixels: NDArray[np.uint8]) -> bytes:
    """Return an image (h, w, 3) as PNG.

    Rows are stored as they are: of drawings, which are white for the most part, this takes fewer bytes than the filters
    that Pillow tries on every row, and a third of the time, during which other threads run.
    """
    tall, wide, _ = pixels.shape
    rows = np.zeros((tall, 3 * wide + 1), dtype=np.uint8)
    rows[:, 1:] = pixels.reshape(tall, -1)
    per_metre = round(DPI / 0.0254)
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", wide, tall, 8, 2, 0, 0, 0)),
        (b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1)),
        (b"IDAT", zlib.compress(rows.data, 5)),
        (b"IEND", b""),
    )
    found = [struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
             for kind, data in parts]  # fmt: skip
    return b"\x89PNG\r\n\x1a\n" + b"".join(found)


def _mark(image: Any, draw: Any, mark: Mark) -> None:
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


def _write(sheet: Any, text: Writing) -> None:
    from PIL import Image, ImageDraw

    scale, letters = DPI / 72.0, font(text.size, text.bold)
    left, top, right, bottom = (side * scale for side in text.box)
    if text.turned:
        wide, tall = round(bottom - top), round(right - left)
        mask = Image.new("L", (wide, tall + round(0.3 * text.size * scale)))
        turned = ImageDraw.Draw(mask)
        for line, (x, _), _ in text.lines():
            turned.text((wide / 2.0, x * scale - left), line, fill=255, font=letters, anchor="ms")
        sheet.paste(text.colour, (round(left), round(top)), mask.transpose(Image.Transpose.ROTATE_90))
        return
    draw = ImageDraw.Draw(sheet)
    for rim in (True, False) if text.halo > 0.0 else (False,):
        for line, (x, y), _ in text.lines():
            more = {"stroke_width": text.halo * scale / 2.0, "fill": "white", "stroke_fill": "white"} if rim else {}
            draw.text((x * scale, y * scale), line,
                      **({"fill": text.colour, "font": letters, "anchor": _ANCHORS[text.side]} | more))  # fmt: skip
