"""Normal force, shear force and bending moment along a link."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.theory import BeamCheck
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.labels import heights, stacked, write_stacked
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.sheet.style import GROUND, INK, WIDTH
from alula.reports.words.numbers import number

Real = NDArray[np.float64]
_BESIDE = 0.03
"""Room beside the link, as a share of its length."""
_ALONG = "x along the link [mm]"
_NIL = 1e-9
"""Share of the largest value below which a quantity is drawn as zero."""
_LEFT, _RIGHT, _LABEL = 80.0, 517.0, 20.0
_PITCH, _MANY, _BETWEEN, _BELOW = 90.0, 66.0, 16.0, 18.0
"""Sides of the panels, middle of their labels, their distance where they are up to three and where they are more, and
the room between and below them [points]. The lower panels let a printed sheet hold the rows of two links."""
_COLOURS = {"N": "#7a4fa3", "V": "#00795a", "M": "#c8460b", "T": "#0067a8", "σ": "#8a1538"}


def internal_force_diagram(beam: BeamCheck, points: dict[str, float]) -> Canvas:
    """Draw N, V and M of a link over its length, with extreme values.

    Out-of-plane shear, moment and torque are drawn where they are not zero, and of a part from a file, whose section
    varies, the largest stress of each section.

    Parameters
    ----------
    beam : BeamCheck
    points : dict
        Name -> x of the link's pins and load points [mm].

    Returns
    -------
    Canvas
    """
    rows: list[tuple[str, str, Real]] = [("N", "N [N]", beam.n), ("V", "V [N]", beam.v_y), ("M", "M [N·mm]", beam.m_z)]
    length = float(np.ptp(beam.x))
    force = max(float(np.abs(v).max()) for v in (beam.n, beam.v_y, beam.v_z))
    moment = max(float(np.abs(v).max()) for v in (beam.t, beam.m_y, beam.m_z))
    scale = max(force, moment / length)
    for kind, label, values, size in (
        ("V", "V out\nof plane\n[N]", beam.v_z, scale),
        ("M", "M out\nof plane\n[N·mm]", beam.m_y, scale * length),
        ("T", "torque\n[N·mm]", beam.t, scale * length),
    ):
        if np.abs(values).max() > _NIL * size:
            rows.append((kind, label, values))
    if beam.cuts:
        rows.append(("σ", "stress [MPa]", beam.equivalent))
    low, wide = float(beam.x[0]), _RIGHT - _LEFT
    along = (low - _BESIDE * length, low + (1.0 + _BESIDE) * length)
    names = stacked(points, [wide * (x - along[0]) / (along[1] - along[0]) for x in points.values()])
    top = 9.0 + heights(names)
    pitch = _PITCH if len(rows) <= 3 else _MANY
    sheet = Canvas(72.0 * WIDTH, top + pitch * len(rows) + _BELOW)
    for k, (kind, label, values) in enumerate(rows):
        size = float(values.max()) if kind == "σ" else scale if kind in "NV" else scale * length
        values = np.where(np.abs(values) > _NIL * size, values, 0.0)
        box = (_LEFT, top + pitch * k, _RIGHT, top + pitch * (k + 1) - _BETWEEN)
        axes = Axes(box=box, x=along, y=_room(values))
        for x in points.values():
            place = float(axes.at([x, 0.0])[0])
            sheet.line([(place, box[1]), (place, box[3])], GROUND, 0.6, dashes=(1.2, 1.8))
        _panel(sheet, axes, beam.x, values, (kind, label))
    axes.frame(sheet, "bottom")
    axes.scale_x(sheet, _ALONG)
    write_stacked(sheet, names, _LEFT, top)
    return sheet


def _room(values: Real) -> tuple[float, float]:
    """Return the ends of a scale with room for the extreme values' numbers."""
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    room = high - low
    if room == 0.0:
        return -1.0, 1.0
    return low - (0.34 if low < 0.0 else 0.1) * room, high + (0.34 if high > 0.0 else 0.1) * room


def _panel(sheet: Canvas, axes: Axes, x: Real, values: Real, row: tuple[str, str]) -> None:
    (kind, label), colour = row, _COLOURS[row[0]]
    curve = axes.at(np.column_stack([x, values]))
    zero = axes.at([[x[0], 0.0], [x[-1], 0.0]])
    sheet.area(np.vstack([zero[:1], curve, zero[1:]]), faint(colour, 0.16))
    axes.curve(sheet, x, values, colour, 1.4, name=kind, labels=(_ALONG, label))
    sheet.line([(axes.box[0], zero[0, 1]), (axes.box[2], zero[0, 1])], INK, 0.7)
    axes.frame(sheet, "left")
    if not values.any():
        axes.scale_y(sheet, label, label_at=_LABEL, most=1)
        sheet.write("zero all along", axes.at([x.mean(), 0.0]) - (0.0, 4.0), anchor="center bottom", size=8.5)
        return
    unit = 10.0 ** axes.scale_y(sheet, label, label_at=_LABEL, most=4)
    for pick, sign in ((np.argmax, 1), (np.argmin, -1)):
        i = int(pick(values))
        if sign * values[i] <= 0.0:
            continue
        level = np.flatnonzero(np.isclose(values, values[i], rtol=1e-9, atol=0.0))
        at = float(x[level].mean()) if len(level) > 1 and np.all(np.diff(level) == 1) else float(x[i])
        share = (at - x[0]) / np.ptp(x)
        place = axes.at([at, values[i]])
        sheet.disc(place, 1.6, colour)
        side = "left" if share < 0.08 else "right" if share > 0.92 else "center"
        sheet.write(
            number(float(values[i]) / unit),
            place - (0.0, 4.0 * sign),
            anchor=f"{side} {'bottom' if sign > 0 else 'top'}",
            colour=colour,
            size=8.5,
            halo=2.5,
        )
