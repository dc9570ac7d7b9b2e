"""How many tetrahedra a body will get, from its areas, its volume and the element sizes: told before it is meshed.

Runs in a child process only (see ``alula.geometry.meshing.mesh``).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.meshing.mesh_target import MeshTarget

Sizes = Callable[[NDArray[np.float64]], NDArray[np.float64]]
"""Element sizes (n,) at points (n, 3), in scaled units."""
PER_SIZE = 3.6
"""Tetrahedra per area over squared size, and per volume over cubed size.

Of 28 meshes of tubes and bars, from 2,200 to 238,000 tetrahedra, thin and thick, long and short, even and graded, the
estimate is 0.77 to 1.33 times the count.
"""
SAFETY = 1.5
"""Factor by which the estimate may be wrong: only beyond it is a body refused."""
_SAMPLES = 64
"""Of each face; the estimate is within 4 % of that by 1000."""
# Low-discrepancy points of the unit square (M. Roberts' R2 sequence: powers of the plastic number's inverse).
_SQUARE = np.modf(np.arange(1, _SAMPLES + 1)[:, None] * np.array([0.7548776662466927, 0.5698402909980532]))[0]


def estimated_elements(gmsh: Any, target: MeshTarget, sizes: Sizes, turn_elements: int) -> float:
    """Estimate the number of tetrahedra of a whole body.

    It is ``PER_SIZE`` (∫dA/h² + ∫dV/h³), h the size at each point, on surfaces at most what their curvature allows.
    Sizes inside are those at a quarter and three quarters of the depth V/A from the surface, on the coarser side of it:
    that needs no test of what lies inside, which takes the kernel a tenth of a second for each point.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    target : MeshTarget
        What will be meshed.
    sizes : callable
        Element sizes at points.
    turn_elements : int
        Least number of element edges on a full turn of a round surface.

    Returns
    -------
    float
        The estimate, right within a factor of ``SAFETY``.
    """
    depth = target.volume / sum(target.areas.values())
    total = 0.0
    for face, area in target.areas.items():
        low, high = (np.array(bound) for bound in gmsh.model.getParametrizationBounds(2, face))
        place = (low + _SQUARE * (high - low)).ravel()
        points = np.array(gmsh.model.getValue(2, face, place)).reshape(-1, 3)
        tangents = np.array(gmsh.model.getDerivative(2, face, place)).reshape(-1, 2, 3)
        normals = np.cross(tangents[:, 0], tangents[:, 1])
        # Also points that holes have cut away from the face: the share of the whole is corrected, not their place.
        patch = np.linalg.norm(normals, axis=1)
        normals /= np.where(patch > 0.0, patch, 1.0)[:, None]
        curvature = np.abs(gmsh.model.getCurvature(2, face, place))
        arc = 2.0 * math.pi / (turn_elements * np.maximum(curvature, 1e-12))
        density = np.minimum(sizes(points), arc) ** -2.0
        for share in (0.25, 0.75):
            step = share * depth * normals
            density += depth / 2.0 * np.maximum(sizes(points + step), sizes(points - step)) ** -3.0
        total += area * float(np.average(density, weights=patch))
    return PER_SIZE * total * (2.0 if target.half else 1.0)
