"""How fine a mesh is to be, and what it may cost."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True)
class MeshSettings:
    """Element sizes as ratios, so that a part at any scale gets the same mesh; and limits.

    Attributes
    ----------
    size : float
        General element edge as a fraction of the section's smaller size.
    bore_elements : int
        Element edges round a pin hole.
    hole_elements : int
        Element edges round each hole of a row.
    turn_elements : int
        Least number of element edges on a full turn of any other round surface.
    fillet_size : float
        Element edge along fillets as a fraction of the fillet radius (at sharp junctions of the general size).
    growth : float
        Growth of the element edge per distance from a hole or fillet.
    curved : bool
        Whether elements are quadratic and follow round surfaces (10 nodes), else straight (4 nodes).
    halves : bool
        Whether of a body that is symmetric about z = 0 the upper half is meshed and mirrored.
    size_points, size_values : ndarray, optional
        Points (n, 3) and the element edges there (n,), interpolated linearly between [mm]; they replace all sizes above
        but for ``turn_elements``.
    time_limit : float
        Wall time for one body [s].
    max_elements : int
        Largest number of tetrahedra that is accepted.
    memory_limit : float
        What the mesher may hold [bytes]; at most half of what the machine has, since two may run at once.
    """

    size: float = 0.25
    bore_elements: int = 16
    hole_elements: int = 8
    turn_elements: int = 8
    fillet_size: float = 0.8
    growth: float = 0.5
    curved: bool = True
    halves: bool = True
    size_points: NDArray[np.float64] | None = None
    size_values: NDArray[np.float64] | None = None
    time_limit: float = 300.0
    max_elements: int = 1_500_000
    memory_limit: float = 6e9

    def scaled(self, factor: float) -> "MeshSettings":
        """Return the same settings with all element edges longer; a turn keeps at least six.

        Parameters
        ----------
        factor : float
            By which edges grow.

        Returns
        -------
        MeshSettings
            The new settings.
        """
        values = self.size_values
        return replace(
            self,
            size_values=None if values is None else values * factor,
            size=self.size * factor,
            bore_elements=max(6, round(self.bore_elements / factor)),
            hole_elements=max(6, round(self.hole_elements / factor)),
            turn_elements=max(6, round(self.turn_elements / factor)),
            fillet_size=self.fillet_size * factor,
        )

    @property
    def chord_error(self) -> float:
        """Largest relative difference of area or volume between mesh and geometry that is accepted.

        With sides that span the angle θ of a circle, an inscribed polygon has θ²/6 less area than it; parabolas
        through the sides' ends and middles have about θ⁴/480 less. Half as much again is allowed for unequal
        straight sides, three times as much for curved ones, of which some are flattened.
        """
        turn = 2.0 * math.pi / min(self.bore_elements, self.hole_elements, self.turn_elements)
        return 1e-3 + (3.0 * turn**4 / 480.0 if self.curved else 1.5 * turn**2 / 6.0)


COARSE = MeshSettings(size=0.4, bore_elements=8, hole_elements=6, turn_elements=6, fillet_size=1.2, growth=1.0)
"""A few thousand elements per link: for tests and first looks, not for stresses at holes."""
