"""Colours, letters and size that all pictures share."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

INK = "#1c2733"
LINK = "#9fb1c1"
GROUND = "#5d6b78"
GRID = "#e8ecef"
JOINT_FORCE = "#c8460b"
LOAD = "#0067a8"
TORQUE = "#00795a"
SPRING = "#8a5200"
DPI = 200
WIDTH = 7.4
"""Inches; fonts are in points, so this sets how large they read on the page."""
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": GROUND,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.linewidth": 0.6,
}
"""Of what matplotlib draws."""


@contextmanager
def quiet_glyphs() -> Iterator[None]:
    """Names may hold letters that the figures' font lacks; a box in their place is no reason to warn."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield
