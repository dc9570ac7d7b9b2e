"""Natural frequencies over the motion, and over the speed of the drive (Campbell's diagram).

W. Campbell, The Protection of Steam-Turbine Disk Wheels from Axial Vibration, Transactions of the ASME 46 (1924).
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.vibration.harmonics import HIGHEST, Meeting, meetings
from alula.fea.vibration.over_motion import FrequencyHistory
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.plot import Axes, ticks, widest
from alula.reports.figures.sheet.style import GROUND, INK, JOINT_FORCE, WIDTH
from alula.reports.words.numbers import ordinal

Real = NDArray[np.float64]
COLOURS = ("#0067a8", "#00795a", "#7a4fa3", "#8a5200")
"""Of the natural frequencies, from the lowest up; they begin anew after the last."""
_HEIGHT, _ABOVE, _BELOW, _RIGHT, _LETTERS = 230.0, 20.0, 88.0, 26.0, 8.5
"""Of the panels, the room about them and the size of letters [points]."""
_SPEED, _FREQUENCY = "speed of the drive [rpm]", "frequency [Hz]"
UPPER_ENDS = "Bands that go down to 0 are not filled: thin lines are their upper ends"
NO_BANDS = "Frequencies without a band are lines alone"
_SHORT = 3.0
"""Length of a mark at least [points]."""
_FASTER = 1.5
"""Times the stated speed up to which speeds are drawn."""
_APART = 3.0
"""Distance of lines of harmonics at least, of which others are left out from the highest down [points]."""
_FAR = 4.0
"""Natural frequencies that begin above so many times the least one and the driving frequency are not drawn."""


def campbell_diagram(history: FrequencyHistory, *, coordinate: str, unit: str, load_case: str) -> Canvas:
    """Draw natural frequencies over the motion with the harmonics of the drive, and over the speed of the drive.

    Parameters
    ----------
    history : FrequencyHistory
        Of a load case.
    coordinate : str
        Of the motion, for people.
    unit : {"deg", "mm"}
        In which its values are told.
    load_case : str
        Its name.

    Returns
    -------
    Canvas
    """
    history = _everywhere(history)
    shown = _shown(history)
    top = 1.08 * max(float(_upper(history)[:, :shown].max()), 1.2 * history.driving) or 1.0
    left = 40.0 + widest(ticks(0.0, top, most=8))
    over_motion, over_speed = len(history.at) > 1, history.driving > 0.0
    panels = over_motion + over_speed
    sheet = Canvas(72.0 * WIDTH, _ABOVE + _HEIGHT + _BELOW)
    if panels == 0:
        panels, over_motion = 1, True
    wide = (sheet.width - panels * (left + _RIGHT)) / panels
    starts = [left + k * (wide + left + _RIGHT) for k in range(panels)]
    if over_motion:
        at = np.degrees(history.at) if unit == "deg" else history.at
        ends = (float(min(at)), float(max(at))) if len(at) > 1 else (float(at[0]) - 1.0, float(at[0]) + 1.0)
        axes = Axes(box=_box(starts[0], wide), x=ends, y=(0.0, top))
        _over_motion(sheet, axes, history, at, shown, f"{coordinate} [{unit}]")
    if over_speed:
        rpm = 60.0 * history.driving
        axes = Axes(box=_box(starts[-1], wide), x=(0.0, _FASTER * rpm), y=(0.0, top))
        _over_speed(sheet, axes, history, shown)
    _legend(sheet, history, shown, load_case)
    return sheet


def _everywhere(history: FrequencyHistory) -> FrequencyHistory:
    """Return a history without the frequencies that not every pose has."""
    there = np.isfinite(history.frequencies).all(axis=0)
    low, value, high = (c[:, there] for c in (history.low, history.frequencies, history.high))
    return replace(history, low=low, frequencies=value, high=high)


def _upper(history: FrequencyHistory) -> Real:
    """Return the upper ends of bands, and the values of frequencies whose bands have none."""
    return np.where(np.isfinite(history.high), history.high, history.frequencies)


def _filled(history: FrequencyHistory) -> NDArray[np.bool_]:
    """Return which natural frequencies have bands with two ends; others would cover the whole diagram."""
    return np.asarray((np.isfinite(history.high) & (history.low > 0.0)).all(axis=0))


def _box(left: float, wide: float) -> tuple[float, float, float, float]:
    return left, _ABOVE, left + wide, _ABOVE + _HEIGHT


def _shown(history: FrequencyHistory) -> int:
    """Return how many natural frequencies fit on one scale beside the lowest one."""
    begin = np.where(_filled(history), history.low, history.frequencies)
    swinging = begin.max(axis=0)[begin.max(axis=0) > 0.0]  # at 0 it departs
    if not len(swinging):
        return int(begin.shape[1])
    near = begin.min(axis=0) <= _FAR * max(float(swinging[0]), history.driving)
    return int(np.argmin(near)) if not near.all() else len(near)


def _colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def _over_motion(sheet: Canvas, axes: Axes, history: FrequencyHistory, at: Real, shown: int, label: str) -> None:
    moves = len(at) > 1
    title = "Over the motion" if moves else "In the stated pose"
    sheet.write(title, (axes.box[0], axes.box[1] - 5.0), anchor="left bottom", bold=True)
    x, filled = at if moves else np.array(axes.x), _filled(history)
    curves = (history.low, history.high, history.frequencies)
    low, high, value = (np.broadcast_to(c[:, :shown], (len(x), shown)) for c in curves)
    for k in reversed(np.flatnonzero(filled[:shown])):
        edge = np.vstack([np.column_stack([x, low[:, k]]), np.column_stack([x, high[:, k]])[::-1]])
        sheet.area(axes.at(edge), faint(_colour(k), 0.28))
    for harmonic, level in _drawn(_levels(history, axes), axes):
        ends, name = np.array(axes.x), f"{harmonic}×"
        axes.curve(
            sheet, ends, np.full(2, level), GROUND, 0.6, name=name, labels=(label, _FREQUENCY), dashes=(4.0, 2.5)
        )
    for k in range(shown):
        for curve, width, there in ((low, 0.5, filled[k]), (high, 0.5, True), (value, 1.5, True)):
            if there and np.isfinite(curve[:, k]).all():
                name = ordinal(k + 1) + ("" if curve is value else ", band")
                axes.curve(sheet, x, curve[:, k], _colour(k), width, name=name, labels=(label, _FREQUENCY))
    _mark(sheet, axes, history, shown, at)
    axes.frame(sheet)
    if moves:
        axes.scale_x(sheet, label, most=6)
    axes.scale_y(sheet, _FREQUENCY, label_at=axes.box[0] - 30.0 - widest(ticks(*axes.y, most=8)), most=8)
    _name_harmonics(sheet, axes, _levels(history, axes))


def _mark(sheet: Canvas, axes: Axes, history: FrequencyHistory, shown: int, at: Real) -> None:
    """Draw the ranges of the coordinate over which harmonics meet the natural frequencies that are shown."""
    told = np.degrees if at is not history.at else np.asarray
    for met in _met(history, shown):
        for ends in met.ranges:
            first, last = sorted(axes.at(np.column_stack([told(np.array(ends)), [met.frequency] * 2])).tolist())
            wider = max(_SHORT - (last[0] - first[0]), 0.0) / 2.0
            inside = np.clip([first[0] - wider, last[0] + wider], axes.box[0], axes.box[2])
            sheet.line([(x, first[1]) for x in inside], JOINT_FORCE, 2.4)


def _met(history: FrequencyHistory, shown: int) -> list[Meeting]:
    """Return the meetings with natural frequencies whose bands are filled."""
    filled = _filled(history)
    return [met for met in meetings(history) if met.mode <= shown and filled[met.mode - 1]]


def _levels(history: FrequencyHistory, axes: Axes) -> list[tuple[int, float]]:
    """Return the harmonics that lie on the scale."""
    found = [(n, n * history.driving) for n in range(1, HIGHEST + 1) if history.driving > 0.0]
    return [(n, level) for n, level in found if level < axes.y[1]]


def _drawn(levels: Sequence[tuple[int, float]], axes: Axes) -> list[tuple[int, float]]:
    """Return the harmonics whose lines lie apart, from the highest down."""
    kept: list[tuple[int, float]] = []
    for harmonic, level in reversed(levels):
        if not kept or axes.at([0.0, level])[1] - axes.at([0.0, kept[-1][1]])[1] >= _APART:
            kept.append((harmonic, level))
    return kept


def _name_harmonics(sheet: Canvas, axes: Axes, levels: Sequence[tuple[int, float]]) -> None:
    """Write 1×, 2×, ... beside the ends of their lines: the highest, then from the lowest up those that have room."""
    taken: list[float] = []
    drawn = _drawn(levels, axes)
    for harmonic, level in (*drawn[:1], *reversed(drawn[1:])):
        x, y = axes.at([axes.x[1], level])
        if all(abs(y - one) >= 1.15 * _LETTERS for one in taken):
            sheet.write(f"{harmonic}×", (x + 4.0, y), anchor="left middle", colour=GROUND, size=_LETTERS)
            taken.append(float(y))


def _over_speed(sheet: Canvas, axes: Axes, history: FrequencyHistory, shown: int) -> None:
    sheet.write("Over the speed of the drive", (axes.box[0], axes.box[1] - 5.0), anchor="left bottom", bold=True)
    filled, value = _filled(history)[:shown], history.frequencies[:, :shown]
    low = np.where(filled, history.low[:, :shown], value).min(axis=0)
    high = np.where(filled, history.high[:, :shown], value).max(axis=0)
    upper = _upper(history)[:, :shown].max(axis=0)
    for k in reversed(range(shown)):
        corners = [(x, y) for x, y in zip((*axes.x, *axes.x[::-1]), (low[k], low[k], high[k], high[k]), strict=True)]
        sheet.area(axes.at(corners), faint(_colour(k), 0.28))
        for level, width in ((low[k], 0.8), (high[k], 0.8), (upper[k], 0.5)):
            ends, name = np.array(axes.x), f"{ordinal(k + 1)}, band"
            axes.curve(sheet, ends, np.full(2, level), _colour(k), width, name=name, labels=(_SPEED, _FREQUENCY))
    drawn = {harmonic for harmonic, _ in _drawn(_rays(axes), axes)}
    for harmonic in range(1, HIGHEST + 1):
        rise = harmonic / 60.0
        end = min(axes.x[1], axes.y[1] / rise)
        if harmonic in drawn:
            ray, labels = np.array([0.0, end]), (_SPEED, _FREQUENCY)
            axes.curve(sheet, ray, rise * ray, GROUND, 0.6, name=f"{harmonic}×", labels=labels, dashes=(4.0, 2.5))
        for k in (k for k in range(shown) if filled[k]):
            first, last = low[k] / rise, min(high[k] / rise, end)
            if first <= last:
                sheet.line(axes.at([(first, rise * first), (last, rise * last)]), JOINT_FORCE, 2.0)
    stated = 60.0 * history.driving
    upright, name = np.array([0.0, axes.y[1]]), "stated speed"
    axes.curve(sheet, np.full(2, stated), upright, INK, 1.2, name=name, labels=(_SPEED, _FREQUENCY))
    for _, level in _levels(history, axes):
        if np.any(filled & (low <= level) & (level <= high)):
            sheet.ring(axes.at([stated, level]), 3.6, JOINT_FORCE, 1.3)
    axes.frame(sheet)
    axes.scale_x(sheet, _SPEED, most=5)
    axes.scale_y(sheet, _FREQUENCY, label_at=axes.box[0] - 30.0 - widest(ticks(*axes.y, most=8)), most=8)
    _name_rays(sheet, axes)


def _rays(axes: Axes) -> list[tuple[int, float]]:
    """Return every harmonic and its frequency at the highest speed that is drawn."""
    return [(n, n / 60.0 * axes.x[1]) for n in range(1, HIGHEST + 1)]


def _name_rays(sheet: Canvas, axes: Axes) -> None:
    """Write 1×, 2×, ... at the ends of the rays: at the right side, then along the top; those that have room."""
    _name_harmonics(sheet, axes, [(n, level) for n, level in _rays(axes) if level <= axes.y[1]])
    last_x = -math.inf
    for harmonic in range(HIGHEST, 0, -1):
        rise = harmonic / 60.0
        if rise * axes.x[1] > axes.y[1]:
            x, y = axes.at([axes.y[1] / rise, axes.y[1]])
            if x - last_x >= 2.2 * _LETTERS and x > axes.box[0] + 148.0:
                sheet.write(f"{harmonic}×", (x, y - 3.0), anchor="center bottom", colour=GROUND, size=_LETTERS)
                last_x = float(x)


def _legend(sheet: Canvas, history: FrequencyHistory, shown: int, load_case: str) -> None:
    """Say below the panels what the colours mean."""
    filled = _filled(history)[:shown]
    x, y = 14.0, sheet.height - 48.0
    for k in range(shown):
        if filled[k]:
            sheet.area([(x, y - 4.0), (x + 18.0, y - 4.0), (x + 18.0, y + 4.0), (x, y + 4.0)], faint(_colour(k), 0.28))
        sheet.line([(x, y), (x + 18.0, y)], _colour(k), 1.5)
        text = f"{ordinal(k + 1)} natural frequency" if k == shown - 1 else ordinal(k + 1)
        x = sheet.write(text, (x + 23.0, y), anchor="left middle", size=_LETTERS).box[2] + 12.0
    if history.driving > 0.0:
        x, y = 14.0, y + 13.0
        sheet.line([(x, y), (x + 18.0, y)], GROUND, 0.6, dashes=(4.0, 2.5))
        x = sheet.write("harmonic of the drive", (x + 23.0, y), anchor="left middle", size=_LETTERS).box[2] + 12.0
        if filled.any():
            sheet.line([(x, y), (x + 18.0, y)], JOINT_FORCE, 2.4)
            sheet.write(
                "harmonic within the band of a natural frequency", (x + 23.0, y), anchor="left middle", size=_LETTERS
            )
        speed = f"load case {load_case}: {60.0 * history.driving:.4g} rpm (upright line), {history.driving:.3g} Hz"
        y += 13.0
        sheet.write(speed, (14.0, y), anchor="left middle", size=_LETTERS)
    if not filled.all():
        ended = np.isfinite(history.high[:, :shown][:, ~filled]).all()
        text, harmonics = (UPPER_ENDS, "any harmonic below") if ended else (NO_BANDS, "any harmonic")
        text += f"; {harmonics} may meet them." if history.driving > 0.0 else "."
        sheet.write(text, (14.0, y + 13.0), anchor="left middle", size=_LETTERS)
