"""The round tube."""

import itertools
import math
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.body import Body, Feature, extent, patch_span
from alula.geometry.bodies.eyes import EYE_WIDTH, RIM, ROUNDING
from alula.geometry.bodies.features import Pin, Ring
from alula.geometry.bodies.footprint import Footprint, eye, strip
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle, ring
from alula.geometry.parts.lugs import check_lugs, fine_at_lugs, with_lugs, without_lugs
from alula.geometry.parts.straight import Piece, Straight
from alula.geometry.parts.tube_pins import check_pins_through

ROD_SIZE = 0.8
"""Largest element edge in a rod, over its radius."""


class Tube(Straight):
    """A round tube (hollow, or solid with inner diameter 0) with a cylindrical eye at every pin, or none.

    Without eyes the pins go straight through both walls. The bore ends where it meets an eye: eyes are solid but for
    their pin hole.
    """

    takes: ClassVar[frozenset[Feature]] = frozenset(
        ("arms", "rows of holes", "load points without a pin", "eyes of their own")
    )

    main_size: ClassVar[str] = "outer_diameter"
    shape: Literal["tube"]
    material: Name
    """Name of a material, of the library or of [materials]."""
    outer_diameter: Annotated[Length, POSITIVE]
    """Outer diameter of the tube."""
    inner_diameter: Annotated[Length, NOT_NEGATIVE]
    """Diameter of its bore, less than the outer diameter; 0 mm for a rod."""
    eyes: Literal["round", "none"] = "round"
    """round: a solid cylindrical eye at every pin. none: pins go straight through both walls; the ends are square."""
    fillet_radius: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Fillet where the tube meets an eye, a plug or a bush; 0 leaves the edge sharp (and its stress singular).
    With eyes it must be stated; without eyes, plugs and bushes it has no effect."""
    eye_diameter: Annotated[Length, POSITIVE] = Field(
        default_factory=lambda part: EYE_WIDTH * part["outer_diameter"] if part["eyes"] == "round" else 0.0
    )
    """1.6 times outer_diameter unless stated; not with eyes = "none"."""
    eye_thickness: Annotated[Length, POSITIVE] = Field(
        default_factory=lambda part: (
            part["outer_diameter"] + (2.5 * part["fillet_radius"] if part["eyes"] == "round" else 0.0)
        )
    )
    """Height of the eye's cylinder along the pin; outer_diameter + 2.5 fillet_radius unless stated; not with eyes =
    "none"."""
    overhang: Annotated[Length, POSITIVE] = Field(
        default_factory=lambda part: part["outer_diameter"] if part["eyes"] == "none" else 0.0
    )
    """Only with eyes = "none": how far the tube goes on beyond an outermost pin; outer_diameter unless stated."""
    plug_length: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Only with eyes = "none": length of a rod that is glued into the bore at every pin, which goes through its middle.
    Tube and plugs are modelled as one solid of one material; the glue is not checked."""
    bush_diameter: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Only with eyes = "none": outer diameter of a bush about every pin, from wall to wall across the bore, glued in.
    1.1 times the pin's to 0.8 times inner_diameter; tube and bushes are modelled as one solid of one material, and the
    glue is not checked."""
    arm_width: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Width of the arms, in the linkage's plane: flat lugs on the tube's wall, with a round end about their pin and
    fillet_radius at the wall. Needed where a link of this part has arms."""
    arm_thickness: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Thickness of the arms along their pins; stated together with arm_width."""

    def check_sizes(self) -> None:
        """As ``Straight.check_sizes``: there is a wall, and the eyes stand out by enough for their fillets."""
        if self.inner_diameter >= self.outer_diameter:
            raise PydanticCustomError(
                "no_wall",
                "inner_diameter {inner} mm must be less than outer_diameter {outer} mm; reduce it, or set 0 for a rod",
                {"inner": f"{self.inner_diameter:g}", "outer": f"{self.outer_diameter:g}"},
            )
        if (self.arm_width > 0.0) != (self.arm_thickness > 0.0):
            raise PydanticCustomError(
                "half_an_arm", "arm_width and arm_thickness are the two sides of one section; state both, or neither"
            )
        if self.eyes == "none":
            self._without_eyes()
            return
        if "fillet_radius" not in self.model_fields_set:
            raise PydanticCustomError(
                "no_fillet",
                'fillet_radius is missing: state the fillet between tube and eyes, "0 mm" for a sharp edge, or '
                'eyes = "none"',
            )
        self._stray("round", "overhang", "plug_length", "bush_diameter")
        if self.eye_diameter <= self.outer_diameter:
            raise PydanticCustomError(
                "narrow_eye",
                "eye_diameter {eye} mm must be greater than outer_diameter {outer} mm; increase it or leave it out",
                {"eye": f"{self.eye_diameter:g}", "outer": f"{self.outer_diameter:g}"},
            )
        least = self.outer_diameter + RIM * self.fillet_radius
        if self.eye_thickness < (1.0 - ROUNDING) * least:
            raise PydanticCustomError(
                "thin_eye",
                "eye_thickness {eye} mm must be at least outer_diameter + {rim} fillet_radius = {least} mm, so that "
                "the fillet runs all round the tube; increase it, reduce fillet_radius, or leave eye_thickness out",
                {"eye": f"{self.eye_thickness:g}", "rim": f"{RIM:g}", "least": f"{least:g}"},
            )

    def _without_eyes(self) -> None:
        """Refuse sizes that make no tube with pins through its walls."""
        self._stray("none", "eye_diameter", "eye_thickness")
        fills = {"plug_length": self.plug_length, "bush_diameter": self.bush_diameter}
        stated = [name for name, size in fills.items() if size > 0.0]
        if len(stated) > 1:
            raise PydanticCustomError(
                "plug_and_bush",
                "plug_length and bush_diameter exclude each other: a plug fills the bore; leave one out",
            )
        if stated and self.inner_diameter == 0.0:
            raise PydanticCustomError(
                "no_bore", "{name} needs a bore, but inner_diameter is 0; leave it out", {"name": stated[0]}
            )
        if self.bush_diameter >= self.inner_diameter > 0.0:
            raise PydanticCustomError(
                "wide_bush",
                "bush_diameter {bush} mm must be less than inner_diameter {inner} mm; reduce it, or state plug_length",
                {"bush": f"{self.bush_diameter:g}", "inner": f"{self.inner_diameter:g}"},
            )

    def _stray(self, eyes: str, *names: str) -> None:
        """Refuse entries that have no meaning with these eyes."""
        stray = [name for name in names if name in self.model_fields_set]
        if stray:
            raise PydanticCustomError(
                "stray_size",
                '{name} has no meaning with eyes = "{eyes}"; leave it out, or set eyes = "{other}"',
                {"name": stray[0], "eyes": eyes, "other": "none" if eyes == "round" else "round"},
            )

    @property
    def section(self) -> Section:
        """Cross-section of the tube between its eyes."""
        return ring(self.outer_diameter, self.inner_diameter)

    @property
    def unmeasured(self) -> str:
        """As ``PartKind.unmeasured``: without eyes."""
        if self.arm_width > 0.0:
            return "it has arms"
        return "" if self.eyes == "round" else "its pins go through its walls, without eyes"

    @property
    def arm_section(self) -> Section:
        """As ``PartKind.arm_section``: that of a flat lug."""
        return rectangle(self.arm_width, self.arm_thickness)

    def ring(self, pin: Pin) -> Ring:
        """As ``PartKind.ring``: without eyes there is none, and the hole goes through both walls, a plug or a bush."""
        if pin.foot is not None:
            return Ring(diameter=self.arm_width, low=-self.arm_thickness / 2.0, high=self.arm_thickness / 2.0)
        if self.eyes == "round":
            return super().ring(pin)
        high, bore = (math.sqrt(max(d**2 / 4.0 - pin.y**2, 0.0)) for d in (self.outer_diameter, self.inner_diameter))
        filled = bore == 0.0 or self.plug_length > 0.0 or self.bush_diameter > 0.0
        return Ring(diameter=0.0, low=-high, high=high, gaps=() if filled else ((-bore, bore),))

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: of a tube with eyes as ``Straight.check``, else the pins' holes fit its walls."""
        bare = without_lugs(body)
        if self.eyes == "round":
            super().check(bare)
        else:
            check_pins_through(bare, self.reach(body), self.bush_diameter)
        arms = [pin.name for pin in body.pins if pin.foot is not None]
        if arms and self.arm_width == 0.0:
            raise CaseError(
                f"the arm to {arms[0]} needs sizes, since an arm of a tube is a flat lug: state arm_width and "
                "arm_thickness"
            )
        check_lugs(body, self.reach(body))

    def reach(self, body: Body) -> tuple[float, float]:
        """As ``Straight.reach``: without eyes the overhang beyond an outermost pin."""
        first, last = extent(body)
        pinned = {pin.x for pin in body.pins if pin.foot is None}
        return first - self.overhang * (first in pinned), last + self.overhang * (last in pinned)

    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """As ``Straight.prism``: along the axis, split at the borders of loaded patches."""
        stations = sorted({*self.reach(body), *(x for end in body.ends for x in patch_span(body, end))})
        radius = self.outer_diameter / 2.0
        return [kernel.cylinder((low, 0, 0), (high - low, 0, 0), radius) for low, high in itertools.pairwise(stations)]

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: with eyes as ``Straight.solid``, else the tube alone; then the arms."""
        bare = without_lugs(body)
        if self.eyes == "round":
            return with_lugs(kernel, body, super().solid(kernel, bare))
        tube = [entity for piece in self.pieces(bare) for entity in self.prism(kernel, bare, piece)]
        return with_lugs(kernel, body, kernel.fuse(tube))

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: as wide at every height as at its middle; and the arms."""
        found = [*super().footprints(without_lugs(body))]
        for pin in body.pins:
            if pin.foot is not None:
                angle = math.copysign(math.pi / 2.0, pin.y)
                found.append(strip(pin.foot, angle, abs(pin.y), self.arm_width, self.arm_thickness))
                found += eye(pin, body.ring(pin), self.arm_width)
        return tuple(found)

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: as ``Straight.fine_places``, or at fillets of plugs and bushes; and at arms."""
        at_lugs, body = fine_at_lugs(body, size, share), without_lugs(body)
        if self.eyes == "round":
            return super().fine_places(body, size, share) + at_lugs
        first, last = self.reach(body)
        radius, wall = self._hollow_fillet(body), f"(Sqrt(y^2+z^2)-{self.inner_diameter / 2.0:.12g})"
        across = [f"(x-({x:.12g}))" for span in self._hollow_spans(body) for x in span if first < x < last]
        if self.bush_diameter > 0.0:
            across += [f"({pin.distance_formula}-{self.bush_diameter / 2.0:.12g})" for pin in body.pins]
        edge = min((radius or size) * share, size)
        return [(edge, f"Max(Sqrt({one}^2+{wall}^2)-{radius:.12g},0)") for one in across] + at_lugs

    def cavities(self, kernel: Kernel, body: Body) -> list[Entity]:
        """As ``PartKind.cavities``: the bore, less plugs or bushes."""
        bare = without_lugs(body)
        return [self._hollow(kernel, bare, *span) for span in self._hollow_spans(bare)]

    def _hollow_fillet(self, body: Body) -> float:
        """Fillet radius in the bore: the part's, but at most half the bore's radius, or half of what fits at a bush.

        Between a bush and the wall fits half of their distance.
        """
        bore = self.inner_diameter / 2.0
        room = (
            min(bore - abs(pin.y) - self.bush_diameter / 2.0 for pin in body.pins) if self.bush_diameter else 2.0 * bore
        )
        return min(self.fillet_radius, room / 4.0)

    def _hollow_spans(self, body: Body) -> list[tuple[float, float]]:
        """Return the x between which a tube is hollow: up to each plug or eye's nearest generator, open at a plain end.

        The bottom of the bore touches the eye's cylinder and is flat but for a fillet at its rim: a bore that ran on
        to the cylinder would leave a re-entrant edge.
        """
        bore = self.inner_diameter / 2.0
        first, last = self.reach(body)
        spans: list[tuple[float, float]] = []
        start = first
        for pin in sorted(body.pins, key=lambda p: p.x):
            radius = body.ring(pin).diameter / 2.0
            half = math.sqrt(max(radius**2 - max(abs(pin.y) - bore, 0.0) ** 2, 0.0)) or self.plug_length / 2.0
            if half > 0.0:
                spans.append((start, pin.x - half))
                start = max(start, pin.x + half)
        spans.append((start, last))
        return [(low, high) for low, high in spans if high - low > 2.0 * self._hollow_fillet(body) and bore > 0.0]

    def _hollow(self, kernel: Kernel, body: Body, low: float, high: float) -> Entity:
        """Return what is cut out of a tube between two stations, rounded where it ends inside or meets a bush."""
        first, last = self.reach(body)
        solid = kernel.cylinder((low, 0, 0), (high - low, 0, 0), self.inner_diameter / 2.0)
        bushes = body.pins if self.bush_diameter > 0.0 else ()
        solid = kernel.cut(
            solid, [bush for pin in bushes for bush in kernel.upright(pin, self.bush_diameter, self.outer_diameter)]
        )

        def to_fillet(p: NDArray[np.float64]) -> bool:
            """Return whether a point lies where the bore ends inside, or at a bush's side."""
            inside = abs(p[0] - low) < ON_SURFACE < low - first or abs(p[0] - high) < ON_SURFACE < last - high
            return bool(abs(math.hypot(p[1], p[2]) - self.inner_diameter / 2.0) < ON_SURFACE) and (
                inside or any(abs(pin.distance(p[0], p[1]) - self.bush_diameter / 2.0) < ON_SURFACE for pin in bushes)
            )

        radius, found = self._hollow_fillet(body), kernel.curves(to_fillet)
        faces = kernel.model.getBoundary([solid], oriented=False)
        own = {tag for _, tag in kernel.model.getBoundary(faces, combined=False, oriented=False)}
        curves = sorted(own.intersection(found))
        return kernel.fillet(solid, curves, radius) if curves and radius > 0.0 else solid

    def largest_element(self) -> float:
        """Return the element edge whose chords on one side stay clear of the other side, or of the axis.

        In a rod, edges as long as the radius leave no node on the axis: then elements have two edges on the rim, whose
        curved sides meet at 180°, and many are flattened. At 0.8 radii, of five rods, 24 or fewer elements in place of
        254 to 326, and 0.1 % of the volume missed in place of 2 %.
        """
        radius, bore = self.outer_diameter / 2.0, self.inner_diameter / 2.0
        # Chord h of radius r has a sagitta of h²/(8r): a quarter of the wall here.
        return math.sqrt(2.0 * radius * (radius - bore)) if bore > 0.0 else ROD_SIZE * radius
