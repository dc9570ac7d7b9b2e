"""Over one quantity: a number of every point with its band, in the colour of the verdict."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.reports.figures.sheet.style import GROUND, INK, WIDTH
from alula.reports.figures.study.points import Parameter, Response
from alula.reports.figures.study.style import (
    LOOKS,
    Words,
    legend,
    limit_handle,
    mark_size,
    scale,
    scatter,
    styled,
    wants_decades,
)

Real = NDArray[np.float64]
Panel = tuple[str, NDArray[np.bool_]]
"""Title of a panel, and which points stand in it."""
_HEADROOM = 3.0
"""Bands are cut off at so many times the largest value, and at as small a part of the least one."""


@styled
def curves(parameter: Parameter, response: Response, outcome: Words, panels: Sequence[Panel]) -> Figure:
    """Draw a number over an entry.

    Parameters
    ----------
    parameter : Parameter
        A quantity.
    response : Response
    outcome : ndarray of str, shape (n,)
    panels : sequence of tuple
        One for each combination of what else varies.

    Returns
    -------
    Figure
    """
    figure, grid = subplots(panels, height=3.4, sharey=True)
    known = np.isfinite(response.value)
    decades = wants_decades(np.concatenate([response.value[known], response.low[np.isfinite(response.low)]]))
    bottom, top = reach(response, decades=decades)
    for axes, (title, here) in zip(grid, panels, strict=True):
        order = np.flatnonzero(here)[np.argsort(parameter.values[here], kind="stable")]
        x, lost = parameter.values[order], order[~known[order]]
        axes.set_ylim(bottom, top)
        _bands(axes, x, order, response, outcome, (bottom, top))
        axes.plot(x, np.where(known[order], response.value[order], np.nan), color=GROUND, linewidth=1.0, zorder=3)
        found = order[known[order]]
        size = mark_size(len(found))
        scatter(axes, parameter.values[found], response.value[found], outcome[found], size=size)
        edge = np.full(len(lost), 0.03)
        scatter(axes, parameter.values[lost], edge, outcome[lost], size=size, transform=axes.get_xaxis_transform())
        if np.isfinite(response.limit):
            axes.axhline(response.limit, color=INK, linewidth=1.2, linestyle=(0, (4, 2)), zorder=2)
        axes.set_title(title, loc="left", fontsize=9.0, parse_math=False)
        axes.grid(color="0.92", linewidth=0.6)
        axes.set_axisbelow(True)
        scale(axes.yaxis, decades=decades)
        scale(axes.xaxis, decades=wants_decades(parameter.values))
    name_axes(figure, grid, parameter.label, response.label)
    limit = [(limit_handle(), "limit")] if np.isfinite(response.limit) else []
    legend(figure, outcome, limit)
    return figure


def subplots(panels: Sequence[Panel], *, height: float, sharey: bool) -> tuple[Figure, list[Any]]:
    """Return a figure with its panels, one or two beside each other.

    Parameters
    ----------
    panels : sequence of tuple
    height : float
        Of a panel that has a row of its own [inches].
    sharey : bool
        Whether all have one vertical scale.

    Returns
    -------
    Figure
    list of object
        The Axes.
    """
    columns = min(len(panels), 2)
    rows = -(-len(panels) // 2)
    each = height if columns == 1 else 0.85 * height
    figure = Figure(figsize=(WIDTH, rows * each + 0.6), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=sharey).ravel().tolist()
    for axes in grid[len(panels) :]:
        axes.remove()
    for axes in grid[max(0, len(panels) - 2) : len(panels)]:
        axes.tick_params(labelbottom=True)
    return figure, grid[: len(panels)]


def name_axes(figure: Figure, grid: Sequence[Any], x: str, y: str) -> None:
    """Name the axes of all panels once.

    Parameters
    ----------
    figure : Figure
    grid : sequence of object
        The Axes.
    x, y : str
    """
    if len(grid) == 1:
        grid[0].set_xlabel(x, parse_math=False)
        grid[0].set_ylabel(y, parse_math=False)
    else:
        figure.supxlabel(x, fontsize=9.0, parse_math=False)
        figure.supylabel(y, fontsize=9.0, parse_math=False)


def reach(response: Response, *, decades: bool) -> tuple[float, float]:
    """Return the ends of a scale that holds all values and the limit, and bands as far as they are near.

    Parameters
    ----------
    response : Response
    decades : bool
        For a logarithmic scale.

    Returns
    -------
    tuple of float
    """
    values = response.value[np.isfinite(response.value)]
    marks = np.append(values, response.limit) if np.isfinite(response.limit) else values
    if not marks.size:
        return 0.0, 2.0
    ends = np.concatenate([band[np.isfinite(band)] for band in (response.low, response.high)])
    low, high = float(marks.min()), float(marks.max())
    if decades:
        positive = marks[marks > 0.0]
        low, high = float(positive.min()), float(positive.max())
        near = ends[(ends > low / _HEADROOM) & (ends < high * _HEADROOM)]
        low, high = min(low, *near, low / 1.1), max(high, *near, high * 1.1)
        return low / (high / low) ** 0.04, high * (high / low) ** 0.04
    span = max(high - low, 0.1 * abs(high), 1e-12)
    near = ends[(ends > low - span) & (ends < high + span)]
    low, high = min([low, *near]), max([high, *near])
    margin = 0.06 * max(high - low, span)
    return low - margin, high + margin


def _bands(
    axes: Any, x: Real, order: NDArray[np.intp], response: Response, outcome: Words, ends: tuple[float, float]
) -> None:
    """Fill the band about every point as far as the middle of its neighbours, in the colour of its outcome."""
    wide = [i for i, point in enumerate(order) if response.low[point] < response.high[point]]
    if not wide or len(np.unique(x)) < 2:
        return
    low, high = (np.clip(band[order], *ends) for band in (response.low, response.high))
    for i in wide:
        look = LOOKS[str(outcome[order[i]])]
        near = [j for j in (i - 1, i, i + 1) if 0 <= j < len(x) and np.isfinite([low[j], high[j]]).all()]
        at, under, over = ((values[i] + values[near]) / 2.0 for values in (x, low, high))
        axes.fill_between(at, under, over, color=look.colour, alpha=0.2, linewidth=0.0, zorder=1)
