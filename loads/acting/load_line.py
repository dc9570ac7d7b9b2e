"""A force along a line in space, which enters links over rigid levers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement, vector
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import PointLoad, rotated, shifted
from alula.loads.records.load_case import LoadLine, vector3

Real = NDArray[np.float64]


@dataclass(frozen=True)
class ForceOnLine(Acting):
    """A force along a line through two points.

    With the line in global axes, its moment about a point of a link depends on where the link stands.

    Attributes
    ----------
    line : LoadLine
    """

    line: LoadLine

    def ends(self, place: Placement) -> tuple[Real, Real]:
        """Return the two points of the line.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        tuple of array (..., 3)
            Global axes; of a line without z, with z = 0 [mm].
        """
        start, end = (np.broadcast_to(vector3(at), (*place.shape, 3)) for at in (self.line.from_, self.line.to))
        if self.line.axes == "global":
            return start, end
        origin, turn = self._in_plane(place, self.line.link, place.origin(self.line.link)), place.axes(self.line.link)
        return origin + rotated(turn, start), origin + rotated(turn, end)

    def loads(self, place: Placement) -> tuple[PointLoad, ...]:
        """As ``Acting.loads``: the force on its link and, where it leaves by another, the opposite on that one."""
        line, (start, end) = self.line, self.ends(place)
        force = line.force * (end - start) / np.linalg.norm(end - start, axis=-1, keepdims=True)
        found = [self._over_lever(place, line.link, line.at, start, force)]
        if line.leaves is not None:
            found.append(self._over_lever(place, line.leaves.link, line.leaves.at, end, -force))
        return tuple(found)

    def _in_plane(self, place: Placement, link: str, at: NDArray[np.complex128]) -> Real:
        """Return a place in the mid-plane of a link (..., 3), at z = 0 for a line without z [mm]."""
        height = place.linkage.heights.get(link, 0.0) if len(self.line.to) == 3 else 0.0
        return np.asarray(vector(at) + np.array([0.0, 0.0, height]))

    def _over_lever(self, place: Placement, link: str, point: str, start: Real, force: Real) -> PointLoad:
        """Return a force at a place (..., 3) as a load at a point of a link."""
        arm = start - self._in_plane(place, link, place.position(link, point))
        wrench = shifted(np.concatenate([force, np.zeros(force.shape)], axis=-1), arm)
        return PointLoad(link=link, point=point, wrench=wrench, arm=arm)
