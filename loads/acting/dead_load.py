"""A load that is stated as it is, whatever the place: forces, moments, pressures, spread loads, stated air."""

from dataclasses import dataclass

from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import LineLoad, Load, PointLoad, at_poses


@dataclass(frozen=True)
class DeadLoad(Acting):
    """A load of constant components, in global axes or in those of its link, with which it turns.

    Attributes
    ----------
    load : PointLoad or LineLoad
        At one pose.
    """

    load: PointLoad | LineLoad

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: the load at every pose."""
        return (at_poses(self.load, place.shape),)
