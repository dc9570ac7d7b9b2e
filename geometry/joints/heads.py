"""The heads of a pin: faces across it, such as a head and a ring, between which its links lie."""

from typing import Annotated

from pydantic import PlainValidator, WithJsonSchema

from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import POSITIVE, Length
from alula.geometry.joints.pin_entries import LENGTH_OR_RANGE, Range, ends_of, length_or_range

HeadGap = Annotated[
    float | Range,
    PlainValidator(lambda stated: length_or_range(stated, "gap", "write zero or more")),
    WithJsonSchema(LENGTH_OR_RANGE),
]
"""Play along a pin [mm], or a range of it."""


class Heads(CaseModel):
    """Faces across a pin, such as its head and a ring or a washer, between which its links lie."""

    diameter: Annotated[Length, POSITIVE]
    """Outer diameter of the smallest of these faces; where the eye of a link is smaller, that counts."""
    gap: HeadGap
    """How far the links of the joint may move along the pin, all together: a length, or a range [least, largest]."""

    @property
    def gap_ends(self) -> Range:
        """Least and largest gap [mm]."""
        return ends_of(self.gap)
