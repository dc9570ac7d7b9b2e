"""Pictures of many entries at once: by words, parallel coordinates, and mass against safety factor."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.reports.figures.sheet.chart import legend_above
from alula.reports.figures.sheet.style import GROUND, INK, WIDTH
from alula.reports.figures.study.curves import reach
from alula.reports.figures.study.points import MOST_LINES, MOST_MARKS, Parameter, Response, marked
from alula.reports.figures.study.style import (
    LOOKS,
    Words,
    legend,
    limit_handle,
    mark_size,
    present,
    scale,
    scatter,
    styled,
    tick,
    wants_decades,
)

Real = NDArray[np.float64]
_APART = 16.0
"""Least distance of two points of a front that carry their numbers [points of the sheet]."""


@styled
def categories(names: Sequence[str], response: Response, outcome: Words, *, label: str) -> Figure:
    """Draw a number with its band for every combination of words.

    Parameters
    ----------
    names : sequence of str
        The combination of each point.
    response : Response
    outcome : ndarray of str, shape (n,)
    label : str
        What the names are of.

    Returns
    -------
    Figure
    """
    figure = Figure(figsize=(WIDTH, 1.2 + 0.32 * len(names)), layout="constrained")
    axes = figure.add_subplot()
    known = np.isfinite(response.value)
    decades = wants_decades(np.concatenate([response.value[known], response.low[np.isfinite(response.low)]]))
    ends = reach(response, decades=decades)
    places = -np.arange(len(names), dtype=float)
    axes.set_xlim(*ends)
    for place, low, high, name in zip(places, response.low, response.high, outcome, strict=True):
        if np.isfinite(low) or np.isfinite(high):
            axes.plot(np.clip([low, high], *ends), [place, place], color=LOOKS[str(name)].colour, linewidth=3.0,
                      alpha=0.35, solid_capstyle="butt", zorder=2)  # fmt: skip
    scatter(axes, response.value[known], places[known], outcome[known], size=6.0)
    edge = np.full(int((~known).sum()), 0.01)
    scatter(axes, edge, places[~known], outcome[~known], size=6.0, transform=axes.get_yaxis_transform())
    if np.isfinite(response.limit):
        axes.axvline(response.limit, color=INK, linewidth=1.2, linestyle=(0, (4, 2)), zorder=1)
    scale(axes.xaxis, decades=decades)
    axes.set_yticks(places, list(names), parse_math=False)
    axes.set_ylim(places[-1] - 0.7, 0.7)
    axes.set_xlabel(response.label, parse_math=False)
    axes.set_title(label, loc="left", fontsize=9.0, parse_math=False)
    axes.grid(axis="x", color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    legend(figure, outcome, [(limit_handle(), "limit")] if np.isfinite(response.limit) else [])
    return figure


@styled
def parallel(parameters: Sequence[Parameter], responses: Sequence[Response], outcome: Words) -> Figure:
    """Draw every point as a line through its values on upright axes, side by side.

    Parameters
    ----------
    parameters : sequence of Parameter
    responses : sequence of Response
        On further axes at the right; a point without such a number ends before it.
    outcome : ndarray of str, shape (n,)

    Returns
    -------
    Figure
    """
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D

    upright: list[Parameter | Response] = [*parameters, *responses]
    figure = Figure(figsize=(WIDTH, 4.4), layout="constrained")
    axes = figure.add_subplot()
    columns = []
    for i, one in enumerate(upright):
        columns.append(_upright(axes, i, one))
    at = np.column_stack(columns)
    drawn = lines_drawn(len(at))
    strong = float(np.clip(6.0 / np.sqrt(len(drawn)), 0.2, 0.9))
    for name in sorted(present(outcome), key=lambda name: -int(np.sum(outcome == name))):  # the rarest on top
        lines = [np.column_stack([np.arange(len(upright)), line]) for line in at[drawn][outcome[drawn] == name]]
        look = LOOKS[name]
        axes.add_collection(
            LineCollection(lines, colors=look.colour, linestyles=[look.dashes], linewidths=0.9, alpha=strong, zorder=2)
        )
    axes.set_xlim(-0.35, len(upright) - 0.5)
    axes.set_ylim(-0.04, 1.04)
    axes.set_yticks([])
    axes.set_xticks(range(len(upright)), [_broken(one.label) for one in upright], parse_math=False, fontsize=7.5)
    axes.tick_params(axis="x", length=0.0)
    for side in axes.spines.values():
        side.set_visible(False)
    handles = [Line2D([], [], color=LOOKS[name].colour, linestyle=LOOKS[name].dashes, linewidth=1.6)
               for name in present(outcome)]  # fmt: skip
    texts = [f"{name}: {int(np.sum(outcome == name))}" for name in present(outcome)]
    legend_above(figure, handles, texts)
    return figure


def lines_drawn(count: int) -> NDArray[np.intp]:
    """Return which of so many points are drawn as lines.

    Parameters
    ----------
    count : int

    Returns
    -------
    ndarray of int
    """
    return np.unique(np.linspace(0, count - 1, min(count, MOST_LINES)).round().astype(np.intp))


def _upright(axes: Any, place: int, one: Parameter | Response) -> Real:
    """Draw an upright axis with its ticks, and return where each point stands on it, from 0 to 1."""
    axes.plot([place, place], [0.0, 1.0], color=GROUND, linewidth=0.8, zorder=3)
    if isinstance(one, Parameter) and one.words:
        shares = one.values / max(len(one.words) - 1, 1)
        ticks = [(i / max(len(one.words) - 1, 1), word) for i, word in enumerate(one.words)]
        ticks = ticks if len(ticks) <= 8 else [ticks[0], ticks[-1]]
    else:
        values = one.values if isinstance(one, Parameter) else one.value
        known = values[np.isfinite(values)]
        decades = wants_decades(values)
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
        if isinstance(one, Response) and np.isfinite(one.limit):
            low, high = min(low, one.limit), max(high, one.limit)

        def share(value: Real) -> Real:
            ends = np.log([low, high]) if decades else np.array([low, high])
            at = np.log(value) if decades else value
            found: Real = (at - ends[0]) / ((ends[1] - ends[0]) or 1.0)
            return found

        shares = share(np.where(np.isfinite(values), values, np.nan))
        from matplotlib.ticker import LogLocator, MaxNLocator

        locator = LogLocator(subs=(1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,)) if decades else MaxNLocator(5)
        wanted = [float(value) for value in locator.tick_values(low, high) if low <= value <= high]
        ticks = [(float(share(np.array(value))), tick(float(f"{value:.6g}"))) for value in wanted]
        if isinstance(one, Response) and np.isfinite(one.limit):
            axes.plot([place - 0.08, place + 0.08], [float(share(np.array(one.limit)))] * 2, color=INK, linewidth=2.5,
                      zorder=5)  # fmt: skip
    for at, text in ticks:
        axes.plot([place - 0.03, place], [at, at], color=GROUND, linewidth=0.8, zorder=3)
        axes.annotate(
            text, (place, at), xytext=(-4.5, 0.0), textcoords="offset points", ha="right", va="center", fontsize=7.5,
            parse_math=False, zorder=6, bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.6},
        )  # fmt: skip
    found: Real = shares
    return found


def _broken(label: str, width: int = 16) -> str:
    """Break a label at dots and spaces into lines of some letters."""
    lines = [""]
    for piece in label.replace(".", ".\0").replace(" ", " \0").replace("_", "_\0").split("\0"):
        if lines[-1] and len(lines[-1]) + len(piece) > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(line.rstrip() for line in lines)


def front(mass: Real, gain: Real, candidate: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the points that no other one beats: none is as light with more gain, or lighter with as much.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        To be small.
    gain : ndarray, shape (n,)
        To be large.
    candidate : ndarray of bool, shape (n,)
        Which points count.

    Returns
    -------
    ndarray of int
        From the lightest to the heaviest.
    """
    counted = np.flatnonzero(candidate & np.isfinite(mass) & ~np.isnan(gain))
    best, found = -np.inf, []
    for point in counted[np.lexsort((-gain[counted], mass[counted]))]:
        if gain[point] > best:
            best = gain[point]
            found.append(point)
    return np.array(found, dtype=np.intp)


