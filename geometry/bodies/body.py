"""What shapes a link: its part, of some kind, and the pins, loaded ends and rows of holes along it.

A body lies along the x axis of its link's frame, its pins along z, its mid-plane at z = 0. A new kind of part derives
from ``PartKind`` in a file of its own, and joins ``Part``.
"""

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, Self

from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.bodies.features import HoleRow, Pin, PlainEnd, Ring
from alula.geometry.bodies.footprint import Footprint
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section
from alula.geometry.materials.printable import Printable

Feature = Literal["slots", "arms", "rows of holes", "load points without a pin", "eyes of their own", "forks"]
ON_AXIS = 1e-9
"""Share of a size by which a place may lie off the link's axis."""
FLAT_WALL = 0.75
"""Share of an eye's wall that the flat ring takes up on which a torque or thrust enters, where the rim of the eye lies
in or close to the outline: circle and outline would leave cusps between them that no mesh fills."""


class PartKind(Printable):
    """A kind of part: the sizes that a case states, as fields, and what follows from them.

    Its fields are ``shape`` (a literal), ``material`` and sizes. The properties below are fields or properties of
    each kind's own.
    """

    if TYPE_CHECKING:  # at run time they would stand in the way of a kind's fields

        @property
        def shape(self) -> str:
            """Name of the kind in the case file."""

        @property
        def material(self) -> str:
            """Name of its material."""

        @property
        def eye_diameter(self) -> float:
            """Outer diameter of the rings about its holes, where a pin has none of its own [mm]."""

        @property
        def eye_thickness(self) -> float:
            """Height of these rings, which is the holes' length [mm]."""

        @property
        def fillet_radius(self) -> float:
            """Between eyes and the rest [mm]; 0 where edges are sharp."""

    takes: ClassVar[frozenset[Feature]] = frozenset()
    """What a link of this kind may have besides pin holes."""
    main_size: ClassVar[str] = ""
    """The size that makes a part stronger and stiffer; "" where there is none, as of a file."""
    is_beam: ClassVar[bool] = True
    """Whether beam theory holds between its eyes."""
    by_hand: ClassVar[str] = ""
    """What the reader must know of its hand calculation; "" where beam theory holds."""
    has_holes: ClassVar[bool] = False
    """Whether its solid has its pin holes from the start."""
    is_fixed: ClassVar[bool] = False
    """Whether it comes as a mesh, which is not refined."""
    patches_anywhere: ClassVar[bool] = False
    """Whether a load point without a pin may lie anywhere on it, where a circle about the point is loaded; else it lies
    on the axis, and a stretch of the part is."""

    def rough_volume(self, body: "Body") -> float | None:
        """Return the volume by length and section, without the geometry kernel.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        float or None
            [mm³]; None of a kind that is no bar with eyes.
        """
        return None

    @property
    def patch_height(self) -> float | None:
        """Z of the flat faces, of which there is one on either side, that alone carry such a circle; None for any."""
        return None

    @property
    def unmeasured(self) -> str:
        """In what it differs from the parts for which hand calculation was calibrated; "" where in nothing."""
        return ""

    @property
    def eye_entry(self) -> str:
        """What in the case file bounds its eyes, for messages."""
        return "eye_diameter"

    @property
    @abstractmethod
    def section(self) -> Section:
        """Cross-section between the eyes; of a part that is no beam, one through its middle."""

    @abstractmethod
    def solid(self, kernel: Kernel, body: "Body") -> Entity:
        """Build the part without its pin holes, slots, rows of holes and ``cavities``.

        Parameters
        ----------
        kernel : Kernel
            The geometry kernel; sections are ten units across.
        body : Body
            The body, of which this is the part, in the kernel's unit.

        Returns
        -------
        Entity
            The solid.

        Raises
        ------
        FilletError
            Where a fillet does not fit.
        """

    @abstractmethod
    def footprints(self, body: "Body") -> tuple[Footprint, ...]:
        """Return what the part covers as seen along its pins, pin holes included: what must not touch other links.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        tuple of Footprint
            Pieces in the link's frame, which may overlap; fillets of ``fillet_radius`` between them are left out.
        """

    def cavities(self, kernel: Kernel, body: "Body") -> list[Entity]:
        """Build what is cut out of the part besides its holes.

        Parameters
        ----------
        kernel : Kernel
            The geometry kernel.
        body : Body
            The body, in the kernel's unit.

        Returns
        -------
        list of Entity
            Solids.
        """
        return []

    @abstractmethod
    def fine_places(self, body: "Body", size: float, share: float) -> list[tuple[float, str]]:
        """Return where elements must be smaller than elsewhere, pin holes and rows of holes apart.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.
        size : float
            Element edge elsewhere, in the unit of the body.
        share : float
            Element edge along a fillet over its radius.

        Returns
        -------
        list of tuple
            Element edge, and the distance from the place as a formula of the mesher in x, y and z.
        """

    def cuts(self, body: "Body") -> tuple[CutSection, ...]:
        """Return sections across the x axis.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        tuple of CutSection
            By rising x; none of a part of one section, ``section``.
        """
        return ()

    def half_width(self, body: "Body", x: float) -> float:
        """Return how far a flat part reaches from the x axis along y.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.
        x : float
            Station [unit of the body].

        Returns
        -------
        float
            That of its section unless the kind knows better.
        """
        return self.section.half_y

    def check(self, body: "Body") -> None:
        """Refuse a body that this kind of part cannot be built for, by closed form.

        Parameters
        ----------
        body : Body
            The body, of which this is the part; what holds for all kinds has been checked.

        Raises
        ------
        CaseError
            With the entry, its value, the rule and a remedy.
        """

    @property
    def arm_section(self) -> Section:
        """Cross-section of its arms: that between the eyes unless the kind knows better."""
        return self.section

    def hand_section(self, body: "Body") -> Section:
        """Return the section of which hand calculation takes the link to be made.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        Section
            The section between the eyes unless the kind knows better.
        """
        return self.section

    def frame_section(self, body: "Body") -> Section:
        """Return the section with which the link stands in a frame of beams.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        Section
            The section between the eyes unless the kind knows better.
        """
        return self.section

    def has_centre_line(self, body: "Body") -> bool:
        """Return whether a beam along the x axis, with what is known of eyes, bounds how far a body gives.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        bool
            Of a part that is no beam, whether all of its pins lie on that axis.
        """
        return self.is_beam or all(abs(pin.y) <= ON_AXIS * self.section.width for pin in body.pins)

    def flat_diameter(self, body: "Body", pin: Pin) -> float:
        """Return the outer diameter of the flat face about a hole on which a torque or a thrust enters.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.
        pin : Pin
            One of its pins.

        Returns
        -------
        float
            That of the ring about the hole unless the kind knows better [unit of the body]; 0 where it has none.
        """
        return body.ring(pin).diameter

    def ring(self, pin: Pin) -> Ring:
        """Return the flat ring about a hole that has none of its own.

        Parameters
        ----------
        pin : Pin
            A pin of the body.

        Returns
        -------
        Ring
            Of eye_diameter and eye_thickness unless the kind knows better.
        """
        half = self.eye_thickness / 2.0
        return Ring(diameter=self.eye_diameter, low=-half, high=half)

    def wall(self, body: "Body", pin: Pin) -> float:
        """Return the radius out to which a hole has material all about it.

        Parameters
        ----------
        body : Body
            The part with its holes.
        pin : Pin
            A pin of the body.

        Returns
        -------
        float
            Of the hole's ring, or half the width of the part where it has none [mm].
        """
        return (body.ring(pin).diameter or self.section.width) / 2.0

    def scaled(self, s: Callable[[float], float]) -> Self:
        """Return the part with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        Self
            The part; of the kind itself all fields that are numbers are lengths.
        """
        lengths = {name: s(value) for name, value in self.model_dump().items() if isinstance(value, int | float)}
        return self.model_copy(update=lengths)

    @property
    def size(self) -> float:
        """What sets its first element edges and the unit in which it is built [mm]: a section's smaller size."""
        return min(self.section.width, self.section.height)

    @property
    def may_be_sharp(self) -> bool:
        """Whether it may have re-entrant edges."""
        return self.is_beam and self.fillet_radius == 0.0

    def largest_element(self) -> float:
        """Return the largest element edge that its round surfaces bear [unit of its sizes]."""
        return float("inf")


