"""Properties over temperature: tables of factors on what a material has at room temperature."""

import itertools

from pydantic_core import PydanticCustomError

from alula.geometry.base.model import refusal
from alula.geometry.base.units import Number, Temperature

TemperatureFactors = tuple[tuple[Temperature, Number], ...]
"""(temperature [°C], factor), rising in temperature."""
ROOM = (20.0, 23.0)
"""Temperatures at which a card's own values hold [°C]: the reference temperatures of ISO 1 and of ISO 291."""


def factor_at(points: TemperatureFactors, temperature: float) -> float | None:
    """Return the factor at a temperature, linear between those of a table; 1 at room temperature.

    Parameters
    ----------
    points : tuple of (float, float)
        The table; it may be empty.
    temperature : float
        [°C]

    Returns
    -------
    float or None
        None outside the table.
    """
    table = _with_room(points)
    if not table[0][0] <= temperature <= table[-1][0]:
        return None
    for (t0, f0), (t1, f1) in itertools.pairwise(table):
        if temperature <= t1:
            return f0 + (f1 - f0) * (temperature - t0) / (t1 - t0)
    raise AssertionError("the table rises in temperature")


def covered(points: TemperatureFactors) -> tuple[float, float]:
    """Return the first and the last temperature that a table tells of.

    Parameters
    ----------
    points : tuple of (float, float)

    Returns
    -------
    tuple of 2 float
        [°C]
    """
    table = _with_room(points)
    return table[0][0], table[-1][0]


def _with_room(points: TemperatureFactors) -> TemperatureFactors:
    """Return a table with room temperature, where it ends above or below, or has no point of its own there."""
    known = [temperature for temperature, _ in points]
    states_it = any(ROOM[0] <= at <= ROOM[1] for at in known)
    room = tuple((at, 1.0) for at in ROOM if not (states_it and known[0] <= at <= known[-1]))
    return tuple(sorted((*room, *points)))


def check_factors(entry: str, points: TemperatureFactors, what: str) -> None:
    """Refuse a table that is not sorted, and one whose property is not 1 at room temperature or grows above it.

    Parameters
    ----------
    entry : str
        Name of the table.
    points : tuple of (float, float)
    what : str
        The property, in words.

    Raises
    ------
    PydanticCustomError
    """
    if any(a >= b for (a, _), (b, _) in itertools.pairwise(points)):
        raise PydanticCustomError(
            "temperatures_not_rising",
            "{entry} must rise in temperature; sort them and state each once",
            {"entry": entry},
        )
    for temperature, factor in points:
        if ROOM[0] <= temperature <= ROOM[1] and factor != 1.0:
            raise refusal(
                f"{entry} are {factor:g} at {temperature:g} degC, where the card's own {what} holds; state 1 there, "
                f"and the others as shares of the {what} at room temperature"
            )
    warm = ((ROOM[1], 1.0), *(point for point in points if point[0] > ROOM[1]))
    for (cooler, more), (warmer, less) in itertools.pairwise(warm):
        if less > more:
            raise refusal(
                f"{entry} grow from {more:g} at {cooler:g} degC to {less:g} at {warmer:g} degC, though a {what} falls "
                f"as it gets warmer; they are shares of the {what} at room temperature, at most 1"
            )
