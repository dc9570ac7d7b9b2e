"""The scatter of a load case as people state it: ``"20 %"`` about its loads, or the least and largest share of them."""

import re
from typing import Annotated

from pydantic import PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

MOST = 10.0


def parse_scatter(stated: object) -> tuple[float, float]:
    """Return the least and the largest share of the stated loads: (0.8, 1.2) for ``"20 %"`` or 0.2.

    A table ``{ low = "90 %", high = "130 %" }`` states the two shares themselves, as a pair of numbers does. Raises
    ``PydanticCustomError`` for anything else, and for shares that do not hold the whole load or exceed ``MOST``.
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
    if low is None or high is None or not 0.0 < low <= 1.0 <= high <= MOST:
        raise PydanticCustomError(
            "not_a_scatter",
            'the scatter must be a share below 100 %, such as "20 %", or the least and the largest share of the loads, '
            'above zero, up to {most}, with the whole between them: write for example { low = "90 %", high = "130 %" }',
            {"most": f"{MOST:g}"},
        )
    return low, high


def _share(stated: object) -> float | None:
    if isinstance(stated, int | float) and not isinstance(stated, bool):
        return float(stated)
    if isinstance(stated, str) and (found := re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(%?)\s*", stated, re.ASCII)):
        return float(found[1]) / (100.0 if found[2] else 1.0)
    return None


_SHARE = {"anyOf": [{"type": "string"}, {"type": "number"}]}
LoadScatter = Annotated[
    tuple[float, float],
    PlainValidator(parse_scatter),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "description": "share of the loads, up and down", "examples": ["20 %"]},
                {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
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
