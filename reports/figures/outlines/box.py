"""The box about a linkage over its motion, from above and from the side."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.whole.size import size_band
from alula.geometry.clearance.reach import Standing
from alula.geometry.linkage.placement import Placement
from alula.loads.states.extent import Extent
from alula.reports.figures.outlines.assembly import draw
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.plot import Axes, ticks, widest
from alula.reports.figures.sheet.style import GROUND, INK, JOINT_FORCE, LINK, LOAD, WIDTH
from alula.reports.words.numbers import plain

Real = NDArray[np.float64]

POSES = 17
"""At which outlines are drawn, besides those that reach furthest."""
_TALLEST, _LOWEST = 320.0, 60.0
"""Height of the view from above at most, and of the view from the side at least [points]."""
_RIGHT, _ABOVE, _BELOW, _LETTERS, _ROW = 12.0, 18.0, 40.0, 8.5, 13.0
_PAD = (14.0, 24.0, 30.0, 14.0)
"""Room within the axes for the lines of dimensions: left, top, right, bottom [points]."""
_STRETCHES = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


def box_drawing(found: Extent, limits: Sequence[float] = ()) -> Canvas:
    """Draw the outlines at poses of the motion, with the box about all of them and its lengths.

    Parameters
    ----------
    found : Extent
    limits : sequence of float, optional
        Greatest lengths along x, y and z, of a check [mm].

    Returns
    -------
    Canvas
    """
    box = np.array([[side.value for side in sides] for sides in found.reaches])
    allowed = _allowed(box, limits)
    low, high = np.minimum(box[:, 0], allowed[:, 0]), np.maximum(box[:, 1], allowed[:, 1])
    size = np.maximum(high - low, 1e-3 * float((high - low).max()))
    left = 34.0 + max(widest(ticks(float(low[k]), float(low[k] + size[k]), most=5)) for k in (1, 2))
    wide, (pad_left, pad_top, pad_right, pad_bottom) = 72.0 * WIDTH - left - _RIGHT, _PAD
    scale = min((wide - pad_left - pad_right) / size[0], (_TALLEST - pad_top - pad_bottom) / size[1])
    stretch = next((s for s in _STRETCHES if s * scale * size[2] >= _LOWEST), _STRETCHES[-1])
    views = [(1, scale, "From above, to scale")]
    told = "to scale" if stretch == 1.0 else f"heights stretched {stretch:g} times"
    views.append((2, stretch * scale, f"From the side, along y, {told}"))
    rows, heights = _legend(found, limits), [pad_top + pad_bottom + by * size[axis] for axis, by, _ in views]
    sheet = Canvas(72.0 * WIDTH, sum(heights) + len(views) * (_ABOVE + _BELOW) + _ROW * len(rows) + 6.0)
    top, middle = _ABOVE, (low[0] + high[0]) / 2.0 + (pad_right - pad_left) / 2.0 / scale
    for (axis, by, title), tall in zip(views, heights, strict=True):
        axes = Axes(
            box=(left, top, left + wide, top + tall),
            x=(float(middle - wide / scale / 2.0), float(middle + wide / scale / 2.0)),
            y=(float(low[axis] - pad_bottom / by), float(low[axis] + size[axis] + pad_top / by)),
        )
        sheet.write(title, (left, top - 4.0), anchor="left bottom")
        axes.scale_x(sheet, "x [mm]", grid=True)
        axes.scale_y(sheet, f"{'xyz'[axis]} [mm]", label_at=12.0, most=5, grid=True)
        axes.frame(sheet)
        _swept(sheet, axes, found, axis)
        _boxes(sheet, axes, found, box, limits, axis)
        top += tall + _BELOW + _ABOVE
    for k, (mark, text) in enumerate(rows):
        _row(sheet, mark, text, left, top - _ABOVE + _ROW * (k + 0.5))
    return sheet


def _allowed(box: Real, limits: Sequence[float]) -> Real:
    """Return the box of the limits, about the middle of the linkage's; that of the linkage without limits."""
    if not limits:
        return box
    return np.asarray(box.mean(axis=1)[:, None] + np.array(limits)[:, None] / 2.0 * np.array([-1.0, 1.0]))


def _swept(sheet: Canvas, axes: Axes, found: Extent, axis: int) -> None:
    """Draw the outlines at poses of the motion, faint, and in the stated pose; pins in the latter alone."""
    over, seen = found.shown(POSES), _above if axis == 1 else _side
    moved = [over.chosen(slice(k, k + 1)) for k in range(len(over.q))] if found.motion is not None else []
    links = [one for one in found.outlines if one[1].point is None]
    swept = [seen(one, place) for one in links for place in moved]
    stated = [seen(one, found.stated) for one in found.outlines]
    for shapes, fill, edge in (
        (swept, faint(LINK, 0.35), faint(LINK, 0.9) if axis == 1 else ""),
        (stated, faint(LOAD, 0.35), LOAD),
    ):
        for shape in shapes:
            _one(sheet, axes, shape, fill, "")
        for shape in shapes if edge else ():  # over all fillings
            _one(sheet, axes, shape, "", edge)


