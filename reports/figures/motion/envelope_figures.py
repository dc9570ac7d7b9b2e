"""The curve of an envelope: safety factor of every link over the drive angle, or over the cycle."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import Quantity, Subject
from alula.fea.motion.envelope_result import EnvelopeResult, LinkEnvelope
from alula.reports.figures.motion.motion_figures import COLOURS, DASHES
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.chart import Chart, legend_above
from alula.reports.figures.sheet.style import GROUND, INK, STYLE, WIDTH, quiet_glyphs
from alula.reports.words.numbers import number, plain

Real = NDArray[np.float64]

_DECADES = 1e3
"""Largest safety factor shown, as a multiple of the least ones and of the limits: unloaded poses have infinite ones."""
_TITLE = 40
"""Letters of a title beside which that of the next panel has room."""
_MARKS = ("error band", "least of the motion", "limit of the check")
_BAND: dict[str, Any] = {"alpha": 0.22, "linewidth": 0.0}
"""Of the area between both ends of a band."""
_PANEL = 2.1
"""Height of a panel [inches]."""


def envelope_figure(result: EnvelopeResult) -> Chart:
    """Draw a panel per link: safety factor of each load case, band, least value and limit.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    Chart
    """
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    (angles, label), unit = abscissa(result), "deg" if result.moved.motion.instants is None else "%"
    names = list(result.case.load_cases)
    with rc_context(STYLE), quiet_glyphs():
        rows = (len(result.links) + 1) // 2
        figure = Figure(figsize=(WIDTH, _PANEL * rows + 0.7), layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.subplots(rows, 2, squeeze=False, sharex=True)
        panels = grid.ravel().tolist()
        handles: dict[str, Any] = {}
        for axes, (name, link) in zip(panels, result.links.items(), strict=False):
            limits = {
                c.limit
                for c in result.checks
                if c.subject == Subject.link(name) and c.quantity is Quantity.SAFETY_FACTOR
            }
            _panel(axes, angles, link, names, limits, handles, unit)
        for axes in panels[len(result.links) :]:
            axes.remove()
        for axes in panels[max(0, len(result.links) - 2) : len(result.links)]:
            axes.set_xlabel(label, parse_math=False)
            axes.tick_params(labelbottom=True)
        figure.supylabel("safety factor", fontsize=9.0)
        drawn = [i for i, name in enumerate(names) if name in handles]
        handles[_MARKS[0]] = tuple(Patch(**_BAND, color=COLOURS[i % len(COLOURS)]) for i in drawn[: len(COLOURS)])
        shown = [name for name in (*names, *_MARKS) if name in handles]
        legend_above(figure, [handles[name] for name in shown], shown)
        return Chart(figure, style=STYLE)


def stress_pictures(result: EnvelopeResult, links: Iterable[str]) -> tuple[dict[str, Canvas], tuple[str, ...]]:
    """Draw the stress of links at their worst poses.

    Parameters
    ----------
    result : EnvelopeResult
    links : iterable of str
        Their names.

    Returns
    -------
    tuple
        Link -> Canvas, and warnings.
    """
    from alula.reports.figures.figures import plots_of
    from alula.reports.figures.scene import scene_from

    scenes, points = {}, {}
    for name in links:
        link = result.links[name]
        scenes[name] = scene_from(
            link.field,
            link.displacement,
            link.worst.discretisation,
            result.case.part_of(name).section,
            brittle=result.case.material_of(name).brittle,
        )
        points[name] = result.case.links[name].points
    return plots_of(scenes, points)


def abscissa(result: EnvelopeResult) -> tuple[Real, str]:
    """Return the angles of the horizontal axis and their label.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    tuple
        Per cent (n,) of the cycle, where there is one; else angles [degrees] of the drive, or of the coordinate if the
        drive reverses its direction; and the label.
    """
    motion = result.moved.motion
    if motion.instants is not None or result.drive is None:
        return motion.progress, motion.progress_title
    steps = np.diff(result.drive_angles)
    if np.all(steps > 0.0) or np.all(steps < 0.0):
        return np.degrees(result.drive_angles), f"direction of {result.drive.link} (driven) [deg]"
    return np.degrees(result.angles), f"direction of {result.moved.motion.coordinate} [deg]"


def _panel(
    axes: Any,
    angles: Real,
    link: LinkEnvelope,
    names: list[str],
    limits: set[float],
    handles: dict[str, Any],
    unit: str = "deg",
) -> None:
    shown, marks = [], list(limits)
    for name, found in link.load_cases.items():
        i = names.index(name)
        colour, dash = COLOURS[i % len(COLOURS)], DASHES[i // len(COLOURS) % len(DASHES)]
        with np.errstate(divide="ignore"):
            value, low, high = (link.strength / np.maximum(s, 0.0) for s in (found.value, found.high, found.low))
        # Beyond any panel, so that curves leave it upwards where nothing acts.
        far = [np.minimum(curve, 1e6 * _DECADES * np.nanmin(value, initial=np.inf)) for curve in (value, low, high)]
        axes.fill_between(angles, far[1], far[2], color=colour, **_BAND)
        (handles[name],) = axes.plot(angles, far[0], color=colour, linestyle=dash, linewidth=1.6)
        shown += [*value[np.isfinite(value)], *low[np.isfinite(low)]]
        worst = found.safety_factor.value
        if np.isfinite(worst):
            marks += [worst, found.safety_factor.low]
            (handles[_MARKS[1]],) = axes.plot(
                angles[found.pose], worst, marker="o", color=INK, markersize=4.5, markerfacecolor="white",
                linestyle="none", zorder=4, clip_on=False,
            )  # fmt: skip
    for limit in sorted(limits):
        handles[_MARKS[2]] = axes.axhline(limit, color=GROUND, linewidth=1.0, linestyle=(0, (4, 2)))
    axes.set_yscale("log")
    marks = [mark for mark in marks if 0.0 < mark < np.inf]
    if marks:
        ceiling = _DECADES * max(marks)
        axes.set_ylim(min([*marks, *(v for v in shown if v > 0.0)]) / 1.4, min(1.4 * max([*shown, *marks]), ceiling))
        if shown and max(shown) > ceiling:
            axes.annotate(
                f"above {number(ceiling, 2)} not drawn", (0.99, 0.98), xycoords="axes fraction", ha="right", va="top",
                fontsize=7.5, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
            )  # fmt: skip
    axes.set_xlim(float(np.min(angles)), float(np.max(angles)))
    axes.yaxis.set_major_formatter(lambda value, position: plain(value))
    axes.yaxis.set_minor_formatter(lambda value, position: "")
    axes.grid(color="0.9", linewidth=0.6)
    axes.grid(which="minor", color="0.95", linewidth=0.4)
    axes.set_axisbelow(True)
    worst_case = link.worst
    at = angles[worst_case.pose]
    told = f"least {number(worst_case.safety_factor.value, 3)} at {at:.1f} {unit}"
    one_line = f"{link.link}: {told}"
    axes.set_title(
        one_line if len(one_line) <= _TITLE else f"{link.link}:\n{told}",
        loc="left",
        fontsize=9.0,
        parse_math=False,
    )
