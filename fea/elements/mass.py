"""The consistent mass matrix of a link: inertia as the same functions see it that displacements are made of."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.elements.quadrature import Quadrature

_CHUNK = 4096  # elements at a time


def consistent_mass(volume: Quadrature, density: float | NDArray[np.float64], count: int) -> Any:
    """Return the consistent mass matrix of one displacement component, ∫ ρ φa φb dV; it is the same for x, y and z.

    Parameters
    ----------
    volume : Quadrature
        Of the elements; its rule must be exact for products of two basis functions (degree 4 on straight ones).
    density : float or ndarray, shape (k, q)
        ρ, everywhere or at the points of the quadrature [tonne/mm³].
    count : int
        Number of nodes n.

    Returns
    -------
    csr_array, shape (n, n)
        The matrix [tonne]; symmetric.

    Raises
    ------
    CannotRunError
        Where it does not fit into memory.

    References
    ----------
    Zienkiewicz, Taylor & Zhu, The Finite Element Method, 6th ed., vol. 1, section 16.2.1.
    """
    from scipy.sparse import csr_array

    elements, b = volume.nodes.shape
    memory.require(32.0 * elements * b * b, f"the mass matrix of {3 * count:,} unknowns", None)
    weight = volume.w * density
    pairs = (volume.phi[:, :, None] * volume.phi[:, None, :]).reshape(len(volume.phi), b * b)
    values = np.concatenate([weight[i : i + _CHUNK] @ pairs for i in range(0, elements, _CHUNK)])
    row, column = np.repeat(volume.nodes, b, axis=1).ravel(), np.tile(volume.nodes, (1, b)).ravel()
    return csr_array((values.ravel(), (row, column)), shape=(count, count))
