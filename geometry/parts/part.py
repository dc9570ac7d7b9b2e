"""The parametric shapes of links, with their cross-sections in closed form.

A part lies along the x axis of its link's frame, its pins along z, its mid-plane at z = 0.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from geometry.base.model import CaseModel, Name
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length

EYE_WIDTH = 1.6
"""Diameter of an eye over the width of its tube or bar, where none is stated: a proportion often met, no standard."""
RIM = 2.05
"""Fillet radii that an eye must rise in all above what it is filleted to: 2 by geometry, and the kernel fails on a
fillet that just touches the eye's rim."""
ROUNDING = 1e-9
"""Share by which lengths that are meant to be equal may differ, such as "0.3 in" and "7.62 mm"."""


@dataclass(frozen=True, kw_only=True)
class Section:
    """A cross-section normal to x: areas in mm², second moments in mm⁴.

    area      A
    i_y       second moment for bending out of the linkage's plane (about y)
    i_z       second moment for bending in the linkage's plane (about z)
    torsion   torsion constant J
    half_y    distance of the extreme fibre from the axis along y (in the plane) [mm]
    half_z    the same along z [mm]
    round     True where the section is a circular tube (its shear coefficient is Cowper's)
    """

    area: float
    i_y: float
    i_z: float
    torsion: float
    half_y: float
    half_z: float
    round: bool
    radius_ratio: float = 0.0
    """Inner over outer radius (tubes)."""

    def shear_coefficient(self, nu: float) -> float:
        """Timoshenko's shear coefficient after Cowper, J. Appl. Mech. 33 (1966) 335-340, table 1.

        Hollow circle: 6(1+ν)(1+m²)² / [(7+6ν)(1+m²)² + (20+12ν)m²]; rectangle: 10(1+ν)/(12+11ν).
        """
        if not self.round:
            return 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        m2 = self.radius_ratio**2
        return 6.0 * (1.0 + nu) * (1.0 + m2) ** 2 / ((7.0 + 6.0 * nu) * (1.0 + m2) ** 2 + (20.0 + 12.0 * nu) * m2)


def ring(outer_diameter: float, inner_diameter: float) -> Section:
    """Return a circular tube, or a rod with inner diameter 0 (Roark, 8th ed., table A.1, case 16)."""
    outer, inner = outer_diameter / 2.0, inner_diameter / 2.0
    second = math.pi / 4.0 * (outer**4 - inner**4)
    return Section(
        area=math.pi * (outer**2 - inner**2),
        i_y=second,
        i_z=second,
        torsion=2.0 * second,
        half_y=outer,
        half_z=outer,
        round=True,
        radius_ratio=inner / outer,
    )


def rectangle(width: float, thickness: float) -> Section:
    """Return a rectangle, its width in the linkage's plane.

    J = a b³ (16/3) (1 - 192/π⁵ b/a Σ tanh(nπa/2b)/n⁵), n odd, of half-sides a >= b (Timoshenko & Goodier, Theory of
    Elasticity, 3rd ed., section 109), with Σ 1/n⁵ = 1.0045237628 taken out of the sum.
    """
    a, b = max(width, thickness) / 2.0, min(width, thickness) / 2.0
    series = 1.0045237627951 - sum(2.0 / (math.exp(min(n * math.pi * a / b, 700.0)) + 1.0) / n**5 for n in (1, 3, 5))
    return Section(
        area=width * thickness,
        i_y=width * thickness**3 / 12.0,
        i_z=thickness * width**3 / 12.0,
        torsion=16.0 / 3.0 * a * b**3 * (1.0 - 192.0 / math.pi**5 * b / a * series),
        half_y=width / 2.0,
        half_z=thickness / 2.0,
        round=False,
    )


