"""How a case writes what it states of a pin in its holes: a clearance or a fit, for the joint or for each link."""

from collections.abc import Callable, Mapping
from typing import Annotated, Any, TypeVar

from pydantic import PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import refusal
from alula.geometry.base.units import EXAMPLES, parse
from alula.geometry.joints.fits import parse_fit

Range = tuple[float, float]
PRESS, RUNS = "press", "running"
_T = TypeVar("_T")


def _by_link(stated: object, read: Callable[[object], _T]) -> _T | dict[str, _T]:
    """Read a value, or a table of them by link."""
    if not isinstance(stated, Mapping):
        return read(stated)
    found = {}
    for link, value in stated.items():
        if not (isinstance(link, str) and link.isprintable() and len(link) <= 64):
            raise refusal("its names must be those of the joint's links; correct them")
        try:
            found[link] = read(value)
        except PydanticCustomError as error:
            raise refusal(f"in link '{link}' {error.message()}") from None
    if not found:
        raise refusal("the table names no link; leave it out, or name one of the joint's links")
    return found


def _clearance(stated: object) -> float | Range:
    return length_or_range(stated, "clearance", 'write zero or more, or a fit = { LINK = "press" }')


def length_or_range(stated: object, what: str, remedy: str) -> float | Range:
    """Read a length that is not negative, or a range of such lengths.

    Parameters
    ----------
    stated : object
        As a case has it.
    what, remedy : str
        What it is, and what to do where it is negative.

    Returns
    -------
    float or tuple of 2 float
        [mm]
    """

    def size(value: object) -> float:
        found = parse(value, "length")
        if found < 0.0:
            raise refusal(f"the {what} must not be negative; {remedy}")
        return found

    if not isinstance(stated, list | tuple):
        return size(stated)
    if len(stated) != 2:
        raise refusal('a range has two lengths; write for example ["0.01 mm", "0.05 mm"]')
    low, high = map(size, stated)
    if low > high:
        raise refusal(f"its range goes from {low:g} mm to {high:g} mm; write the least {what} first")
    return low, high


def ends_of(stated: float | Range) -> Range:
    """Return the least and the largest of a length or a range.

    Parameters
    ----------
    stated : float or tuple of 2 float

    Returns
    -------
    tuple of 2 float
    """
    return stated if isinstance(stated, tuple) else (stated, stated)


def _fit(stated: object) -> str:
    if not isinstance(stated, str):
        raise refusal('a fit is text; write for example "H8/f7", "running" or "press"')
    if stated not in (PRESS, RUNS):
        try:
            parse_fit(stated)
        except CaseError as error:
            raise refusal(str(error)) from None
    return stated


def _schema(value: dict[str, Any]) -> WithJsonSchema:
    """Describe a value, or a table of them whose names are those of the joint's links."""
    table = {"type": "object", "additionalProperties": value, "minProperties": 1, "maxProperties": 2}
    options = value.get("anyOf", [value])
    return WithJsonSchema({"anyOf": [*options, {**table, "x-names": "links"}]})


_LENGTH = {
    "type": "string",
    "format": "length",
    "description": "length with its unit",
    "examples": [EXAMPLES["length"]],
    "x-rule": "not negative",
}
LENGTH_OR_RANGE: dict[str, Any] = {
    "anyOf": [_LENGTH, {"type": "array", "items": _LENGTH, "minItems": 2, "maxItems": 2}]
}

PinClearance = Annotated[
    float | Range | dict[str, float | Range],
    PlainValidator(lambda stated: _by_link(stated, _clearance)),
    _schema(LENGTH_OR_RANGE),
]
"""Diametral clearance [mm], a range of it, or either by link."""
PinFit = Annotated[
    str | dict[str, str],
    PlainValidator(lambda stated: _by_link(stated, _fit)),
    _schema({"type": "string", "examples": [RUNS, PRESS, "H8/f7"]}),
]
"""Code of a fit, ``running`` or ``press``, or one of these by link."""
