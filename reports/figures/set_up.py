"""The set-up of the tests of a level: their load lines about the links, and profiles of force and tilt over time."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from alula.fea.level.check_level import LevelResult
from alula.geometry.linkage.pose import Pose
from alula.loads.records.attachment import Attachment
from alula.loads.stated.level_spec import LevelSpec, LevelStep, turned
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.sheet.style import GROUND, INK, LINK, WIDTH
from alula.reports.words.numbers import plain

Real = NDArray[np.float64]
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a5200", "#5d6b78")
_TALLEST, _NARROWEST = 330.0, 150.0
"""Height of a view at most, and its width at least [points]."""
_LEFT, _RIGHT, _ABOVE, _BELOW, _ROW = 52.0, 10.0, 18.0, 44.0, 13.0
_PLOT = 96.0
"""Height of a curve over time [points]."""
_PAD = 0.08
"""Room about what is drawn, as a share of its largest extent."""


def set_up_drawing(result: LevelResult) -> Canvas:
    """Draw the load lines of all tests, to scale, in the axes of the standard.

    Parameters
    ----------
    result : LevelResult

    Returns
    -------
    Canvas
        On the left forward and up, on the right outward and up.
    """
    level, pose = result.level, next(iter(result.tests.values())).result.pose
    links = {link: [(link, point) for point in record.points] for link, record in pose.linkage.links.items()}
    places = {at: _place(level, pose, *at) for own in links.values() for at in own}
    lines = _lines(result)
    every = np.array([*places.values(), *(end for ends, _ in lines for end in ends), np.zeros(3)])
    low, high = every.min(axis=0), every.max(axis=0)
    low, high = low - _PAD * (high - low).max(), high + _PAD * (high - low).max()
    wide = (72.0 * WIDTH - 2.0 * _LEFT - 2.0 * _RIGHT) / 2.0
    scale = min(_TALLEST / (high - low)[2], wide / (high - low)[:2].max())
    tall, half = float(scale * (high - low)[2]), max(scale * (high - low)[:2].max(), _NARROWEST) / scale / 2.0
    sheet = Canvas(72.0 * WIDTH, _ABOVE + tall + _BELOW + _ROW * (len(lines) + 2))
    for k, (name, title) in enumerate((("forward", "From the side"), ("outward", "From the front"))):
        left, middle = _LEFT + k * (wide + _LEFT + _RIGHT), (low + high)[k] / 2.0
        box = (left, _ABOVE, left + 2.0 * half * scale, _ABOVE + tall)
        axes = Axes(box=box, x=(float(middle - half), float(middle + half)), y=(float(low[2]), float(high[2])))
        sheet.write(f"{title}, to scale", (left, _ABOVE - 4.0), anchor="left bottom")
        axes.scale_x(sheet, f"{name} [mm]", most=5, grid=True)
        axes.scale_y(sheet, "up [mm]", label_at=left - 42.0, grid=True)
        axes.frame(sheet)
        for at in ([(0.0, axes.y[0]), (0.0, axes.y[1])], [(axes.x[0], 0.0), (axes.x[1], 0.0)]):
            sheet.line(axes.at(at), GROUND, 0.5, (6.0, 3.0))
        _links(sheet, axes, places, result, k)
        for number, (ends, _) in enumerate(lines):
            _line(sheet, axes, ends, [_entry(places, level.enters), _entry(places, level.leaves)], number, k)
    bottom = _ABOVE + tall + _BELOW
    rows: list[tuple[str, tuple[float, float] | None, str]]
    rows = [(_COLOURS[number % len(_COLOURS)], None, ", ".join(names)) for number, (_, names) in enumerate(lines)]
    rows += [(INK, (2.0, 2.0), "rigid levers to where the load line enters and leaves"), (LINK, None, "links")]
    for number, (colour, dashes, text) in enumerate(rows):
        y = bottom + _ROW * (number + 0.5)
        sheet.line([(_LEFT, y), (_LEFT + 18.0, y)], colour, 4.0 if text == "links" else 1.6, dashes)
        sheet.write(text, (_LEFT + 24.0, y), anchor="left middle", size=8.5)
    return sheet


def profile_drawing(step: LevelStep) -> Canvas:
    """Draw force and tilt of a profile over time, row by row.

    Parameters
    ----------
    step : LevelStep
        With a profile.

    Returns
    -------
    Canvas
    """
    times = np.array([row.time for row in step.rows])
    curves = [("force [N]", np.array([row.force for row in step.rows]), _COLOURS[0])]
    if any(row.tilt for row in step.rows):
        curves.append(("tilt [deg]", np.degrees([row.tilt for row in step.rows]), _COLOURS[1]))
    sheet = Canvas(72.0 * WIDTH, len(curves) * (_PLOT + _ABOVE) + _BELOW)
    for k, (label, values, colour) in enumerate(curves):
        top, low = _ABOVE + k * (_PLOT + _ABOVE), min(float(values.min()), 0.0)
        high = max(float(values.max()), 0.0)
        room = _PAD * (high - low)
        axes = Axes(
            box=(_LEFT, top, 72.0 * WIDTH - 2.0 * _RIGHT, top + _PLOT),
            x=(float(times[0]), float(times[-1])),
            y=(low - room, high + room),
        )
        axes.scale_y(sheet, label, label_at=_LEFT - 42.0, most=4, grid=True)
        if k == len(curves) - 1:
            axes.scale_x(sheet, "time [s]", grid=True)
        axes.frame(sheet)
        points = axes.at(np.column_stack([times, values]))
        sheet.line(points, colour, 1.6)
        for at in points:
            sheet.disc(at, 1.8, colour)
    return sheet


def _lines(result: LevelResult) -> list[tuple[Real, list[str]]]:
    """Return the ends of each load line (2, 3) in the axes of the standard, and the tests that have it.

    Of a profile those of the least and of the largest tilt of all states that load, and that of forces beside it.
    """
    found: list[tuple[Real, list[str]]] = []
    for name, test in result.tests.items():
        loading = [state for state in test.spec.states if state.force > 0.0]
        tilts = [state.tilt for state in loading]
        beside = [state.tilt for state in loading if state.time is None]
        for tilt in dict.fromkeys((min(tilts), max(tilts), *beside)):
            ends = turned(test.spec, tilt)
            told = f"{name}, tilted by {plain(float(np.degrees(tilt)))}°" if tilt else name
            alike = next((names for other, names in found if np.array_equal(other, ends)), None)
            if alike is None:
                found.append((ends, [told]))
            else:
                alike.append(told)
    return found


def _place(level: LevelSpec, pose: Pose, link: str, point: str) -> Real:
    """Return where a point of a link lies (3,) in the axes of the standard."""
    at = np.array([*pose.position(link, point), pose.linkage.heights.get(link, 0.0)])
    return level.seen(at)


def _entry(places: Mapping[tuple[str, str], Real], at: Attachment | None) -> Real | None:
    return None if at is None else places[at.link, at.at]


def _links(sheet: Canvas, axes: Axes, places: Mapping[tuple[str, str], Real], result: LevelResult, k: int) -> None:
    for link, record in result.case.links.items():
        points = axes.at(np.array([places[link, point][[k, 2]] for point in record.points]))
        colour = GROUND if record.ground else LINK
        if len(points) > 1:
            sheet.line(points, colour, 4.0)
        for at in points:
            sheet.disc(at, 2.6, colour, "#ffffff", 0.6)


def _line(sheet: Canvas, axes: Axes, ends: Real, entries: list[Real | None], number: int, k: int) -> None:
    """Draw a load line with its arrow from top to bottom, and the levers from its ends."""
    colour, drawn = _COLOURS[number % len(_COLOURS)], axes.at(ends[:, [k, 2]])
    for end, entry in zip(drawn, entries, strict=True):
        if entry is not None:
            sheet.line([end, axes.at(entry[[k, 2]])], INK, 0.9, (2.0, 2.0))
    sheet.arrow(drawn[0], drawn[1], colour, 1.6)
    sheet.disc(drawn[0], 2.4, colour)
