"""Placing labels on a drawing so that they cover neither each other nor what is drawn."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.letters import extent

Real = NDArray[np.float64]

_DIRECTIONS = 24
_REACHES = (0.6, 1.2, 2.0, 3.0, 4.2, 6.0, 8.0)
"""Distances that are tried, in heights of the label's text."""
_LEADER = 2.5
"""Distance beyond which a label gets a line to its anchor."""
_COVERS, _MORE = 6.0, 0.3
"""Cost of a label over anything drawn, in heights of its text by which it would rather move away; and of each point."""
_CLASH, _OUTSIDE = 8.0, 30.0
"""The same of each square point over another label, and of each point by which it leaves the drawing."""
_CELL = 0.7
"""Points; as fine as two pixels."""


def place_labels(
    sheet: Canvas,
    inside: tuple[float, float, float, float],
    labels: Sequence[tuple[Real, str, str]],
    obstacles: Real,
    *,
    size: float,
) -> None:
    """Write labels beside their anchors, where they cover least.

    The labels are placed one after the other. One that is far from its anchor has a thin line to it.

    Parameters
    ----------
    sheet : Canvas
    inside : tuple of 4 float
        Left, top, right, bottom of where they may stand [points].
    labels : sequence of tuple
        Anchors (k, 2) on the sheet, of which one is chosen; text; colour.
    obstacles : array
        Points (n, 2) of what is drawn, on the sheet.
    size : float
        Of the letters [points].
    """
    angles = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    ways = np.column_stack([np.cos(angles), np.sin(angles)])
    reaches = np.repeat(_REACHES, _DIRECTIONS)
    drawn, taken = _Crowd(sheet, obstacles), np.zeros((0, 4))
    for anchors, content, colour in labels:
        half = np.array(extent(content, size)) / 2.0 + 0.7
        steps = reaches[:, None] * size * np.tile(ways, (len(_REACHES), 1)) + np.tile(
            ways * (np.abs(ways) @ half)[:, None], (len(_REACHES), 1)
        )
        centres = (anchors[:, None] + steps).reshape(-1, 2)
        boxes = np.hstack([centres - half, centres + half])
        covered = drawn.inside(boxes)
        common = np.minimum(boxes[:, None, 2:], taken[:, 2:]) - np.maximum(boxes[:, None, :2], taken[:, :2])
        clash = np.prod(np.maximum(common, 0.0), axis=2).sum(axis=1)
        outside = np.maximum(0.0, np.hstack([inside[:2] - boxes[:, :2], boxes[:, 2:] - inside[2:]])).sum(axis=1)
        cost = np.tile(reaches, len(anchors)) + np.where(covered > 0, _COVERS + _MORE * covered, 0.0)
        best = int(np.argmin(cost + _CLASH * clash + _OUTSIDE * outside))
        centre, at = centres[best], anchors[best // len(steps)]
        taken = np.vstack([taken, boxes[best]])
        if reaches[best % len(steps)] > _LEADER:
            arm = at - centre
            near = centre + arm * np.min(half / np.maximum(np.abs(arm), half))  # where it leaves the text's box
            sheet.line([at, near], faint(colour, 0.6), 0.5)
        sheet.write(content, centre, colour=colour, size=size, halo=2.0)


class _Crowd:
    """How many points of what is drawn lie in a box, by sums over cells of the sheet."""

    def __init__(self, sheet: Canvas, points: Real) -> None:
        self.shape = np.array([math.ceil(sheet.width / _CELL), math.ceil(sheet.height / _CELL)])
        cells = np.floor(points / _CELL).astype(np.int64)
        cells = cells[((cells >= 0) & (cells < self.shape)).all(axis=1)]
        self.sums = np.zeros(self.shape + 1, dtype=np.int64)
        np.add.at(self.sums, tuple(cells.T + 1), 1)
        for axis in (0, 1):
            np.cumsum(self.sums, axis=axis, out=self.sums)

    def inside(self, boxes: Real) -> NDArray[np.int64]:
        """Return the number of points in boxes (k, 4)."""
        low = np.clip(np.floor(boxes[:, :2] / _CELL).astype(np.int64), 0, self.shape)
        high = np.clip(np.ceil(boxes[:, 2:] / _CELL).astype(np.int64), 0, self.shape)
        (x0, y0), (x1, y1) = low.T, high.T
        s = self.sums
        return np.asarray(s[x1, y1] - s[x0, y1] - s[x1, y0] + s[x0, y0])


def along(start: NDArray[np.float64], end: NDArray[np.float64], count: int = 240) -> NDArray[np.float64]:
    """Return points on a line that labels must not cover.

    Parameters
    ----------
    start : array
    end : array
    count : int, optional

    Returns
    -------
    array
        (count, 2).
    """
    return np.asarray(np.linspace(start, end, count))


@dataclass(frozen=True, kw_only=True)
class Stacked:
    """A name above an axis.

    Attributes
    ----------
    text : str
    at : float
        Place along the axis [points].
    row : int
        From below.
    """

    text: str
    at: float
    row: int


def stacked(names: Iterable[str], at: Iterable[float]) -> tuple[Stacked, ...]:
    """Return names above an axis without overlap.

    Parameters
    ----------
    names : iterable of str
    at : iterable of float
        Place of each along the axis [points]; names of one place stand together, others move to a higher row.

    Returns
    -------
    tuple of Stacked
        Names of one place are joined; others move to a higher row.
    """
    together: dict[float, list[str]] = {}
    for name, place in zip(names, at, strict=True):
        near = next((known for known in together if abs(known - place) < _TOGETHER), float(place))
        together.setdefault(near, []).append(name)
    ends: list[float] = []
    found = []
    for place, group in sorted(together.items()):
        text = ", ".join(group)
        half = extent(text, _NAME_SIZE, bold=True)[0] / 2.0 + _NAME_GAP
        row = next((k for k, end in enumerate(ends) if end <= place - half), len(ends))
        ends[row : row + 1] = [place + half]
        found.append(Stacked(text=text, at=place, row=row))
    return tuple(found)


def heights(names: Sequence[Stacked]) -> float:
    """Return the height that stacked names need [points].

    Parameters
    ----------
    names : sequence of Stacked

    Returns
    -------
    float
    """
    return _NAME_ROW * (1 + max((name.row for name in names), default=0))


def write_stacked(sheet: Canvas, names: Sequence[Stacked], left: float, bottom: float) -> None:
    """Write stacked names above an axis.

    Parameters
    ----------
    sheet : Canvas
    names : sequence of Stacked
    left : float
        Where the axis begins [points].
    bottom : float
        Above what they stand [points].
    """
    for name in names:
        place = (left + name.at, bottom - 3.0 - _NAME_ROW * name.row)
        sheet.write(name.text, place, anchor="center bottom", size=_NAME_SIZE, bold=True)


_TOGETHER = 0.36
_NAME_SIZE, _NAME_ROW, _NAME_GAP = 9.0, 13.0, 2.2
"""Points."""