class Tube(CaseModel):
    """A round tube (hollow, or solid with inner diameter 0) with a cylindrical eye at every pin.

    The bore ends where it meets an eye: eyes are solid but for their pin hole.
    """

    shape: Literal["tube"]
    material: Name
    outer_diameter: Annotated[Length, POSITIVE]
    inner_diameter: Annotated[Length, NOT_NEGATIVE]
    fillet_radius: Annotated[Length, NOT_NEGATIVE]
    """Fillet where the tube meets an eye; 0 leaves the edge sharp (and its stress singular)."""
    eye_diameter: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: EYE_WIDTH * part["outer_diameter"])
    """1.6 times outer_diameter unless stated."""
    eye_thickness: Annotated[Length, POSITIVE] = Field(
        default_factory=lambda part: part["outer_diameter"] + 2.5 * part["fillet_radius"]
    )
    """Height of the eye's cylinder along the pin; outer_diameter + 2.5 fillet_radius unless stated."""

    @model_validator(mode="after")
    def _sizes(self) -> "Tube":
        if self.inner_diameter >= self.outer_diameter:
            raise PydanticCustomError(
                "no_wall",
                "inner_diameter {inner} mm leaves no wall in outer_diameter {outer} mm; make the bore smaller",
                {"inner": f"{self.inner_diameter:g}", "outer": f"{self.outer_diameter:g}"},
            )
        if self.eye_diameter <= self.outer_diameter:
            raise PydanticCustomError(
                "narrow_eye",
                "eye_diameter {eye} mm must be greater than outer_diameter {outer} mm; widen the eye or leave it out",
                {"eye": f"{self.eye_diameter:g}", "outer": f"{self.outer_diameter:g}"},
            )
        least = self.outer_diameter + RIM * self.fillet_radius
        if self.eye_thickness < (1.0 - ROUNDING) * least:
            raise PydanticCustomError(
                "thin_eye",
                "eye_thickness {eye} mm must be at least outer_diameter + {rim} fillet_radius = {least} mm, so that "
                "the fillet runs all round the tube; make the eye thicker, the fillet smaller or leave eye_thickness "
                "out",
                {"eye": f"{self.eye_thickness:g}", "rim": f"{RIM:g}", "least": f"{least:g}"},
            )
        return self

    @property
    def section(self) -> Section:
        """Cross-section of the tube between its eyes."""
        return ring(self.outer_diameter, self.inner_diameter)


class Bar(CaseModel):
    """A flat bar with round eyes: width in the linkage's plane, thickness along the pins."""

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
        if self.eye_diameter < (1.0 - ROUNDING) * self.width:
            raise PydanticCustomError(
                "narrow_eye",
                "eye_diameter {eye} mm must be at least width {width} mm; widen the eye or leave it out",
                {"eye": f"{self.eye_diameter:g}", "width": f"{self.width:g}"},
            )
        if self.eye_thickness < (1.0 - ROUNDING) * self.thickness:
            raise PydanticCustomError(
                "thin_eye",
                "eye_thickness {eye} mm must be at least the bar's thickness {bar} mm; make the eye thicker or leave "
                "eye_thickness out",
                {"eye": f"{self.eye_thickness:g}", "bar": f"{self.thickness:g}"},
            )
        least = self.thickness + RIM * self.fillet_radius
        if self.has_step and self.eye_thickness < (1.0 - ROUNDING) * least:
            raise PydanticCustomError(
                "low_step",
                "eye_thickness {eye} mm makes a step on the bar of {bar} mm too low for its fillet, whose sharp edge "
                "would have no finite stress; it must be at least thickness + {rim} fillet_radius = {least} mm, or "
                "leave it out for eyes as thick as the bar",
                {
                    "eye": f"{self.eye_thickness:g}",
                    "bar": f"{self.thickness:g}",
                    "rim": f"{RIM:g}",
                    "least": f"{least:g}",
                },
            )
        return self

    @property
    def has_step(self) -> bool:
        """Whether the eyes are thicker than the bar."""
        return self.eye_thickness > (1.0 + ROUNDING) * self.thickness

    @property
    def section(self) -> Section:
        """Cross-section of the bar."""
        return rectangle(self.width, self.thickness)


