"""The linkage: links with their points, joints between them, and its mobility."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import BeforeValidator, Field, PlainValidator, ValidationInfo, WithJsonSchema, field_validator
from pydantic_core import PydanticKnownError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Angle, Length
from alula.geometry.linkage.joint_kinds import IN_PLANE, JOINT_KINDS, JointKind, Way, Ways
from alula.geometry.parts.part import EyeSizes, HoleRow, Slot


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


Place = tuple[Length, Length]


class Link(CaseModel):
    """A rigid body of the linkage, described in a frame of its own whose x axis is the link's axis."""

    ground: bool = False
    """True for the one link that does not move; its frame is the global one."""
    points: Annotated[dict[Name, Place], Field(min_length=1, max_length=100)]
    """Pins, clamped ends and load points: name -> (x, y) in the link's frame, in order along the link. A link that
    moves has two or more."""
    part: Name | None = None
    """The part (shape and material) that the link is made of; none for a link that is not checked."""
    held_at: Name | None = None
    """Of the ground with a part, which is then checked: the point, without a joint, at which its support holds it. The
    support's force and moment balance the joints' and enter the part there as a load at a point does."""
    holes: Annotated[tuple[HoleRow, ...], Field(max_length=10)] = ()
    """Rows of cross holes, such as those that hold feathers."""
    slots: Annotated[dict[Name, Slot], Field(max_length=10)] = {}
    """Slots of the part, by the point of the joint (pin in slot) whose pin slides in it."""
    arms: Annotated[dict[Name, Name], Field(max_length=10)] = {}
    """Pins far off the axis: point -> the point on the axis from which an arm reaches to it. An arm of a bar has its
    section and starts at a pin; one of a tube is a flat lug (arm_width, arm_thickness) and starts at a point without a
    joint or load."""
    eyes: Annotated[dict[Name, EyeSizes], Field(max_length=100)] = {}
    """Eyes whose sizes are not those that the part states for all, by the point of the pin."""
    end_patch: Annotated[Length, POSITIVE] = 5.0
    """Length over which a load at a plain end (a point without pin) enters the part. On a plate it enters both
    faces within a circle of this diameter; on an imported part the nearest face, or those that are equally near: a flat
    one within such a circle, a round one whole."""
    layer: int | None = None
    """Layer in which the link lies, counted along z; every link states its own, or none does. Layers stand
    ``layer_spacing`` apart, or are as thick as their links with a ``washer`` between neighbours."""
    z: Length | None = None
    """Height of the link's mid-plane along the pins, in place of a layer."""
    thickness: Annotated[Length, POSITIVE] | None = None
    """Height along the pins that the link takes up, where its part does not tell; of a pair, that of one plate."""
    count: Annotated[int, Field(ge=1, le=2)] = 1
    """2 makes the link a pair of side plates: its part twice, one above the other, held together by pins alone. All
    that acts on the link is shared by both plates."""
    apart: Annotated[Length, POSITIVE] | None = None
    """Of a pair: the distance of the mid-planes of its plates, evenly about the link's own height. Left out, it is
    twice layer_spacing, so that the other link of a joint lies in between."""

    @field_validator("points")
    @classmethod
    def _tell_a_direction(cls, points: dict[Name, Place], info: ValidationInfo) -> dict[Name, Place]:
        if len(points) < 2 and not info.data.get("ground"):
            raise refusal("it has 1, but at least 2 must be there in a link that moves; add what is missing")
        return points

    @property
    def pieces(self) -> tuple[tuple[Name, Name], ...]:
        """The straight pieces of the link, by the points at their ends: between neighbours in order, and the arms."""
        chain = [point for point in self.points if point not in self.arms]
        return (*itertools.pairwise(chain), *((foot, point) for point, foot in self.arms.items()))


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
    out, it may be tight in either, and the band holds both."""
    friction: Coefficient = 0.0
    """Coefficient of friction of the pin in its bore, of a pin in its slot or of a slider on its guide, from 0 to 2. It
    opposes the motion, so every load case is solved for both directions of it, or for the one that it states."""
    friction_range: tuple[Coefficient, Coefficient] | None = None
    """Least and largest coefficient of friction that may be; bands of all that friction enters hold it. Left out, 30 %
    less and 30 % more."""
    guide_length: Annotated[Length, POSITIVE] | None = None
    """Length over which the guide holds a slider, half of it on either side of the second link's point. With it a
    moment on the slider presses its ends on the guide, and these rub; without it the normal force alone does."""
    clearance: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Play of the pin: how much wider its hole is than the pin, which moves by up to half of it to any side. A pin in a
    slot has the slot's clearance beside it."""
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
    a bore of ``pin_diameter``. What holds them, such as screws, friction or glue, is not judged."""
    clamp_length: Annotated[Length, POSITIVE] | None = None
    """Length over which a clamped joint holds the end of a tube or bar, from the joint's point at that end inwards. All
    of it is held, so that the free length begins at its inner edge, the mouth of the clamp. On a plate both faces are
    held within a circle of this diameter; on an imported part the nearest face, as a load at a point is."""

    def model_post_init(self, context: object) -> None:
        """Let a clamped joint be a bonded one, which it is but for the pin.

        Parameters
        ----------
        context : object
            Of pydantic; not used.
        """
        super().model_post_init(context)
        if self.clamped:
            self.__dict__["bonded"] = True

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


def _check_clamp(name: str, joint: Joint) -> None:
    """Refuse entries of a joint that a clamp rules out, and those of a clamp at a joint that is none."""
    entry = f"joints.{name}"
    if not joint.clamped:
        if joint.clamp_length is not None:
            raise CaseError(f"{entry}.clamp_length: joint {name} is not clamped; add clamped = true, or leave it out")
        return
    if joint.slides:
        raise CaseError(
            f"{entry}.clamped: a joint of type {joint.type} slides, but a clamped one holds its links; leave clamped "
            "out, or remove the type"
        )
    if joint.clamp_length is not None and joint.pin_diameter is not None:
        raise CaseError(
            f"{entry}: a clamp holds an end over its clamp_length, or a bore of its pin_diameter, but both are stated; "
            "leave one out"
        )
    for wrong, why in (("friction", "does not turn"), ("clearance", "has no play"), ("tight_in", "has no pin")):
        if getattr(joint, wrong):
            raise CaseError(f"{entry}.{wrong}: a clamped joint {why}; leave it out")


@dataclass(frozen=True)
class Linkage:
    """Links and joints that fit together.

    Attributes
    ----------
    links : mapping of str to Link
        Links by name.
    joints : mapping of str to Joint
        Joints by name.
    heights : mapping of str to float
        Link -> z of its mid-plane [mm]; a link that is left out lies at 0.

    Raises
    ------
    CaseError
        For unknown names, no or several ground links, a moving link without joint, or links without connection to the
        ground.
    """

    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    heights: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check that every name means something and that all links hang together."""
        grounds = [name for name, link in self.links.items() if link.ground]
        if len(grounds) != 1:
            raise CaseError(
                f"links: {len(grounds)} links have ground = true ({', '.join(grounds) or 'none'}); "
                "mark exactly one link as the ground"
            )
        for name, joint in self.joints.items():
            self._check_joint(name, joint)
            _check_clamp(name, joint)
        for name in self.moving:
            if not self.joints_of(name):
                raise CaseError(f"links.{name}: it has no joint, so nothing holds it; add a joint or remove the link")
        reached = {self.ground}
        for _ in self.links:
            reached |= {other for j in self.joints.values() for other in j.links if reached & set(j.links)}
        if lost := [name for name in self.links if name not in reached]:
            raise CaseError(
                f"links.{lost[0]}: no chain of joints connects it to the ground link '{self.ground}'; "
                "add the missing joint or remove the link"
            )

    def _check_joint(self, name: str, joint: Joint) -> None:
        for link, point in zip(joint.links, self.joint_points(name), strict=True):
            if link not in self.links:
                raise CaseError(f"joints.{name}: link '{link}' does not exist; the links are {', '.join(self.links)}")
            if point not in self.links[link].points:
                raise CaseError(
                    f"joints.{name}: link '{link}' has no point '{point}'; "
                    f"its points are {', '.join(self.links[link].points)}"
                )
        if joint.links[0] == joint.links[1]:
            raise CaseError(f"joints.{name}: it joins link '{joint.links[0]}' to itself; name two different links")
        if joint.bonded and not joint.clamped and joint.slides:
            raise CaseError(
                f"joints.{name}.bonded: a joint of type {joint.type} slides, and only a revolute joint can be bonded; "
                "leave bonded out, or remove the type"
            )

    @cached_property
    def ground(self) -> str:
        """Name of the ground link."""
        return next(name for name, link in self.links.items() if link.ground)

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """Names of the moving links, in the order of the case file."""
        return tuple(name for name, link in self.links.items() if not link.ground)

    @cached_property
    def longest(self) -> float:
        """The greatest distance between two points of one link [mm]: the linkage's length scale."""
        spans = []
        for link in self.links.values():
            xy = np.array(list(link.points.values()))
            spans.append(float(np.max(np.linalg.norm(xy[:, None] - xy[None], axis=-1))))
        if max(spans) == 0.0:
            raise CaseError("links: all points of every link coincide; give the links a length")
        return max(spans)

    @cached_property
    def mobility(self) -> int:
        """Degrees of freedom after Gruebler/Kutzbach: M = 3(L - 1) less what joints bear, bonds with a stated angle.

        Norton, Design of Machinery, 5th ed., chapter 2. It counts, and can be wrong for special
        dimensions (parallelograms): there the rank of the Jacobian decides.
        """
        unstated = sum(joint.as_posed for joint in self.joints.values())
        return 3 * len(self.moving) - self.borne + unstated

    @cached_property
    def borne(self) -> int:
        """Number of the forces and moments in the plane that its joints bear."""
        return sum(len(joint.bears & IN_PLANE) for joint in self.joints.values())

    def rise(self, name: str) -> float:
        """Return how far a joint's second link lies above its first, along z.

        Parameters
        ----------
        name : str
            Name of the joint.

        Returns
        -------
        float
            [mm]
        """
        first, second = (self.heights.get(link, 0.0) for link in self.joints[name].links)
        return second - first

    def joint_points(self, name: str) -> tuple[str, str]:
        """Names of the two points that a joint brings together, on its first and its second link.

        Parameters
        ----------
        name : str
            Name of the joint.

        Returns
        -------
        tuple of str
            Names of points.
        """
        return self.joints[name].points or (name, name)

    def joints_of(self, link: str) -> tuple[str, ...]:
        """Names of the joints on a link.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        tuple of str
            Names of joints.
        """
        return tuple(name for name, joint in self.joints.items() if link in joint.links)

    def point_of(self, joint: str, link: str) -> str:
        """Name of the point at which a joint sits on a link.

        Parameters
        ----------
        joint : str
            Name of the joint.
        link : str
            Name of the link.

        Returns
        -------
        str
            Name of the point.
        """
        return self.joint_points(joint)[self.joints[joint].links.index(link)]
