"""The flat plate about pins anywhere."""

import math
from collections.abc import Callable
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name
from alula.geometry.base.outline import STRAIGHT, BallError, Outline, gap, outline
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.body import FLAT_WALL, Body, Feature, PartKind, apart, extent
from alula.geometry.bodies.eyes import check_flat_eyes
from alula.geometry.bodies.features import Pin, PlainEnd
from alula.geometry.bodies.footprint import Footprint, of_outlines
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle
from alula.geometry.parts.pockets import Pocket, RoundHole

LEAST_WALL = 0.05
"""Least wall beside a hole or pocket over its diameter, or that of its corners, and least neck over eye_diameter.
Assumed: a thinner one is hardly made."""
_WIDEST = 1e6
"""Fillet radius over the plate's extent beyond which its outline is the hull to any reader: bound of a search."""
_CHORDS = 200


class Plate(PartKind):
    """A flat plate about two or more pins anywhere: the outline is the convex hull of the circles of its eyes.

    With a fillet_radius it is drawn in between them: a concave arc of that radius touches every two neighbouring eyes.
    A load point without a pin has such a circle of eye_diameter as well; the load enters within end_patch about it, on
    both faces.

    In a frame of beams it is a strip as wide as eye_diameter, or as its narrowest place if that is less: a cautious
    stiffness, but for the flanks of a slot. Hand calculation does not decide on it.
    """

    takes: ClassVar[frozenset[Feature]] = frozenset(
        ("slots", "load points without a pin", "eyes of their own", "forks")
    )
    is_beam: ClassVar[bool] = False
    patches_anywhere: ClassVar[bool] = True
    by_hand: ClassVar[str] = (
        "hand calculation takes the plate for a beam of its narrowest net section across the x axis: an estimate, "
        "since beam theory needs a length of several widths"
    )

    main_size: ClassVar[str] = "thickness"
    shape: Literal["plate"]
    material: Name
    """Name of a material, of the library or of [materials]."""
    thickness: Annotated[Length, POSITIVE]
    """Thickness along the pins."""
    eye_diameter: Annotated[Length, POSITIVE]
    """Diameter of the eyes about whose circles the outline runs; a link may state others for its points (eyes)."""
    fillet_radius: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Radius of the concave arcs between neighbouring eyes; 0 for straight lines."""
    holes: Annotated[tuple[RoundHole, ...], Field(max_length=100)] = ()
    """Holes that make the plate lighter, in the frame of the link."""
    pockets: Annotated[tuple[Pocket, ...], Field(max_length=50)] = ()
    """Recesses with a floor that make it lighter."""

    @property
    def eye_thickness(self) -> float:
        """Length of the holes: the plate's thickness [mm]."""
        return self.thickness

    @property
    def may_be_sharp(self) -> bool:
        """As ``PartKind.may_be_sharp``: at the floor of a pocket."""
        return any(pocket.floor_radius == 0.0 for pocket in self.pockets)

    @property
    def size(self) -> float:
        """As ``PartKind.size``: its thickness, or half of an eye if that is more.

        Away from the eyes stresses vary over their size: with the thickness alone the first mesh of a plate of
        200 x 150 x 3 mm has 82,000 elements in place of 22,000.
        """
        return max(self.thickness, self.eye_diameter / 2.0)

    @property
    def section(self) -> Section:
        """Section of a strip as wide as an eye."""
        return rectangle(self.eye_diameter, self.thickness)

    def outline(self, body: Body) -> Outline:
        """Return the outline.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        Outline
            About the eyes' circles.

        Raises
        ------
        BallError
            Where the fillets do not fit between the eyes.
        """
        return self._outline(body, self.fillet_radius or STRAIGHT)

    def _outline(self, body: Body, radius: float) -> Outline:
        """Return the outline with fillets of a radius, whose necks are wide enough."""
        circles = [(x, pin.y, body.ring(pin).diameter / 2.0) for pin in body.pins for x in pin.span]
        found = outline(circles + [(end.x, end.y, self.eye_diameter / 2.0) for end in body.ends], radius)
        if any(width < LEAST_WALL * self.eye_diameter for width, *_ in found.webs):
            raise BallError
        return found

    @property
    def patch_height(self) -> float:
        """As ``PartKind.patch_height``: its top and bottom."""
        return self.thickness / 2.0

    def hand_section(self, body: Body) -> Section:
        """As ``PartKind.hand_section``: the narrowest net section across the x axis, from the first to the last pin.

        That is the chord of the outline less what all holes cut out of it: an estimate, as of a disc.
        """
        return rectangle(
            min(
                width - sum(_about(pin, pin.diameter).across(x) for pin in body.pins) for x, width in self._widths(body)
            ),
            self.thickness,
        )

    def frame_section(self, body: Body) -> Section:
        """As ``PartKind.frame_section``: as wide as an eye, or as the plate where that is narrowest."""
        return rectangle(min([self.eye_diameter, *(width for _, width in self._widths(body))]), self.thickness)

    def _widths(self, body: Body) -> list[tuple[float, float]]:
        """Return stations from the first to the last pin, and the width there of a full section as large [mm].

        That is the width of the outline less that of lightening holes, and of pockets by their share of the thickness.
        """
        around, (first, last) = self.outline(body), extent(body)
        cuts = [(hole.outline, 1.0) for hole in self.holes]
        cuts += [(pocket.outline, pocket.cut / self.thickness) for pocket in self.pockets]
        stations = [first + (last - first) * i / _CHORDS for i in range(_CHORDS + 1)]
        return [(x, around.across(x) - sum(share * cut.across(x) for cut, share in cuts)) for x in stations]

    def has_centre_line(self, body: Body) -> bool:
        """As ``PartKind.has_centre_line``: no, since it is wider than the strip for which a frame takes it."""
        return False

    def wall(self, body: Body, pin: Pin) -> float:
        """As ``PartKind.wall``: to the eye's rim, or to the nearest other hole or pocket."""
        others = [
            *self._cuts.values(),
            *(_about(other, other.diameter) for other in body.pins if other.name != pin.name),
        ]
        return min([super().wall(body, pin), *(gap(_about(pin, pin.diameter), o) + pin.diameter / 2.0 for o in others)])

    def flat_diameter(self, body: Body, pin: Pin) -> float:
        """As ``PartKind.flat_diameter``: within the eye's wall, along whose rim the outline runs, and clear of others.

        Between two holes each ring takes up that share of half the wall.
        """
        others = [other for other in body.pins if other is not pin]
        walls = [2.0 * apart(pin, other) - pin.diameter - other.diameter for other in others]
        return pin.diameter + FLAT_WALL * min([body.ring(pin).diameter - pin.diameter, *(wall / 2.0 for wall in walls)])

    def scaled(self, s: Callable[[float], float]) -> Self:
        """As ``PartKind.scaled``: holes and pockets as well."""
        cuts = {"holes": tuple(h.scaled(s) for h in self.holes), "pockets": tuple(p.scaled(s) for p in self.pockets)}
        return super().scaled(s).model_copy(update=cuts)

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: eyes are as thick as the plate, and walls are left beside the holes."""
        check_flat_eyes(body)
        self._check_fillets(body)
        for number, end in enumerate(body.ends):
            self._check_patch(body, number, end)
        for number, pocket in enumerate(self.pockets, start=1):
            pocket.check(f"pockets[{number}]", self.thickness)
        for name, cut in self._cuts.items():
            what, wall = self._wall(body, name)
            across = 2.0 * cut.arcs[0].radius
            if wall < LEAST_WALL * across:
                raise CaseError(
                    f"{name} of the plate leaves a wall of {max(wall, 0.0):.4g} mm to {what}, but must leave "
                    f"{LEAST_WALL * across:.4g} mm ({LEAST_WALL:g} of its diameter): reduce its diameter "
                    f"{across:.4g} mm or move it"
                )

    def _check_fillets(self, body: Body) -> None:
        """Refuse fillets beside slots, and such as do not fit between the eyes, with the least radius that does."""
        sliding = next((pin.name for pin in body.pins if pin.slot > 0.0), None)
        if sliding is not None and self.fillet_radius > 0.0:
            raise CaseError(
                f"fillet_radius {self.fillet_radius:.4g} mm of a plate with a slot would draw the outline in between "
                f"the ends of the slot at {sliding} as well; leave it out"
            )
        try:
            self.outline(body)
        except BallError:
            pass
        else:
            return
        first, last = extent(body)
        low, high = self.fillet_radius, max(self.fillet_radius, last - first)
        while high < _WIDEST * (last - first) and not self._fits(body, high):
            low, high = high, 2.0 * high
        for _ in range(40):
            middle = (low + high) / 2.0
            low, high = (low, middle) if self._fits(body, middle) else (middle, high)
        raise CaseError(
            f"fillet_radius {self.fillet_radius:.4g} mm is too small for the distance of the eyes: an arc of it "
            f"between two of them cuts the plate through, or leaves less than {LEAST_WALL:g} eye_diameter; set it to "
            f"{math.ceil(1e3 * high) / 1e3:.6g} mm or more, or leave it out for straight edges"
        )

    def _fits(self, body: Body, radius: float) -> bool:
        try:
            self._outline(body, radius)
        except BallError:
            return False
        return True

    def _check_patch(self, body: Body, number: int, end: PlainEnd) -> None:
        """Refuse a loaded patch that leaves its circle, or runs into the ring about a hole or another patch."""
        room = [(FLAT_WALL * self.eye_diameter, f"{FLAT_WALL:g} eye_diameter")]
        for pin in body.pins:
            gap = float(pin.distance(end.x, end.y)) - self.flat_diameter(body, pin) / 2.0
            room.append((2.0 * gap, f"the eye at {pin.name}"))
        later = body.ends[number + 1 :]
        room += [(math.dist((o.x, o.y), (end.x, end.y)), f"the patch of {o.name}") for o in later]
        most, what = min(room)
        if end.patch >= most:
            raise CaseError(
                f"the loaded patch of {end.name} is {end.patch:.4g} mm wide, but {what} leaves it less than "
                f"{max(most, 0.0):.4g} mm: reduce {end.entry}, or move {end.name}"
            )

    @property
    def _cuts(self) -> dict[str, Outline]:
        """The outlines of holes and pockets, by their entries."""
        cuts = {f"holes[{number}]": hole.outline for number, hole in enumerate(self.holes, start=1)}
        return cuts | {f"pockets[{number}]": pocket.outline for number, pocket in enumerate(self.pockets, start=1)}

    def _wall(self, body: Body, name: str) -> tuple[str, float]:
        """Return what is closest to a hole or pocket, and the wall between them [mm].

        The edge of the plate is closest to a corner, or to where a ball that has rounded the edge is.
        """
        cuts, around = self._cuts, self.outline(body)
        cut = cuts.pop(name)
        found = [("the edge of the plate", around.depth(arc.x, arc.y) - arc.radius) for arc in cut.arcs]
        beside = [("the edge of the plate", (a.x, a.y, -a.radius)) for a in around.arcs if a.radius < 0.0]
        beside += [(f"the patch of {e.name}", (e.x, e.y, e.patch / 2.0)) for e in body.ends]
        others = [(what, outline([circle])) for what, circle in beside] + list(cuts.items())
        others += [(f"the eye at {p.name}", _about(p, self.flat_diameter(body, p))) for p in body.pins]
        others += [(f"the fork at {p.name}", _about(p, 2.0 * p.fork.depth)) for p in body.pins if p.fork is not None]
        return min([*found, *((what, gap(cut, other)) for what, other in others)], key=lambda entry: entry[1])

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: the outline, extruded."""
        return kernel.slab(self.outline(body), self.thickness)

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: within its outline, less its lightening holes."""
        return (of_outlines(self.outline(body), [hole.outline for hole in self.holes], self.thickness),)

    def cavities(self, kernel: Kernel, body: Body) -> list[Entity]:
        """As ``PartKind.cavities``: the lightening holes, and the pockets."""
        high = self.thickness
        holes = [kernel.cylinder((h.x, h.y, -high), (0, 0, 2.0 * high), h.diameter / 2.0) for h in self.holes]
        return holes + [solid for pocket in self.pockets for solid in pocket.solids(kernel, high)]

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: narrow rings and walls take elements as small as they are wide."""
        places = []
        for pin in body.pins:
            flat = self.flat_diameter(body, pin)
            places.append((min((flat - pin.diameter) / 2.0, size), f"Fabs({pin.distance_formula}-{flat / 2.0:.12g})"))
        for end in body.ends:
            circle = Pin(name="", x=end.x, y=end.y, diameter=end.patch)
            places.append((min(end.patch / 4.0, size), f"Fabs({circle.distance_formula}-{end.patch / 2.0:.12g})"))
        for width, one, other in self.outline(body).webs:
            neck = Pin(name="", x=(one.x + other.x) / 2.0, y=(one.y + other.y) / 2.0, diameter=width)
            places.append((min(width / 2.0, size), f"Max({neck.distance_formula}-{width / 2.0:.12g},0)"))
        for number, hole in enumerate(self.holes, start=1):
            rim = Pin(name="", x=hole.x, y=hole.y, diameter=hole.diameter)
            edge = min(self._wall(body, f"holes[{number}]")[1], hole.diameter / 3.0, size)
            places.append((edge, f"Fabs({rim.distance_formula}-{hole.diameter / 2.0:.12g})"))
        for number, pocket in enumerate(self.pockets, start=1):
            narrow = min(self._wall(body, f"pockets[{number}]")[1], pocket.radius)
            edge = min((pocket.floor_radius or size) * share, narrow, size)
            places.append((edge, pocket.distance_formula(self.thickness)))
        return places


def _about(pin: Pin, diameter: float) -> Outline:
    """Return the circle about a pin hole, or the long one about a slot."""
    return outline([(x, pin.y, diameter / 2.0) for x in pin.span])
