"""First, last and extreme values over a motion and where they stand: as data, and as cells of tables."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.rates import QUANTITIES, Values
from alula.geometry.base.ties import first_largest
from alula.geometry.linkage.motion import Motion
from alula.reports.sections.section import Cell, Column, Number, Table, words
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
        ends |= with_pose(motion, key, values[pose], pose)
    return ends | {"unbounded": False}


def _extreme_pose(values: Real) -> int:
    """Return the first of the poses whose value is the largest, but for rounding, as in a symmetric linkage."""
    return first_largest(values, float(np.nanmax(np.abs(values))))


def with_pose(motion: Motion, what: str, value: float, pose: int) -> dict[str, float]:
    """Return a value and where it stands.

    Parameters
    ----------
    motion : Motion
    what : str
        Its name.
    value : float
    pose : int
        Number of the pose.

    Returns
    -------
    dict
        ``what`` and ``what_at``, the value of the coordinate there, or per cent of the cycle.
    """
    return {what: float(value), f"{what}_at": float(motion.progress[pose])}


def stretches(motion: Motion, true: NDArray[np.bool_]) -> list[list[float]]:
    """Return first and last value of the coordinate of every run of poses at which something is true.

    Parameters
    ----------
    motion : Motion
    true : ndarray of bool, shape (n,)

    Returns
    -------
    list of [first, last]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    return [motion.progress[[first, after - 1]].tolist() for first, after in edges.reshape(-1, 2)]


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
        **with_pose(motion, "largest", np.abs(values[pose]), pose),
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


def extremes_table(
    key: str,
    load_case: str,
    rows: Iterable[tuple[str, str, Mapping[str, Any]]],
    at: str,
    *,
    ends: bool,
    known: bool = True,
    caption: str = "",
) -> Table:
    """Return quantities with their extremes as a table; a number beside which they are rounding is 0.

    Parameters
    ----------
    key : str
        Of the table.
    load_case : str
    rows : iterable of (str, str, mapping)
        Name, unit and extremes of each quantity, of numbers or of a vector.
    at : str
        Unit of the coordinate.
    ends : bool
        Whether first and last value stand before the extremes.
    known : bool, optional
        False where extremes mean nothing, next to a dead point: columns for notebooks alone.
    caption : str, optional

    Returns
    -------
    Table
    """
    found = (("smallest", ""), ("smallest at", at), ("largest", ""), ("largest at", at))
    columns = [Column("first"), Column("last")] if ends else []
    columns += [Column(title, unit, hidden=not known) for title, unit in found]
    return Table(
        key=key,
        columns=(words("quantity"), words("unit"), *columns),
        rows=tuple((name, unit, *_extreme_cells(row, ends=ends)) for name, unit, row in rows),
        caption=caption,
        under=(("load case", load_case),),
    )


def _extreme_cells(row: Mapping[str, Any], *, ends: bool) -> list[Number]:
    values = ("first", "last", "smallest", "largest")
    size = max((abs(row[key]) for key in values if row.get(key) is not None), default=0.0)
    # where nothing changes, no pose has the extreme
    moves = row.get("smallest") != row.get("largest")
    found = [Number(row[key], beside=size) for key in ("first", "last")] if ends else []
    for key in ("smallest", "largest"):
        found += [Number(row.get(key), beside=size), Number(row.get(f"{key}_at") if moves else None, decimals=1)]
    return found


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
    name, unit, vector = key.replace("_", " "), QUANTITIES[key], key in SIZES
    found = [] if vector else [Column(name, unit, hidden=not told)]
    for end in ("largest",) if vector else ("smallest", "largest"):
        found += [Column(f"{name}, {end}", unit, hidden=not (told and vector))]
        found += [Column(f"{name}, {end} at", at, hidden=True)]
    return tuple(found)


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
    found, vector = row or {}, key in SIZES
    cells: list[Cell] = [] if vector else [between(row)]
    for end in ("largest",) if vector else ("smallest", "largest"):
        cells += [Number(found.get(end)), Number(found.get(f"{end}_at"), decimals=1)]
    return tuple(cells)


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
