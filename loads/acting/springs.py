"""Springs and tendons as a user states them, and what they do."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag, model_validator

from alula.geometry.base.model import CaseModel, Name, one_of, refusal
from alula.geometry.base.units import (
    NOT_NEGATIVE,
    POSITIVE,
    Angle,
    Force,
    Length,
    Moment,
    Stiffness,
    TorsionalStiffness,
)
from alula.geometry.linkage.placement import Placement
from alula.loads.acting import sizes
from alula.loads.acting.sprung import Law, Sprung, SprungRecord
from alula.loads.records.attachment import Attachment


class LineSpring(SprungRecord):
    """A straight spring between points of two links: it pulls with stiffness times (length - free length)."""

    between: tuple[Attachment, Attachment]
    """Where its two ends are fastened: points of two different links, of which the ground may be one."""
    stiffness: Annotated[Stiffness, POSITIVE]
    """Force per elongation."""
    free_length: Annotated[Length, NOT_NEGATIVE] | None = None
    """Length at which it neither pulls nor pushes; either this or a preload."""
    preload: Force | None = None
    """Its pull in the stated pose, in place of the free length; negative where it pushes there."""

    @model_validator(mode="after")
    def _fits(self) -> "LineSpring":
        if self.between[0].link == self.between[1].link:
            raise refusal(f"both of its ends are on link '{self.between[0].link}'; fasten one to another link")
        return one_of(self, "free_length", "preload")

    @property
    def fastened(self) -> Mapping[str, Attachment]:
        """Entry -> point of a link at which it is fastened."""
        return {f"between.{i}": one for i, one in enumerate(self.between)}

    def acting(self, name: str, stated: Placement) -> Sprung:
        """As ``SprungRecord.acting``."""
        along = self.route()
        if self.preload is not None:
            law = Law(size=float(along.of(stated)), effort=self.preload, stiffness=self.stiffness)
        else:
            law = Law(size=self.free_length or 0.0, stiffness=self.stiffness)
        return Sprung(name=name, along=along, law=law)

    def standing(self, effort: float) -> "LineSpring":
        """As ``SprungRecord.standing``: with a preload."""
        return self.model_copy(update={"free_length": None, "preload": effort})


class TurnSpring(SprungRecord):
    """A spring about a revolute joint, between its two links.

    The angle is that of the joint's second link less that of its first, counter-clockwise positive. The spring turns
    the second link with stiffness times (free angle - angle), and the first one with the opposite moment.
    """

    joint: Name
    """The revolute joint about which it turns."""
    stiffness: Annotated[TorsionalStiffness, POSITIVE]
    """Moment per angle."""
    free_angle: Angle | None = None
    """Angle at which it is not wound; it is less than half a turn from that of the stated pose. Either this or a
    preload."""
    preload: Moment | None = None
    """Its moment on the joint's second link in the stated pose, counter-clockwise positive, in place of the free
    angle; any number of turns may be wound."""

    @model_validator(mode="after")
    def _fits(self) -> "TurnSpring":
        return one_of(self, "free_angle", "preload")

    @property
    def hinge(self) -> str:
        """The joint about which it turns."""
        return self.joint

    def acting(self, name: str, stated: Placement) -> Sprung:
        """As ``SprungRecord.acting``."""
        along = sizes.Angle(self.joint, stated, self.free_angle)
        if self.preload is not None:
            law = Law(size=along.at_stated, effort=-self.preload, stiffness=self.stiffness)
        else:
            law = Law(size=self.free_angle or 0.0, stiffness=self.stiffness)
        return Sprung(name=name, along=along, law=law)

    def standing(self, effort: float) -> "TurnSpring":
        """As ``SprungRecord.standing``: with a preload."""
        return self.model_copy(update={"free_angle": None, "preload": effort})


class Tendon(SprungRecord):
    """A cord without mass or friction through points of links, with the same force all along; it only pulls."""

    through: Annotated[tuple[Attachment, ...], Field(min_length=2, max_length=50)]
    """Its points from one end to the other: fastened at the first and the last, led over all between."""
    tension: Annotated[Force, POSITIVE] | None = None
    """Its force, whatever its length; either this or a stiffness with a free length."""
    stiffness: Annotated[Stiffness, POSITIVE] | None = None
    """Force per elongation of the whole cord."""
    free_length: Annotated[Length, POSITIVE] | None = None
    """Length of the whole cord below which it is slack and does nothing."""

    @model_validator(mode="after")
    def _fits(self) -> "Tendon":
        if len({place.link for place in self.through}) == 1:
            raise refusal(f"all of its points are on link '{self.through[0].link}'; lead it to another link")
        stated = (self.tension is not None, self.stiffness is not None, self.free_length is not None)
        if stated not in ((True, False, False), (False, True, True)):
            raise refusal("it needs either a tension, or a stiffness and a free_length; state one of the two")
        return self

    @property
    def fastened(self) -> Mapping[str, Attachment]:
        """Entry -> point of a link at which it is fastened or led over."""
        return {f"through.{i}": one for i, one in enumerate(self.through)}

    def acting(self, name: str, stated: Placement) -> Sprung:
        """As ``SprungRecord.acting``."""
        law = Law(size=self.free_length or 0.0, effort=self.tension or 0.0, stiffness=self.stiffness or 0.0, pulls=True)
        return Sprung(name=name, kind="tendon", along=self.route(), law=law)


def _kind(stated: Any) -> str:
    keys = stated if isinstance(stated, dict) else vars(stated) if isinstance(stated, CaseModel) else ()
    return "turn" if "joint" in keys or "free_angle" in keys else "line"


Spring = Annotated[Annotated[LineSpring, Tag("line")] | Annotated[TurnSpring, Tag("turn")], Discriminator(_kind)]
