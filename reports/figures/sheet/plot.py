"""Axes of a plot: where values stand on the sheet, round ticks and their numbers."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.drawing import Plotted
from alula.reports.figures.sheet.letters import extent
from alula.reports.figures.sheet.style import GRID, GROUND, INK

Real = NDArray[np.float64]

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_TICK = 3.0
"""Length [points]."""
_FEW, _MANY = 1e-3, 1e6
"""Largest values between which ticks are written as they are; others with a power of ten in the unit."""
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, kw_only=True)
class Axes:
    """A rectangle of the sheet with scales along x and y.

    Attributes
    ----------
    box : tuple of 4 float
        Left, top, right, bottom [points].
    x : tuple of 2 float
        Values at the left and at the right.
    y : tuple of 2 float
        Values at the bottom and at the top.
    """

    box: tuple[float, float, float, float]
    x: tuple[float, float]
    y: tuple[float, float]

    def at(self, values: ArrayLike) -> Real:
        """Return where values are on the sheet.

        Parameters
        ----------
        values : array, shape (..., 2)

        Returns
        -------
        array, shape (..., 2)
            [points].
        """
        values = np.asarray(values, dtype=np.float64)
        left, top, right, bottom = self.box
        x = left + (values[..., 0] - self.x[0]) / (self.x[1] - self.x[0]) * (right - left)
        y = bottom + (values[..., 1] - self.y[0]) / (self.y[1] - self.y[0]) * (top - bottom)
        return np.stack([x, y], axis=-1)

    def curve(
        self,
        sheet: Canvas,
        x: Real,
        y: Real,
        colour: str,
        width: float,
        *,
        name: str,
        labels: tuple[str, str],
        dashes: tuple[float, float] | None = None,
    ) -> None:
        """Draw a curve, of which the sheet can tell what it shows.

        Parameters
        ----------
        sheet : Canvas
        x, y : array, shape (n,)
        colour : str
        width : float
            Of the line [points].
        name : str
        labels : tuple of 2 str
            Of the axes.
        dashes : tuple of 2 float, optional
            As of ``Canvas.line``.
        """
        points = self.at(np.column_stack([x, y]))
        sheet.line(points, colour, width, dashes)
        shown = self.values(points)
        sheet.plotted.append(Plotted(name=name, x=shown[:, 0], y=shown[:, 1], x_label=labels[0], y_label=labels[1]))

    def values(self, points: Real) -> Real:
        """Return the values that places on the sheet stand for.

        Parameters
        ----------
        points : array, shape (n, 2)
            [points].

        Returns
        -------
        array, shape (n, 2)
        """
        left, top, right, bottom = self.box
        share = (points - (left, bottom)) / (right - left, top - bottom)
        low, high = np.array([self.x, self.y]).T
        return np.asarray(low + share * (high - low), dtype=np.float64)

    def scale_x(self, sheet: Canvas, label: str, *, most: int = 9, grid: bool = False) -> None:
        """Draw ticks, numbers and label below the rectangle.

        Parameters
        ----------
        sheet : Canvas
        label : str
        most : int, optional
            Number of steps between ticks, at most.
        grid : bool, optional
            True for lines across the rectangle.
        """
        left, top, right, bottom = self.box
        places = ticks(*self.x, most=most)
        texts, power = numbers(places)
        along = [float(self.at([value, self.y[0]])[0]) for value in places]
        for x in along if grid else ():
            sheet.line([(x, top), (x, bottom)], GRID, 0.5)
        for x, text in zip(along, texts, strict=True):
            sheet.line([(x, bottom), (x, bottom + _TICK)], INK, 0.8)
            sheet.write(text, (x, bottom + _TICK + 3.0), anchor="center top")
        sheet.write(_with_power(label, power), ((left + right) / 2.0, bottom + _TICK + 17.0), anchor="center top")

    def scale_y(self, sheet: Canvas, label: str, *, label_at: float, most: int = 9, grid: bool = False) -> int:
        """Draw ticks, numbers and label to the left of the rectangle.

        Parameters
        ----------
        sheet : Canvas
        label : str
        label_at : float
            x of the label's middle [points].
        most : int, optional
            Number of steps between ticks, at most.
        grid : bool, optional
            True for lines across the rectangle.

        Returns
        -------
        int
            The power of ten by which its numbers are to be multiplied, as its label says.
        """
        left, top, right, bottom = self.box
        places = ticks(*self.y, most=most)
        texts, power = numbers(places)
        up = [float(self.at([self.x[0], value])[1]) for value in places]
        for y in up if grid else ():
            sheet.line([(left, y), (right, y)], GRID, 0.5)
        for y, text in zip(up, texts, strict=True):
            sheet.line([(left - _TICK, y), (left, y)], INK, 0.8)
            sheet.write(text, (left - _TICK - 3.0, y), anchor="right middle")
        sheet.write(_with_power(label, power), (label_at, (top + bottom) / 2.0), turned=True)
        return power

    def frame(self, sheet: Canvas, sides: str = "left bottom right top") -> None:
        """Draw sides of the rectangle.

        Parameters
        ----------
        sheet : Canvas
        sides : str, optional
            Their names.
        """
        left, top, right, bottom = self.box
        lines = {
            "left": [(left, top), (left, bottom)],
            "right": [(right, top), (right, bottom)],
            "top": [(left, top), (right, top)],
            "bottom": [(left, bottom), (right, bottom)],
        }
        for side in sides.split():
            sheet.line(lines[side], GROUND, 0.6)


def ticks(low: float, high: float, *, most: int) -> Real:
    """Return round values between two.

    Parameters
    ----------
    low : float
    high : float
    most : int
        Number of steps between them, at most.

    Returns
    -------
    array
    """
    least = (high - low) / most
    power = 10.0 ** math.floor(math.log10(least))
    step = next(s * power for s in _STEPS if s * power >= least * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return np.asarray(step * np.arange(first, last + 1), dtype=np.float64)


def numbers(places: Real) -> tuple[list[str], int]:
    """Return the numbers of ticks as texts, all with the same decimals.

    Parameters
    ----------
    places : array
        Where the ticks are.

    Returns
    -------
    tuple of list of str and int
        The texts, and the power of ten by which they are to be multiplied.
    """
    largest = float(np.abs(places).max(initial=0.0))
    power = 0 if largest == 0.0 or _FEW <= largest < _MANY else 3 * math.floor(math.log10(largest) / 3.0)
    scaled = places / 10.0**power
    decimals = next((d for d in range(12) if np.allclose(np.round(scaled, d), scaled, rtol=1e-9, atol=1e-13)), 12)
    return [f"{value + 0.0:.{decimals}f}".replace("-", "−") for value in scaled], power


def widest(places: Real) -> float:
    """Return the width of the longest number of ticks.

    Parameters
    ----------
    places : array
        Where the ticks are.

    Returns
    -------
    float
        [points].
    """
    return max((extent(text)[0] for text in numbers(places)[0]), default=0.0)


def _with_power(label: str, power: int) -> str:
    return label.replace("[", f"[10{str(power).translate(_SUPERSCRIPT)} ", 1) if power else label
