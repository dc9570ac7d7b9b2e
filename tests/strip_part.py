"""A kind of part in one class: a plain strip with square ends, as a contributor would add it."""

from typing import Annotated, ClassVar, Literal

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import POSITIVE, Length
from alula.geometry.bodies.body import Body, Feature, PartKind, extent
from alula.geometry.bodies.footprint import Footprint, strip
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle


class Strip(PartKind):
    """A flat strip that reaches beyond its outermost pins."""

    takes: ClassVar[frozenset[Feature]] = frozenset(("rows of holes",))

    shape: Literal["strip"]
    material: str
    width: Annotated[Length, POSITIVE]
    thickness: Annotated[Length, POSITIVE]
    overhang: Annotated[Length, POSITIVE]
    fillet_radius: ClassVar[float] = 0.0

    @property
    def eye_diameter(self) -> float:
        return self.width

    @property
    def eye_thickness(self) -> float:
        return self.thickness

    @property
    def section(self) -> Section:
        return rectangle(self.width, self.thickness)

    def check(self, body: Body) -> None:
        for pin in body.pins:
            if pin.diameter / 2.0 >= self.overhang:
                raise CaseError(f"the hole at {pin.name} reaches the end: set overhang above {pin.diameter / 2.0:g} mm")

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        first, last = extent(body)
        corner = first - self.overhang, -self.width / 2.0, -self.thickness / 2.0
        return kernel.box(corner, (last - first + 2.0 * self.overhang, self.width, self.thickness))

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        first, last = extent(body)
        length = last - first + 2.0 * self.overhang
        return (strip((first - self.overhang, 0.0), 0.0, length, self.width, self.thickness),)

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        return []
