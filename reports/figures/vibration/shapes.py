"""The shapes in which a linkage vibrates at its lowest natural frequencies."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.model import FrameModel
from alula.fea.vibration.linkage_modes import LinkageModes
from alula.fea.vibration.modes import Mode
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.plot import ticks
from alula.reports.figures.sheet.style import GROUND, INK, LINK, LOAD, WIDTH
from alula.reports.sentences.places import directions
from alula.reports.words.numbers import band, plain

Real = NDArray[np.float64]
MOST = 4
"""Shapes that are drawn."""
_REACH = 0.16
"""Of the largest displacement that is seen, over the size of the linkage in the panel."""
_TURN, _RISE = math.radians(-20.0), math.radians(28.0)
"""How a view from the side is turned about the pins, and how high the eye stands above the linkage's plane."""
_GAP, _TITLE, _BELOW, _LETTERS = 14.0, 30.0, 26.0, 8.5
"""Room between the panels, above each and below all, and size of letters [points]."""
_AXES = 36.0
"""Width beside the shape in which the axes are shown [points]."""
_STEPS = 6
"""Straight pieces in which an element is drawn."""


def shapes_drawing(found: LinkageModes) -> Canvas:
    """Draw the first shapes of a linkage in a pose: undeformed grey, deformed coloured, each as large as is legible.

    Shapes in the plane are seen along the pins, others from the side.

    Parameters
    ----------
    found : LinkageModes

    Returns
    -------
    Canvas
    """
    modes = found.modes[:MOST]
    columns = min(len(modes), 2)
    wide = (72.0 * WIDTH - _GAP * (columns + 1)) / columns
    views = [_view(mode) for mode in modes]
    still = axis_lines(found.model, None)
    flat = [np.vstack([line @ view.T for line in still]) for view in views]
    spans = [np.ptp(points, axis=0) for points in flat]
    room = 1.0 + 2.0 * _REACH
    tall = min(
        max((wide - _AXES) * float(max((s[1] + _REACH * max(s)) / (room * s[0]) for s in spans)), 0.3 * wide),
        1.1 * wide,
    )
    rows = math.ceil(len(modes) / columns)
    sheet = Canvas(72.0 * WIDTH, rows * (tall + _TITLE + _GAP) + _BELOW)
    for k, (mode, view, points) in enumerate(zip(modes, views, flat, strict=True)):
        row, column = divmod(k, columns)
        box = (_GAP + column * (wide + _GAP), _TITLE + row * (tall + _TITLE + _GAP))
        _panel(sheet, found, k, mode, view, points, still, (*box, box[0] + wide, box[1] + tall))
    _legend(sheet)
    return sheet


def axis_lines(model: FrameModel, shape: Real | None) -> list[Real]:
    """Return the axes of all beams of a frame, displaced by a shape.

    Between its ends a beam bends as a cubic does (Hermite), by the displacements and rotations of its ends.

    Parameters
    ----------
    model : FrameModel
    shape : array (n, 6) or None
        Displacements and rotations of the nodes [mm, rad]; None where it stands still.

    Returns
    -------
    list of array (k, 3)
        [mm]
    """
    s = np.linspace(0.0, 1.0, _STEPS + 1)[:, None]
    lines = []
    for i, element in enumerate(model.elements):
        start, end = model.ends(i)
        line = start + s * (end - start)
        if shape is not None:
            (u, v), along = shape[list(element.nodes)], end - start
            u_end, v_end = (d[:3] + np.cross(d[3:], arm) for d, arm in zip((u, v), element.offsets, strict=True))
            chord = v_end - u_end
            across = chord - along * (chord @ along) / (along @ along)
            first, last = (np.cross(d[3:], along) - across for d in (u, v))  # slopes beyond that of the chord
            line = line + u_end + s * chord + s * (1.0 - s) ** 2 * first - s**2 * (1.0 - s) * last
        lines.append(line)
    return lines


def _view(mode: Mode) -> Real:
    """Return the directions on the sheet (2, 3), to the right and up."""
    if mode.in_plane >= 0.5:
        return np.eye(3)[:2]
    right = np.array([math.cos(_TURN), math.sin(_TURN), 0.0])
    back = np.array([-math.sin(_TURN), math.cos(_TURN), 0.0])
    return np.array([right, math.sin(_RISE) * back + math.cos(_RISE) * np.array([0.0, 0.0, 1.0])])


