"""How a number spreads and what it depends on: a histogram with its limit, and a tornado; both of plain arrays."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from alula.reports.figures.sheet.chart import legend_above
from alula.reports.figures.sheet.style import GROUND, INK, JOINT_FORCE, LOAD, WIDTH
from alula.reports.figures.study.style import LOOKS, Words, limit_handle, present, scale, styled, wants_decades
from alula.reports.words.numbers import fixed, number

Real = NDArray[np.float64]
MOST_BARS = 20
"""Of a tornado; the least are left out and counted."""


@styled
def histogram(
    values: ArrayLike,
    limit: float = math.nan,
    *,
    label: str,
    outcome: Words | None = None,
    at_least: bool = True,
    counted: str = "points",
) -> Figure:
    """Draw how often values occur, and which miss their limit.

    Parameters
    ----------
    values : array, shape (n,)
        Those that are not finite are counted beside the bars.
    limit : float, optional
        An edge of the bars, so that no bar holds both sides of it.
    label : str
        What the values are, with their unit.
    outcome : ndarray of str, shape (n,), optional
        Verdict or state of each, by which the bars are divided; without, by the side of the limit.
    at_least : bool, optional
        Whether values must be at least the limit, else at most.
    counted : str, optional
        What the values are of: points, samples.

    Returns
    -------
    Figure
    """
    from matplotlib.ticker import MaxNLocator

    values = np.asarray(values, dtype=float)
    if outcome is None:
        kept = np.ones(len(values), dtype=bool) if math.isnan(limit) else values >= limit
        if not at_least and not math.isnan(limit):
            kept = values <= limit
        outcome = np.where(kept, "pass" if math.isfinite(limit) else "done", "fail")
    known = np.isfinite(values)
    found, decades = values[known], wants_decades(values)
    figure = Figure(figsize=(WIDTH, 3.0), layout="constrained")
    axes = figure.add_subplot()
    edges = _edges(found, limit, decades=decades)
    names = present(outcome[known])
    looks = [LOOKS[name] for name in names]
    if names:
        axes.hist(
            [found[outcome[known] == name] for name in names], edges.tolist(), stacked=True, label=names,
            color=[look.colour for look in looks], edgecolor="white", linewidth=0.5, alpha=0.85,
        )  # fmt: skip
    for bars, look in zip(_containers(axes, len(names)), looks, strict=True):
        for bar in bars:
            bar.set_hatch(look.hatch)
    scale(axes.xaxis, decades=decades)
    if math.isfinite(limit):
        axes.axvline(limit, color=INK, linewidth=1.2, linestyle=(0, (4, 2)))
    axes.set_xlabel(label, parse_math=False)
    axes.set_ylabel(counted)
    axes.yaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.grid(axis="y", color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    handles, texts = axes.get_legend_handles_labels()
    if math.isfinite(limit):
        handles, texts = [*handles, limit_handle()], [*texts, f"limit {'≥' if at_least else '≤'} {number(limit, 3)}"]
    if math.isfinite(limit) or names != ["done"]:
        legend_above(figure, handles, texts)
    if beside := int((~known).sum()):
        axes.set_title(f"not drawn: {beside} {counted} without a finite value", loc="right", fontsize=8.0)
    return figure


def _containers(axes: Any, count: int) -> list[Any]:
    return list(axes.containers)[-count:] if count else []


def _edges(values: Real, limit: float, *, decades: bool) -> Real:
    """Edges of bars; the limit is one of them where it lies among the values."""
    if not values.size:
        return np.array([0.0, 1.0])
    at = np.log(values) if decades else values
    low, high = float(at.min()), float(at.max())
    if not high - low > 1e-9 * max(abs(high), abs(low)):
        wide = 0.5 * abs(high) or 0.5
        low, high = low - wide, high + wide
    count = int(np.clip(len(np.histogram_bin_edges(at, "auto")) - 1, 8, 60)) if at.size < 10**6 else 60
    step = (high - low) / count
    origin = low
    place = math.log(limit) if decades and limit > 0.0 else limit
    if math.isfinite(place) and low < place < high and not (decades and limit <= 0.0):
        origin = place - math.ceil((place - low) / step) * step
    edges = origin + step * np.arange(math.ceil((high - origin) / step - 1e-9) + 1)
    edges[-1] = max(edges[-1], high)
    found: Real = np.exp(edges) if decades else np.asarray(edges, dtype=np.float64)
    if not decades:
        return found
    found[0], found[-1] = min(found[0], values.min()), max(found[-1], values.max())
    return found


@styled
def tornado(
    names: Sequence[str],
    first: ArrayLike,
    total: ArrayLike | None = None,
    *,
    label: str,
    texts: tuple[str, str] = ("first order", "total"),
    unsigned: Sequence[bool] = (),
) -> Figure:
    """Draw what a number depends on, the strongest first.

    Parameters
    ----------
    names : sequence of str
        Of the parameters.
    first : array, shape (n,)
        Coefficients with their signs, or first-order indices.
    total : array, shape (n,), optional
        Total indices.
    label : str
        What the bars are.
    texts : tuple of 2 str, optional
        What ``first`` and ``total`` are.
    unsigned : sequence of bool, optional
        Which bars have no direction, as those of words.

    Returns
    -------
    Figure
    """
    first = np.asarray(first, dtype=float)
    widest = np.abs(first) if total is None else np.fmax(np.abs(first), np.abs(np.asarray(total, dtype=float)))
    order = np.argsort(-np.nan_to_num(widest), kind="stable")[:MOST_BARS]
    figure = Figure(figsize=(WIDTH, 1.1 + 0.3 * len(order) * (1.0 if total is None else 1.5)), layout="constrained")
    axes = figure.add_subplot()
    places = -np.arange(len(order), dtype=float)
    plain = np.asarray(unsigned, dtype=bool)[order] if len(unsigned) else np.zeros(len(order), dtype=bool)
    shown = first[order]
    if total is None:
        colours = [GROUND if free else LOAD if value >= 0.0 else JOINT_FORCE
                   for value, free in zip(shown, plain, strict=True)]  # fmt: skip
        bars = axes.barh(places, shown, 0.7, color=colours, edgecolor="white", linewidth=0.5)
        for bar, value, free in zip(bars, shown, plain, strict=True):
            bar.set_hatch("...." if free else "" if value >= 0.0 else "////")
        _values(axes, places, shown, signed=~plain)
    else:
        ours = np.asarray(total, dtype=float)[order]
        axes.barh(places + 0.19, shown, 0.36, color=LOAD, label=texts[0])
        axes.barh(places - 0.19, ours, 0.36, color="white", edgecolor=LOAD, hatch="////", linewidth=0.8, label=texts[1])
        for shift, values in ((0.19, shown), (-0.19, ours)):
            _values(axes, places + shift, values, signed=np.zeros(len(order), dtype=bool))
        figure.legend(loc="outside upper center", ncols=2, frameon=False)
    axes.set_yticks(places, [names[i] for i in order], parse_math=False)
    axes.tick_params(axis="y", length=0.0)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.set_xlabel(label, parse_math=False)
    axes.margins(x=0.12)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    if len(order) < len(first):
        axes.set_title(f"{len(first) - len(order)} weaker ones are not drawn", loc="right", fontsize=8.0)
    return figure


def _values(axes: Any, places: Real, values: Real, *, signed: NDArray[np.bool_]) -> None:
    """Write values at the ends of their bars."""
    for place, value, sign in zip(places, values, signed, strict=True):
        text = fixed(float(value), 2)
        axes.annotate(
            f"+{text}" if sign and value > 0.0 else text, (value, place),
            xytext=(3.0 if value >= 0.0 else -3.0, 0.0), textcoords="offset points",
            ha="left" if value >= 0.0 else "right", va="center", fontsize=8.0,
        )  # fmt: skip
