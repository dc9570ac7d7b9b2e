"""The force of a pin along z: a pressure on the flat face that it pushes on.

A pin pushes a link along z by its head, a washer or the neighbouring link, which bear on the flat face about the hole:
on the lower one where they push up. The wall of a hole has no shoulder; only friction could hold the force there, and
none is counted on that a case does not state. A hole without flat faces (through the walls of a tube) has no other
way: there it is even shear in the hole.
"""

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer, thrust_traction, wrench_density

Real = NDArray[np.float64]


class Thrust(LinearLoad):
    """The force of one pin along z, without a moment about the place where the pin stands, which travels in a slot.

    Its amounts are the force up, by how much the pin's travel shifts its moment about y, and both of the force down.
    """

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[str, PinLoad]:
        """As ``LinearLoad.places``: the pins."""
        return {pin.name: pin for pin in loads.pins}

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """As ``LinearLoad.amounts``: the forces [N] and moments [N mm] of the pin (4, n)."""
        found = np.zeros((4, loads.poses))
        for pin in (pin for pin in loads.pins if pin.name == self.place):
            up, down = (np.maximum(sign * pin.wrench[:, 2], 0.0) for sign in (1.0, -1.0))
            shift = pin.centre[:, 0] - self.sample.centre[0, 0]
            found += [up, -shift * up, down, shift * down]
        return found

    def unit(self, number: int) -> Real:
        """As ``LinearLoad.unit``: the load vector on the face that bears the force."""
        centre, flat = self.sample.centre[0], self.surfaces.space.flat_faces(self.place)
        face = self.surfaces.named(f"{('bottom', 'top')[number // 2]}:{self.place}" if flat else f"bore:{self.place}")
        wrench = np.eye(6)[4] if number % 2 else (1.0, -1.0)[number // 2] * np.eye(6)[2]
        if number % 2 or not flat:
            return self.surfaces.vector(face, wrench_density(face, centre, wrench))
        pin = PinLoad(name=self.place, centre=centre, diameter=self.sample.diameter, wrench=wrench)
        return self.surfaces.vector(face, thrust_traction(face, pin))
