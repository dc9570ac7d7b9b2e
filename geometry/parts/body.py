"""What shapes a link: its part, and the pins, loaded ends and rows of holes along it.

A body lies along the x axis of its link's frame, its pins along z, its mid-plane at z = 0.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from geometry.base.model import CaseModel
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from geometry.parts.section import Section

if TYPE_CHECKING:
    from geometry.parts.part import Part


class HoleRow(CaseModel):
    """A row of equal cross holes along the link, such as those that hold feathers."""

    count: Annotated[int, Field(gt=0, le=200)]
    diameter: Annotated[Length, POSITIVE]
    first: Length
    """x of the first hole in the link's frame."""
    last: Length
    """x of the last hole; the others are evenly spaced between."""
    along: Literal["y", "z"]
    """Direction of the holes' axes: y in the linkage's plane, z along the pins."""

    @property
    def positions(self) -> tuple[float, ...]:
        """The x of every hole [mm]."""
        if self.count == 1:
            return (self.first,)
        step = (self.last - self.first) / (self.count - 1)
        return tuple(self.first + i * step for i in range(self.count))


class Slot(CaseModel):
    """A through slot along the link's axis, with round ends, in which a pin slides."""

    first: Length
    """x of the centre of one round end in the link's frame: how far the pin's centre may travel."""
    last: Length
    """x of the centre of the other round end."""
    clearance: Annotated[Length, NOT_NEGATIVE] = 0.0
    """How much wider the slot is than the pin."""

    @model_validator(mode="after")
    def _order(self) -> "Slot":
        if not self.first < self.last:
            raise PydanticCustomError(
                "no_slot",
                "first = {first} mm must be less than last = {last} mm; swap them or lengthen the slot",
                {"first": f"{self.first:g}", "last": f"{self.last:g}"},
            )
        return self


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A pin hole of a link, or a slot: a hole drawn out along x.

    Attributes
    ----------
    name : str
        Name of the point.
    x, y : float
        Middle in the link's frame [mm].
    diameter : float
        Diameter of the hole, or width of the slot [mm].
    slot : float
        Distance of the centres of a slot's round ends [mm]; 0 for a hole.
    clearance : float
        How much wider than the pin the slot is [mm].
    foot : tuple of float, optional
        (x, y) of the pin on the link's axis from which an arm reaches to this one [mm]; None for a pin without arm.
    """

    name: str
    x: float
    y: float
    diameter: float
    slot: float = 0.0
    clearance: float = 0.0
    foot: tuple[float, float] | None = None

    @property
    def span(self) -> tuple[float, float]:
        """The x of the centres of a slot's round ends; twice that of a hole's centre [mm]."""
        return self.x - self.slot / 2.0, self.x + self.slot / 2.0

    @property
    def pin_diameter(self) -> float:
        """Diameter of the pin in it [mm]."""
        return self.diameter - self.clearance

    def distance(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Return the distance of places from the hole's axis, or the slot's centre line.

        Parameters
        ----------
        x, y : array_like
            Places in the link's frame, of any one shape [mm].

        Returns
        -------
        ndarray
            Distances, of the same shape [mm].
        """
        along = np.maximum(np.abs(np.asarray(x) - self.x) - self.slot / 2.0, 0.0)
        return np.asarray(np.hypot(along, np.asarray(y) - self.y))

    @property
    def distance_formula(self) -> str:
        """The same distance as a formula of the mesher in x and y."""
        along = f"(x-({self.x:.12g}))"
        if self.slot > 0.0:
            along = f"Max(Fabs{along}-{self.slot / 2.0:.12g},0)"
        return f"Sqrt({along}^2+(y-({self.y:.12g}))^2)"


@dataclass(frozen=True, kw_only=True)
class PlainEnd:
    """A load point that is no pin.

    Attributes
    ----------
    name : str
        Name of the point.
    x : float
        Its place on the link's axis [mm].
    patch : float
        Length of the loaded patch along x [mm].
    """

    name: str
    x: float
    patch: float


@dataclass(frozen=True, kw_only=True)
class Body:
    """All that shapes one link: what the mesher and the mass properties need.

    Attributes
    ----------
    part : Part
        Kind and sizes.
    pins : tuple of Pin
        Pin holes and slots.
    ends : tuple of PlainEnd
        Load points without pins.
    holes : tuple of HoleRow
        Rows of cross holes.
    """

    part: "Part"
    pins: tuple[Pin, ...]
    ends: tuple[PlainEnd, ...]
    holes: tuple[HoleRow, ...]


def extent(body: Body) -> tuple[float, float]:
    """Return the least and greatest x of the pins and ends on the axis: where a tube or bar begins and ends.

    Parameters
    ----------
    body : Body
        The body; of a disc the result tells what lies between its holes.

    Returns
    -------
    first, last : float
        Stations [mm].
    """
    stations = [x for p in body.pins if p.foot is None for x in p.span] + [e.x for e in body.ends]
    return min(stations), max(stations)


def patch_span(body: Body, end: PlainEnd) -> tuple[float, float]:
    """Return the x between which a loaded patch lies: inwards from an end of the link, else about its point.

    Parameters
    ----------
    body : Body
        The body.
    end : PlainEnd
        One of its load points without pin.

    Returns
    -------
    low, high : float
        Stations [mm].
    """
    first, last = extent(body)
    if end.x == last:
        return end.x - end.patch, end.x
    if end.x == first:
        return end.x, end.x + end.patch
    return end.x - end.patch / 2.0, end.x + end.patch / 2.0


def apart(one: Pin, other: Pin) -> float:
    """Return the distance between two holes.

    Parameters
    ----------
    one, other : Pin
        Holes or slots.

    Returns
    -------
    float
        Distance of their centres, or the slots' centre lines [mm].
    """
    along = max(abs(one.x - other.x) - (one.slot + other.slot) / 2.0, 0.0)
    return math.hypot(along, one.y - other.y)


def hand_section(body: Body) -> Section:
    """Return the section of which hand calculation takes the link to be made.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    Section
        A tube's or bar's own between the eyes, the narrowest net section of a disc.
    """
    return body.part.hand_section(body)


def reference_line(body: Body) -> tuple[float, float]:
    """Return the two stations through which the line runs that hand calculation's displacements refer to.

    The first and last pin on the axis. A link with a single pin has that station twice: the line turns with its bore.
    Where there are pins off the axis besides, the eye of the one on it holds the direction, as does an arm on it.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    first, last : float
        Stations [mm].
    """
    on_axis = [pin.x for pin in body.pins if pin.foot is None]
    if len(on_axis) > 1 and on_axis[0] != on_axis[-1]:
        return on_axis[0], on_axis[-1]
    if len(body.pins) == 1:
        return on_axis[0], on_axis[0]
    first, last = extent(body)
    half = body.part.eye_diameter / 2.0
    return on_axis[0], on_axis[0] + (half if last - on_axis[0] >= on_axis[0] - first else -half)
