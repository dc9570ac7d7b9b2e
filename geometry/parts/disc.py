"""The crank disc."""

import itertools
import math
from typing import Annotated, ClassVar, Literal

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name
from alula.geometry.base.units import POSITIVE, Length
from alula.geometry.bodies.body import Body, Feature, PartKind, apart, extent
from alula.geometry.bodies.eyes import check_flat_eyes
from alula.geometry.bodies.features import Pin
from alula.geometry.bodies.footprint import Footprint
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle

_CHORDS = 200


class Disc(PartKind):
    """A round plate, such as a crank disc, about the origin of its link's frame, with a hole for every pin."""

    takes: ClassVar[frozenset[Feature]] = frozenset(("eyes of their own",))
    is_beam: ClassVar[bool] = False
    by_hand: ClassVar[str] = (
        "hand calculation takes the disc for a beam of its narrowest net section between its holes: an estimate, "
        "since beam theory needs a length of several widths"
    )

    main_size: ClassVar[str] = "thickness"
    shape: Literal["disc"]
    material: Name
    """Name of a material, of the library or of [materials]."""
    diameter: Annotated[Length, POSITIVE]
    """Diameter of the disc."""
    thickness: Annotated[Length, POSITIVE]
    """Thickness along the pins."""
    eye_diameter: Annotated[Length, POSITIVE]
    """Diameter of the rings about the holes on whose faces a torque or a thrust enters, as under a washer or boss."""

    @model_validator(mode="after")
    def _sizes(self) -> "Disc":
        if self.eye_diameter >= self.diameter:
            raise PydanticCustomError(
                "wide_eye",
                "eye_diameter {eye} mm must be less than diameter {disc} mm; reduce it or widen the disc",
                {"eye": f"{self.eye_diameter:g}", "disc": f"{self.diameter:g}"},
            )
        return self

    @property
    def eye_thickness(self) -> float:
        """Length of the holes: the disc's thickness [mm]."""
        return self.thickness

    @property
    def fillet_radius(self) -> float:
        """0: a disc has no edges between eyes and the rest [mm]."""
        return 0.0

    @property
    def section(self) -> Section:
        """Cross-section through the middle of the disc, without its holes."""
        return rectangle(self.diameter, self.thickness)

    def hand_section(self, body: Body) -> Section:
        """As ``PartKind.hand_section``: the narrowest net section between the holes.

        That is the chord 2 √(R² - x²) less what the holes cut out of it: an estimate, since a disc is as wide as long
        and no beam.
        """

        def net(x: float) -> float:
            cut = sum(2.0 * math.sqrt(max((p.diameter / 2.0) ** 2 - (x - p.x) ** 2, 0.0)) for p in body.pins)
            return 2.0 * math.sqrt(max((self.diameter / 2.0) ** 2 - x**2, 0.0)) - cut

        first, last = extent(body)
        return rectangle(min(net(first + (last - first) * i / _CHORDS) for i in range(_CHORDS + 1)), self.thickness)

    def wall(self, body: Body, pin: Pin) -> float:
        """As ``PartKind.wall``: to the rim or to the nearest other hole; rings are faces of the disc."""
        others = [apart(pin, other) - other.diameter / 2.0 for other in body.pins if other.name != pin.name]
        return min(self.diameter / 2.0 - math.hypot(pin.x, pin.y), *others)

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: the rings about the holes fit."""
        check_flat_eyes(body)
        for pin in body.pins:
            eye = body.ring(pin).diameter
            least = 2.0 * math.hypot(pin.x, pin.y) + eye
            if least >= self.diameter:
                raise CaseError(
                    f"the ring about the hole at {pin.name} does not fit on the disc of {self.diameter:.4g} mm about "
                    f"the origin of the link's frame: set diameter above {least:.4g} mm, reduce eye_diameter "
                    f"{eye:.4g} mm, or move the pin inwards"
                )
        for one, other in itertools.combinations(body.pins, 2):
            if apart(one, other) <= (body.ring(one).diameter + body.ring(other).diameter) / 2.0:
                raise CaseError(
                    f"the rings about the holes at {one.name} and {other.name} overlap: set eye_diameter below "
                    f"{apart(one, other):.4g} mm, or move the pins further apart"
                )

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: a cylinder."""
        return kernel.cylinder((0, 0, -self.thickness / 2.0), (0, 0, self.thickness), self.diameter / 2.0)

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: a circle."""
        half = self.thickness / 2.0
        return (Footprint(corners=((0.0, 0.0),), radius=self.diameter / 2.0, low=-half, high=half),)

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: narrow rings keep their area only with elements as small as they are wide."""
        return [
            (
                min((body.ring(pin).diameter - pin.diameter) / 2.0, size),
                f"Fabs({pin.distance_formula}-{body.ring(pin).diameter / 2.0:.12g})",
            )
            for pin in body.pins
        ]
