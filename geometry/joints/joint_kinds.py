"""Kinds of joints: what each bears, and where it rubs. All else that is asked of a kind follows from these two.

A new kind is one more record of ``JOINT_KINDS``, and what stands of it in the text of ``Joint.type``.
"""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property


class Way(Enum):
    """A direction in which a joint may hold its second link on its first, or an axis about which it may.

    ALONG its slot or guide, or x where it has none; ACROSS that, in the plane; and along the PIN, out of the plane.
    """

    ALONG = "along"
    ACROSS = "across"
    PIN = "pin"
    ABOUT_ALONG = "about along"
    ABOUT_ACROSS = "about across"
    ABOUT_PIN = "about pin"


Ways = frozenset[Way]
MOVES = (Way.ALONG, Way.ACROSS, Way.PIN)
TURNS = (Way.ABOUT_ALONG, Way.ABOUT_ACROSS, Way.ABOUT_PIN)
"""About the axes of ``MOVES``, in their order."""
ALL_WAYS: Ways = frozenset(Way)
IN_PLANE: Ways = frozenset((Way.ALONG, Way.ACROSS, Way.ABOUT_PIN))


class Surface(Enum):
    """Where a joint rubs: a pin in its BORE, a pin on the FLANKS of a slot, or a slider without pin on its GUIDE."""

    BORE = "bore"
    FLANKS = "flanks"
    GUIDE = "guide"


@dataclass(frozen=True, kw_only=True)
class JointKind:
    """A kind of joint.

    Attributes
    ----------
    name : str
        Its ``type`` in the case file.
    bears : frozenset of Way
        In which it holds the second link on the first: a force or a couple acts in each. It moves in the others.
    rubs : Surface
        Where it rubs.

    Raises
    ------
    ValueError
        Where it does not bear across, which is how it holds its links together; or where it rubs in a bore and slides,
        or the other way round.
    """

    name: str
    bears: Ways
    rubs: Surface

    def __post_init__(self) -> None:
        """Check that closure, equilibrium and friction have what they take for granted."""
        if Way.ACROSS not in self.bears:
            raise ValueError(f"joint kind {self.name}: it must bear across")
        if self.slides != (self.rubs is not Surface.BORE):
            raise ValueError(f"joint kind {self.name}: what slides rubs on flanks or a guide, all else in a bore")

    @cached_property
    def slides(self) -> bool:
        """Whether it has a slot or guide, with a travel along it."""
        return Way.ALONG not in self.bears

    @cached_property
    def keeps_angle(self) -> bool:
        """Whether its links keep their angle to each other, which takes part in closing the loops."""
        return Way.ABOUT_PIN in self.bears

    @cached_property
    def guided(self) -> bool:
        """Whether it moves along its guide alone, so that a drive pushes it and does not turn it."""
        return self.slides and self.keeps_angle

    @cached_property
    def has_pin(self) -> bool:
        """Whether a pin is in it, with a diameter, a mass and play."""
        return self.rubs is not Surface.GUIDE

    @cached_property
    def driven(self) -> Ways:
        """What a drive in it bears as well: along its guide, or about all axes."""
        return frozenset((Way.ALONG,) if self.guided else TURNS)


REVOLUTE = JointKind(name="revolute", bears=ALL_WAYS - {Way.ABOUT_PIN}, rubs=Surface.BORE)
PIN_IN_SLOT = JointKind(name="pin-in-slot", bears=frozenset((Way.ACROSS, Way.ABOUT_ALONG)), rubs=Surface.FLANKS)
SLIDER = JointKind(name="slider", bears=ALL_WAYS - {Way.ALONG}, rubs=Surface.GUIDE)
JOINT_KINDS = {kind.name: kind for kind in (REVOLUTE, PIN_IN_SLOT, SLIDER)}
"""By their names in the case file."""
