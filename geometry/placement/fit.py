"""What a link wants of its part, and how the part lies in it: records of the matching of bores and points."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.facts import Bore

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """A point of a link that must be a bore of its part.

    Attributes
    ----------
    name : str
        Of the point.
    place : tuple of float
        (x, y) in the link's frame; of a slot, its middle [mm].
    diameter : float
        Of its pin [mm].
    slot : tuple of float, optional
        The x of the centres of a slot's round ends [mm]; None for a round bore.
    clearance : float
        How much wider than its pin the slot is, as the case states it [mm].
    """

    name: str
    place: tuple[float, float]
    diameter: float
    slot: tuple[float, float] | None = None
    clearance: float = 0.0

    @property
    def ends(self) -> list["Wanted"]:
        """What takes one place each: a round bore itself, or both round ends of a slot."""
        return [self] if self.slot is None else [replace(self, place=(x, self.place[1])) for x in self.slot]


@dataclass(frozen=True, kw_only=True)
class SlotEnd(Bore):
    """A round end of a slot, as a bore of its own.

    Attributes
    ----------
    whole : Bore
        The slot.
    """

    whole: Bore


def ends_of(bore: Bore) -> list[Bore]:
    """Return what takes one place each: a round bore itself, or both round ends of a slot.

    Parameters
    ----------
    bore : Bore
        Of a part.

    Returns
    -------
    list of Bore
        One, or two of kind ``SlotEnd``.
    """
    if not bore.slot:
        return [bore]
    arm = bore.slot / 2.0 * np.asarray(bore.slot_axis)
    found: list[Bore] = []
    for which, side in (("one", -1.0), ("other", 1.0)):
        x, y, z = (np.asarray(bore.centre) + side * arm).tolist()
        own = {field.name: getattr(bore, field.name) for field in fields(Bore)}
        own |= {"name": f"{bore.name} ({which} end)", "centre": (x, y, z)}
        found.append(SlotEnd(**own, whole=bore))
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """Where a part lies in its link: a point p of the file at ``turn`` p + ``shift``.

    Attributes
    ----------
    turn : ndarray
        Rotation (3, 3).
    shift : ndarray
        Translation (3,) [mm].
    bores : mapping of str to Bore
        Point of the link -> its bore, in the file's frame.
    """

    turn: Real
    shift: Real
    bores: Mapping[str, Bore]

    def middle(self, point: str) -> Real:
        """Return the middle (3,) of a point's bore in the link's frame [mm].

        Parameters
        ----------
        point : str
            Name of the point.

        Returns
        -------
        ndarray
            The place.
        """
        return np.asarray(self.turn @ np.asarray(self.bores[point].centre) + self.shift)

    def span(self, point: str) -> tuple[float, float]:
        """Return the x of the centres of a slot's round ends; of a round bore twice that of its middle [mm].

        Parameters
        ----------
        point : str
            Name of the point.

        Returns
        -------
        tuple of float
            From low to high.
        """
        x, half = float(self.middle(point)[0]), self.bores[point].slot / 2.0
        return x - half, x + half
