"""Something on which a verdict stands that no check judges: every feature tells its own."""

from dataclasses import dataclass
from enum import StrEnum

from alula.loads.text.reason import Reason


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
    what : Reason or str
        In a few words; a text is a name.
    why : Reason or str
        "" where ``what`` has it.
    """

    heading: Heading = Heading.NOT_CHECKED
    topic: Topic
    what: Reason | str
    why: Reason | str = ""
