"""Lateral-torsional buckling of a deep strip: bent in its stiff plane, it turns aside and twists.

With the twist φ along a strip under the moment M in its stiff plane, the moment about its weak axis is M φ, which bends
it by v'' = -M φ/(E I). Between points that are held aside, v follows from v'' by as many constants as there are points:
where these are two, or one that is built in, nothing hinders v'', and the energy is that of the twist alone,

    G J ∫φ'² dx = λ² ∫M²/(E I) φ² dx   with φ = 0 where the twist is held,

of which the least λ is the factor (derived in ``docs/theory/walls.md``). Under an even moment between
two such points λ M = π √(E I G J)/L, under a force at the end of a cantilever λ F = 4.013 √(E I G J)/L². Where points
also keep the slope v', v'' has no mean and no first moment between them, which takes the nearest straight line off M φ.
Loads act on the axis; the section does not warp.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from alula.fea.beam.piecewise import Piecewise

ELEMENTS = 48
"""Along the whole strip, at least; linear ones, 0.1 % too stiff where a half-wave spans 32."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)
POINTS, WEIGHTS = (_POINTS + 1.0) / 2.0, _WEIGHTS / 2.0
"""Exact for a moment of degree 3."""
ABOUT_Y, ABOUT_Z = 4, 5
"""Where the moments stand among internal forces."""
NOTHING = 1e-12
"""Share of the largest moment squared times length over ``stiffness`` below which no factor makes the strip buckle."""


def lateral_factor(
    forces: Piecewise, about: int, stiffness: float, held: Sequence[float], *, kept: bool = False
) -> float:
    """Return the factor on all loads at which a strip buckles sideways; infinite where none does.

    Parameters
    ----------
    forces : Piecewise
        Internal forces along it.
    about : int
        Which of them is the moment in its stiff plane.
    stiffness : float
        √(E I G J), I about the weak axis [N·mm²].
    held : sequence of float
        x where it is held aside and in its twist, at least one [mm].
    kept : bool, optional
        Whether its slope aside is held there as well.

    Returns
    -------
    float
    """
    breaks = np.unique([*forces.breaks, *held])
    share = (breaks[-1] - breaks[0]) / ELEMENTS
    pieces = [np.linspace(a, b, math.ceil((b - a) / share) + 1)[:-1] for a, b in itertools.pairwise(breaks)]
    nodes = np.append(np.concatenate(pieces), breaks[-1])
    sizes, count = np.diff(nodes), len(nodes)
    stations, weights = nodes[:-1, None] + sizes[:, None] * POINTS, sizes[:, None] * WEIGHTS
    moment = forces.along(stations)[..., about]
    turned = np.zeros((count, *stations.shape))  # M φ at the Gauss points, of a unit twist of each node
    for e in range(len(sizes)):
        turned[e, e], turned[e + 1, e] = (1.0 - POINTS) * moment[e], POINTS * moment[e]
    taken = np.einsum("ieg,jeg,eg->ij", turned, turned, weights)
    for a, b in itertools.pairwise(sorted(set(held))) if kept else ():
        between = weights * ((stations > a) & (stations < b))
        for line, size in (np.ones_like(stations), b - a), (stations - (a + b) / 2.0, (b - a) ** 3 / 12.0):
            part = np.einsum("ieg,eg->i", turned, between * line)
            taken -= np.outer(part, part) / size
    twist = np.diag(np.append(1.0 / sizes, 0.0) + np.append(0.0, 1.0 / sizes))
    twist -= np.diag(1.0 / sizes, 1) + np.diag(1.0 / sizes, -1)
    free = np.setdiff1d(np.arange(count), [int(np.argmin(np.abs(nodes - x))) for x in held])
    half = np.linalg.inv(np.linalg.cholesky(twist[np.ix_(free, free)]))
    largest = float(np.linalg.eigvalsh(half @ taken[np.ix_(free, free)] @ half.T)[-1])
    least = NOTHING * float(np.abs(moment).max() * (nodes[-1] - nodes[0])) ** 2
    return math.inf if largest <= least else stiffness / math.sqrt(largest)