@dataclass(frozen=True, kw_only=True)
class Body:
    """All that shapes one link: what the mesher and the mass properties need.

    Attributes
    ----------
    part : PartKind
        Kind and sizes.
    pins : tuple of Pin
        Pin holes and slots.
    ends : tuple of PlainEnd
        Load points without pins.
    holes : tuple of HoleRow
        Rows of cross holes.
    """

    part: PartKind
    pins: tuple[Pin, ...]
    ends: tuple[PlainEnd, ...]
    holes: tuple[HoleRow, ...]

    @cached_property
    def cuts(self) -> tuple[CutSection, ...]:
        """Sections across the x axis by rising x, of a part whose section varies; else none."""
        return self.part.cuts(self)

    def section_at(self, x: float) -> Section:
        """Return the section of a beam's part at a station.

        Parameters
        ----------
        x : float
            Station [mm].

        Returns
        -------
        Section
            Where it varies that of the nearest cut.
        """
        cuts = self.cuts if self.part.is_beam else ()
        nearest = min(cuts, key=lambda cut: abs(cut.x - x)).plain if cuts else None
        return nearest or self.part.section

    @property
    def may_be_sharp(self) -> bool:
        """Whether it may have re-entrant edges: those of its part, and at the roots of forks."""
        return self.part.may_be_sharp or any(pin.fork is not None and pin.fork.radius == 0.0 for pin in self.pins)

    def ring(self, pin: Pin) -> Ring:
        """Return the flat ring about a hole.

        Parameters
        ----------
        pin : Pin
            One of the pins.

        Returns
        -------
        Ring
            The pin's own, or the one that the part makes.
        """
        return pin.ring or self.part.ring(pin)

    def across(self, pin: Pin) -> float:
        """Return how wide the place of a pin is: its ring's diameter, or twice that of a hole without ring.

        Parameters
        ----------
        pin : Pin
            One of the pins.

        Returns
        -------
        float
            Width [mm].
        """
        return self.ring(pin).diameter or 2.0 * pin.diameter

    def pin(self, name: str) -> Pin:
        """Return a pin by its name.

        Parameters
        ----------
        name : str
            Name of its point.

        Returns
        -------
        Pin
            The pin.
        """
        return next(pin for pin in self.pins if pin.name == name)

    def foot(self, arm: Pin) -> Pin | None:
        """Return the pin on the axis from which an arm reaches to another; None where it starts at none, on a tube.

        Parameters
        ----------
        arm : Pin
            The pin at the arm's end.

        Returns
        -------
        Pin or None
            The pin at its foot.
        """
        return next((pin for pin in self.pins if (pin.x, pin.y) == arm.foot), None)

    def arm_root(self, arm: Pin) -> float:
        """Return how far from its foot on the axis an arm begins.

        Parameters
        ----------
        arm : Pin
            The pin at the arm's end.

        Returns
        -------
        float
            Radius of the eye or tube from which it starts [mm].
        """
        foot = self.foot(arm)
        return self.part.section.half_y if foot is None else self.ring(foot).diameter / 2.0


