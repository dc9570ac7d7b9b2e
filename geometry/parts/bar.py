"""The flat bar."""

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.body import FLAT_WALL, ON_AXIS, Body, Feature, extent
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.bodies.eyes import EYE_WIDTH, RIM, ROUNDING
from alula.geometry.bodies.features import Pin, Ring
from alula.geometry.bodies.footprint import Footprint
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle
from alula.geometry.parts.profile import Profile, profile, width_at
from alula.geometry.parts.straight import CLEAR_EYE, Piece, Straight
from alula.geometry.parts.widths import check_widths, widths_cuts, widths_footprints, widths_places, widths_solid

WIDE = 10.0
"""Width over thickness of a bar from which on the elements of its first mesh follow its width."""
MOST_TIMES = 4.0
"""Times its thickness that they follow at most: flatter elements solve slowly and bend less well."""
Station = tuple[Length, Annotated[Length, POSITIVE]]


class Bar(Straight):
    """A flat bar with round eyes: width in the linkage's plane, thickness along the pins."""

    takes: ClassVar[frozenset[Feature]] = frozenset(
        ("slots", "arms", "rows of holes", "load points without a pin", "eyes of their own", "forks")
    )

    main_size: ClassVar[str] = "thickness"
    shape: Literal["bar"]
    material: Name
    """Name of a material, of the library or of [materials]."""
    widths: Annotated[tuple[Station, ...], Field(max_length=50)] = ()
    """Width at stations along the bar in place of width, each [x, width] in the link's frame: linear in between, a step
    where two stations have one x, constant beyond the first and last. Eyes are then 1.6 times as wide as the bar at
    their pin, and as thick as the bar."""
    width: Annotated[Length, POSITIVE] = Field(default_factory=lambda part: _least(part))
    """Width all along; left out where widths states it."""
    thickness: Annotated[Length, POSITIVE]
    """Thickness along the pins."""
    fillet_radius: Annotated[Length, NOT_NEGATIVE]
    """Fillet where the bar's sides meet an eye, and its faces a thicker eye; 0 leaves the edge sharp."""
    shoulder_radius: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Fillet in the re-entrant corners of widths; 0 leaves them sharp."""
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
        self._check_stations()
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

    def _check_stations(self) -> None:
        """Refuse stations out of order, and what does not go with them."""
        if not self.widths:
            if self.width <= 0.0:
                raise PydanticCustomError("no_width", "width is missing; state it, or widths at stations of the bar")
            if self.shoulder_radius > 0.0:
                raise PydanticCustomError(
                    "shoulder", "shoulder_radius belongs to widths; state those, or leave shoulder_radius out"
                )
            return
        places = [x for x, _ in self.widths]
        pair = next((pair for pair in itertools.pairwise(places) if pair[1] < pair[0]), None)
        if pair is not None or any(places.count(x) > 2 for x in places):
            raise PydanticCustomError(
                "stations",
                "widths needs stations by rising x, and at most two with one x; {what}",
                {"what": f"sort them (x = {pair[1]:g} mm follows {pair[0]:g} mm)" if pair else "remove one"},
            )
        if self.width != _least({"widths": self.widths}):
            raise PydanticCustomError("width", "width and widths are both stated; leave one of them out")
        if self.ends == "round" and self.eye_diameter != EYE_WIDTH * self.width:
            raise PydanticCustomError(
                "eyes",
                "a bar with widths has eyes of {ratio} times the width at their pin; leave eye_diameter out, and state "
                "others with eyes in the link",
                {"ratio": f"{EYE_WIDTH:g}"},
            )
        if abs(self.eye_thickness - self.thickness) > ROUNDING * self.thickness:
            raise PydanticCustomError(
                "thick_eye", "a bar with widths has eyes as thick as itself; leave eye_thickness out"
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
        """As ``PartKind.unmeasured``: square ends, and a width that varies."""
        if self.widths:
            return "its width varies"
        return "its ends are square" if self.ends == "square" else ""

    @property
    def eye_entry(self) -> str:
        """As ``PartKind.eye_entry``: with square ends there is no eye_diameter, but the bar has an end and sides."""
        if self.ends == "round" or self.overhang is None:
            return "eye diameter" if self.widths else "eye_diameter"
        return "2 overhang" if 2.0 * self.overhang < self.width else "width"

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: pins of a strip with square ends lie on its axis."""
        for pin in body.pins:
            if self.ends == "square" and pin.foot is None and abs(pin.y) > ON_AXIS * self.width:
                raise CaseError(
                    f"pin {pin.name} is {abs(pin.y):.4g} mm off the link's axis, where a bar with square ends has no "
                    "pins: move it onto the axis, let an arm reach it (arms), or take a part of shape plate"
                )
        if self.widths:
            check_widths(body, self.profile(body), round_ends=self.ends == "round")
        else:
            super().check(body)

    def reach(self, body: Body) -> tuple[float, float]:
        """As ``Straight.reach``: past outermost pins by the overhang of square ends."""
        first, last = extent(body)
        spans = [x for pin in body.pins if pin.foot is None for x in pin.span]
        overhang = self.overhang or 0.0
        return first - overhang * (first in spans), last + overhang * (last in spans)

    @property
    def size(self) -> float:
        """As ``PartKind.size``: of a sheet a tenth of its width, but at most four times its thickness.

        Stresses in its plane vary over its width, and one quadratic element bends through its thickness as a plate
        does. With the thickness alone the first mesh of a sheet of 300 x 30 x 1 mm has 418,128 elements in place of
        45,388; one of 100 x 30 x 1 mm bends 0.2 % less in either direction than with half these sizes.
        """
        least = super().size
        return min(max(least, max(self.width, self.thickness) / WIDE), MOST_TIMES * least)

    @property
    def section(self) -> Section:
        """Cross-section of the bar."""
        return rectangle(self.width, self.thickness)

    def profile(self, body: Body) -> Profile:
        """Return the upper side of the bar.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        Profile
            From one end to the other.
        """
        return profile(self.widths or ((0.0, self.width),), self.shoulder_radius, *self.reach(body))

    def half_width(self, body: Body, x: float) -> float:
        """As ``PartKind.half_width``: by its stations."""
        return self.profile(body).half(x) if self.widths else super().half_width(body, x)

    def ring(self, pin: Pin) -> Ring:
        """As ``PartKind.ring``: where the width varies, by that at the pin."""
        found = super().ring(pin)
        if not self.widths:
            return found
        wide = width_at(self.widths, pin.x)
        eye = EYE_WIDTH * wide if self.ends == "round" else min(wide, 2.0 * (self.overhang or wide))
        return replace(found, diameter=eye)

    def flat_diameter(self, body: Body, pin: Pin) -> float:
        """As ``PartKind.flat_diameter``: clear of sides that are not parallel, too."""
        if not self.widths:
            return super().flat_diameter(body, pin)
        side, eye = self.profile(body), body.ring(pin).diameter
        if self.ends == "round" and eye >= CLEAR_EYE * 2.0 * side.half(pin.x):
            return eye
        return pin.diameter + FLAT_WALL * (min(eye, 2.0 * side.distance((pin.x, 0.0))) - pin.diameter)

    def cuts(self, body: Body) -> tuple[CutSection, ...]:
        """As ``PartKind.cuts``: those of its widths."""
        return widths_cuts(body, profile(self.widths, 0.0, *extent(body))) if self.widths else ()

    @property
    def may_be_sharp(self) -> bool:
        """As ``PartKind.may_be_sharp``: at re-entrant corners of its widths as well."""
        return super().may_be_sharp or (bool(self.widths) and self.shoulder_radius == 0.0)

    def scaled(self, s: Callable[[float], float]) -> Self:
        """As ``PartKind.scaled``: stations as well."""
        return super().scaled(s).model_copy(update={"widths": tuple((s(x), s(width)) for x, width in self.widths)})

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: of varying width, its outline extruded, with its eyes."""
        if not self.widths:
            return super().solid(kernel, body)
        return widths_solid(kernel, body, self.profile(body), round_ends=self.ends == "round")

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: of varying width, its outline and its eyes."""
        if not self.widths:
            return super().footprints(body)
        return widths_footprints(body, self.profile(body), round_ends=self.ends == "round")

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: along the fillets of shoulders, too."""
        if not self.widths:
            return super().fine_places(body, size, share)
        return widths_places(body, self.profile(body), size, share)

    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """As ``Straight.prism``: a box."""
        x, y = piece.start
        corner, sides = (x, y - self.width / 2.0, -self.thickness / 2.0), (piece.length, self.width, self.thickness)
        return [kernel.box(corner, sides, piece.angle, piece.start)]


def _least(part: dict[str, Any]) -> float:
    """Least width at the stations, which stands for the bar where one section must; 0 where none is stated."""
    return min((width for _, width in part.get("widths", ())), default=0.0)


def _eye(part: dict[str, Any]) -> float:
    """Diameter of the eyes where none is stated; with square ends that of the circle that fits about a last pin."""
    if part.get("ends") == "square" and part.get("overhang"):
        return float(min(part["width"], 2.0 * part["overhang"]))
    return float(EYE_WIDTH * part["width"])
