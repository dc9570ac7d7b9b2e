"""What fixes or drives a linkage: the angle of a moving link, or the travel in a slider or slot."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.linkage import Linkage


class Measure(Enum):
    """As what a coordinate is measured, a link's or a joint's.

    Attributes
    ----------
    word : str
        Its name for people.
    unit : str
        In which people read it.
    stiffness_unit : str
        In which people read a stiffness along it.
    symbol : str
        Unit in which alula computes.
    """

    ANGLE = "angle", "deg", "N·mm/rad", "rad"
    TRAVEL = "travel", "mm", "N/mm", "mm"

    def __init__(self, word: str, unit: str, stiffness_unit: str, symbol: str) -> None:
        self.word, self.unit, self.stiffness_unit, self.symbol = word, unit, stiffness_unit, symbol

    def told(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return values in the unit in which people read them.

        Parameters
        ----------
        values : array_like
            Angles [rad] or travels [mm].

        Returns
        -------
        ndarray
            Values in ``unit``.
        """
        return np.asarray(np.degrees(values) if self is Measure.ANGLE else values, dtype=float)

    def in_words(self, value: float) -> str:
        """Return a value with its unit.

        Parameters
        ----------
        value : float
            Angle [rad] or travel [mm].

        Returns
        -------
        str
            With six digits.
        """
        return f"{float(self.told(value)):.6g} {self.unit}"

    def scale(self, linkage: Linkage) -> float:
        """Return the size by which it counts.

        Parameters
        ----------
        linkage : Linkage
            The linkage.

        Returns
        -------
        float
            1 rad, or the longest link [mm].
        """
        return 1.0 if self is Measure.ANGLE else linkage.longest


@dataclass(frozen=True)
class Coordinate:
    """The one number that fixes or drives a linkage.

    Attributes
    ----------
    name : str
        Of the moving link, slider or slot.
    measure : Measure
        The link's angle, or the travel in the slider or slot.
    """

    name: str
    measure: Measure = Measure.ANGLE

    def __str__(self) -> str:
        return self.name

    @property
    def slides(self) -> bool:
        """True where it is the travel in a slider or slot."""
        return self.measure is Measure.TRAVEL

    def column(self, closure: LoopClosure) -> int:
        """Return its number among the unknowns of a loop closure.

        Parameters
        ----------
        closure : LoopClosure
            Of a linkage that has it.

        Returns
        -------
        int
            The number, from 0.
        """
        moving = closure.linkage.moving
        return len(moving) + closure.slots.index(self.name) if self.slides else moving.index(self.name)
