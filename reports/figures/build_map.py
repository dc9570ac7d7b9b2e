"""Safety factor of a printed link over the direction in which it is built, as a map of half the sphere."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.solid.layers import AZIMUTH, POLAR, build_directions
from alula.fea.whole.build_directions import BuildDirections
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.style import GROUND, INK
from alula.reports.words.numbers import direction, number

Real = NDArray[np.float64]
_WIDTH, _HEIGHT = 262.0, 330.0
_CENTRE, _RADIUS = np.array([131.0, 122.0]), 100.0
_BAR = (31.0, 257.0, 231.0, 268.0)
"""Left, top, right and bottom of the scale of colours [points]. All is narrow enough for a telephone."""
_COLOURS = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])
"""Of the map viridis, from the least to the largest."""
_MOST = 20.0
"""Factors above the least that the colours tell apart; more is drawn as that."""
_STEPS = 60


def build_map(found: BuildDirections) -> Canvas:
    """Draw the safety factor of a link's layers for every direction of building, with the stated and the best one.

    Lambert's projection of equal areas, seen along the pins: they are in the middle, the linkage's plane is the rim.

    Parameters
    ----------
    found : BuildDirections
        With its scan.

    Returns
    -------
    Canvas
    """
    assert found.scan is not None
    assert found.best is not None
    sheet = Canvas(_WIDTH, _HEIGHT)
    finite = found.scan[np.isfinite(found.scan)]
    low = float(finite.min()) if finite.size else 1.0
    high = min(float(finite.max()) if finite.size else 1.0, _MOST * low)
    high = high if high > 1.001 * low else 1.001 * low
    corners, middle = _cells(found.scan)
    for points, value in zip(corners, middle, strict=True):
        sheet.area(points, _colour(_share(value, low, high)))
    _graticule(sheet)
    way, factor = found.best
    for vector, colour, text, row in (
        (found.layers.normal, "#c8460b", f"as built, {_told(found.layers.normal, found.safety_factor.value)}", 0),
        (way, "#ffffff", f"best, {_told(way, factor)}", 1),
    ):
        place = _project(np.asarray(vector, dtype=np.float64))
        sheet.disc(place, 4.2 if row == 0 else 3.4, colour, INK, 1.0)
        left = 12.0, 303.0 + 16.0 * row
        sheet.disc(left, 3.4, colour, INK, 1.0)
        sheet.write(text, (left[0] + 9.0, left[1]), anchor="left middle", size=8.5)
    _scale(sheet, low, high, capped=bool(found.scan.max() > 1.001 * high))
    return sheet


def _told(vector: tuple[float, float, float], factor: float) -> str:
    return f"along {direction(vector)}: n = {number(factor, 3)}"


def _graticule(sheet: Canvas) -> None:
    """Draw the rim, circles at 30 and 60° to the pins, and the names of the axes."""
    sheet.ring(_CENTRE, _RADIUS, GROUND, 0.8)
    for degrees in (30.0, 60.0):
        radius = _RADIUS * np.sqrt(2.0) * np.sin(np.radians(degrees) / 2.0)
        sheet.ring(_CENTRE, radius, "#ffffff", 0.6)
        beside = _CENTRE + radius * np.array([-1.0, 1.0]) / np.sqrt(2.0)
        sheet.write(f"{degrees:.0f}°", beside, anchor="center middle", halo=2.0, size=7.5)
    for name, at, anchor in (
        ("x", (_RADIUS + 7.0, 0.0), "left middle"),
        ("y", (0.0, -_RADIUS - 5.0), "center bottom"),
        ("z (pins)", (0.0, 6.0), "center top"),
    ):
        sheet.write(name, _CENTRE + np.array(at), anchor=anchor, halo=2.5, size=8.5)


def _scale(sheet: Canvas, low: float, high: float, *, capped: bool) -> None:
    """Draw the colours with numbers, evenly spaced in the logarithm."""
    left, top, right, bottom = _BAR
    for i in range(_STEPS):
        start, end = (left + (right - left) * (i + k) / _STEPS for k in (0, 1))
        sheet.area([(start, top), (end, top), (end, bottom), (start, bottom)], _colour((i + 0.5) / _STEPS))
    for share in np.linspace(0.0, 1.0, 5):
        value, x = low * (high / low) ** share, left + (right - left) * share
        sheet.line([(x, bottom), (x, bottom + 3.0)], INK, 0.8)
        more = "≥ " if capped and share == 1.0 else ""
        sheet.write(f"{more}{number(value, 2)}", (x, bottom + 5.0), anchor="center top", size=8.5)
    sheet.write("safety factor n of the layers", (left, top - 4.0), anchor="left bottom", size=8.5)


def _share(value: float, low: float, high: float) -> float:
    return float(np.clip(np.log(min(value, high) / low) / np.log(high / low), 0.0, 1.0))


def _colour(share: float) -> str:
    parts = [np.interp(share, np.linspace(0.0, 1.0, len(_COLOURS)), _COLOURS[:, k]) for k in range(3)]
    return "#" + "".join(f"{round(float(part)):02x}" for part in parts)


def _project(vector: Real) -> Real:
    """Return the place of a direction on the sheet; of a direction and its opposite the one with z ≥ 0."""
    unit = vector / np.linalg.norm(vector)
    x, y, z = unit if unit[2] >= 0.0 else -unit
    return np.asarray(_CENTRE + _RADIUS * np.array([x, -y]) / np.sqrt(1.0 + z))


def _cells(scan: Real) -> tuple[list[Real], list[float]]:
    """Return quadrilaterals between the directions of the scan, and their mean values, geometric."""
    places = np.array([[_project(v) for v in row] for row in build_directions()[:-1]])
    # On the rim itself z is 0, and rounding must not send a direction to the other side.
    rim = build_directions()[-1][:, :2] * (1.0, -1.0)
    places = np.concatenate([places, (_CENTRE + _RADIUS * rim)[None]])
    corners, middle = [], []
    with np.errstate(divide="ignore"):
        logs = np.log(scan)
    for i in range(POLAR - 1):
        for j in range(AZIMUTH):
            k = (j + 1) % AZIMUTH
            corners.append(np.array([places[i, j], places[i + 1, j], places[i + 1, k], places[i, k]]))
            middle.append(float(np.exp(np.mean([logs[i, j], logs[i + 1, j], logs[i + 1, k], logs[i, k]]))))
    return corners, middle
