"""The kinds of parts that a case may state, and the records of a body made of one."""

from typing import Annotated

from pydantic import Field

from alula.geometry.bodies.body import Body
from alula.geometry.bodies.features import EyeSizes, HoleRow, Pin, PlainEnd, Ring, Slot
from alula.geometry.bodies.section import Section, rectangle, ring
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.disc import Disc
from alula.geometry.parts.mesh_part import MeshPart
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.step import FilePart, StepPart
from alula.geometry.parts.tube import Tube

__all__ = [
    "Bar",
    "Body",
    "Disc",
    "EyeSizes",
    "FilePart",
    "HoleRow",
    "MeshPart",
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

Part = Annotated[Tube | Bar | Disc | Plate | StepPart | MeshPart, Field(discriminator="shape")]
"""Any kind of part; a new kind joins here."""
