"""The kinds of parts that a case may state, and the records of a body made of one."""

from typing import Annotated

from pydantic import Field

from geometry.parts.bar import Bar
from geometry.parts.body import Body
from geometry.parts.disc import Disc
from geometry.parts.features import EyeSizes, HoleRow, Pin, PlainEnd, Ring, Slot
from geometry.parts.plate import Plate
from geometry.parts.section import Section, rectangle, ring
from geometry.parts.step import StepPart
from geometry.parts.tube import Tube

__all__ = [
    "Bar",
    "Body",
    "Disc",
    "EyeSizes",
    "HoleRow",
    "Part",
    "Pin",
    "PlainEnd",
    "Plate",
    "Ring",
    "Section",
    "Slot",
    "StepPart",
    "Tube",
    "rectangle",
    "ring",
]

Part = Annotated[Tube | Bar | Disc | Plate | StepPart, Field(discriminator="shape")]
"""Any kind of part; a new kind joins here."""
