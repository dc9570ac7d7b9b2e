"""A four-bar at the precision points of its synthesis."""

import io
import math

import numpy as np
from numpy.typing import NDArray

from alula.geometry.mechanisms.synthesis import DRIVES, PrecisionPoint, Synthesis
from alula.reports.words.four_bar import ANGLES, seen, unit_of

_LABELS = {"O2": (-23, -13), "A": (5, 8), "B": (8, 6), "O4": (8, -13)}
"""Places of the joints' names beside them, in points."""
_COLOURS = ("#0072b2", "#d55e00", "#009e73")


def joints_at(synthesis: Synthesis, point: PrecisionPoint) -> NDArray[np.float64]:
    """Return the joints of the linkage at a precision point.

    Parameters
    ----------
    synthesis : Synthesis
    point : PrecisionPoint

    Returns
    -------
    array
        O2, A, B, O4 (4, 2) in the unit of d.
    """
    bar = synthesis.four_bar
    psi = point.psi + math.pi * synthesis.c_turned
    crank = bar.a * np.array([math.cos(point.phi), math.sin(point.phi)])
    output = np.array([bar.d + bar.c * math.cos(psi), bar.c * math.sin(psi)])
    return np.array([[0.0, 0.0], crank, output, [bar.d, 0.0]])


def precision_points_png(synthesis: Synthesis) -> bytes:
    """Draw the linkage at the three precision points, one below the other.

    Parameters
    ----------
    synthesis : Synthesis

    Returns
    -------
    bytes
        A PNG file.
    """
    from matplotlib.figure import Figure

    unit, factor = unit_of(synthesis)
    shapes = [joints_at(synthesis, point) / factor for point in synthesis.points]
    everything = np.concatenate(shapes)
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = 0.09 * float(np.max(high - low))
    width, tall = (high - low) + 2.0 * margin
    panel = float(np.clip(8.0 * tall / width, 1.6, 6.0))
    figure = Figure(figsize=(9.0, 3 * (panel + 0.55) + 0.9), layout="constrained")
    for number, (axes, shape) in enumerate(zip(figure.subplots(3, 1, sharex=True), shapes, strict=True), start=1):
        point = synthesis.points[number - 1]
        axes.set_aspect("equal")
        axes.set_xlim(low[0] - margin, high[0] + margin)
        axes.set_ylim(low[1] - margin, high[1] + margin)
        axes.grid(color="0.92", linewidth=0.8)
        axes.set_axisbelow(True)
        axes.plot(*shape[[0, 3]].T, color="0.6", linewidth=1.2, linestyle=(0, (5, 3)), label="d (ground)")
        for link, ends, colour in zip("abc", ([0, 1], [1, 2], [3, 2]), _COLOURS, strict=True):
            axes.plot(
                *shape[ends].T, color=colour, linewidth=3.0, solid_capstyle="round", label=f"{link} ({ANGLES[link]})"
            )
        axes.plot(*shape.T, "o", color="black", markerfacecolor="white", markersize=6, zorder=4)
        for (name, off), here in zip(_LABELS.items(), shape, strict=True):
            axes.annotate(name, here, textcoords="offset points", xytext=off, fontsize=9)
        angles = (
            f"θ {math.degrees(point.theta):.4g}°, ψ {math.degrees(point.psi):.4g}°, φ {math.degrees(point.phi):.4g}°"
        )
        branches = ", ".join(f"{drive} {seen(point, drive)}" for drive in DRIVES)
        axes.set_title(f"Point {number}: {angles}; branch seen from {branches}", fontsize=10, loc="left")
        axes.set_ylabel(f"y [{unit}]")
        if number == 3:
            axes.set_xlabel(f"x [{unit}]")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    stream = io.BytesIO()
    figure.savefig(stream, dpi=130, format="png", bbox_inches="tight")
    return stream.getvalue()
