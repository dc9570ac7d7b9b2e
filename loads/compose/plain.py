"""Values of Python as a case file states them: text, numbers, lists and tables."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.loads.text.explain import printable
from alula.loads.text.nesting import refuse_deep


def plain(value: object, entry: str) -> Any:
    """Return a value as a case file states it.

    Parameters
    ----------
    value : object
        Text, a number, a truth value, a list or a mapping of such; a path, which becomes its text; a numpy array or a
        series of pandas, which becomes a list; a pint quantity, which becomes text with its unit, or of an array a list
        of such. What a mapping names with None is left out.
    entry : str
        What the message calls it.

    Returns
    -------
    object
        Made of ``str``, ``bool``, ``int``, ``float``, ``list`` and ``dict`` alone; nothing of it is shared with
        `value`.

    Raises
    ------
    CaseError
        For any other object, for a key that is no text, and where tables stand too deep in one another.
    """
    refuse_deep(value, entry)
    return _plain(value, entry)


def _plain(value: object, entry: str) -> Any:
    if hasattr(value, "magnitude") and hasattr(value, "units"):  # a quantity, of whichever registry
        return _with_unit(_plain(value.magnitude, entry), format(value.units, "~C"))
    if hasattr(value, "tolist"):  # an array, a series, a number of numpy
        value = value.tolist()
    match value:
        case bool():
            return bool(value)
        case str() | int() | float():  # a subclass, such as an enumeration's, as what it is made of
            kind = next(kind for kind in (str, int, float) if isinstance(value, kind))
            return kind(value) if kind is not str else str.__str__(value)
        case os.PathLike():
            return os.fsdecode(value)
        case Mapping():
            return {
                _key(key, entry): _plain(inner, f"{entry}.{key}") for key, inner in value.items() if inner is not None
            }
        case list() | tuple():
            return [_plain(inner, f"{entry}.{i}") for i, inner in enumerate(value)]
    raise CaseError(
        f"{printable(entry)}: a value of a case is text, with its unit where it has one, a number, True or False, a "
        f"list or a dictionary, not {printable(type(value).__name__)}; give one of these"
    )


def _key(key: object, entry: str) -> str:
    if not isinstance(key, str):
        raise CaseError(f"{printable(entry)}: the key {printable(repr(key))} must be text; write it in quotes")
    return str.__str__(key)


def _with_unit(number: Any, unit: str) -> Any:
    if isinstance(number, list):
        return [_with_unit(inner, unit) for inner in number]
    return f"{number!r} {unit}" if unit else number


def in_millimetres(points: object) -> object:
    """Return the points of a link with the unit of those that are arrays of bare numbers.

    An array has one kind of entry, so that no text with its unit stands in it beside a number; its numbers are mm, as
    those of all arrays that alula returns.

    Parameters
    ----------
    points : object
        Name -> place, where it is a mapping.

    Returns
    -------
    object
    """
    if not isinstance(points, Mapping):
        return points
    return {name: _millimetres(place) if _is_bare(place) else place for name, place in points.items()}


def _is_bare(place: object) -> bool:
    return isinstance(place, np.ndarray) and place.dtype.kind in "iuf"


def _millimetres(place: Any) -> Any:
    return _with_unit(place.tolist(), "mm")
