"""Springs, tendons and stops as a user states them."""

from typing import Annotated, Any, NamedTuple, TypeVar

from pydantic import Discriminator, Field, PlainValidator, Tag, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import (
    NOT_NEGATIVE,
    POSITIVE,
    Angle,
    Force,
    Length,
    Moment,
    Stiffness,
    TorsionalStiffness,
    parse,
)
from alula.geometry.linkage.coordinate import Measure

Record = TypeVar("Record", bound=CaseModel)


class Attachment(CaseModel):
    """A point of a link, moving or not, at which a spring or a tendon is fastened or led over."""

    link: Name
    """The link."""
    at: Name
    """The point of that link."""


class LineSpring(CaseModel):
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
        return _one_of(self, "free_length", "preload")


class TurnSpring(CaseModel):
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
        return _one_of(self, "free_angle", "preload")


class Tendon(CaseModel):
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


class Limit(NamedTuple):
    """Where a stop is.

    Attributes
    ----------
    value : float
        Angle [rad] or travel [mm].
    measure : Measure
        Which of the two it is.
    """

    value: float
    measure: Measure


def _limit(stated: object) -> Limit:
    try:
        return Limit(parse(stated, "angle"), Measure.ANGLE)
    except PydanticCustomError as wrong:
        try:
            return Limit(parse(stated, "length"), Measure.TRAVEL)
        except PydanticCustomError:
            raise refusal(
                f"{wrong.message()} for the angle of a revolute joint, or a length such as "
                '"10 mm" for the travel of a slider'
            ) from None


AngleOrTravel = Annotated[
    Limit,
    PlainValidator(_limit),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "format": "angle", "examples": ["30 deg"]},
                {"type": "string", "format": "length", "examples": ["5 mm"]},
            ]
        }
    ),
]


class Stop(CaseModel):
    """A stop in a joint, which pushes its two links apart where they reach it, and does nothing elsewhere."""

    joint: Name
    """A revolute joint or a slider."""
    at_least: AngleOrTravel | None = None
    """The least angle of a revolute joint's second link to its first, counter-clockwise positive, or the least travel
    of a slider. Either this or at_most."""
    at_most: AngleOrTravel | None = None
    """The greatest angle, or the greatest travel."""

    @property
    def limit(self) -> Limit:
        """Where it is."""
        found = self.at_least or self.at_most
        assert found is not None  # the validator sees to it
        return found

    @property
    def sense(self) -> float:
        """1 where the joint may go on to larger values, -1 to smaller ones; so it pushes the second link."""
        return 1.0 if self.at_least is not None else -1.0

    @model_validator(mode="after")
    def _fits(self) -> "Stop":
        return _one_of(self, "at_least", "at_most")


def _one_of(record: Record, one: str, other: str) -> Record:
    """Require that exactly one of two entries is stated."""
    if (getattr(record, one) is None) == (getattr(record, other) is None):
        raise refusal(f"it needs either {one} or {other}; state one of the two, and not both")
    return record


def _kind(stated: Any) -> str:
    keys = stated if isinstance(stated, dict) else vars(stated) if isinstance(stated, CaseModel) else ()
    return "turn" if "joint" in keys or "free_angle" in keys else "line"


Spring = Annotated[Annotated[LineSpring, Tag("line")] | Annotated[TurnSpring, Tag("turn")], Discriminator(_kind)]
