"""The content of a value as a digest: equal for equal values, whatever their identity, and different in any part."""

import hashlib
import struct
from collections.abc import Mapping, Sequence, Set
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np
from pydantic import BaseModel

OWN = "alula."
"""Whose classes are known by their names, since the sources that they come from are told besides."""


def digest(value: object) -> str:
    """Return the digest of a value's content.

    Of a record every field counts.

    Parameters
    ----------
    value : object
        Numbers, texts, arrays, collections, and records of alula.

    Returns
    -------
    str
        SHA-256, in hexadecimal digits.

    Raises
    ------
    TypeError
        For a value, or a part of it, whose content is not known.
    """
    found = hashlib.sha256()
    _feed(found, value)
    return found.hexdigest()


def _feed(found: Any, value: Any) -> None:
    def told(kind: str, size: int = 0) -> None:
        found.update(f"{len(kind)}:{kind}:{size};".encode())

    if value is None or isinstance(value, bool):
        told(repr(value))
    elif isinstance(value, Enum):
        _name(told, type(value))
        told(value.name)
    elif isinstance(value, int | str | bytes):
        content = value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogatepass")
        told({int: "int", str: "str", bytes: "bytes"}.get(type(value), type(value).__name__), len(content))
        found.update(content)
    elif type(value) in (float, complex):
        told(type(value).__name__)
        found.update(struct.pack("<dd", value.real, value.imag))
    elif isinstance(value, np.ndarray | np.generic):
        if value.dtype.hasobject:
            raise TypeError("an array of objects has no content of its own")
        told(f"{type(value).__name__} {value.dtype.str} {value.shape}")
        found.update(np.ascontiguousarray(value).data)
    elif isinstance(value, type):
        _name(told, value)
    elif isinstance(value, BaseModel):
        _name(told, type(value))
        _feed(found, {name: getattr(value, name) for name in type(value).model_fields})
        _feed(found, [value.__pydantic_extra__, value.__pydantic_private__])
    elif is_dataclass(value):
        _name(told, type(value))
        _feed(found, {one.name: getattr(value, one.name) for one in fields(value)})
    elif isinstance(value, Mapping):
        told("mapping", len(value))
        for one in value.items():
            _feed(found, one)
    elif isinstance(value, Set):
        told("set", len(value))
        for name in sorted(map(digest, value)):
            told(name)
    elif isinstance(value, Sequence):
        told("tuple" if isinstance(value, tuple) else "list", len(value))
        for one in value:
            _feed(found, one)
    else:
        raise TypeError(f"the content of a {type(value).__name__} is not known")


def _name(told: Any, what: Any) -> None:
    if not what.__module__.startswith(OWN):
        raise TypeError(f"the code of {what.__module__}.{what.__qualname__} is not known")
    told(f"{what.__module__}.{what.__qualname__}")
