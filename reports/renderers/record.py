"""Sections as ``result.json``."""

import json
import math
import tomllib
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from alula.geometry.base.version import result_stamp
from alula.reports.sections.section import Section, merged


@cache
def field_units() -> dict[str, Any]:
    """Return the unit of every dimension and, under ``fields``, of every field of ``result.json``."""
    found = tomllib.loads(files("alula.reports.renderers").joinpath("units.toml").read_text(encoding="utf-8"))
    return {**found["dimensions"], "fields": found["fields"]}


def as_record(sections: Iterable[Section], **head: Any) -> dict[str, Any]:
    """Return all entries of sections as data that JSON can hold.

    Parameters
    ----------
    sections : iterable of Section
    **head
        Entries above theirs.

    Returns
    -------
    dict
        Infinite and undefined numbers are None, and ``nulls`` lists them.
    """
    nulls: dict[str, str] = {}
    return as_brief_record(sections, nulls, units=field_units(), **head) | {"nulls": nulls}


def as_brief_record(sections: Iterable[Section], nulls: dict[str, str] | None = None, /, **head: Any) -> dict[str, Any]:
    """Return all entries of sections as data that JSON can hold, without ``nulls`` and without the unit of each field.

    Parameters
    ----------
    sections : iterable of Section
    nulls : dict, optional
        As of ``finite``.
    **head
        Entries above theirs.

    Returns
    -------
    dict
        Infinite and undefined numbers are None.
    """
    entries = merged(section.data for section in sections)
    return dict(finite({**result_stamp(), **head, **entries}, {} if nulls is None else nulls))


def as_json(record: Mapping[str, Any]) -> str:
    """Return a record as strict JSON, without NaN or infinity.

    Parameters
    ----------
    record : Mapping[str, Any]

    Returns
    -------
    str
    """
    return json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False)


def finite(value: Any, nulls: dict[str, str], path: str = "") -> Any:
    """Return data in which None replaces every infinite or undefined number.

    Parameters
    ----------
    value : object
        Plain data.
    nulls : dict
        Receives, for every number that was replaced, its path and what it was.
    path : str, optional
        Where the value stands in the whole data.

    Returns
    -------
    object
        A copy.
    """
    if isinstance(value, Mapping):
        return {key: finite(item, nulls, f"{path}.{key}" if path else str(key)) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item, nulls, f"{path}.{i}") for i, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        nulls[path] = "not a number" if math.isnan(value) else "infinite" if value > 0.0 else "minus infinite"
        return None
    return float(value) if isinstance(value, float) else value
