"""The flat bar."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from geometry.base.model import Name
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from geometry.parts.body import Body, Feature
from geometry.parts.eyes import EYE_WIDTH, RIM, ROUNDING
from geometry.parts.kernel import Entity, Kernel
from geometry.parts.section import Section, rectangle
from geometry.parts.straight import Piece, Straight


class Bar(Straight):
    """A flat bar with round eyes: width in the linkage's plane, thickness along the pins."""

    takes: ClassVar[frozenset[Feature]] = frozenset(("slots", "arms", "rows of holes", "load points without a pin"))

    shape: Literal["bar"]
    material: Name
    width: Annotated[Length, POSITIVE]
    thickness: Annotated[Length, POSITIVE]
    fillet_radius: Annotated[Length, NOT_NEGATIVE]
    """Fillet where the bar's sides meet an eye, and its faces a thicker eye; 0 leaves the edge sharp."""
    eye_diameter: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: EYE_WIDTH * part["width"])
    """1.6 times width unless stated; built as wide as the bar where it is at most 1 % wider."""
    eye_thickness: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: part["thickness"])
    """The bar's thickness unless stated; if thicker, by so much that the fillet fits on the step."""

    @model_validator(mode="after")
    def _sizes(self) -> "Bar":
        sizes = {"eye": f"{self.eye_thickness:g}", "bar": f"{self.thickness:g}", "rim": f"{RIM:g}"}
        if self.eye_diameter < (1.0 - ROUNDING) * self.width:
            raise PydanticCustomError(
                "narrow_eye",
                "eye_diameter {eye} mm must be at least width {width} mm; increase it or leave it out",
                {"eye": f"{self.eye_diameter:g}", "width": f"{self.width:g}"},
            )
        if self.eye_thickness < (1.0 - ROUNDING) * self.thickness:
            raise PydanticCustomError(
                "thin_eye",
                "eye_thickness {eye} mm must be at least the bar's thickness {bar} mm; increase it or leave it out",
                sizes,
            )
        least = self.thickness + RIM * self.fillet_radius
        if (1.0 + ROUNDING) * self.thickness < self.eye_thickness < (1.0 - ROUNDING) * least:
            raise PydanticCustomError(
                "low_step",
                "eye_thickness {eye} mm makes a step too low for fillet_radius: set at least thickness + {rim} "
                "fillet_radius = {least} mm, or leave it out for eyes as thick as the bar ({bar} mm)",
                sizes | {"least": f"{least:g}"},
            )
        return self

    @property
    def section(self) -> Section:
        """Cross-section of the bar."""
        return rectangle(self.width, self.thickness)

    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """As ``Straight.prism``: a box."""
        x, y = piece.start
        corner, sides = (x, y - self.width / 2.0, -self.thickness / 2.0), (piece.length, self.width, self.thickness)
        return [kernel.box(corner, sides, piece.angle, piece.start)]
