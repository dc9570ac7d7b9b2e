"""First, last and extreme values over a motion and where they stand: as data, and as cells of tables."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.rates import QUANTITIES, Values
from alula.geometry.base.ties import first_largest
from alula.geometry.linkage.motion import Motion
from alula.reports.sections.section import Cell, Column, Number
from alula.reports.words.numbers import number

Real = NDArray[np.float64]


def extremes(motion: Motion, values: Real, *, unbounded: bool = False) -> dict[str, Any]:
    """Return first, last and extreme values over a motion, and where the extremes stand.

    Parameters
    ----------
    motion : Motion
    values : array (n,)
        NaN where they are not known.
    unbounded : bool, optional
        True where they grow without bound on the way, so that extremes mean nothing.

    Returns
    -------
    dict
        As ``docs/result.md`` describes them.
    """
    ends: dict[str, Any] = {"first": finite_or_none(values[0]), "last": finite_or_none(values[-1])}
    if unbounded or not np.any(np.isfinite(values)):
        return ends | {"smallest": None, "largest": None, "unbounded": True}
    for key, sign in (("smallest", -1.0), ("largest", 1.0)):
        pose = _extreme_pose(sign * values)
        ends |= {key: float(values[pose]), f"{key}_at": float(motion.told(motion.angles[pose]))}
    return ends | {"unbounded": False}


def _extreme_pose(values: Real) -> int:
    """Return the first of the poses whose value is the largest, but for rounding, as in a symmetric linkage."""
    return first_largest(values, float(np.nanmax(np.abs(values))))


def vector_extremes(motion: Motion, values: Values) -> dict[str, Any]:
    """Return the largest size of a vector over a motion, where it stands, and the ends of its components.

    Parameters
    ----------
    motion : Motion
    values : complex array (n,)

    Returns
    -------
    dict
        As ``docs/result.md`` describes it.
    """
    pose = _extreme_pose(np.abs(values))
    return {
        "largest": float(np.abs(values[pose])),
        "largest_at": float(motion.told(motion.angles[pose])),
        "x": [float(values.real.min()), float(values.real.max())],
        "y": [float(values.imag.min()), float(values.imag.max())],
    }


def every_extreme(motion: Motion, values: Mapping[str, Values]) -> dict[str, Any]:
    """Return extremes of some quantities: of vectors those of their size and components.

    Parameters
    ----------
    motion : Motion
    values : mapping of str to array (n,)

    Returns
    -------
    dict
    """
    return {
        key: vector_extremes(motion, found) if np.iscomplexobj(found) else extremes(motion, found)
        for key, found in values.items()
    }


def finite_or_none(value: float) -> float | None:
    """Return a number as JSON takes it.

    Parameters
    ----------
    value : float

    Returns
    -------
    float or None
        None where it is infinite or unknown.
    """
    return float(value) if np.isfinite(value) else None


def extreme_columns(at: str, *, ends: bool, known: bool = True) -> tuple[Column, ...]:
    """Return the columns of ``extreme_cells``.

    Parameters
    ----------
    at : str
        Unit of the coordinate.
    ends : bool
        Whether first and last value stand before the extremes.
    known : bool, optional
        False where extremes mean nothing, next to a dead point: columns for notebooks alone.

    Returns
    -------
    tuple of Column
    """
    found = ("smallest", "smallest at", "largest", "largest at")
    own = tuple(Column(title, at if title.endswith(" at") else "", hidden=not known) for title in found)
    return (Column("first"), Column("last"), *own) if ends else own


def extreme_cells(row: Mapping[str, Any], *, ends: bool) -> tuple[Number, ...]:
    """Return extremes as cells; a number beside which they are rounding is 0.

    Parameters
    ----------
    row : mapping
        Extremes, of numbers or of a vector.
    ends : bool
        Whether first and last value stand before them.

    Returns
    -------
    tuple of Number
    """
    values = ("first", "last", "smallest", "largest")
    size = max((abs(row[key]) for key in values if row.get(key) is not None), default=0.0)
    cells = {key: Number(row.get(key), beside=size) for key in values}
    # where nothing changes, no pose has the extreme
    moves = row.get("smallest") != row.get("largest")
    at = {key: Number(row.get(key) if moves else None, decimals=1) for key in ("smallest_at", "largest_at")}
    found = (cells["smallest"], at["smallest_at"], cells["largest"], at["largest_at"])
    return (cells["first"], cells["last"], *found) if ends else found


def rate_columns(key: str, at: str, *, told: bool = True) -> tuple[Column, ...]:
    """Return the columns of ``rate_cells``: of a vector, or of a number with its ends, which are for notebooks.

    Parameters
    ----------
    key : str
        Of ``QUANTITIES``.
    at : str
        Unit of the coordinate.
    told : bool, optional
        False for what notebooks alone have.

    Returns
    -------
    tuple of Column
    """
    name, unit = key.replace("_", " "), QUANTITIES[key]
    largest = (Column(f"{name}, largest", unit, hidden=not told), Column(f"{name}, largest at", at, hidden=True))
    if key in SIZES:
        return largest
    smallest = (Column(f"{name}, smallest", unit, hidden=True), Column(f"{name}, smallest at", at, hidden=True))
    hidden = tuple(Column(column.title, column.unit, hidden=True) for column in largest)
    return (Column(name, unit, hidden=not told), *smallest, *hidden)


SIZES = ("speed", "acceleration", "momentum")
"""Quantities of links and points that are vectors."""


def rate_cells(key: str, row: Mapping[str, Any] | None) -> tuple[Cell, ...]:
    """Return extremes of a quantity of a link or point as cells.

    Parameters
    ----------
    key : str
        Of ``QUANTITIES``.
    row : mapping or None
        None where they are not known.

    Returns
    -------
    tuple of str or Number
    """
    found = row or {}
    largest = (Number(found.get("largest")), Number(found.get("largest_at"), decimals=1))
    if key in SIZES:
        return largest
    smallest = (Number(found.get("smallest")), Number(found.get("smallest_at"), decimals=1))
    return (between(row), *smallest, *largest)


def between(row: Mapping[str, Any] | None) -> str:
    """Return ``−3.1 to 4.2`` or ``±4.2``, or the one value of what is constant.

    Parameters
    ----------
    row : mapping or None
        Extremes of numbers; None where they are not known.

    Returns
    -------
    str
    """
    if row is None:
        return "–"
    if row["unbounded"]:
        return number(float("nan"))
    size = max(abs(row["smallest"]), abs(row["largest"]))
    low, high = (number(row[key], 4, beside=1e3 * size) for key in ("smallest", "largest"))
    if row["smallest"] < 0.0 and low == f"−{high}":
        return f"±{high}"
    return low if low == high else f"{low} to {high}"
