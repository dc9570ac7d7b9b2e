"""A joint between two links, as a case states it."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import BeforeValidator, Field, PlainValidator, WithJsonSchema
from pydantic_core import PydanticKnownError

from alula.geometry.base.model import CaseModel, Name
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Angle, Length
from alula.geometry.joints.heads import Heads
from alula.geometry.joints.joint_kinds import JOINT_KINDS, JointKind, Way, Ways
from alula.geometry.joints.pin_entries import PRESS, PinClearance, PinFit


def _as_list(stated: object) -> object:
    return (stated,) if isinstance(stated, str) else stated


_NAME = {"type": "string", "format": "name"}
TightIn = Annotated[
    tuple[Name, ...],
    Field(max_length=2),
    BeforeValidator(_as_list),
    WithJsonSchema({"anyOf": [_NAME, {"type": "array", "items": _NAME, "maxItems": 2}]}),
]
"""One link, or both as a list."""


def _kind_name(stated: object) -> str:
    if isinstance(stated, str) and stated in JOINT_KINDS:
        return stated
    *first, last = map(repr, JOINT_KINDS)
    raise PydanticKnownError("literal_error", {"expected": f"{', '.join(first)} or {last}"})


KindName = Annotated[str, PlainValidator(_kind_name), WithJsonSchema({"type": "string", "enum": list(JOINT_KINDS)})]
Coefficient = Annotated[float, Field(ge=0.0, le=2.0)]
UNSTATED = 0.3
"""Share by which a coefficient of friction without a stated range may be off to either side."""


class Joint(CaseModel):
    """A joint between two links."""

    type: KindName = "revolute"
    """revolute: the two points coincide. pin-in-slot: the second link's point lies on the line through the first link's
    point along ``direction`` (a half joint: it may turn and slide). slider: as pin-in-slot, and the second link keeps
    the angle ``angle`` to the first."""
    links: tuple[Name, Name]
    """The two links; reactions are given as what the first does to the second."""
    points: tuple[Name, Name] | None = None
    """The point on each link; the joint's own name on both when left out."""
    pin_diameter: Annotated[Length, POSITIVE] | None = None
    """Diameter of the pin (and of the holes that hold it)."""
    pin_material: Name = "steel-wire"
    """Material of the pin, for the check of pins."""
    pin_gap: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Free length of the pin between the two eyes that it joins, for the check of pins; layers tell it as well."""
    tight_in: TightIn = ()
    """The link in which the pin is tight, where links lie in layers, or a list of both; in any other it may tilt. Left
    out, its value is a running pin in both holes, and the band holds pins that are tight as well."""
    friction: Coefficient = 0.0
    """Coefficient of friction of the pin in its bore, of a pin in its slot or of a slider on its guide, from 0 to 2. It
    opposes the motion, so every load case is solved for both directions of it, or for the one that it states."""
    friction_range: tuple[Coefficient, Coefficient] | None = None
    """Least and largest coefficient of friction that may be; bands of all that friction enters hold it. Left out, 30 %
    less and 30 % more."""
    guide_length: Annotated[Length, POSITIVE] | None = None
    """Length over which the guide holds a slider, half of it on either side of the second link's point. With it a
    moment on the slider presses its ends on the guide, and these rub; without it the normal force alone does."""
    clearance: PinClearance | None = None
    """Play of the pin: how much wider its hole is than the pin, which moves by up to half of it to any side. A length,
    or a range [least, largest], of the hole in which the pin is not tight; where that is not stated, either hole may
    have it, and anything between. Or a table with one for each link, such as
    { crank = "0.02 mm", coupler = ["0.01 mm", "0.05 mm"] }; both count one after the other. In the plane the larger end
    of a range counts. A pin in a slot has the slot's clearance beside it. Left out, there is no play in the plane."""
    fit: PinFit | None = None
    """In place of a clearance: the fit of hole and pin at pin_diameter. "H8/f7" or another one of ISO 286, of a hole H
    and a pin d to h in grades 5 to 12 (rounded by up to 2 µm; coarser than IT8 or above 315 mm by up to 5 %, and 16 %
    up to 3 mm); "running", for which H8/f7 is assumed; or, for a link, "press". Of the hole in which the pin is not
    tight, or a table with one for each link, such as { crank = "press", coupler = "H8/f7" }."""
    heads: Heads | None = None
    """Where links lie in layers: faces on the pin, such as a head and a ring, that keep its links from tilting by more
    than their gap over their diameter, and bear couples from there on. Left out, only the holes do."""
    direction: Angle = 0.0
    """Direction of the slot in the first link's frame (slider, pin-in-slot)."""
    angle: Angle = 0.0
    """Angle of the second link to the first (slider, bonded or clamped joint). A bonded joint without it keeps the
    angle that its links have in the pose; a clamped one has 0."""
    bonded: bool = False
    """Of a revolute joint: true where its two links do not turn against each other, such as glued, pressed or screwed
    ones. It then bears a moment about its pin."""
    clamped: bool = False
    """True of a joint without a pin, that holds its two links as one: a tube in a clamp or an adapter, a bar built into
    the ground, a lever pressed on a shaft. It bears forces and moments. Its parts are held over ``clamp_length``, or in
    a bore of ``pin_diameter``. What holds them, such as screws, friction or glue, a check of type ``connection``
    judges."""
    clamp_length: Annotated[Length, POSITIVE] | None = None
    """Length over which a clamped joint holds the end of a tube or bar, from the joint's point at that end inwards. All
    of it is held, so that the free length begins at its inner edge, the mouth of the clamp. On a plate both faces are
    held within a circle of this diameter; on an imported part the nearest face, as a load at a point is."""

    def model_post_init(self, context: object) -> None:
        """Let a clamped joint be a bonded one, which it is but for the pin, and a pressed pin be tight.

        Parameters
        ----------
        context : object
            Of pydantic; not used.
        """
        super().model_post_init(context)
        if self.clamped:
            self.__dict__["bonded"] = True
        fits = self.fit if isinstance(self.fit, Mapping) else {}
        if pressed := [link for link in self.links if fits.get(link) == PRESS]:
            self.__dict__["tight_in"] = tuple(dict.fromkeys((*self.tight_in, *pressed)))

    @property
    def friction_ends(self) -> tuple[float, float]:
        """Least and largest coefficient of friction."""
        return self.friction_range or ((1.0 - UNSTATED) * self.friction, (1.0 + UNSTATED) * self.friction)

    @property
    def kind(self) -> JointKind:
        """Its kind."""
        return JOINT_KINDS[self.type]

    @property
    def bears(self) -> Ways:
        """The ways in which it holds its second link on its first."""
        return self.kind.bears | {Way.ABOUT_PIN} if self.bonded else self.kind.bears

    @property
    def fixes_angle(self) -> bool:
        """Whether the case states the angle between its links, which takes part in closing the loops."""
        return self.kind.keeps_angle or self.clamped or (self.bonded and "angle" in self.model_fields_set)

    @property
    def slides(self) -> bool:
        """Whether it has a slot or guide, with a travel along it."""
        return self.kind.slides

    @property
    def pivots(self) -> bool:
        """Whether its links turn about its pin, and do nothing else."""
        return not (self.slides or self.bears_moment)

    @property
    def fixed(self) -> bool:
        """Whether its links do not move against each other: it is bonded or clamped."""
        return self.bears_moment and not self.slides

    @property
    def as_posed(self) -> bool:
        """Whether its links are fixed at the angle that they have in the pose, since none is stated."""
        return self.bears_moment and not self.fixes_angle

    @property
    def carrier(self) -> str | None:
        """The link that carries its slot or guide; None where it does not slide."""
        return self.links[0] if self.slides else None

    @property
    def slotted(self) -> str | None:
        """The link in whose slot its pin runs; None where there is no pin in a slot."""
        return self.carrier if self.kind.has_pin else None

    @property
    def bored(self) -> tuple[Name, ...]:
        """The links that have its pin at the point that they state, in a round hole."""
        return self.links[1:] if self.slides else self.links

    def is_tight_in(self, link: str) -> bool:
        """Return True if the pin is stated to be tight in one of the joint's links.

        Parameters
        ----------
        link : str
            One of ``links``.

        Returns
        -------
        bool
            False where nothing states it: the pin may run there. A bonded joint is tight in both links.
        """
        return self.fixed or link in self.tight_in

    @property
    def bears_moment(self) -> bool:
        """Whether it bears a moment about z."""
        return self.bonded or self.kind.keeps_angle
