"""Over two quantities: the verdict of every point, with contours of the margin."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.reports.figures.sheet.style import INK
from alula.reports.figures.study.curves import Panel, name_axes, subplots
from alula.reports.figures.study.points import Parameter, Response
from alula.reports.figures.study.style import (
    LOOKS,
    Words,
    legend,
    levels,
    mark_size,
    scale,
    scatter,
    styled,
    tick,
    wants_decades,
)

Real = NDArray[np.float64]
_TINT = 0.22
"""Share of an outcome's colour in the cells of a grid."""
_VALUES = "cividis"
"""Colours of numbers that have no verdict, told apart by the colour-blind (Nunez, Anderton & Renslow, 2018)."""


@styled
def verdict_map(
    parameters: tuple[Parameter, Parameter], response: Response, outcome: Words, panels: Sequence[Panel]
) -> Figure:
    """Draw the outcome of every point over two entries, and contours of a number.

    Parameters
    ----------
    parameters : tuple of 2 Parameter
        Quantities.
    response : Response
    outcome : ndarray of str, shape (n,)
    panels : sequence of tuple
        One for each combination of what else varies.

    Returns
    -------
    Figure
    """
    figure, grid = subplots(panels, height=4.6, sharey=True)
    x, y = (parameter.values for parameter in parameters)
    judged = not set(outcome) <= {"done", "refused", "crashed"}
    coloured, ends = None, _ends(response.value)
    for axes, (title, here) in zip(grid, panels, strict=True):
        cells = _cells(x[here], y[here], outcome[here])
        for (left, bottom, wide, tall), name in cells:
            if name != "done":
                axes.bar(left, tall, wide, bottom, align="edge", color=LOOKS[name].colour, alpha=_TINT, linewidth=0.0)
        axes.margins(0.0 if cells else 0.04)
        size = mark_size(int(here.sum()))
        known = here & np.isfinite(response.value) & (not judged)
        scatter(axes, x[here & ~known], y[here & ~known], outcome[here & ~known], size=size)
        if known.any():
            coloured = axes.scatter(
                x[known], y[known], c=response.value[known], cmap=_VALUES, vmin=ends[0], vmax=ends[1],
                s=(1.6 * size) ** 2, edgecolors=INK, linewidths=0.4, zorder=3,
            )  # fmt: skip
        _contours(axes, x[here], y[here], response.value[here], response.limit)
        axes.set_title(title, loc="left", fontsize=9.0, parse_math=False)
        for axis, values in ((axes.xaxis, x), (axes.yaxis, y)):
            scale(axis, decades=wants_decades(values))
    name_axes(figure, grid, *(parameter.label for parameter in parameters))
    if coloured is not None:
        bar = figure.colorbar(coloured, ax=grid)
        bar.set_label(response.label, parse_math=False)
        scale(bar.ax.yaxis, decades=False)
    legend(figure, outcome, _contour_handles(response) if _has_contours(grid) else ())
    return figure


def _has_contours(grid: Sequence[Any]) -> bool:
    from matplotlib.contour import ContourSet

    return any(isinstance(artist, ContourSet) for axes in grid for artist in axes.collections)


def _ends(values: Real) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)


def _contour_handles(response: Response) -> list[tuple[Any, str]]:
    from matplotlib.lines import Line2D

    return [(Line2D([], [], color=INK, linewidth=0.8), response.label)]


def _cells(x: Real, y: Real, outcome: Words) -> list[tuple[tuple[float, float, float, float], str]]:
    """Return the cells of a grid, each left, bottom, width and height, with its outcome; none for other points."""
    columns, rows = np.unique(x), np.unique(y)
    places = {(float(a), float(b)) for a, b in zip(x, y, strict=True)}
    if min(len(columns), len(rows)) < 2 or len(places) < len(x) or len(x) < 0.6 * len(columns) * len(rows):
        return []
    across, up = _edges(columns, decades=wants_decades(x)), _edges(rows, decades=wants_decades(y))
    found = []
    for a, b, name in zip(x, y, outcome, strict=True):
        i, j = int(np.searchsorted(columns, a)), int(np.searchsorted(rows, b))
        cell = (across[i], up[j], across[i + 1] - across[i], up[j + 1] - up[j])
        found.append((cell, str(name)))
    return found


def _edges(values: Real, *, decades: bool) -> list[float]:
    """Middles between neighbours, and as far beyond the ends."""
    at = np.log(values) if decades else values
    middle = (at[1:] + at[:-1]) / 2.0
    edges = np.concatenate([[2.0 * at[0] - middle[0]], middle, [2.0 * at[-1] - middle[-1]]])
    return [float(edge) for edge in (np.exp(edges) if decades else edges)]


def _contours(axes: Any, x: Real, y: Real, value: Real, limit: float) -> None:
    """Draw contours through triangles between points; none across a point without a value."""
    from matplotlib.patheffects import withStroke
    from matplotlib.tri import Triangulation

    wanted = levels(value)
    low, high = _ends(value)
    if np.isfinite(limit) and low < limit < high:
        wanted = sorted({*wanted, limit})
    if not wanted or len(x) < 4:
        return
    try:
        flat = Triangulation(_unit(x), _unit(y))
    except (RuntimeError, ValueError):  # all points on one line
        return
    thin = _thin(flat)
    triangles = Triangulation(x, y, flat.triangles, mask=thin | ~np.isfinite(value)[flat.triangles].all(axis=1))
    if triangles.mask.all():
        return
    shown, places = np.where(np.isfinite(value), value, 1.0), np.array(wanted)
    if low > 0.0:  # factors: straight between their logarithms
        shown, places = np.log(shown), np.log(places)
    widths = [2.0 if level == limit else 0.8 for level in wanted]
    drawn = axes.tricontour(
        triangles, shown, levels=places, colors=INK, linewidths=widths, zorder=5, linestyles="solid"
    )
    names = {float(place): tick(level) for place, level in zip(places, wanted, strict=True)}
    for text in axes.clabel(drawn, fmt=names, fontsize=8.0, inline=True, inline_spacing=2.0):
        text.set(zorder=6, path_effects=[withStroke(linewidth=2.5, foreground="white")])


def _unit(values: Real) -> Real:
    at = np.log(values) if wants_decades(values) else values
    found: Real = (at - at.min()) / max(float(np.ptp(at)), 1e-300)
    return found


def _thin(triangles: Any) -> NDArray[np.bool_]:
    """Triangles at the rim that are all but flat, which would join far points."""
    from matplotlib.tri import TriAnalyzer

    found: NDArray[np.bool_] = TriAnalyzer(triangles).get_flat_tri_mask(0.02)
    return found
