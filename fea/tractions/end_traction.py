"""The wrench on a plain end, spread over its patch."""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import EndLoad, LinkLoads
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer, wrench_density

Real = NDArray[np.float64]


class EndTraction(LinearLoad):
    """The wrench on one end; virtual loads may want the components in the plane that no load has."""

    ALWAYS: ClassVar[tuple[int, ...]] = (0, 1, 5)

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[str, EndLoad]:
        """As ``LinearLoad.places``: the ends."""
        return {end.name: end for end in loads.ends}

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """As ``LinearLoad.amounts``: the components of the wrench (6, n) [N, N mm]."""
        return sum((end.wrench.T for end in loads.ends if end.name == self.place), np.zeros((6, loads.poses)))

    def unit(self, number: int) -> Real:
        """As ``LinearLoad.unit``: the load vector of a unit component."""
        patch = self.surfaces.named(f"end:{self.place}")
        return self.surfaces.vector(patch, wrench_density(patch, self.sample.point, np.eye(6)[number]))
