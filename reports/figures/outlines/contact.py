"""Two outlines of links in layers where they touch first, or come nearest."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.clearance.least import Gap
from alula.loads.states.clearance import Clearance
from alula.reports.figures.outlines.assembly import FILL, LAYERS, Placed, border, dark, draw
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.labels import place_labels
from alula.reports.figures.sheet.letters import extent
from alula.reports.figures.sheet.plot import Axes, ticks, widest
from alula.reports.figures.sheet.style import JOINT_FORCE, WIDTH
from alula.reports.words.numbers import number

Real = NDArray[np.float64]

_RIGHT, _ABOVE, _BELOW, _LETTERS, _ROW = 16.0, 18.0, 40.0, 8.5, 13.0
"""Room about the drawings, size of letters and height of a line of them [points]."""
_MARGIN, _CLOSE = 0.04, 0.1
"""Room about the outlines, and half the width of a close-up, over the size of what is drawn."""


def contact_drawing(found: Clearance) -> Canvas:
    """Draw the two outlines that touch first, or come nearest, at that pose, with a close-up.

    Parameters
    ----------
    found : Clearance
        With a gap at least.

    Returns
    -------
    Canvas
    """
    gap = found.shown
    assert gap is not None
    placed = Placed(found.assembly, found.placed(gap))
    low, high = placed.bounds
    margin = _MARGIN * float((high - low).max())
    low, high = low - margin, high + margin
    left = 34.0 + widest(ticks(float(low[1]), float(high[1]), most=7))
    space = 52.0
    wide = (72.0 * WIDTH - left - space - _RIGHT) / 2.0
    tall = min(max(wide * (high - low)[1] / (high - low)[0], wide), 1.4 * wide)
    sheet = Canvas(72.0 * WIDTH, _ABOVE + tall + _BELOW + 2.0 * _ROW)
    size = float(max((high - low) / (wide, tall)))
    x, y = gap.place
    close = max(_CLOSE * float(np.hypot(*(high - low))), 1.5 * abs(gap.value)) / wide * 2.0
    views = [
        ("The whole linkage", left, (low + high) / 2.0, size),
        ("Close-up", left + wide + space, np.array([x, y]), close),
    ]
    for title, at, centre, per_point in views:
        half = per_point * np.array([wide, tall]) / 2.0
        (x0, y0), (x1, y1) = centre - half, centre + half
        axes = Axes(box=(at, _ABOVE, at + wide, _ABOVE + tall), x=(float(x0), float(x1)), y=(float(y0), float(y1)))
        sheet.write(title, (at, _ABOVE - 4.0), anchor="left bottom")
        _pair(sheet, axes, placed, gap, at - left + 12.0)
    _told(sheet, found, gap, _ABOVE + tall + _BELOW)
    return sheet


def _pair(sheet: Canvas, axes: Axes, placed: Placed, gap: Gap, label_at: float) -> None:
    """Draw two outlines within a window, the others as thin lines, and the place between them."""
    import shapely

    axes.scale_x(sheet, "x [mm]", most=5, grid=True)
    axes.scale_y(sheet, "y [mm]", label_at=label_at, most=7, grid=True)
    window = shapely.box(axes.x[0], axes.y[0], axes.x[1], axes.y[1])
    shapes: Mapping[str, Any] = {
        **{f"link {name}": shape for name, shape in placed.links.items()},
        **{f"pin {name}": shape for name, shape in placed.pins.items()},
    }
    for name, shape in shapes.items():
        if name not in gap.names:
            draw(sheet, axes, shape.intersection(window), "", "#c3ccd4", 0.6)
    obstacles, labels = [axes.at(_filled_around(gap.place, axes))], []
    pair = sorted(gap.names, key=lambda name: -shapes[name].area)
    for name, colour in zip(pair, (LAYERS[0], LAYERS[1]), strict=True):
        shown = shapes[name].intersection(window)
        draw(sheet, axes, shown, faint(colour, FILL), colour, 0.9)
        if not shown.is_empty:
            obstacles.append(axes.at(border(shown)))
            inside = shown.representative_point().coords[0]
            labels.append((axes.at(np.array([inside])), name, dark(colour)))
    axes.frame(sheet)
    between = np.asarray(shapely.shortest_line(*(shapes[name] for name in gap.names)).coords)
    if gap.value > 0.0 and abs(float(np.hypot(*(between[1] - between[0]))) - gap.value) < 0.01 * gap.value:
        sheet.line(axes.at(between), JOINT_FORCE, 1.4)  # else pieces at other heights are nearer
    sheet.ring(axes.at(gap.place), 5.0, JOINT_FORCE, 1.4)
    place_labels(sheet, axes.box, labels, np.vstack(obstacles), size=_LETTERS)


def _filled_around(place: ArrayLike, axes: Axes) -> Real:
    """Points (n, 2) about a place, over which no label is to stand."""
    per_point = (axes.x[1] - axes.x[0]) / (axes.box[2] - axes.box[0])
    steps = per_point * np.linspace(-7.0, 7.0, 12)
    x, y = np.meshgrid(steps, steps)
    return np.asarray(place) + np.column_stack([x.ravel(), y.ravel()])


def _told(sheet: Canvas, found: Clearance, gap: Gap, top: float) -> None:
    """Say below what is shown."""
    what = "first contact" if found.contact is not None else f"least gap, {number(gap.value, 3)} mm,"
    text = f"{what} of {' and '.join(gap.names)}"
    wide = extent(text, _LETTERS)[0]
    left = (sheet.width - wide - 16.0) / 2.0
    sheet.ring((left + 5.0, top + 0.5 * _ROW), 5.0, JOINT_FORCE, 1.4)
    sheet.write(text, (left + 16.0, top + 0.5 * _ROW), anchor="left middle", size=_LETTERS)
    sheet.write(found.where(gap), (sheet.width / 2.0, top + 1.5 * _ROW), size=_LETTERS)
