"""How pins may move on from where they stand in their holes: the tangent of their state.

With a rim's force R n on the pin's centre at the distance r from the middle of its disc, the Lagrangian of the state
(``alula.fea.pins.programme``) has the second derivative R/r beside that of the frame. So a rim that touches is closed
along its normal n, and holds the pin across it by R/r, as weight holds a ball in a bowl. A rim that does not touch
holds nothing, and a hole without clearance all.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

NO_FORCE = 1e-6
"""Force at a rim, over the largest, below which it does not touch: the programme leaves some 1e-9 of it."""
TIGHT = 1e-9
"""Radius of a disc below which the hole is tight [mm]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RimTangent:
    """The motions that the rims of h holes leave to their pins.

    Attributes
    ----------
    v : ndarray, shape (4 h,)
        Where pins stand [mm].
    ways : ndarray, shape (4 h, k)
        The k independent motions, each of one rim.
    stiffness : ndarray, shape (k,)
        Of each by the forces at rims [N/mm]; it grows with the load.
    touching : int
        How many rims touch.
    force : float
        The largest at a rim [N].
    """

    v: Real
    ways: Real
    stiffness: Real
    touching: int
    force: float


def tangent_of(radii: Real, v: Real, forces: Real) -> RimTangent:
    """Return how pins may move on from a state.

    Parameters
    ----------
    radii : ndarray, shape (2 h,)
        Of the rims' discs [mm].
    v : ndarray, shape (4 h,)
        Where pins stand [mm].
    forces : ndarray, shape (4 h,)
        At the rims [N].

    Returns
    -------
    RimTangent
    """
    sizes = np.linalg.norm(forces.reshape(-1, 2), axis=1)
    largest = float(sizes.max(initial=0.0))
    ways, stiffness, touching = [], [], 0
    for k, (radius, size) in enumerate(zip(radii, sizes, strict=True)):
        if radius < TIGHT:
            continue
        turns = size > NO_FORCE * largest
        touching += int(turns)
        x, y = v[2 * k : 2 * k + 2] / np.linalg.norm(v[2 * k : 2 * k + 2]) if turns else (0.0, 1.0)
        for way in ((-y, x), (x, y))[: 1 if turns else 2]:
            ways.append(np.zeros(len(v)))
            ways[-1][2 * k : 2 * k + 2] = way
            stiffness.append(size / radius if turns else 0.0)
    return RimTangent(
        v=v,
        ways=np.array(ways).reshape(-1, len(v)).T,
        stiffness=np.array(stiffness),
        touching=touching,
        force=largest,
    )
