"""What a load case does to the layers of a printed link."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.refine.discretisation import Discretisation
from alula.fea.solid.layers import Layers


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerStress:
    """What a load case does to the layers of a link.

    Attributes
    ----------
    layers : Layers
        Their direction and strengths.
    safety_factor : Band
        Against parting of the layers; its lower end is 0 where their shear strength is not known.
    location : ndarray, shape (3,)
        Place of the largest stress on the layers in the link's frame [mm].
    tension : float
        Stress normal to the layers there, negative in compression [MPa].
    shear : float
        Along them [MPa].
    discretisation : Discretisation
        The error that the meshes leave.
    scan : ndarray or None
        Safety factor (POLAR, AZIMUTH) for the directions of building of ``alula.fea.solid.layers.build_directions``, by
        the same solution; None without a shear strength or without a safety factor.
    """

    layers: Layers
    safety_factor: Band
    location: NDArray[np.float64]
    tension: float
    shear: float
    discretisation: Discretisation
    scan: NDArray[np.float64] | None

    @property
    def peak(self) -> Reason:
        """Where the peak is and what acts there."""
        place = tuple(map(float, self.location))
        across, pulled = abs(self.tension), self.tension >= 0.0
        return reason("peak_of_layers", place=place, across=across, pulled=pulled, shear=self.shear)