def _above(one: Standing, place: Placement) -> Any:
    """Return an outline as seen along the pins."""
    from shapely.affinity import affine_transform

    shape, spot = one
    turn, at = complex(place.direction(spot.link)[0]), complex(spot.origin(place)[0])
    return affine_transform(shape.polygon, [turn.real, -turn.imag, turn.imag, turn.real, at.real, at.imag])


def _side(one: Standing, place: Placement) -> Any:
    """Return an outline as seen along y: its pieces between their heights."""
    import shapely

    shape, spot = one
    turn, at = complex(place.direction(spot.link)[0]), complex(spot.origin(place)[0])
    pieces = []
    for core in shape.cores:
        x = (turn * core.corners + at).real
        pieces.append(shapely.box(x.min() - core.radius, core.low, x.max() + core.radius, core.high))
    return shapely.union_all(pieces)


def _one(sheet: Canvas, axes: Axes, shape: Any, fill: str, edge: str) -> None:
    import shapely

    if shape.geom_type in ("MultiPoint", "Point"):
        for point in shapely.get_parts(shape) if edge else ():
            sheet.disc(axes.at(np.asarray(point.coords[0])), 1.6, edge)
    elif shape.geom_type == "LineString":
        if edge:
            sheet.line(axes.at(np.asarray(shape.coords)), edge, 1.0)
    elif edge:
        draw(sheet, axes, shape, "", edge, 0.5)
    else:
        draw(sheet, axes, shape, fill, fill, 0.3)


def _boxes(sheet: Canvas, axes: Axes, found: Extent, box: Real, limits: Sequence[float], axis: int) -> None:
    """Draw the box, that of the limits dashed, and the lengths."""
    allowed = _allowed(box, limits)
    if limits:
        sheet.line(axes.at(_corners(allowed, axis)), JOINT_FORCE, 1.0, (5.0, 3.0))
    sheet.line(axes.at(_corners(box, axis)), INK, 1.2)
    outer = axes.at(_corners(np.hstack([box, allowed]), axis))
    top, right = float(outer[:, 1].min()) - 8.0, float(outer[:, 0].max()) + 8.0
    (x0, y0), (x1, y1) = axes.at([box[0, 0], box[axis, 0]]), axes.at([box[0, 1], box[axis, 1]])
    dimensions = [(((right, y0), (right, y1)), (3.0, 0.0), True, axis)]
    if axis == 1:
        dimensions.append((((x0, top), (x1, top)), (0.0, 3.0), False, 0))
    for ends, across, turned, k in dimensions:
        sheet.line(ends, INK, 0.8)
        for end in np.array(ends):
            sheet.line([end - across, end + across], INK, 0.8)
        length = size_band(found, k)
        missed = bool(limits) and length.high > limits[k]
        text = f"{plain(float(f'{length.value:.4g}'))} mm" + (f" of {plain(limits[k])} mm" if limits else "")
        middle = np.mean(ends, axis=0) + ((9.0, 0.0) if turned else (0.0, -9.0))
        sheet.write(text, middle, colour=JOINT_FORCE if missed else INK, size=_LETTERS, turned=turned, halo=2.0)


def _corners(box: Real, axis: int) -> Real:
    x, y = (box[0].min(), box[0].max()), (box[axis].min(), box[axis].max())
    return np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])])


def _legend(found: Extent, limits: Sequence[float]) -> list[tuple[str, str]]:
    over = [] if found.motion is None else [("swept", f"at {POSES} poses over the motion of {found.motion.coordinate}")]
    rows = [*over, ("stated", "in the stated pose"), ("box", "the box about all poses" if over else "the box")]
    return [*rows, ("limits", "the limits, about the middle of the box")] if limits else rows


def _row(sheet: Canvas, mark: str, text: str, left: float, y: float) -> None:
    box = np.array([(left, y - 4.0), (left + 16.0, y - 4.0), (left + 16.0, y + 4.0), (left, y + 4.0), (left, y - 4.0)])
    if mark in ("swept", "stated"):
        colour = LINK if mark == "swept" else LOAD
        sheet.area(box[:4], faint(colour, 0.35), colour, 0.7)
    elif mark == "limits":
        sheet.line(box, JOINT_FORCE, 1.0, (4.0, 2.0))
    else:
        sheet.line(box, INK, 1.2)
    sheet.write(text, (left + 22.0, y), anchor="left middle", size=_LETTERS, colour=INK if mark else GROUND)
