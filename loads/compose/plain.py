"""Values of Python as a case file states them: text, numbers, lists and tables."""

import os
import re
from collections.abc import Mapping
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.loads.text.explain import printable
from alula.loads.text.nesting import DEEPEST, too_deep

_POINT = re.compile(r"links\.[^.]+\.points\.[^.]+")
_LARGEST = 2**63 - 1
"""Of the whole numbers that every reader of TOML takes."""


def plain(value: object, entry: str, level: int = 0) -> Any:
    """Return a value as a case file states it.

    Parameters
    ----------
    value : object
        Text, a number, a truth value, a list or a mapping of such; a path, which becomes its text; a numpy array or a
        series of pandas, which becomes a list; a pint quantity, which becomes text with its unit, or of an array a list
        of such. What a mapping names with None is left out. An array of bare numbers that is the point of a link is
        in mm, as all arrays that alula returns: no text with its unit stands in it beside a number.
    entry : str
        Its path, which decides on points and begins messages; "" for a whole case.
    level : int, optional
        Of tables and lists above it.

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
    if level > DEEPEST:
        raise too_deep(printable(entry))
    if hasattr(value, "magnitude") and hasattr(value, "units"):  # a quantity, of whichever registry
        number = value.magnitude.tolist() if hasattr(value.magnitude, "tolist") else value.magnitude
        return _with_unit(plain(number, entry, level), format(value.units, "~C"))
    if hasattr(value, "tolist"):  # an array, a series, a number of numpy
        bare = getattr(getattr(value, "dtype", None), "kind", None) in ("i", "u", "f")
        value = value.tolist()
        if bare and _POINT.fullmatch(entry):
            return _with_unit(value, "mm")
    match value:
        case bool():
            return bool(value)
        case int() if abs(value) > _LARGEST:
            raise CaseError(f"{printable(entry)}: a whole number of a case is at most 2^63 - 1; make it smaller")
        case int():  # a subclass, such as an enumeration's, as what it is made of
            return int(value)
        case float():
            return float(value)
        case str():
            return str.__str__(value)
        case os.PathLike():
            return os.fsdecode(value)
        case Mapping():
            return {
                (name := text_of(key, entry or "case", "key")): plain(inner, below(entry, name), level + 1)
                for key, inner in value.items()
                if inner is not None
            }
        case list() | tuple():
            return [plain(inner, below(entry, str(i)), level + 1) for i, inner in enumerate(value)]
    remedy = "leave it out, or remove the entry with without" if value is None else "give one of these"
    raise CaseError(
        f"{printable(entry or 'case')}: a value of a case is text, with its unit where it has one, a number, True or "
        f"False, a list or a dictionary, not {printable(type(value).__name__)}; {remedy}"
    )


def below(entry: str, key: str) -> str:
    """Return the path of an entry below another one.

    Parameters
    ----------
    entry : str
        "" for the top level.
    key : str

    Returns
    -------
    str
    """
    return f"{entry}.{key}" if entry else key


def text_of(value: object, entry: str, what: str) -> str:
    """Return text as a plain ``str``.

    Parameters
    ----------
    value : object
    entry : str
        What it belongs to; it begins the message.
    what : str
        What it is, for the message.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For anything else.
    """
    if not isinstance(value, str):
        raise CaseError(f"{printable(entry)}: the {what} must be text, not {type(value).__name__}; write it in quotes")
    return str.__str__(value)


def mapping_of(value: object, entry: str, holds: str) -> Mapping[Any, object]:
    """Return a mapping as it is.

    Parameters
    ----------
    value : object
    entry : str
        What takes it; it begins the message.
    holds : str
        What it holds, for the message.

    Returns
    -------
    mapping

    Raises
    ------
    CaseError
        For anything else.
    """
    if not isinstance(value, Mapping):
        raise CaseError(f"{entry}: it takes {holds} as a dictionary, not {type(value).__name__}; give one")
    return value


def path_text(value: object, entry: str) -> str:
    """Return the text of a path.

    Parameters
    ----------
    value : object
        Text, or a path.
    entry : str
        What it names; it begins the message.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For anything else, and for what no file can be called.
    """
    path = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    if not isinstance(path, str):
        raise CaseError(
            f"{entry}: it must be a path, as text or as Python has it, not {type(value).__name__}; give one"
        )
    try:
        named = b"\0" not in os.fsencode(path)
    except UnicodeEncodeError:
        named = False
    if not named:
        raise CaseError(f"{entry}: no file can be called '{printable(path)}'; choose another name")
    return str.__str__(path)


def _with_unit(number: Any, unit: str) -> Any:
    if isinstance(number, list):
        return [_with_unit(inner, unit) for inner in number]
    return f"{number!r} {unit}" if unit else number
