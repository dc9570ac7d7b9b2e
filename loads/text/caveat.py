"""Something on which a verdict stands that no check judges: every feature tells its own."""

from dataclasses import dataclass
from enum import StrEnum


class Heading(StrEnum):
    """Under which heading a caveat is told."""

    NOT_CHECKED = "not checked"
    ASSUMED = "assumed"
    UNUSUAL = "unusual"


class Topic(StrEnum):
    """What a caveat is about."""

    PART = "part"
    STRESS = "stress"
    PINS = "pins"
    MASS = "mass"
    SIZE = "size"
    INERTIA = "inertia"
    WEIGHT = "weight"
    LOADS = "loads"
    VIBRATION = "vibration"
    BUCKLING = "buckling"
    DRIVE = "drive"
    FRICTION = "friction"
    BONDS = "bonds"
    MATERIAL = "material"
    TEMPERATURE = "temperature"
    LAYERS = "layers"
    CREEP = "creep"
    FATIGUE = "fatigue"
    LIMIT = "limit"
    PLAY = "play"
    TOLERANCES = "tolerances"
    MOTION = "motion"
    SHAFT = "shaft"
    COLLISIONS = "collisions"


@dataclass(frozen=True, kw_only=True)
class Caveat:
    """Something on which a verdict stands that no check judges.

    Attributes
    ----------
    heading : Heading
    topic : Topic
    what : str
        In a few words.
    why : str
        Its reason; "" where ``what`` has it.
    """

    heading: Heading = Heading.NOT_CHECKED
    topic: Topic
    what: str
    why: str = ""

    def __str__(self) -> str:
        """For people: ``thigh (no part)``."""
        return f"{self.what} ({self.why})" if self.why else self.what

    @property
    def short(self) -> str:
        """For a headline: without the reason where most cases have the same."""
        return self.what if self.topic in (Topic.SHAFT, Topic.COLLISIONS) else str(self)
