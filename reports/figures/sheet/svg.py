"""A sheet as SVG: an element of a page, with presentation attributes alone, which a page's policy allows."""

import base64
import io
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.sheet.marks import Area, Mark, Raster, Stroke, Text
from alula.reports.figures.sheet.style import INK

Real = NDArray[np.float64]
_FONTS = "DejaVu Sans,Verdana,sans-serif"
"""Verdana is as wide as DejaVu Sans; whatever letters a reader has, they are set to the width that is reckoned with."""
_ANCHORS = {"left": "", "center": ' text-anchor="middle"', "right": ' text-anchor="end"'}
_PIXELS = 96.0 / 72.0
"""Of CSS for a point."""


def as_svg(width: float, height: float, marks: Sequence[Mark], texts: Iterable[Text], alt: str) -> str:
    """Return a sheet as SVG.

    Coordinates are whole hundredths of a point. Neighbouring marks of one colour share their paths, since it does not
    show which of them covers which.

    Parameters
    ----------
    width, height : float
        [points].
    marks : sequence of Stroke, Area or Raster
    texts : iterable of Text
    alt : str
        What the picture is, for who does not see it.

    Returns
    -------
    str
    """
    sides = (
        f'viewBox="0 0 {_told(width)} {_told(height)}" width="{width * _PIXELS:.0f}" height="{height * _PIXELS:.0f}"'
    )
    named = f' aria-label="{escape(alt)}"' if alt else ""
    body = "".join(_painted(marks))
    letters = "".join(f"<g{style}>{''.join(map(_lines, group))}</g>" for style, group in groupby(texts, key=_style))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {sides} role="img"{named}>'
        f'<path fill="#fff" d="M0 0h{_told(width)}v{_told(height)}h-{_told(width)}z"/>'
        f'<g fill="none" stroke-linejoin="round">{body}</g>'
        f'<g font-family="{_FONTS}" fill="{INK}">{letters}</g></svg>'
    )


def _told(value: float) -> str:
    """Return a length in hundredths, without zeros that say nothing."""
    return _hundredths(round(100.0 * value))


def _hundredths(value: int) -> str:
    whole, part = divmod(abs(value), 100)
    sign = "-" if value < 0 else ""
    if not part:
        return f"{sign}{whole}"
    return f"{sign}{whole or ''}.{part:02d}".rstrip("0")


def _painted(marks: Sequence[Mark]) -> Iterator[str]:
    for colour, run in groupby(marks, key=lambda mark: "" if isinstance(mark, Raster) else mark.colour):
        group = list(run)
        if not colour:
            yield from (_image(mark) for mark in group if isinstance(mark, Raster))
            continue
        if areas := [mark for mark in group if isinstance(mark, Area)]:
            yield f'<path fill="{colour}" d="{"".join(_closed(area) for area in areas)}"/>'
        strokes: dict[tuple[float, tuple[float, float] | None], list[Stroke]] = {}
        for mark in group:
            if isinstance(mark, Stroke):
                strokes.setdefault((mark.width, mark.dashes), []).append(mark)
        for (width, dashes), lines in strokes.items():
            dashed = f' stroke-dasharray="{_told(dashes[0])} {_told(dashes[1])}"' if dashes else ""
            path = "".join(_round(*line.circle) if line.circle else _open(line.points) for line in lines)
            yield f'<path stroke="{colour}" stroke-width="{_told(width)}"{dashed} d="{path}"/>'


def _closed(area: Area) -> str:
    """Return a polygon, the same way round as all others, so that two that overlap do not leave a hole."""
    if area.circle:
        return _round(*area.circle)
    x, y = area.points.T
    turns = float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
    return _open(area.points if turns >= 0.0 else area.points[::-1], closed=True)


def _round(x: float, y: float, radius: float) -> str:
    r, wide = _told(radius), _hundredths(2 * round(100.0 * radius))
    return f"M{_told(x - radius)} {_told(y)}a{r} {r} 0 1 1 {wide} 0a{r} {r} 0 1 1 -{wide} 0z"


def _open(points: Real, *, closed: bool = False) -> str:
    """Return a path: its first point, then steps from each point to the next, without those of no length."""
    if not len(points):
        return ""
    at = np.round(100.0 * points).astype(np.int64)
    steps = np.diff(at, axis=0)
    steps = steps[steps.any(axis=1)]
    if closed and len(at) > 1 and not steps.sum(axis=0).any():
        steps = steps[:-1]
    parts = ["M", _hundredths(int(at[0, 0])), " ", _hundredths(int(at[0, 1]))]
    before = ""
    for dx, dy in steps.tolist():
        if dy == 0 or dx == 0:
            now, told = ("h", _hundredths(dx)) if dy == 0 else ("v", _hundredths(dy))
        else:
            now, down = "l", _hundredths(dy)
            told = f"{_hundredths(dx)}{'' if down[0] == '-' else ' '}{down}"
        parts.append(now if now != before else "" if told[0] == "-" else " ")
        parts.append(told)
        before = now
    return "".join(parts) + ("z" if closed else "")


def _image(raster: Raster) -> str:
    from PIL import Image

    left, top, right, bottom = raster.box
    stream = io.BytesIO()
    Image.fromarray(raster.pixels).save(stream, "WEBP", lossless=True, quality=60)
    data = base64.b64encode(stream.getvalue()).decode("ascii")
    return (
        f'<image x="{_told(left)}" y="{_told(top)}" width="{_told(right - left)}" height="{_told(bottom - top)}" '
        f'preserveAspectRatio="none" href="data:image/webp;base64,{data}"/>'
    )


def _style(text: Text) -> str:
    """Return what neighbouring texts may share."""
    style = f' font-size="{_told(text.size)}"'
    style += "" if text.colour == INK else f' fill="{text.colour}"'
    style += ' font-weight="bold"' if text.bold else ""
    if text.halo > 0.0:
        style += f' stroke="#fff" stroke-width="{_told(text.halo)}" stroke-linejoin="round" paint-order="stroke"'
    return style + _ANCHORS["center" if text.turned else text.side]


def _lines(text: Text) -> str:
    """Return the lines of a text, each set to the width that it has on the sheet."""
    found = []
    for line, (x, y), wide in text.lines():
        turn = f' transform="rotate(-90 {_told(x)} {_told(y)})"' if text.turned else ""
        fit = f' textLength="{_told(wide)}" lengthAdjust="spacingAndGlyphs"' if len(line) > 1 else ""
        found.append(f'<text x="{_told(x)}" y="{_told(y)}"{turn}{fit}>{escape(line, quote=False)}</text>')
    return "".join(found)