def _panel(
    sheet: Canvas,
    found: LinkageModes,
    k: int,
    mode: Mode,
    view: Real,
    points: Real,
    still: Sequence[Real],
    box: tuple[float, float, float, float],
) -> None:
    """Draw one shape into a box."""
    model, (left, top, right, bottom) = found.model, box
    size = float(np.ptp(points, axis=0).max())
    moves = axis_lines(model, mode.shape)
    seen = [(moved - line) @ view.T for moved, line in zip(moves, still, strict=True)]
    most = max(float(np.linalg.norm(d, axis=1).max()) for d in seen)
    grown = _REACH * size / most if most > 0.0 else 0.0
    moved = [line @ view.T + grown * d for line, d in zip(still, seen, strict=True)]
    every = np.vstack([points, *moved])
    low, high = every.min(axis=0), every.max(axis=0)
    room = np.array([right - _AXES - left, bottom - top])
    per_mm = min(room / np.maximum(1.06 * (high - low), 1e-9 * size))
    middle, centre = (low + high) / 2.0, np.array([left, top]) + room / 2.0

    def at(places: Real) -> Real:
        return np.asarray(centre + (places - middle) * per_mm * np.array([1.0, -1.0]))

    sheet.write(f"{k + 1}: {band(mode.frequency)} Hz, {directions(mode.in_plane)}", (left, top - 17.0),
                anchor="left bottom", bold=True)  # fmt: skip
    for line in still:
        sheet.line(at(line @ view.T), LINK, 2.4)
    if mode.in_plane < 0.5:
        for line, flat in zip(still, moved, strict=True):
            sheet.line([at(line[-1] @ view.T), at(flat[-1])], LINK, 0.5)
    for flat in moved:
        sheet.line(at(flat), LOAD, 1.8)
    for name, nodes in found.frame.pins.items():
        node = next(node for node in nodes if node is not None)
        place = at(found.frame.model.nodes[node] @ view.T)
        grounded = found.frame.pose.linkage.ground in found.frame.pose.linkage.joints[name].links
        if grounded:
            sheet.area(place + 3.2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]), GROUND)
        else:
            sheet.disc(place, 2.0, "#ffffff", GROUND, 0.8)
    _scale(sheet, per_mm, (left, bottom), right - left)
    _triad(sheet, view, np.array([right - 24.0, top + 18.0]))


def _scale(sheet: Canvas, per_mm: float, corner: tuple[float, float], wide: float) -> None:
    """Draw a bar of a round length below a panel."""
    length = float(ticks(0.0, 0.3 * wide / per_mm, most=2)[-1])
    x, y = corner[0], corner[1] + 5.0
    sheet.line([(x, y), (x + length * per_mm, y)], INK, 1.2)
    sheet.write(f"{plain(length)} mm", (x + length * per_mm + 5.0, y), anchor="left middle", size=_LETTERS)


def _triad(sheet: Canvas, view: Real, origin: Real) -> None:
    """Draw the axes as they are seen."""
    for axis, name in zip(np.eye(3), "xyz", strict=True):
        way = view @ axis * np.array([1.0, -1.0])
        if np.linalg.norm(way) > 0.0:
            sheet.line([origin, origin + 13.0 * way], GROUND, 0.9)
            sheet.write(name, origin + 18.0 * way, colour=GROUND, size=7.5)


def _legend(sheet: Canvas) -> None:
    y, x = sheet.height - 10.0, _GAP
    for colour, width, text in ((LINK, 2.4, "at rest"), (LOAD, 1.8, "at the end of its swing, enlarged")):
        sheet.line([(x, y), (x + 18.0, y)], colour, width)
        x = sheet.write(text, (x + 24.0, y), anchor="left middle", size=_LETTERS).box[2] + 16.0
    sheet.area(np.array([x + 4.0, y]) + 3.2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]), GROUND)
    x = sheet.write("pin on the ground", (x + 13.0, y), anchor="left middle", size=_LETTERS).box[2] + 16.0
    sheet.disc((x + 4.0, y), 2.0, "#ffffff", GROUND, 0.8)
    sheet.write("other joint", (x + 13.0, y), anchor="left middle", size=_LETTERS)
