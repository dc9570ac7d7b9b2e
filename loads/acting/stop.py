"""Stops as a user states them, and how near joints are to them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.model import CaseModel, Name, one_of, refusal
from alula.geometry.base.units import parse
from alula.geometry.linkage.coordinate import Measure
from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting, ActingMark
from alula.loads.acting.sizes import Angle, places, travel
from alula.loads.records.applied import Load

Real = NDArray[np.float64]

TOUCHING = 1e-9
"""Distance from a stop within which it is reached [rad], or over the longest link."""


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

    def acting(self, name: str, stated: Placement, beside: Sequence["Stop"]) -> "Bound":
        """Return what it does in a linkage.

        Parameters
        ----------
        name : str
            Its own.
        stated : Placement
            The stated pose.
        beside : sequence of Stop
            All stops of its joint.

        Returns
        -------
        Bound
        """
        limits = [other.limit.value for other in beside]
        return Bound(name, self, Angle(self.joint, stated, (min(limits) + max(limits)) / 2.0))

    @model_validator(mode="after")
    def _fits(self) -> "Stop":
        return one_of(self, "at_least", "at_most")


@dataclass(frozen=True)
class Bound(Acting):
    """A stop in a linkage.

    What it bears does not follow from where the links stand: it is whatever the balance asks for, and takes the place
    of the drive's effort there (``alula.loads.states.standing``). So it has no loads of its own.

    Attributes
    ----------
    name : str
    stop : Stop
    angle : Angle
        Of its joint; of no use at a slider.
    """

    lasting: ClassVar[bool] = True
    name: str
    stop: Stop
    angle: Angle

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: none."""
        return ()

    def value(self, place: Placement) -> Real:
        """Return the angle or the travel that it limits.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (...)
            [rad] or [mm]
        """
        slides = self.stop.limit.measure is Measure.TRAVEL
        return travel(place, self.stop.joint) if slides else self.angle.of(place)

    def gap(self, place: Placement) -> Real:
        """Return how far its joint is from it: negative beyond it.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (...)
            [rad] or [mm]
        """
        return np.asarray(self.stop.sense * (self.value(place) - self.stop.limit.value))

    @property
    def touching(self) -> float:
        """The distance within which it is reached [rad, mm]."""
        return TOUCHING * self.stop.limit.measure.scale(self.angle.stated.linkage)

    def marks(self, place: Placement) -> tuple[ActingMark, ...]:
        """As ``Acting.marks``: a wall where the joint's second link comes to, or at its travel."""
        joint, limit = place.linkage.joints[self.stop.joint], self.stop.limit
        first, second = joint.links
        at, pin = places(place, self.angle.ends)
        if limit.measure is Measure.TRAVEL:
            along = place.direction(first) * np.exp(1j * joint.direction)
            at, aside = at + limit.value * along, 0j
        else:
            reach = complex(*max(place.linkage.links[second].points.values(), key=lambda point: math.hypot(*point)))
            at, aside = pin, place.direction(first) * np.exp(1j * limit.value) * reach / abs(reach)
            along = 1j * aside
        behind = -self.stop.sense * along
        return (ActingMark(name=f"stop {self.name}", kind="wall", at=at, aside=aside, behind=behind),)
