"""Normal force, shear force and bending moment along a link (matplotlib, PNG)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.beam.theory import BeamCheck
from reports.figures.drawings import DPI, GROUND, INK, STYLE, WIDTH, as_png
from reports.figures.labels import heights, stacked, write_stacked
from reports.words.wording import number

Real = NDArray[np.float64]
_BESIDE = 0.03
"""Room beside the link, as a share of its length."""
_NIL = 1e-9
"""Share of the largest value below which a quantity is drawn as zero."""
_COLOURS = {"N": "#7a4fa3", "V": "#00795a", "M": "#c8460b", "T": "#0067a8"}


def internal_force_diagram(beam: BeamCheck, points: dict[str, float]) -> bytes:
    """Draw N, V and M of a link over its length, with extreme values.

    Out-of-plane shear, moment and torque are drawn where they are not zero.

    Parameters
    ----------
    beam : BeamCheck
    points : dict
        Name -> x of the link's pins and load points [mm].

    Returns
    -------
    bytes
        A PNG.
    """
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows: list[tuple[str, str, Real]] = [("N", "N [N]", beam.n), ("V", "V [N]", beam.v_y), ("M", "M [N·mm]", beam.m_z)]
    length = float(np.ptp(beam.x))
    force = max(float(np.abs(v).max()) for v in (beam.n, beam.v_y, beam.v_z))
    moment = max(float(np.abs(v).max()) for v in (beam.t, beam.m_y, beam.m_z))
    scale = max(force, moment / length)
    for kind, label, values, size in (
        ("V", "V out of\nplane [N]", beam.v_z, scale),
        ("M", "M out of\nplane [N·mm]", beam.m_y, scale * length),
        ("T", "torque [N·mm]", beam.t, scale * length),
    ):
        if np.abs(values).max() > _NIL * size:
            rows.append((kind, label, values))
    with rc_context(STYLE):
        low = float(beam.x[0])
        wide = (0.97 - 0.12) * WIDTH
        names = stacked(points, [wide * (x - low + _BESIDE * length) / ((1.0 + 2.0 * _BESIDE) * length)
                                 for x in points.values()])  # fmt: skip
        top = 0.12 + heights(names)
        figure = Figure(figsize=(WIDTH, 1.25 * len(rows) + 0.4 + top), dpi=DPI)
        FigureCanvasAgg(figure)
        all_axes = figure.subplots(len(rows), 1, sharex=True, squeeze=False)[:, 0]
        figure.subplots_adjust(left=0.12, right=0.97, top=1.0 - top / figure.get_figheight(),
                               bottom=0.45 / figure.get_figheight(), hspace=0.22)  # fmt: skip
        for axes, (kind, label, values) in zip(all_axes, rows, strict=True):
            size = scale if kind == "N" or kind == "V" else scale * length
            _panel(axes, beam.x, np.where(np.abs(values) > _NIL * size, values, 0.0), label, _COLOURS[kind])
            for x in points.values():
                axes.axvline(x, color=GROUND, linewidth=0.6, linestyle=(0, (2, 3)), zorder=0)
        write_stacked(all_axes[0], names, wide)
        all_axes[-1].spines["bottom"].set_visible(True)
        all_axes[-1].tick_params(axis="x", length=3.0)
        all_axes[-1].set_xlabel("x along the link [mm]")
        figure.align_ylabels(all_axes)
        return as_png(figure)


def _panel(axes: Any, x: Real, values: Real, label: str, colour: str) -> None:
    from matplotlib.patheffects import withStroke

    axes.fill_between(x, values, color=colour, alpha=0.16, linewidth=0.0)
    axes.plot(x, values, color=colour, linewidth=1.4)
    axes.axhline(0.0, color=INK, linewidth=0.7)
    axes.set_ylabel(label)
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    room = high - low
    axes.set_xlim(x[0] - _BESIDE * np.ptp(x), x[-1] + _BESIDE * np.ptp(x))
    axes.spines[["top", "right", "bottom"]].set_visible(False)
    axes.tick_params(axis="x", length=0.0)
    if low == high:
        axes.set_ylim(-1.0, 1.0)
        axes.set_yticks([0.0])
        axes.annotate("zero all along", (0.5, 0.5), xycoords="axes fraction", xytext=(0, 5),
                      textcoords="offset points", ha="center", fontsize=8.5)  # fmt: skip
        return
    axes.set_ylim(low - (0.34 if low < 0.0 else 0.1) * room, high + (0.34 if high > 0.0 else 0.1) * room)
    axes.yaxis.set_major_locator(_locator())
    for pick, sign in ((np.argmax, 1), (np.argmin, -1)):
        i = int(pick(values))
        if sign * values[i] <= 0.0:
            continue
        level = np.flatnonzero(np.isclose(values, values[i], rtol=1e-9, atol=0.0))
        at = float(x[level].mean()) if len(level) > 1 and np.all(np.diff(level) == 1) else float(x[i])
        share = (at - x[0]) / np.ptp(x)
        axes.plot(at, values[i], marker="o", markersize=3.2, color=colour)
        axes.annotate(
            number(float(values[i])), (at, values[i]), xytext=(0, 4 * sign), textcoords="offset points",
            ha="left" if share < 0.08 else "right" if share > 0.92 else "center",
            va="bottom" if sign > 0 else "top", fontsize=8.5, color=colour,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )  # fmt: skip


def _locator() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(nbins=4, steps=[1, 2, 2.5, 5, 10])
