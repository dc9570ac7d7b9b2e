"""What all pictures of studies share: colour and mark of an outcome, scales, legends."""

import functools
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ParamSpec

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.reports.figures.sheet.chart import Chart, legend_above
from alula.reports.figures.sheet.style import GROUND, INK, LOAD, STYLE
from alula.reports.figures.study.points import OUTCOMES
from alula.reports.words.numbers import number

Real = NDArray[np.float64]
Words = NDArray[np.str_]
_Given = ParamSpec("_Given")


@dataclass(frozen=True, kw_only=True)
class Look:
    """How an outcome is drawn.

    Attributes
    ----------
    colour : str
    mark : str
        Of matplotlib.
    hollow : bool
        Whether the mark is not filled.
    hatch : str
        Of areas.
    dashes : object
        Of lines, for matplotlib.
    """

    colour: str
    mark: str
    hollow: bool = False
    hatch: str = ""
    dashes: Any = "-"


LOOKS: Mapping[str, Look] = {
    "pass": Look(colour="#1b6e3c", mark="o"),
    "undecided": Look(colour="#8a5a00", mark="D", hollow=True, hatch="////", dashes=(0, (4, 1.5))),
    "fail": Look(colour="#b3261e", mark="X", hatch="xxxx", dashes=(0, (1.5, 1))),
    "refused": Look(colour=GROUND, mark="s", hollow=True, hatch="....", dashes=(0, (1, 3))),
    "crashed": Look(colour=INK, mark="*", hatch="++", dashes=(0, (1, 3))),
    "done": Look(colour=LOAD, mark="o"),
}
"""Colours of verdicts as ``report.css`` has them."""
_STYLE = {**STYLE, "hatch.linewidth": 0.5}
_NICE = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)


def styled(draw: Callable[_Given, Figure]) -> Callable[_Given, Figure]:
    """Draw a figure with the letters and lines of all pictures.

    Parameters
    ----------
    draw : callable

    Returns
    -------
    callable
    """

    @functools.wraps(draw)
    def inner(*args: _Given.args, **kwargs: _Given.kwargs) -> Figure:
        with rc_context(_STYLE):
            return draw(*args, **kwargs)

    return inner


def chart(figure: Figure) -> Chart:
    """Return a figure as a picture, with the letters and lines of all pictures.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    Chart
    """
    return Chart(figure, few=True, style=_STYLE)


def present(outcome: Words) -> list[str]:
    """Return the outcomes that some point has, in the order of legends.

    Parameters
    ----------
    outcome : ndarray of str, shape (n,)

    Returns
    -------
    list of str
    """
    return [name for name in OUTCOMES if np.any(outcome == name)]


def scatter(axes: Any, x: Real, y: Real, outcome: Words, *, size: float = 5.0, **more: Any) -> None:
    """Draw a mark for each point, by its outcome.

    Parameters
    ----------
    axes : object
        A matplotlib Axes.
    x, y : ndarray, shape (n,)
    outcome : ndarray of str, shape (n,)
    size : float, optional
        Of the marks [points].
    **more : object
        For matplotlib.
    """
    for name in reversed(present(outcome)):
        look, here = LOOKS[name], outcome == name
        axes.plot(
            x[here], y[here], linestyle="none", marker=look.mark, markersize=size * (1.4 if look.mark == "*" else 1.0),
            markeredgecolor=look.colour if look.hollow else "white", markeredgewidth=1.1 if look.hollow else 0.4,
            markerfacecolor="white" if look.hollow else look.colour, zorder=4, label=name, **more,
        )  # fmt: skip


def mark_size(count: int) -> float:
    """Return the size of marks for so many points [points].

    Parameters
    ----------
    count : int

    Returns
    -------
    float
    """
    return float(np.clip(60.0 / math.sqrt(max(count, 1)), 2.5, 6.0))


def legend(figure: Figure, outcome: Words, others: Iterable[tuple[Any, str]] = ()) -> None:
    """Name the outcomes above a figure, with the number of points of each; points without verdict go without saying.

    Parameters
    ----------
    figure : Figure
    outcome : ndarray of str, shape (n,)
    others : iterable of tuple, optional
        Further handles with their texts.
    """
    from matplotlib.lines import Line2D

    handles: list[Any] = []
    texts = []
    for name in present(outcome):
        if name == "done":
            continue
        look = LOOKS[name]
        handles.append(
            Line2D([], [], linestyle="none", marker=look.mark, markersize=6.0, markeredgecolor=look.colour,
                   markerfacecolor="white" if look.hollow else look.colour)
        )  # fmt: skip
        texts.append(f"{name}: {int(np.sum(outcome == name))}")
    for handle, text in others:
        handles.append(handle)
        texts.append(text)
    if handles:
        legend_above(figure, handles, texts)


def limit_handle() -> Any:
    """Return the legend's line of a limit.

    Returns
    -------
    object
    """
    from matplotlib.lines import Line2D

    return Line2D([], [], color=INK, linewidth=1.2, linestyle=(0, (4, 2)))


def wants_decades(values: Real) -> bool:
    """Return True for positive values that span so much that a logarithmic scale shows them better.

    Parameters
    ----------
    values : ndarray

    Returns
    -------
    bool
    """
    known = values[np.isfinite(values)]
    return known.size > 1 and bool(known.min() > 0.0) and bool(known.max() > 20.0 * known.min())


def scale(axis: Any, *, decades: bool) -> None:
    """Give an axis its scale, with ticks that are plain numbers.

    Parameters
    ----------
    axis : object
        A matplotlib XAxis or YAxis.
    decades : bool
        Logarithmic.
    """
    if not decades:
        if max(map(abs, axis.get_view_interval())) >= 1e6:
            axis.set_major_formatter(lambda value, position: tick(value))
        return
    from matplotlib.ticker import LogLocator, NullFormatter

    {"x": axis.axes.set_xscale, "y": axis.axes.set_yscale}[axis.axis_name]("log")
    low, high = axis.get_view_interval()
    wide = math.log10(max(high / low, 1.0)) if low > 0.0 else 1.0
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if wide < 2.5 else (1.0,), numticks=12))
    axis.set_major_formatter(lambda value, position: tick(value))
    axis.set_minor_formatter(NullFormatter())


def tick(value: float) -> str:
    """Return a round number as a tick names it.

    Parameters
    ----------
    value : float

    Returns
    -------
    str
    """
    text = f"{value:g}".replace("-", "−")
    return number(value, 2) if "e" in text else text


def levels(values: Real, most: int = 7) -> list[float]:
    """Return round numbers within the range of some values, for contours.

    Parameters
    ----------
    values : ndarray
    most : int, optional

    Returns
    -------
    list of float
        In ascending order; 1, 1.5, 2, 3, 5 and 7 of each decade for positive values of a wide range, else equal steps.
    """
    known = values[np.isfinite(values)]
    if known.size == 0 or not np.ptp(known) > 0.0:
        return []
    low, high = float(known.min()), float(known.max())
    if low > 0.0 and high > 3.0 * low:
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        for steps in (_NICE, (1.0, 2.0, 5.0), (1.0, 3.0), (1.0,)):
            found = [step * 10.0**k for k in range(first, last + 1) for step in steps]
            found = [level for level in found if low < level < high]
            if len(found) <= most:
                return found
    from matplotlib.ticker import MaxNLocator

    return [float(level) for level in MaxNLocator(most).tick_values(low, high) if low < level < high]
