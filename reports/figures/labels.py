"""Placing labels on a drawing so that they cover neither each other nor what is drawn."""

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_DIRECTIONS = 24
_REACHES = (0.6, 1.2, 2.0, 3.0, 4.2, 6.0, 8.0)
"""Distances that are tried, in heights of the label's text."""
_LEADER = 2.5
"""Distance beyond which a label gets a line to its anchor."""


_COVERS = 6.0
"""Cost of a label over anything drawn, in heights of its text by which it would rather move away."""


def place_labels(
    axes: Any,
    labels: Sequence[tuple[NDArray[np.float64], str, str]],
    obstacles: NDArray[np.float64],
    *,
    fontsize: float,
) -> None:
    """Write labels beside their anchors, where they cover least.

    The labels are placed one after the other. One that is far from its anchor has a thin line to it.

    Parameters
    ----------
    axes : object
        A matplotlib Axes with final limits and size.
    labels : sequence of tuple
        Anchors (k, 2), of which one is chosen; text; colour.
    obstacles : array
        Points (n, 2) of what is drawn, in data coordinates.
    fontsize : float
        In points.
    """
    from matplotlib.patheffects import withStroke

    figure = axes.figure
    renderer = figure.canvas.get_renderer()
    inside = axes.get_window_extent(renderer)
    drawn = axes.transData.transform(obstacles)
    taken: list[tuple[float, float, float, float]] = []
    for anchors, content, colour in labels:
        text = axes.text(*anchors[0], content, fontsize=fontsize, color=colour, ha="center", va="center", zorder=10)
        text.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
        box = text.get_window_extent(renderer)
        half = np.array([box.width, box.height]) / 2.0 + 2.0
        line = fontsize * figure.dpi / 72.0
        best: tuple[float, NDArray[np.float64], float, NDArray[np.float64]] | None = None
        for at, reach, k in itertools.product(axes.transData.transform(anchors), _REACHES, range(_DIRECTIONS)):
            angle = 2.0 * math.pi * k / _DIRECTIONS
            way = np.array([math.cos(angle), math.sin(angle)])
            centre = at + way * (reach * line + float(np.abs(way) @ half))
            low, high = centre - half, centre + half
            covered = int(np.count_nonzero(((drawn > low) & (drawn < high)).all(axis=1)))
            clash = sum(
                max(0.0, min(high[0], x1) - max(low[0], x0)) * max(0.0, min(high[1], y1) - max(low[1], y0))
                for x0, y0, x1, y1 in taken
            )
            outside = float(np.maximum(0.0, [*(inside.min - low), *(high - inside.max)]).sum())
            cost = reach + (_COVERS + 0.3 * covered if covered else 0.0) + clash + 10.0 * outside
            if best is None or cost < best[0]:
                best = (cost, centre, reach, at)
        assert best is not None
        _, centre, reach, at = best
        taken.append((*(centre - half), *(centre + half)))
        back = axes.transData.inverted()
        text.set_position(back.transform(centre))
        if reach > _LEADER:
            ends = back.transform([at, centre + (at - centre) * min(1.0, half[1] / abs(at - centre).max())])
            axes.plot(*ends.T, color=colour, linewidth=0.5, alpha=0.6, zorder=4)


def along(start: NDArray[np.float64], end: NDArray[np.float64], count: int = 240) -> NDArray[np.float64]:
    """Return points on a line that labels must not cover.

    Parameters
    ----------
    start : array
    end : array
    count : int, optional

    Returns
    -------
    array
        (count, 2).
    """
    return np.asarray(np.linspace(start, end, count))


@dataclass(frozen=True, kw_only=True)
class Stacked:
    """A name above an axis.

    Attributes
    ----------
    text : str
    at : float
        Place along the axis [inches].
    row : int
        From below.
    """

    text: str
    at: float
    row: int


def stacked(names: Iterable[str], at: Iterable[float]) -> tuple[Stacked, ...]:
    """Return names above an axis without overlap.

    Parameters
    ----------
    names : iterable of str
    at : iterable of float
        Place of each along the axis [inches]; names of one place stand together, others move to a higher row.

    Returns
    -------
    tuple of Stacked
        Names of one place are joined; others move to a higher row.
    """
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    together: dict[float, list[str]] = {}
    for name, place in zip(names, at, strict=True):
        near = next((known for known in together if abs(known - place) < _TOGETHER), float(place))
        together.setdefault(near, []).append(name)
    ends: list[float] = []
    found = []
    for place, group in sorted(together.items()):
        text = ", ".join(group)
        drawn = TextPath(
            (0.0, 0.0), text.replace("$", r"\$"), prop=FontProperties(weight="bold", size=_NAME_SIZE), usetex=False
        )
        half = float(drawn.get_extents().width) / 72.0 / 2.0 + _NAME_GAP
        row = next((k for k, end in enumerate(ends) if end <= place - half), len(ends))
        ends[row : row + 1] = [place + half]
        found.append(Stacked(text=text, at=place, row=row))
    return tuple(found)


def heights(names: Sequence[Stacked]) -> float:
    """Return the height that stacked names need [inches].

    Parameters
    ----------
    names : sequence of Stacked

    Returns
    -------
    float
    """
    return _NAME_ROW * (1 + max((name.row for name in names), default=0))


def write_stacked(axes: Any, names: Sequence[Stacked], width: float) -> None:
    """Write stacked names above an axis.

    Parameters
    ----------
    axes : object
        A matplotlib Axes.
    names : sequence of Stacked
    width : float
        Of the axes [inches].
    """
    for name in names:
        axes.annotate(
            name.text,
            (name.at / width, 1.0),
            xycoords="axes fraction",
            xytext=(0, 3 + 72.0 * _NAME_ROW * name.row),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontweight="bold",
            fontsize=_NAME_SIZE,
            parse_math=False,
            annotation_clip=False,
        )


_TOGETHER = 0.005
_NAME_SIZE, _NAME_ROW, _NAME_GAP = 9.0, 0.18, 0.03
"""Points; inches."""
