"""The round tube."""

import itertools
import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field
from pydantic_core import PydanticCustomError

from geometry.base.model import Name
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from geometry.parts.body import Body, Feature, extent, patch_span
from geometry.parts.eyes import EYE_WIDTH, RIM, ROUNDING
from geometry.parts.kernel import ON_SURFACE, Entity, Kernel
from geometry.parts.section import Section, ring
from geometry.parts.straight import Piece, Straight

ROD_SIZE = 0.8
"""Largest element edge in a rod, over its radius."""


class Tube(Straight):
    """A round tube (hollow, or solid with inner diameter 0) with a cylindrical eye at every pin.

    The bore ends where it meets an eye: eyes are solid but for their pin hole.
    """

    takes: ClassVar[frozenset[Feature]] = frozenset(("rows of holes", "load points without a pin", "eyes of their own"))

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

    def check_sizes(self) -> None:
        """As ``Straight.check_sizes``: there is a wall, and the eyes stand out by enough for their fillets."""
        if self.inner_diameter >= self.outer_diameter:
            raise PydanticCustomError(
                "no_wall",
                "inner_diameter {inner} mm must be less than outer_diameter {outer} mm; reduce it, or set 0 for a rod",
                {"inner": f"{self.inner_diameter:g}", "outer": f"{self.outer_diameter:g}"},
            )
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

    @property
    def section(self) -> Section:
        """Cross-section of the tube between its eyes."""
        return ring(self.outer_diameter, self.inner_diameter)

    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """As ``Straight.prism``: along the axis, split at the borders of loaded patches."""
        stations = sorted({*extent(body), *(x for end in body.ends for x in patch_span(body, end))})
        radius = self.outer_diameter / 2.0
        return [kernel.cylinder((low, 0, 0), (high - low, 0, 0), radius) for low, high in itertools.pairwise(stations)]

    def cavities(self, kernel: Kernel, body: Body) -> list[Entity]:
        """As ``PartKind.cavities``: the bore."""
        return [self._hollow(kernel, body, *span) for span in self._hollow_spans(body)]

    @property
    def _hollow_fillet(self) -> float:
        """Fillet radius at the bottom of the bore: the part's, but at most half the bore's radius."""
        return min(self.fillet_radius, self.inner_diameter / 4.0)

    def _hollow_spans(self, body: Body) -> list[tuple[float, float]]:
        """Return the x between which a tube is hollow: up to each eye's nearest generator, and open at a plain end.

        The bottom of the bore touches the eye's cylinder and is flat but for a fillet at its rim: a bore that ran on
        to the cylinder would leave a re-entrant edge.
        """
        bore = self.inner_diameter / 2.0
        first, last = extent(body)
        spans: list[tuple[float, float]] = []
        start = first
        for pin in sorted(body.pins, key=lambda p: p.x):
            radius = body.ring(pin).diameter / 2.0
            half = math.sqrt(max(radius**2 - max(abs(pin.y) - bore, 0.0) ** 2, 0.0))
            spans.append((start, pin.x - half))
            start = max(start, pin.x + half)
        spans.append((start, last))
        return [(low, high) for low, high in spans if high - low > 2.0 * self._hollow_fillet and bore > 0.0]

    def _hollow(self, kernel: Kernel, body: Body, low: float, high: float) -> Entity:
        """Return what is cut out of a tube between two stations, rounded where it ends inside."""
        first, last = extent(body)
        solid = kernel.cylinder((low, 0, 0), (high - low, 0, 0), self.inner_diameter / 2.0)
        kernel.occ.synchronize()
        faces = kernel.model.getBoundary([solid], oriented=False)
        rims = {
            curve
            for _, curve in kernel.model.getBoundary(faces, combined=False, oriented=False)
            for x in (kernel.point_on_curve(curve, 0.3)[0],)
            if kernel.model.getType(1, curve) == "Circle"
            and (abs(x - low) < ON_SURFACE < low - first or abs(x - high) < ON_SURFACE < last - high)
        }
        return kernel.fillet(solid, sorted(rims), self._hollow_fillet) if rims and self.fillet_radius > 0.0 else solid

    def largest_element(self) -> float:
        """Return the element edge whose chords on one side stay clear of the other side, or of the axis.

        In a rod, edges as long as the radius leave no node on the axis: then elements have two edges on the rim, whose
        curved sides meet at 180°, and many are flattened. At 0.8 radii, of five rods, 24 or fewer elements in place of
        254 to 326, and 0.1 % of the volume missed in place of 2 %.
        """
        radius, bore = self.outer_diameter / 2.0, self.inner_diameter / 2.0
        # Chord h of radius r has a sagitta of h²/(8r): a quarter of the wall here.
        return math.sqrt(2.0 * radius * (radius - bore)) if bore > 0.0 else ROD_SIZE * radius
