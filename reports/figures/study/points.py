"""What pictures of studies are drawn from: arrays with a value for every point."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
OUTCOMES = ("pass", "undecided", "fail", "refused", "crashed", "done")
"""What may become of a point, in the order of legends."""
MOST_MARKS = 5000
"""Points that have a mark in a picture; more would cover each other."""
MOST_LINES = 300
"""Of parallel coordinates; of more points so many are drawn, evenly through the study."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Parameter:
    """An entry that varies.

    Attributes
    ----------
    path : str
        As for ``--set``.
    unit : str
        "" for pure numbers and for words.
    values : ndarray, shape (n,)
        In that unit; for words their numbers in ``words``.
    words : tuple of str
        The values of an entry that is no quantity; empty for a quantity.
    """

    path: str
    unit: str
    values: Real
    words: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """The entry with its unit, as on an axis."""
        return f"{self.path} [{self.unit}]" if self.unit else self.path


@dataclass(frozen=True, kw_only=True, eq=False)
class Response:
    """A number of every point, with its band.

    Attributes
    ----------
    label : str
        What it is, with its unit, as on an axis.
    value, low, high : ndarray, shape (n,)
        NaN where a point has no such number.
    limit : float
        NaN without.
    """

    label: str
    value: Real
    low: Real
    high: Real
    limit: float = np.nan

    @property
    def title(self) -> str:
        """Its label without what stands in brackets, as a heading begins."""
        text = self.label.partition(" (")[0]
        return text[:1].upper() + text[1:]


def marked(here: NDArray[np.bool_], most: int) -> NDArray[np.bool_]:
    """Return which points have a mark: all of few, else so many, drawn at random with a fixed seed.

    Every other point, or each tenth, would follow the lines of a grid.

    Parameters
    ----------
    here : ndarray of bool, shape (n,)
        Which points there are.
    most : int

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    points = np.flatnonzero(here)
    if len(points) <= most:
        return here
    found = np.zeros_like(here)
    found[np.random.default_rng(0).choice(points, most, replace=False)] = True
    return found
