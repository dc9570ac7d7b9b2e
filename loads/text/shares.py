"""Shares as people state them: ``"5 %"``, ``"0.05"`` or 0.05; the accuracy of meshes and the scatter of loads."""

import re
from typing import Annotated

from pydantic import PlainValidator, WithJsonSchema

from alula.geometry.base.model import refusal

LEAST_ACCURACY, LARGEST_ACCURACY = 0.001, 1.0
LARGEST_LOAD = 10.0
"""Largest load that a scatter may reach, as a share of the stated one."""


def parse_accuracy(stated: object) -> float:
    """Read an accuracy.

    Parameters
    ----------
    stated : object
        What the user wrote.

    Returns
    -------
    float
        Share of the number: 0.05 for ``"5 %"``, ``"0.05"`` or 0.05.

    Raises
    ------
    PydanticCustomError
        For anything else, and for a share outside 0.1 % to 100 %.
    """
    share = _share(stated)
    if share is None or not LEAST_ACCURACY <= share <= LARGEST_ACCURACY:
        raise refusal('the accuracy must be a share from 0.1 % to 100 %; write for example "5 %" or 0.05')
    return share


def parse_scatter(stated: object) -> tuple[float, float]:
    """Read the scatter of loads.

    Parameters
    ----------
    stated : object
        What the user wrote: ``"20 %"`` or 0.2 about the stated loads, a table ``{ low = "90 %", high = "130 %" }`` or a
        pair with the least and the largest share of them.

    Returns
    -------
    tuple of float
        Least and largest share of the stated loads: (0.8, 1.2) for ``"20 %"``.

    Raises
    ------
    PydanticCustomError
        For anything else, and for shares that do not hold the whole load or exceed ``LARGEST_LOAD``.
    """
    low = high = None
    if isinstance(stated, dict):
        if set(stated) == {"low", "high"}:
            low, high = _share(stated["low"]), _share(stated["high"])
    elif isinstance(stated, list | tuple):
        if len(stated) == 2:
            low, high = _share(stated[0]), _share(stated[1])
    elif (share := _share(stated)) is not None:
        low, high = 1.0 - share, 1.0 + share
    if low is None or high is None or not 0.0 < low <= 1.0 <= high <= LARGEST_LOAD:
        raise refusal(
            'the scatter must be one share below 100 %, such as "20 %", or the least and the largest load in shares of '
            f"the stated one, low above 0 and up to 100 %, high from 100 % up to {LARGEST_LOAD:.0%}; "
            'write for example { low = "90 %", high = "130 %" }'
        )
    return low, high


def _share(stated: object) -> float | None:
    if isinstance(stated, int | float) and not isinstance(stated, bool):
        return float(stated) if abs(stated) <= LARGEST_LOAD else None
    if isinstance(stated, str) and (found := re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(%?)\s*", stated, re.ASCII)):
        return float(found[1]) / (100.0 if found[2] else 1.0)
    return None


_SHARE = {"anyOf": [{"type": "string", "format": "percentage"}, {"type": "number"}]}
Accuracy = Annotated[float, PlainValidator(parse_accuracy), WithJsonSchema({**_SHARE, "examples": ["5 %", 0.05]})]
LoadScatter = Annotated[
    tuple[float, float],
    PlainValidator(parse_scatter),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "format": "percentage", "examples": ["20 %"]},
                {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
                {"type": "array", "prefixItems": [_SHARE, _SHARE], "minItems": 2, "maxItems": 2},
                {
                    "type": "object",
                    "properties": {"low": _SHARE, "high": _SHARE},
                    "required": ["low", "high"],
                    "additionalProperties": False,
                    "examples": [{"low": "90 %", "high": "130 %"}],
                },
            ]
        }
    ),
]
