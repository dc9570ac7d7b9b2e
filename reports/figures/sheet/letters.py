"""The letters of texts on a sheet: their font, and how wide and tall they are."""

from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from alula.reports.figures.sheet.style import DPI

SIZE = 9.0
"""Of letters [points]."""
SHARES = {"left": 0.0, "center": 0.5, "right": 1.0, "top": 0.0, "middle": 0.5, "bottom": 1.0}
"""Where an anchor is, as a share of its box."""
LINE, RISE = 1.2, 0.77
"""Height from line to line of a text, and from its top to the base of its first line, in sizes of its letters."""


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
    return max(_wide(line, size, bold) for line in lines), size * (1.0 + LINE * (len(lines) - 1))


@cache
def _wide(line: str, size: float, bold: bool) -> float:
    return float(font(size, bold).getlength(line)) * 72.0 / DPI


@cache
def font(size: float, bold: bool) -> Any:
    """Return a font that comes with matplotlib, which need not be imported for it.

    Parameters
    ----------
    size : float
        [points].
    bold : bool

    Returns
    -------
    object
        Of Pillow, for ``DPI``.
    """
    from PIL import ImageFont

    home = find_spec("matplotlib")
    assert home is not None
    assert home.origin is not None
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    path = Path(home.origin).parent / "mpl-data" / "fonts" / "ttf" / name
    return ImageFont.truetype(str(path), size * DPI / 72.0, layout_engine=ImageFont.Layout.BASIC)
