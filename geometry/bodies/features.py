"""Pins, loaded ends and holes of a link, all along the x axis of its frame."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length

OFF_PLANE = 1e-3
"""Share of a hole's length by which its middle may lie off the plane of forces before that counts."""


class HoleRow(CaseModel):
    """A row of equal cross holes along the link, such as those that hold feathers."""

    count: Annotated[int, Field(gt=0, le=200)]
    """Number of holes."""
    diameter: Annotated[Length, POSITIVE]
    """Diameter of each."""
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
    clearance: Annotated[Length, NOT_NEGATIVE] | None = None
    """How much wider the slot is than the pin. Left out, it is as wide as the pin in the plane, and between layers the
    pin may tilt in it as in a hole of which nothing is stated."""

    @property
    def wider(self) -> float:
        """How much wider than the pin it is in the plane [mm]."""
        return self.clearance or 0.0

    @model_validator(mode="after")
    def _order(self) -> "Slot":
        if not self.first < self.last:
            raise PydanticCustomError(
                "no_slot",
                "first = {first} mm must be less than last = {last} mm; swap them or lengthen the slot",
                {"first": f"{self.first:g}", "last": f"{self.last:g}"},
            )
        return self


class EyeSizes(CaseModel):
    """Sizes of one eye of a link, where they are not those that its part states for all."""

    diameter: Annotated[Length, POSITIVE] | None = None
    """Outer diameter; the part's eye_diameter where it is left out."""
    thickness: Annotated[Length, POSITIVE] | None = None
    """Height along the pin; the part's eye_thickness where it is left out."""
    fork: Annotated[Length, POSITIVE] | None = None
    """Of a fork (clevis): the gap in the middle of its thickness, in which the other link's eye lies between two
    cheeks. Of an imported part it tells that the gap of the file is one."""
    fork_depth: Annotated[Length, POSITIVE] | None = None
    """From the pin's axis to the root of that gap, an arc about the axis. Left out, it is 1.05 times the radius of the
    larger of both eyes, and fork_radius."""
    fork_radius: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Rounds the edges between the root of the gap and the cheeks; 0 leaves them sharp."""

    @model_validator(mode="after")
    def _fork(self) -> "EyeSizes":
        if self.fork is None and self.model_fields_set & {"fork_depth", "fork_radius"}:
            raise PydanticCustomError(
                "no_fork", "fork_depth and fork_radius need a fork; state its gap, or leave them out"
            )
        return self


@dataclass(frozen=True, kw_only=True)
class Fork:
    """The gap of a fork end.

    Attributes
    ----------
    gap : float
        Its height along the pin, in the middle of the eye [mm].
    depth : float
        From the pin's axis to its root, an arc about the axis [mm].
    radius : float
        Of the fillets between root and cheeks [mm]; 0 where they are sharp.
    """

    gap: float
    depth: float
    radius: float

    def scaled(self, s: Callable[[float], float]) -> "Fork":
        """Return the fork with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        Fork
            The fork.
        """
        return Fork(gap=s(self.gap), depth=s(self.depth), radius=s(self.radius))


@dataclass(frozen=True, kw_only=True)
class Ring:
    """The flat ring about a hole, on which a torque or a thrust enters.

    Attributes
    ----------
    diameter : float
        Its outer diameter [mm]; 0 where no flat ring is about the hole.
    low, high : float
        z of the hole's two rims [mm].
    share : float
        Share of the circle that the hole's wall takes; less than 1 where it is not round all the way.
    gaps : tuple of tuple of float
        z between which the hole has no wall, from low to high, such as in the bore of a tube [mm].
    """

    diameter: float
    low: float
    high: float
    share: float = 1.0
    gaps: tuple[tuple[float, float], ...] = ()

    @property
    def height(self) -> float:
        """Distance of the rims [mm]."""
        return self.high - self.low

    @property
    def walls(self) -> tuple[tuple[float, float], ...]:
        """The z between which the hole has a wall, from low to high [mm]."""
        edges = (self.low, *(z for gap in self.gaps for z in gap), self.high)
        return tuple(zip(edges[::2], edges[1::2], strict=True))

    @property
    def thickness(self) -> float:
        """Length of the hole's wall, on which a pin bears [mm]."""
        return self.height - sum(high - low for low, high in self.gaps)

    @property
    def second(self) -> float:
        """Second moment of the walls' length about their middle; of a single wall t³/12 [mm³]."""
        return sum((high - self.middle) ** 3 - (low - self.middle) ** 3 for low, high in self.walls) / 3.0

    @property
    def middle(self) -> float:
        """The z of the middle of the hole's wall, where an even pressure along it acts [mm]."""
        return sum((high - low) * (low + high) / 2.0 for low, high in self.walls) / self.thickness

    @property
    def off_plane(self) -> bool:
        """Whether the middle of the hole lies off the plane of the link's forces, z = 0."""
        return abs(self.middle) > OFF_PLANE * self.thickness

    def doubled(self, apart: float) -> "Ring":
        """Return the ring of a pair of plates, each with this one.

        Parameters
        ----------
        apart : float
            Distance of the plates' mid-planes, which lie evenly about z = 0 [mm].

        Returns
        -------
        Ring
            From the lower rim of the lower plate to the upper one of the upper.
        """
        walls = [(low + side, high + side) for side in (-apart / 2.0, apart / 2.0) for low, high in self.walls]
        gaps = tuple((below[1], above[0]) for below, above in itertools.pairwise(walls))
        return replace(self, low=walls[0][0], high=walls[-1][1], gaps=gaps)

    def scaled(self, s: Callable[[float], float]) -> "Ring":
        """Return the ring with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        Ring
            The ring.
        """
        gaps = tuple((s(low), s(high)) for low, high in self.gaps)
        return Ring(diameter=s(self.diameter), low=s(self.low), high=s(self.high), share=self.share, gaps=gaps)


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
        How much wider than the pin it is [mm]; 0 where that is not told.
    foot : tuple of float, optional
        (x, y) of the pin on the link's axis from which an arm reaches to this one [mm]; None for a pin without arm.
    ring : Ring, optional
        The flat ring about its hole; None for the one that the part's eye_diameter and eye_thickness make
        (``Body.ring`` gives the one that holds).
    fork : Fork, optional
        The gap that is cut into its eye, whose ring tells it as well; None where there is none.
    """

    name: str
    x: float
    y: float
    diameter: float
    slot: float = 0.0
    clearance: float = 0.0
    foot: tuple[float, float] | None = None
    ring: Ring | None = None
    fork: Fork | None = None

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
class FlatFace:
    """A flat face of a part in the frame of its link.

    Attributes
    ----------
    centre : tuple of 3 float
        Centroid of its area [mm].
    normal : tuple of 3 float
        Unit vector, out of the material.
    area : float
        [mm²].
    """

    centre: tuple[float, float, float]
    normal: tuple[float, float, float]
    area: float

    def scaled(self, s: Callable[[float], float]) -> "FlatFace":
        """Return the face with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        FlatFace
            The face.
        """
        x, y, z = map(s, self.centre)
        side = s(self.area**0.5)
        return FlatFace(centre=(x, y, z), normal=self.normal, area=side * side)


@dataclass(frozen=True, kw_only=True)
class PlainEnd:
    """A load point that is no pin.

    Attributes
    ----------
    name : str
        Name of the point.
    x : float
        Its place along the link's axis [mm].
    patch : float
        Length of the loaded patch along x; diameter of the patch on an imported part or a plate [mm].
    y : float
        Its place across the axis, off which only imported parts and plates have load points [mm].
    face : FlatFace, optional
        The flat face that carries its load as a whole; None where it enters the nearest ones.
    clamped : bool
        True of an end that a clamp holds over the length of the patch.
    """

    name: str
    x: float
    patch: float
    y: float = 0.0
    face: FlatFace | None = None
    clamped: bool = False

    @property
    def entry(self) -> str:
        """Name of what states its patch, for messages."""
        return "clamp_length" if self.clamped else "end_patch"