class Disc(CaseModel):
    """A round plate, such as a crank disc, about the origin of its link's frame, with a hole for every pin."""

    shape: Literal["disc"]
    material: Name
    diameter: Annotated[Length, POSITIVE]
    thickness: Annotated[Length, POSITIVE]
    eye_diameter: Annotated[Length, POSITIVE]
    """Diameter of the rings about the holes on whose faces a torque or a thrust enters, as under a washer or boss."""

    @model_validator(mode="after")
    def _sizes(self) -> "Disc":
        if self.eye_diameter >= self.diameter:
            raise PydanticCustomError(
                "wide_eye",
                "eye_diameter {eye} mm must be less than diameter {disc} mm; make the rings about the holes smaller",
                {"eye": f"{self.eye_diameter:g}", "disc": f"{self.diameter:g}"},
            )
        return self

    @property
    def eye_thickness(self) -> float:
        """Length of the holes: the disc's thickness [mm]."""
        return self.thickness

    @property
    def section(self) -> Section:
        """Cross-section through the middle of the disc, without its holes."""
        return rectangle(self.diameter, self.thickness)


Part = Annotated[Tube | Bar | Disc, Field(discriminator="shape")]


class HoleRow(CaseModel):
    """A row of equal cross holes along the link, such as those that hold feathers."""

    count: Annotated[int, Field(gt=0, le=200)]
    diameter: Annotated[Length, POSITIVE]
    first: Length
    """x of the first hole in the link's frame."""
    last: Length
    """x of the last hole; the others are evenly spaced between."""
    along: Literal["y", "z"]
    """Direction of the holes' axes: y in the linkage's plane, z along the pins."""

    @property
    def positions(self) -> tuple[float, ...]:
        """The x of every hole [mm]."""
        if self.count == 1:
            return (self.first,)
        step = (self.last - self.first) / (self.count - 1)
        return tuple(self.first + i * step for i in range(self.count))


class Slot(CaseModel):
    """A through slot along the link's axis, with round ends, in which a pin slides."""

    first: Length
    """x of the centre of one round end in the link's frame: how far the pin's centre may travel."""
    last: Length
    """x of the centre of the other round end."""
    clearance: Annotated[Length, NOT_NEGATIVE] = 0.0
    """How much wider the slot is than the pin."""

    @model_validator(mode="after")
    def _order(self) -> "Slot":
        if not self.first < self.last:
            raise PydanticCustomError(
                "no_slot",
                "a slot from first = {first} mm to last = {last} mm has no length; state first < last",
                {"first": f"{self.first:g}", "last": f"{self.last:g}"},
            )
        return self


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A pin hole of a link, or a slot: a hole drawn out along x.

    name       of the point
    x, y       of the middle in the link's frame [mm]
    diameter   of the hole, or width of the slot [mm]
    slot       distance of the centres of a slot's round ends [mm]; 0 for a hole
    clearance  how much wider than the pin the slot is [mm]
    foot       (x, y) on the link's axis from which an arm reaches to this pin [mm]; None for a pin on the axis
    """

    name: str
    x: float
    y: float
    diameter: float
    slot: float = 0.0
    clearance: float = 0.0
    foot: tuple[float, float] | None = None

    @property
    def span(self) -> tuple[float, float]:
        """The x of the centres of a slot's round ends; twice that of a hole's centre [mm]."""
        return self.x - self.slot / 2.0, self.x + self.slot / 2.0

    @property
    def pin_diameter(self) -> float:
        """Diameter of the pin in it [mm]."""
        return self.diameter - self.clearance


@dataclass(frozen=True, kw_only=True)
class PlainEnd:
    """A load point that is no pin: name, x in the link's frame [mm], length of the loaded patch [mm]."""

    name: str
    x: float
    patch: float


@dataclass(frozen=True, kw_only=True)
class Body:
    """All that shapes one link: what the mesher and the mass properties need."""

    part: Part
    pins: tuple[Pin, ...]
    ends: tuple[PlainEnd, ...]
    holes: tuple[HoleRow, ...]
