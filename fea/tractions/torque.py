"""The torques about a pin: of the drive, and of joints and loads that turn, through the eye's faces or its bore.

Friction is shear in the bore, however the other torques enter.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer, couple_traction

Real = NDArray[np.float64]


class Torque(LinearLoad):
    """The torques about one pin: its amounts are those in the bore and on the flat faces."""

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[str, Any]:
        """As ``LinearLoad.places``: the pins in bores, and those that the drive turns."""
        return {couple.pin: couple for couple in loads.couples} | {p.name: p for p in loads.pins if not p.slotted}

    def _torque(self, loads: LinkLoads) -> Real:
        """All torques (n,) about the pin but for friction [N mm]."""
        turning = [pin.torque for pin in loads.pins if pin.name == self.place and not pin.slotted]
        driven = [couple.torque for couple in loads.couples if couple.pin == self.place]
        return sum((*turning, *driven), np.zeros(loads.poses))

    def may_enter_otherwise(self, loads: LinkLoads) -> bool:
        """As ``SurfaceLoad.may_enter_otherwise``: whether a torque acts at a pin with flat faces."""
        return bool(self.surfaces.space.flat_faces(self.place)) and bool(self._torque(loads).any())

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """As ``LinearLoad.amounts``: the torques in the bore and on the faces (2, n) [N mm]."""
        rubbed = [pin.friction for pin in loads.pins if pin.name == self.place and not pin.slotted]
        by_faces = transfer != "bore-shear" and bool(self.surfaces.space.flat_faces(self.place))
        entering = np.outer([not by_faces, by_faces], self._torque(loads))
        return entering + np.outer([1.0, 0.0], sum(rubbed, np.zeros(loads.poses)))

    def unit(self, number: int) -> Real:
        """As ``LinearLoad.unit``: the load vector of a unit torque."""
        faces = self.surfaces.space.flat_faces(self.place)
        surface = self.surfaces.named(*faces if number else (f"bore:{self.place}",))
        centre = getattr(self.sample, "centre", surface.centroid).reshape(-1, 3)[0]
        return self.surfaces.vector(surface, couple_traction(surface, centre, 1.0))
