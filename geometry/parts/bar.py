"""The flat bar."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field
from pydantic_core import PydanticCustomError

from geometry.base.errors import CaseError
from geometry.base.model import Name
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from geometry.bodies.body import ON_AXIS, Body, Feature, extent
from geometry.bodies.eyes import EYE_WIDTH, RIM, ROUNDING
from geometry.bodies.kernel import Entity, Kernel
from geometry.bodies.section import Section, rectangle
from geometry.parts.straight import Piece, Straight


class Bar(Straight):
    """A flat bar with round eyes: width in the linkage's plane, thickness along the pins."""

    takes: ClassVar[frozenset[Feature]] = frozenset(
        ("slots", "arms", "rows of holes", "load points without a pin", "eyes of their own")
    )

    shape: Literal["bar"]
    material: Name
    width: Annotated[Length, POSITIVE]
    thickness: Annotated[Length, POSITIVE]
    fillet_radius: Annotated[Length, NOT_NEGATIVE]
    """Fillet where the bar's sides meet an eye, and its faces a thicker eye; 0 leaves the edge sharp."""
    ends: Literal["round", "square"] = "round"
    """round: an eye at every pin, about which the bar ends. square: a plain strip without eyes, which reaches past its
    outermost pins by overhang and is cut off straight there."""
    overhang: Annotated[Length, POSITIVE] | None = None
    """From the centre of an outermost pin to the square end beyond it."""
    eye_diameter: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: _eye(part))
    """1.6 times width unless stated; built as wide as the bar where it is at most 1 % wider. With square ends it is not
    stated."""
    eye_thickness: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: part["thickness"])
    """The bar's thickness unless stated; if thicker, by so much that the fillet fits on the step."""

    def check_sizes(self) -> None:
        """As ``Straight.check_sizes``: round ends have eyes, on which fillets fit, square ends an overhang and none."""
        if self.ends == "square":
            self._check_square()
            return
        if self.overhang is not None:
            raise PydanticCustomError(
                "overhang", 'overhang belongs to ends = "square"; state that, or leave overhang out'
            )
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

    def _check_square(self) -> None:
        """Refuse what square ends do not go with."""
        if self.overhang is None:
            raise PydanticCustomError(
                "no_overhang", 'overhang is missing: ends = "square" needs how far the bar reaches past its last pins'
            )
        eye, thick = min(self.width, 2.0 * self.overhang), self.thickness
        if abs(self.eye_diameter - eye) > ROUNDING * eye or abs(self.eye_thickness - thick) > ROUNDING * thick:
            raise PydanticCustomError(
                "eyes", 'a bar with ends = "square" has no eyes; leave eye_diameter, eye_thickness and eyes out'
            )

    @property
    def unmeasured(self) -> str:
        """As ``PartKind.unmeasured``: square ends."""
        return "its ends are square" if self.ends == "square" else ""

    @property
    def eye_entry(self) -> str:
        """As ``PartKind.eye_entry``: with square ends there is no eye_diameter, but the bar has an end and sides."""
        if self.ends == "round" or self.overhang is None:
            return "eye_diameter"
        return "2 overhang" if 2.0 * self.overhang < self.width else "width"

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: pins of a strip with square ends lie on its axis."""
        for pin in body.pins:
            if self.ends == "square" and pin.foot is None and abs(pin.y) > ON_AXIS * self.width:
                raise CaseError(
                    f"pin {pin.name} is {abs(pin.y):.4g} mm off the link's axis, where a bar with square ends has no "
                    "pins: move it onto the axis, let an arm reach it (arms), or take a part of shape plate"
                )
        super().check(body)

    def reach(self, body: Body) -> tuple[float, float]:
        """As ``Straight.reach``: past outermost pins by the overhang of square ends."""
        first, last = extent(body)
        spans = [x for pin in body.pins if pin.foot is None for x in pin.span]
        overhang = self.overhang or 0.0
        return first - overhang * (first in spans), last + overhang * (last in spans)

    @property
    def section(self) -> Section:
        """Cross-section of the bar."""
        return rectangle(self.width, self.thickness)

    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """As ``Straight.prism``: a box."""
        x, y = piece.start
        corner, sides = (x, y - self.width / 2.0, -self.thickness / 2.0), (piece.length, self.width, self.thickness)
        return [kernel.box(corner, sides, piece.angle, piece.start)]


def _eye(part: dict[str, Any]) -> float:
    """Diameter of the eyes where none is stated; with square ends that of the circle that fits about a last pin."""
    if part.get("ends") == "square" and part.get("overhang"):
        return float(min(part["width"], 2.0 * part["overhang"]))
    return float(EYE_WIDTH * part["width"])
