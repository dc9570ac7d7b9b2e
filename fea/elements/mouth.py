"""How the section at the mouth of a clamp moves: what displacements of a clamped link refer to.

A clamp holds its link's surface, and what holds the clamp is not known. As loads, its tractions bend the link within
the clamp as well, and how a real clamp shares the moment along its length no model tells. So the section at the mouth,
where the free length begins, stands for it: displacements are relative to that section, as those of a beam built in
there are.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.geometry.bodies.body import clamped_end, mouth
from alula.geometry.parts.part import Body

Real = NDArray[np.float64]
DEGREE = 4
"""Of the polynomials along the clamp. Measured on a tube held over one, two and four diameters: with 4, 5 and 6 the
displacement of its tip is the same within 0.1 %, and within 0.6 % that of a beam built in at the mouth; with 3 it is
1 % less at four diameters."""


@dataclass(frozen=True, kw_only=True)
class Mouth:
    """The mouth of a clamp on a link.

    Attributes
    ----------
    surface : str
        What the clamp holds, such as ``end:A``.
    point : tuple of 3 float
        On the link's axis at the mouth [mm].
    """

    surface: str
    point: tuple[float, float, float]


def reference_surfaces(body: Body) -> tuple[str, str] | Mouth:
    """Return what displacements of a link refer to.

    Parameters
    ----------
    body : Body
        Geometry of the link.

    Returns
    -------
    tuple of 2 str or Mouth
        The mouth of its first clamp; else the bores of its first and last pin, through which a line runs. Of a clamp
        on a part that is no beam, what it holds, as a whole.
    """
    end = clamped_end(body)
    if end is None:
        return f"bore:{body.pins[0].name}", f"bore:{body.pins[-1].name}"
    if not body.part.is_beam:
        return f"end:{end.name}", f"end:{end.name}"
    return Mouth(surface=f"end:{end.name}", point=(mouth(body, end), 0.0, 0.0))


def mouth_motion(surface: SurfaceQuadrature, point: Real, field: Real) -> Real:
    """Return how the section at the mouth of a clamp moves, from the displacements of what the clamp holds.

    Along the clamp, translation and rotation of the sections are polynomials of ``DEGREE`` in the distance from the
    mouth, nearest to the displacements in the mean square over the surface; these are their values at the mouth.

    Parameters
    ----------
    surface : SurfaceQuadrature
        What the clamp holds, along x.
    point : ndarray, shape (3,)
        On the link's axis at the mouth [mm].
    field : ndarray, shape (n, 3)
        Displacements of all nodes [mm].

    Returns
    -------
    ndarray, shape (6,)
        Displacement of the point [mm] and rotation of the section [rad].
    """
    arm = surface.x.reshape(-1, 3) - point
    size = float(np.abs(arm).max())
    x, y, z = arm.T / size
    nil, one = np.zeros_like(x), np.ones_like(x)
    sections = np.array(
        [[one, nil, nil], [nil, one, nil], [nil, nil, one], [nil, -z, y], [z, nil, nil], [-y, nil, nil]]
    )
    columns = np.concatenate([sections * x**power for power in range(DEGREE + 1)])
    roots = np.sqrt(surface.w.ravel())
    moved = np.einsum("qb,kbi->kqi", surface.phi, field[surface.nodes]).reshape(-1, 3)
    matrix = (columns * roots).transpose(2, 1, 0).reshape(-1, len(columns))
    found = np.linalg.lstsq(matrix, (moved * roots[:, None]).ravel(), rcond=None)[0][:6]
    found[3:] /= size
    return np.asarray(found)
