"""Records of models as text that a page can hold: numbers in 16 bits, and no character that HTML gives a meaning."""

import base64
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

STEPS = 2**16 - 1
"""A quantised number is one of this many steps above the least of its column."""
_ESCAPES = {ord(letter): f"\\u{ord(letter):04x}" for letter in "<>&\u2028\u2029"}


def quantised(values: NDArray[np.float64]) -> dict[str, Any]:
    """Pack real numbers in 16 bits each; the error is at most half a step of 1/65535 of the range of their column.

    Parameters
    ----------
    values : array
        (n, k) or (n,).

    Returns
    -------
    dict
        ``low`` and ``high``, k values each, which 0 and 65535 stand for, and ``data``, base64 of little-endian
        integers, row by row.
    """
    columns = np.asarray(values, dtype=np.float64).reshape(len(values), -1)
    low, high = columns.min(axis=0), columns.max(axis=0)
    high = np.where(high > low, high, low + 1.0)
    steps = np.rint((columns - low) / (high - low) * STEPS).astype("<u2")
    return {"low": low.tolist(), "high": high.tolist(), "data": _text(steps)}


def indices(numbers: NDArray[np.int64]) -> dict[str, Any]:
    """Pack whole numbers from 0 in 16 bits each, or in 32 where one does not fit.

    Parameters
    ----------
    numbers : int array
        (n, k).

    Returns
    -------
    dict
        ``columns`` (k), ``bits`` and ``data``, base64 of little-endian integers, row by row.
    """
    bits = 16 if numbers.max(initial=0) <= STEPS else 32
    return {"columns": numbers.shape[1], "bits": bits, "data": _text(numbers.astype(f"<u{bits // 8}"))}


def shades(shares: NDArray[np.float64]) -> str:
    """Pack shares of a range in 8 bits each, since a legend has 256 colours.

    Parameters
    ----------
    shares : array
        From 0 to 1; what lies beyond has the last colour.

    Returns
    -------
    str
        Base64 of bytes, row by row.
    """
    return _text(np.rint(255.0 * np.clip(shares, 0.0, 1.0)).astype(np.uint8))


def data_block(record: Mapping[str, Any]) -> str:
    """Return a record as JSON for a ``<script type="application/json">``, whatever its texts hold.

    A browser ends a script at the first ``</script``, so that no ``<`` may stand in it.

    Parameters
    ----------
    record : mapping

    Returns
    -------
    str
    """
    text = json.dumps(record, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.translate(_ESCAPES)


def _text(numbers: NDArray[Any]) -> str:
    return base64.b64encode(numbers.tobytes()).decode("ascii")