def extent(body: Body) -> tuple[float, float]:
    """Return the least and greatest x of the pins and ends on the axis: where a tube or bar begins and ends.

    Parameters
    ----------
    body : Body
        The body; of a disc the result tells what lies between its holes.

    Returns
    -------
    first, last : float
        Stations [mm].
    """
    stations = [x for p in body.pins if p.foot is None for x in p.span] + [e.x for e in body.ends]
    return min(stations), max(stations)


def patch_span(body: Body, end: PlainEnd) -> tuple[float, float]:
    """Return the x between which a loaded patch lies: inwards from an end of the link, else about its point.

    Parameters
    ----------
    body : Body
        The body.
    end : PlainEnd
        One of its load points without pin.

    Returns
    -------
    low, high : float
        Stations [mm].
    """
    first, last = extent(body)
    if end.x == last:
        return end.x - end.patch, end.x
    if end.x == first:
        return end.x, end.x + end.patch
    return end.x - end.patch / 2.0, end.x + end.patch / 2.0


def mouth(body: Body, end: PlainEnd) -> float:
    """Return where the load of an end acts on the link as a beam: of a clamped end at the mouth of its clamp.

    Parameters
    ----------
    body : Body
        The body.
    end : PlainEnd
        One of its load points without pin.

    Returns
    -------
    float
        x [mm]; that of the point for other ends, and for a clamp on a part that is no beam.
    """
    if not (end.clamped and body.part.is_beam):
        return end.x
    low, high = patch_span(body, end)
    return low if end.x == high else high


def clamped_end(body: Body) -> PlainEnd | None:
    """Return the clamped end to which displacements of a link refer: the first.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    PlainEnd or None
        None where nothing is clamped.
    """
    return next((end for end in body.ends if end.clamped), None)


def apart(one: Pin, other: Pin) -> float:
    """Return the distance between two holes.

    Parameters
    ----------
    one, other : Pin
        Holes or slots.

    Returns
    -------
    float
        Distance of their centres, or the slots' centre lines [mm].
    """
    along = max(abs(one.x - other.x) - (one.slot + other.slot) / 2.0, 0.0)
    return math.hypot(along, one.y - other.y)


def hand_section(body: Body) -> Section:
    """Return the section of which hand calculation takes the link to be made.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    Section
        A tube's or bar's own between the eyes, the narrowest net section of a disc.
    """
    return body.part.hand_section(body)


def no_beam(body: Body) -> str:
    """Say why no beam along the x axis stands for a body.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    str
        For people; "" where one does: for tubes and bars, and for others that reach at least as far along x as across.
    """
    places = [(pin.x, pin.y) for pin in body.pins] + [(end.x, end.y) for end in body.ends]
    along, across = (max(sizes) - min(sizes) for sizes in zip(*places, strict=True))
    if body.part.is_beam or across <= along:
        return ""
    return (
        f"no beam along the x axis stands for it, since its points lie {across:.4g} mm apart across that axis and "
        f"{along:.4g} mm along it: it has no hand calculation"
    )


def reference_line(body: Body) -> tuple[float, float]:
    """Return the two stations through which the line runs that hand calculation's displacements refer to.

    The mouth of its first clamp, twice: the line turns with the section there. Else the first and last pin on the axis.
    A link with a single pin has that station twice: the line turns with its bore.
    Where there are pins off the axis besides, the eye of the one on it holds the direction, as does an arm on it.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    first, last : float
        Stations [mm].
    """
    held = clamped_end(body)
    if held is not None:
        return mouth(body, held), mouth(body, held)
    on_axis = [pin for pin in body.pins if pin.foot is None]
    start, end = on_axis[0].x, on_axis[-1].x
    if (len(on_axis) > 1 and start != end) or len(body.pins) == 1:
        return start, end
    first, last = extent(body)
    half = body.across(on_axis[0]) / 2.0
    return start, start + (half if last - start >= start - first else -half)
