"""A load that is stated as it is, whatever the place: forces, moments, pressures, spread loads, stated air."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement, vector
from alula.loads.acting.acting import Acting, End
from alula.loads.acting.sizes import places
from alula.loads.records.applied import LineLoad, Load, PointLoad, at_poses, in_axes

Real = NDArray[np.float64]


@dataclass(frozen=True)
class DeadLoad(Acting):
    """A load of constant components, in global axes or in those of its link, with which it turns and has no energy.

    Attributes
    ----------
    load : PointLoad or LineLoad
        At one pose.
    """

    load: PointLoad | LineLoad

    @property
    def ends(self) -> tuple[End, ...]:
        """The point at which it acts, or the origin of its link's frame."""
        return ((self.load.link, self.load.point if isinstance(self.load, PointLoad) else ""),)

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: the load at every pose."""
        return (at_poses(self.load, place.shape),)

    def energy(self, place: Placement) -> Real | None:
        """As ``Acting.energy``: minus its work from the global origin; None in axes of its link."""
        if self.load.axes == "link":
            return None
        link = self.load.link
        if isinstance(self.load, PointLoad):
            force, at = self.load.wrench, vector(places(place, self.ends)[0])
            return np.asarray(-(at * force[:3]).sum(axis=-1) - place.angle(link) * force[5])
        force, first = self.load.force, self.load.first_moment
        at, way = vector(place.origin(link)), vector(place.direction(link))
        return np.asarray(-(at * force).sum(axis=-1) - (way * first).sum(axis=-1))

    def tangent(self, place: Placement) -> Real:
        """As ``Acting.tangent``: how force, or moment about the frame's origin, changes as the link turns."""
        found, load = np.zeros((3, 3)), in_axes(self.load, "global", place)
        force = load.wrench[:3] if isinstance(load, PointLoad) else load.force
        if self.load.axes == "link":
            found[:2, 2] = force[1], -force[0]
        elif not isinstance(load, PointLoad):
            found[2, 2] = vector(place.direction(load.link)) @ load.first_moment
        return found
