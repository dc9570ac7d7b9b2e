"""Weight and inertia of a part or of what a link carries."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement, vector
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import BodyForce, LineLoad, Load, PartMass, PointLoad, shifted
from alula.loads.records.carried import Carried, CarriedSpread

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Weight(Acting):
    """Weight of a mass, and its inertia where the place has second rates.

    Attributes
    ----------
    link : str
        That has it.
    mass : PartMass
    gravity : array (3,)
        Weight per mass, global axes [mm/s²]; 0 for inertia alone.
    carried : CarriedSpread or CarriedBody or None
        As what it enters the link; None for a part, which bears it all over.
    """

    link: str
    mass: PartMass
    gravity: Real
    carried: Carried | None = None

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: weight and inertia as they enter the link."""
        [force] = inertia_loads(place, {self.link: self.mass}, self.gravity)
        if self.carried is None:
            return (force,)
        points, turn = place.linkage.links[self.link].points, place.direction(self.link)
        if isinstance(self.carried, CarriedSpread):
            start, end = sorted((points[self.carried.start][0], points[self.carried.end][0]))
            first, last = (self.mass.mass / (end - start) * force.per_mass(vector(x * turn)) for x in (start, end))
            return (LineLoad(link=self.link, start=start, end=end, at_start=first, at_end=last),)
        wrench = force.at_centroid(vector(turn * complex(*self.mass.centroid)))
        arm = vector(turn * complex(*(self.mass.centroid - np.array(points[self.carried.at]))))
        return (PointLoad(link=self.link, point=self.carried.at, wrench=shifted(wrench, arm), arm=arm),)

    def potential(self, place: Placement) -> Real:
        """Return the potential energy of the weight above the global origin.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        array (...)
            [N mm]
        """
        centroid = place.origin(self.link) + place.direction(self.link) * complex(*self.mass.centroid)
        return np.asarray(-self.mass.mass * (vector(centroid) @ self.gravity))


def inertia_loads(place: Placement, masses: Mapping[str, PartMass], gravity: Real) -> tuple[BodyForce, ...]:
    """Return weight and inertia as loads on the links, after D'Alembert.

    Every mass element dm of a link loads it with (g - a) dm, where a is its acceleration.

    Parameters
    ----------
    place : Placement
        Where the links stand and how they move; at rest there is weight alone.
    masses : mapping of str to PartMass
        By link.
    gravity : array (3,)
        Weight per mass g, global axes [mm/s²].

    Returns
    -------
    tuple of BodyForce
        One per mass.

    References
    ----------
    Norton, Design of Machinery, 5th ed., chapters 10 and 11.
    """
    return tuple(
        BodyForce(
            link=link,
            mass=own,
            specific_force=gravity - vector(place.acceleration(link)),
            angular_acceleration=place.spin_rate(link),
            angular_speed_squared=place.spin(link) ** 2,
        )
        for link, own in masses.items()
    )
