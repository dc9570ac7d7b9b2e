"""The linkage: links with their points, joints between them, and its mobility."""

import itertools
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import POSITIVE, Length
from alula.geometry.joints.holes import PinHoles, pin_holes
from alula.geometry.joints.joint import Joint
from alula.geometry.joints.joint_kinds import IN_PLANE
from alula.geometry.parts.part import EyeSizes, HoleRow, Slot

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
    for wrong, why in (
        ("friction", "does not turn"),
        ("clearance", "has no play"),
        ("fit", "has no pin"),
        ("heads", "has no pin"),
        ("tight_in", "has no pin"),
    ):
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
    moduli : mapping of str to float
        Link with a part -> Young's modulus of its material [MPa].
    pin_moduli : mapping of str to float
        Joint -> that of its pin [MPa].

    Raises
    ------
    CaseError
        For unknown names, no or several ground links, a moving link without joint, or links without connection to the
        ground.
    """

    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    heights: Mapping[str, float] = field(default_factory=dict)
    moduli: Mapping[str, float] = field(default_factory=dict)
    pin_moduli: Mapping[str, float] = field(default_factory=dict)

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
        longest = max(map(self.span, self.links))
        if longest == 0.0:
            raise CaseError("links: all points of every link coincide; give the links a length")
        return longest

    def span(self, link: str) -> float:
        """Return the greatest distance between two points of a link.

        Parameters
        ----------
        link : str

        Returns
        -------
        float
            [mm]
        """
        xy = np.array(list(self.links[link].points.values()))
        return float(np.max(np.linalg.norm(xy[:, None] - xy[None], axis=-1)))

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

    def pin_holes(self, name: str) -> PinHoles:
        """Return the holes in which a joint's pin sits, as far as they are stated.

        Parameters
        ----------
        name : str
            Name of the joint.

        Returns
        -------
        PinHoles
            Of a pin in a slot, the slot's clearance across it is that of the first link; a link without a part has a
            slot as wide as the pin.
        """
        return self._pin_holes[name]

    @cached_property
    def plays(self) -> Mapping[str, float]:
        """Joint -> largest play that is stated of it [mm], of joints with any (``PinHoles.play``)."""
        found = {name: holes.play for name, holes in self._pin_holes.items()}
        return {name: play for name, play in found.items() if play > 0.0}

    def wider(self, link: str, point: str) -> tuple[float, float, float]:
        """Return how much wider than its pin a link's hole is, by what the joints there state.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        tuple of 3 float
            At least, in the middle of what is stated, and at most [mm]; zeros where nothing is.
        """
        stated = [hole for name in self.joints_at(link, point) if (hole := self.pin_holes(name)[link]).stated]
        ends = [(hole.low, hole.nominal, hole.high) for hole in stated] or [(0.0, 0.0, 0.0)]
        least, middle, most = map(max, zip(*ends, strict=True))
        return least, middle, most

    @cached_property
    def _pin_holes(self) -> Mapping[str, PinHoles]:
        found = {}
        for name, joint in self.joints.items():
            slot = self.links[joint.links[0]].slots.get(self.joint_points(name)[0])
            found[name] = pin_holes(joint, 0.0 if slot is None else slot.clearance)
        return found

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
        return self._on_links.get(link, ())

    def joints_at(self, link: str, point: str) -> tuple[str, ...]:
        """Names of the joints at a point of a link.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        tuple of str
            Names of joints.
        """
        return tuple(name for name in self.joints_of(link) if self.point_of(name, link) == point)

    @cached_property
    def _on_links(self) -> Mapping[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for name, joint in self.joints.items():
            for link in joint.links:
                found[link] = (*found.get(link, ()), name)
        return found

    @cached_property
    def tree(self) -> Mapping[str, str]:
        """Spanning tree by breadth-first search from the ground: link -> joint that leads to it."""
        tree: dict[str, str] = {}
        reached, queue = {self.ground}, deque([self.ground])
        while queue:
            here = queue.popleft()
            for name in self.joints_of(here):
                other = next(link for link in self.joints[name].links if link != here)
                if other not in reached:
                    reached.add(other)
                    tree[other] = name
                    queue.append(other)
        return tree

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
