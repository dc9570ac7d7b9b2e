"""Tolerances as a user states them: how far a place, an angle, a load or a material may be off, and how it scatters."""

import re
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from geometry.base.model import CaseModel, Text, refusal
from geometry.base.units import parse

Distribution = Literal["uniform", "normal", "worst case"]


class Tolerance(CaseModel):
    """How far an entry of the case may be off, to either side."""

    plus_minus: Text
    """Half the width, such as "0.2 mm" or "10 %" of the entry."""
    distribution: Distribution = "uniform"
    """uniform: everywhere between both ends alike. normal: plus_minus is three standard deviations, and 0.3 % lie
    beyond. worst case: at either end, with equal probability."""

    def half_width(self, dimension: str | None, nominal: float) -> float:
        """Return half the width in alula's unit, or as a share where the entry has no dimension.

        Parameters
        ----------
        dimension : str or None
            Such as "length"; None where only a share makes sense.
        nominal : float
            The entry's own value, of which a share is taken.

        Returns
        -------
        float

        Raises
        ------
        PydanticCustomError
            For text that is neither.
        """
        share = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*%\s*", self.plus_minus, re.ASCII)
        if share:
            half = float(share[1]) / 100.0 * abs(nominal)
        elif dimension is None:
            raise refusal('it must be a share of the entry; write for example "10 %"')
        else:
            half = parse(self.plus_minus, dimension)
        if half <= 0.0:
            raise refusal("a tolerance must be above zero, and a share needs an entry that is not zero; state its size")
        return half


def _stated(value: object) -> object:
    return {"plus_minus": value} if isinstance(value, str) else value


Tolerances = dict[
    str,
    Annotated[
        Tolerance,
        BeforeValidator(_stated),
        WithJsonSchema(
            {
                "anyOf": [
                    {"type": "string", "description": "half the width, uniform", "examples": ["0.2 mm", "10 %"]},
                    {
                        "type": "object",
                        "properties": {
                            "plus_minus": {"type": "string", "examples": ["0.2 mm", "10 %"]},
                            "distribution": {"enum": ["uniform", "normal", "worst case"], "default": "uniform"},
                        },
                        "required": ["plus_minus"],
                        "additionalProperties": False,
                    },
                ]
            }
        ),
    ],
]
"""Path of an entry -> its tolerance."""
TolerancesTable = Annotated[Tolerances, Field(max_length=500)]
