"""How a pin sits in the hole of a link, as far as a case tells it: what its pressure follows."""

from dataclasses import dataclass
from typing import Literal

Side = Literal[-1, 0, 1]


@dataclass(frozen=True, kw_only=True)
class Seat:
    """A pin in its hole.

    Attributes
    ----------
    young, pin_young : float
        Moduli of the link and of the pin [MPa].
    diameter, length : float
        Of the hole, and of its wall along the pin [mm].
    eye : float
        Outer diameter of the flat ring about the hole [mm]; 0 where there is none.
    away : int
        Where the eye ends the link: direction along x in which a pin pulls it off its shank, 1 or -1; 0 elsewhere.
    side : {-1, 0, 1} or None
        Rim at which the pin is loaded: the lower one, both, or the upper one; None where no layers tell it.
    clearance : tuple of 2 float or None
        Least and largest diametral clearance [mm]; None where none is stated.
    """

    young: float
    pin_young: float
    diameter: float
    length: float
    eye: float
    away: Literal[-1, 0, 1] = 0
    side: Side | None = None
    clearance: tuple[float, float] | None = None
