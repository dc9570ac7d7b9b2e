"""Speeds, accelerations, momentum and energy as columns of text and as sentences, for console and page."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.rates import QUANTITIES
from alula.reports.words.numbers import number

Columns = list[tuple[str, list[str]]]
"""Head with its unit, and the cells below it."""
_DIGITS = 4


def link_columns(rates: Mapping[str, Any]) -> Columns:
    """Return the table of the links: ends of signed quantities, the largest of sizes.

    Parameters
    ----------
    rates : mapping
        From ``rates_record``.

    Returns
    -------
    list of tuple of str and list of str
        Head with its unit, cells.
    """
    rows = rates["links"]
    columns: Columns = [("link", list(rows))]
    heads = {"angular_speed": "angular speed", "angular_acceleration": "angular acceleration"}
    if any(row["mass"] is not None for row in rows.values()):
        masses = ["" if row["mass"] is None else number(row["mass"], _DIGITS) for row in rows.values()]
        columns.append(("mass [g]", masses))
        heads |= {"momentum": "largest momentum", "angular_momentum": "angular momentum"}
        heads |= {"kinetic_energy": "kinetic energy"}
    for key, head in heads.items():
        columns.append((f"{head} [{QUANTITIES[key]}]", [ends(row[key]) for row in rows.values()]))
    return columns


def point_columns(rates: Mapping[str, Any], unit: str) -> Columns:
    """Return the table of the points: largest speed and acceleration, and where.

    Parameters
    ----------
    rates : mapping
        From ``rates_record``.
    unit : str
        Of the coordinate.

    Returns
    -------
    list of tuple of str and list of str
        Head with its unit, cells.
    """
    rows = rates["points"]
    columns: Columns = [("point", list(rows))]
    for key in ("speed", "acceleration"):
        columns.append((f"largest {key} [{QUANTITIES[key]}]", [ends(row[key]) for row in rows.values()]))
        columns.append((f"at [{unit}]", [_at(row[key]) for row in rows.values()]))
    return columns


def whole_rows(rates: Mapping[str, Any]) -> list[tuple[str, str, Mapping[str, Any]]]:
    """Return name, unit and extremes of what the linkage as a whole has.

    Parameters
    ----------
    rates : mapping
        From ``rates_record``.

    Returns
    -------
    list of tuple
        Those that are known.
    """
    about = rates["about"]["joint"] or "the global origin"
    names = {
        "momentum": "momentum",
        "angular_momentum": f"angular momentum about {about}",
        "kinetic_energy": "kinetic energy",
        "potential_energy": "potential energy of the weights",
        "shaking_force": "shaking force",
        "shaking_moment": f"shaking moment about {about}",
        "ground_force": "force on the ground, of all loads",
        "ground_moment": f"moment on the ground about {about}, of all loads",
    }
    found = rates["whole"]
    return [(name, QUANTITIES[key], found[key]) for key, name in names.items() if found[key] is not None]


def whole_sentences(rates: Mapping[str, Any], unit: str) -> Iterator[str]:
    """Yield what the linkage as a whole has, a line each.

    Parameters
    ----------
    rates : mapping
        From ``rates_record``.
    unit : str
        Of the coordinate.

    Yields
    ------
    str
    """
    for name, of, row in whole_rows(rates):
        where = " and ".join(places(row))
        at = f" (at {where} {unit})" if where else ""
        yield f"linkage, {name}: {'up to ' if 'x' in row else ''}{ends(row)} {of}{at}"
    if rates["whole"]["momentum"] is None:
        yield "momentum and energy of the links are left out: no load case asks for their weight or inertia"


def ends(row: Mapping[str, Any] | None) -> str:
    """Return ``-3.1 to 4.2`` or ``±4.2``, the one value of what is constant, or the largest size of a vector.

    Parameters
    ----------
    row : mapping or None
        Extremes, of numbers or of a vector; None where they are not known.

    Returns
    -------
    str
    """
    if row is None:
        return ""
    if "x" in row:
        return number(row["largest"], _DIGITS)
    if row["unbounded"]:
        return number(float("nan"))
    size = max(abs(row["smallest"]), abs(row["largest"]))
    told = [number(row[key], _DIGITS, beside=1e3 * size) for key in ("smallest", "largest")]
    if row["smallest"] < 0.0 and told[0] == f"−{told[1]}":
        return f"±{told[1]}"
    return told[0] if told[0] == told[1] else " to ".join(told)


def _at(row: Mapping[str, Any]) -> str:
    return f"{row['largest_at']:.1f}" if row["largest"] > 0.0 else ""


def places(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return where the extremes stand, in words: of a vector its largest, of numbers the smallest and the largest.

    Parameters
    ----------
    row : mapping
        Extremes, of numbers or of a vector.

    Returns
    -------
    tuple of str
        None of what is constant.
    """
    if "x" in row:
        return (_at(row),) if row["largest"] > 0.0 else ()
    if row["unbounded"] or row["smallest"] == row["largest"]:
        return ()
    return f"{row['smallest_at']:.1f}", f"{row['largest_at']:.1f}"


def told_speed(result: CaseMotion, load_case: str) -> str:
    """Return the speed of the coordinate in a load case, at the first pose.

    Parameters
    ----------
    result : CaseMotion
    load_case : str

    Returns
    -------
    str
        In rpm, or in mm/s of a travel.
    """
    speed = result.case.load_cases[load_case].speed or float(result.moved[load_case].speed[0])
    return f"{speed:.4g} mm/s" if result.motion.slides else f"{speed * 30.0 / math.pi:.4g} rpm"
