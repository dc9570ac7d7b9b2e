"""A chart that matplotlib draws: as PNG, as an element of a page, and the curves in it."""

import io
from collections.abc import Iterator, Sequence
from functools import cached_property
from html import escape
from threading import Lock
from typing import Any

import numpy as np

from alula.reports.figures.sheet.drawing import Plotted, data_uri
from alula.reports.figures.sheet.style import DPI, quiet_glyphs

_ALONE = Lock()
"""Matplotlib draws in one thread at a time: a file and a page ask for the same chart."""


class Chart:
    """A figure of matplotlib as a picture.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
    dpi : float
        Of its PNG.
    """

    def __init__(self, figure: Any, *, dpi: float = DPI, few: bool = False, style: dict[str, Any] | None = None):
        """Take a figure.

        Parameters
        ----------
        figure : matplotlib.figure.Figure
        dpi : float, optional
        few : bool, optional
            True for a PNG of 256 colours, a third of the bytes.
        style : dict, optional
            What of matplotlib's is set while it is drawn.
        """
        self.figure, self.dpi = figure, dpi
        self._few, self._style = few, style or {}

    def png(self) -> bytes:
        """Return it as PNG, without a date.

        Returns
        -------
        bytes
        """
        with _ALONE:
            return self._png

    @cached_property
    def _png(self) -> bytes:
        from matplotlib import rc_context

        stream = io.BytesIO()
        with rc_context(self._style), quiet_glyphs():
            self.figure.savefig(stream, format="png", dpi=self.dpi, metadata={"Software": None})
        return _of_few_colours(stream) if self._few else stream.getvalue()

    def element(self, alt: str) -> str:
        """Return it as an element of a page.

        Parameters
        ----------
        alt : str
            What it shows, for who does not see it.

        Returns
        -------
        str
        """
        return f'<img src="{data_uri(self.png())}" alt="{escape(alt)}">'

    @property
    def plotted(self) -> tuple[Plotted, ...]:
        """Its curves, as they stand in the figure: lines, then ends of bands and tops of bars."""
        return tuple(one for axes in self.figure.axes for one in _plotted(self.figure, axes))


def legend_above(figure: Any, handles: Sequence[Any], texts: Sequence[str]) -> None:
    """Put a legend above a figure, in as many columns as it has room for, at most five.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        With constrained layout.
    handles : sequence of matplotlib artists, or of tuples of them, which stand side by side
    texts : sequence of str
        Beside each handle; names of a case, in which no mathematics is meant.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.legend_handler import HandlerTuple

    side_by_side = {tuple: HandlerTuple(ndivide=None, pad=0.0)}
    renderer = FigureCanvasAgg(figure).get_renderer()
    for columns in range(min(5, len(texts)), 0, -1):
        found = figure.legend(
            handles, texts, loc="outside upper center", ncols=columns, frameon=False, handler_map=side_by_side
        )
        for named in found.get_texts():
            named.set_parse_math(False)
        if columns == 1 or found.get_window_extent(renderer).width <= figure.bbox.width:
            break
        found.remove()


def _plotted(figure: Any, axes: Any) -> Iterator[Plotted]:
    shared = [getattr(figure, f"_sup{side}label", None) for side in "xy"]
    below = [one.get_xlabel() for one in figure.axes if one.get_xlabel()]
    x_label = axes.get_xlabel() or (shared[0].get_text() if shared[0] else "") or (below[-1] if below else "")
    labels = {"x_label": x_label, "y_label": axes.get_ylabel() or (shared[1].get_text() if shared[1] else "")}
    for line in axes.lines:
        x, y = (np.asarray(values, dtype=np.float64) for values in line.get_data(orig=True))
        yield Plotted(name=_name(line), x=x, y=y, **labels)
    from matplotlib.collections import PolyCollection

    for area in axes.collections:
        paths: Any = area.get_paths()
        for path in paths if isinstance(area, PolyCollection) else ():
            yield Plotted(name=_name(area), x=path.vertices[:, 0], y=path.vertices[:, 1], **labels)
    for bars in axes.containers:
        if not hasattr(bars, "patches"):
            continue
        boxes = np.array([[bar.get_x(), bar.get_width(), bar.get_height()] for bar in bars.patches]).reshape(-1, 3)
        yield Plotted(name=_name(bars), x=boxes[:, 0] + boxes[:, 1] / 2.0, y=boxes[:, 2], **labels)


def _name(artist: Any) -> str:
    """Return the name of a curve; matplotlib's own for those without begin with an underscore."""
    label = str(artist.get_label())
    return "" if label.startswith("_") else label


def _of_few_colours(drawn: io.BytesIO) -> bytes:
    from PIL import Image

    stream = io.BytesIO()
    picture = Image.open(drawn).convert("RGB")
    picture.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
        stream, format="PNG", optimize=True, dpi=(DPI, DPI)
    )
    return stream.getvalue()
