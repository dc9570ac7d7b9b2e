"""An accuracy as people state it: ``"5 %"`` or 0.05."""

import re
from typing import Annotated

from pydantic import PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

LEAST, MOST = 0.001, 1.0


def parse_accuracy(stated: object) -> float:
    """Return an accuracy as a share of the number, 0.05 for ``"5 %"``, ``"0.05"`` or 0.05.

    Raises ``PydanticCustomError`` for anything else, and for a share outside 0.1 % to 100 %.
    """
    share = None
    if isinstance(stated, int | float) and not isinstance(stated, bool):
        share = float(stated)
    elif isinstance(stated, str) and (found := re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(%?)\s*", stated, re.ASCII)):
        share = float(found[1]) / (100.0 if found[2] else 1.0)
    if share is None or not LEAST <= share <= MOST:
        raise PydanticCustomError(
            "not_an_accuracy", 'the accuracy must be a share from 0.1 % to 100 %; write for example "5 %" or 0.05'
        )
    return share


Accuracy = Annotated[
    float,
    PlainValidator(parse_accuracy),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}], "examples": ["5 %", 0.05]}),
]