@styled
def pareto(mass: Real, response: Response, outcome: Words, position: NDArray[np.int64]) -> Figure:
    """Draw a number over the mass, with its band and the front of the points that no other one beats.

    The front counts the lower ends of the bands of points that do not fail.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        [g].
    response : Response
    outcome : ndarray of str, shape (n,)
    position : ndarray of int, shape (n,)
        Numbers of the points, which the front carries.

    Returns
    -------
    Figure
    """
    figure = Figure(figsize=(WIDTH, 4.0), layout="constrained")
    axes = figure.add_subplot()
    known = np.isfinite(mass) & np.isfinite(response.value)
    decades = wants_decades(np.concatenate([response.value[known], response.low[known]]))
    ends = reach(response, decades=decades)
    axes.set_ylim(*ends)
    scale(axes.yaxis, decades=decades)
    few = int(known.sum()) <= 100
    for point in np.flatnonzero(known & few):
        x, low, high, name = mass[point], response.low[point], response.high[point], outcome[point]
        if low < high:
            axes.plot([x, x], np.clip([low, high], *ends), color=LOOKS[str(name)].colour, linewidth=2.0, alpha=0.25,
                      solid_capstyle="butt", zorder=2)  # fmt: skip
    best = front(mass, response.low, known & (outcome != "fail"))
    drawn = marked(known, MOST_MARKS)
    drawn[best] = True
    scatter(axes, mass[drawn], response.value[drawn], outcome[drawn], size=mark_size(int(drawn.sum())))
    others: list[tuple[Any, str]] = []
    if len(best):
        low = np.clip(response.low[best], *ends)
        (line,) = axes.plot(mass[best], low, drawstyle="steps-post", color=INK, linewidth=1.3, zorder=3)
        others.append((line, "front (lower ends of the bands)"))
        _name_front(axes, mass[best], low, position[best])
    if np.isfinite(response.limit):
        axes.axhline(response.limit, color=INK, linewidth=1.2, linestyle=(0, (4, 2)), zorder=1)
        others.append((limit_handle(), "limit"))
    axes.set_xlabel("mass of all links [g]")
    axes.set_ylabel(response.label, parse_math=False)
    axes.grid(color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    legend(figure, outcome[known], others)
    return figure


def _name_front(axes: Any, mass: Real, gain: Real, position: NDArray[np.int64]) -> None:
    """Write the numbers of a front's points, from the lightest, as far as they have room."""
    from matplotlib.patheffects import withStroke

    axes.margins(x=0.06)
    axes.autoscale_view(scaley=False)
    places = axes.transData.transform(np.column_stack([mass, gain])) * 72.0 / axes.figure.dpi
    last = np.array([-np.inf, -np.inf])
    for place, x, y, name in zip(places, mass, gain, position, strict=True):
        if np.linalg.norm(place - last) < _APART:
            continue
        last = place
        axes.annotate(
            str(name), (x, y), xytext=(3.0, -3.0), textcoords="offset points", ha="left", va="top", fontsize=8.0,
            zorder=6, path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip
