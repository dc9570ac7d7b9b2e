"""Tolerances as a user states them: how far a place, an angle, a load or a material may be off, and how it scatters."""

import re
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import core_schema

from alula.geometry.base.model import CaseModel, Text, refusal
from alula.geometry.base.units import parse

Distribution = Literal["uniform", "normal", "worst case"]


class Tolerance(CaseModel):
    """How far an entry of the case may be off, to either side."""

    plus_minus: Text
    """Half the width, such as "0.2 mm" or "10 %" of the entry."""
    distribution: Distribution = "uniform"
    """uniform: everywhere between both ends alike. normal: plus_minus is three standard deviations, and 0.3 % lie
    beyond. worst case: at either end, with equal probability."""

    def half_width(self, dimension: str | None, nominal: float, body_weight: float | None = None) -> float:
        """Return half the width in alula's unit, or as a share where the entry has no dimension.

        Parameters
        ----------
        dimension : str or None
            Such as "length"; None where only a share makes sense.
        nominal : float
            The entry's own value, of which a share is taken.
        body_weight : float, optional
            What the unit ``body_weight`` stands for [N].

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
            half = parse(self.plus_minus, dimension, body_weight)
        if half <= 0.0:
            raise refusal("a tolerance must be above zero, and a share needs an entry that is not zero; state its size")
        return half


class _TextOrTable:
    """Tells pydantic that text stands for a tolerance with this half width, evenly distributed."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read text as half the width."""
        return core_schema.no_info_before_validator_function(
            lambda value: {"plus_minus": value} if isinstance(value, str) else value, handler(source)
        )

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """Describe both."""
        return {"anyOf": [{"type": "string", "examples": ["0.2 mm", "10 %"]}, handler(schema)]}


Tolerances = dict[
    str,
    Annotated[
        Tolerance,
        _TextOrTable(),
    ],
]
"""Path of an entry -> its tolerance."""
TolerancesTable = Annotated[Tolerances, Field(max_length=500)]
