"""The surfaces and the volume of one link on its mesh, through which loads enter it; each is integrated once."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import Quadrature, SurfaceQuadrature, surface_quadrature, volume_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.fea.tractions.slot_traction import DEGREE

Real = NDArray[np.float64]


class Surfaces:
    """Quadratures of one link by the names of its surfaces.

    Parameters
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    density : float
        Of the material [tonne/mm³].
    """

    def __init__(self, space: DisplacementSpace, density: float) -> None:
        self.space = space
        self.density = density
        self._found: dict[tuple[tuple[str, ...], int], SurfaceQuadrature] = {}

    def named(self, *names: str, degree: int = 8) -> SurfaceQuadrature:
        """Return some surfaces together.

        Parameters
        ----------
        *names : str
        degree : int, optional
            Of the rule.

        Returns
        -------
        SurfaceQuadrature
        """
        if (names, degree) not in self._found:
            self._found[names, degree] = surface_quadrature(self.space, *names, degree=degree)
        return self._found[names, degree]

    def wall(self, pin: PinLoad) -> SurfaceQuadrature:
        """Return the wall of a pin's hole or slot.

        Parameters
        ----------
        pin : PinLoad

        Returns
        -------
        SurfaceQuadrature
        """
        return self.named(f"bore:{pin.name}", **({"degree": DEGREE} if pin.slotted else {}))

    @cached_property
    def volume(self) -> Quadrature:
        """The link's elements."""
        return volume_quadrature(self.space)

    def vector(self, quadrature: Quadrature, density: Real) -> Real:
        """Return the load vector of a force density.

        Parameters
        ----------
        quadrature : Quadrature
            Of some surfaces, or of elements.
        density : ndarray, shape (k, q, 3)
            [MPa, N/mm³]

        Returns
        -------
        ndarray, shape (3 nodes,)
            [N]
        """
        return quadrature.load_vector(density, len(self.space.nodes))
