"""A force spread along a link between two stations."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer, line_density_between
from alula.loads.records.applied import LineLoad

Real = NDArray[np.float64]


class LineForce(LinearLoad):
    """What acts between two stations, of one load or many: intensities at the first, then at the last."""

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[tuple[float, float], LineLoad]:
        """As ``LinearLoad.places``: the stations."""
        return {(line.start, line.end): line for line in loads.lines}

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """As ``LinearLoad.amounts``: the intensities along x, y and z (6, n) [N/mm]."""
        own = [line for line in loads.lines if (line.start, line.end) == self.place]
        return sum((np.hstack([line.at_start, line.at_end]).T for line in own), np.zeros((6, loads.poses)))

    def unit(self, number: int) -> Real:
        """As ``LinearLoad.unit``: the load vector of a unit intensity."""
        (start, end), one, volume = self.place, np.eye(6)[number], self.surfaces.volume
        line = LineLoad(link="", start=start, end=end, at_start=one[:3], at_end=one[3:], axes="link")
        own, density = line_density_between(volume, line)
        return self.surfaces.vector(volume.only(own), density)
