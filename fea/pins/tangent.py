"""How pins may move on from where they stand in their holes: the tangent of their state.

With a rim's force R n on the pin's centre at the distance r from the middle of its disc, the Lagrangian of the state
(``alula.fea.pins.programme``) has the second derivative R/r beside that of the frame. So a rim that touches is closed
along its normal n, and holds the pin across it by R/r, as weight holds a ball in a bowl. A rim that does not touch
holds nothing, and a hole without clearance all. Heads that touch hold the difference of the pin's places at both rims
in the same way, within what the rims leave.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.pins.programme import NO_TIES

Real = NDArray[np.float64]

NO_FORCE = 1e-6
"""Force at a rim, over the largest, below which it does not touch: the programme leaves some 1e-9 of it."""
TIGHT = 1e-9
"""Radius of a disc below which the hole is tight [mm]."""
TOUCHES = 1e-6
"""Share of its radius by which a place may be inside a disc that it touches, of holes between heads."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RimTangent:
    """The motions that the rims of h holes leave to their pins.

    Attributes
    ----------
    v : ndarray, shape (4 h,)
        Where pins stand [mm].
    ways : ndarray, shape (4 h, k)
        The k independent motions, each of one rim, or of one hole that heads hold.
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


def tangent_of(radii: Real, v: Real, forces: Real, ties: NDArray[np.int64] = NO_TIES) -> RimTangent:
    """Return how pins may move on from a state.

    Parameters
    ----------
    radii : ndarray, shape (2 h + f,)
        Of the rims' discs, then of those of ``ties`` [mm].
    v : ndarray, shape (4 h,)
        Where pins stand [mm].
    forces : ndarray, shape (4 h,)
        At the rims, with what heads bear as opposite forces at both [N].
    ties : ndarray of int, shape (f, 2), optional
        The rims of each hole that heads hold.

    Returns
    -------
    RimTangent
    """
    rims, apart = radii[: len(v) // 2], radii[len(v) // 2 :]
    forces, held = forces.reshape(-1, 2).copy(), np.zeros(len(ties))
    for k, (low, high) in enumerate(ties):
        held[k] = _of_heads(rims[[low, high]], apart[k], v.reshape(-1, 2)[[low, high]], forces[[low, high]])
        between = held[k] * _along(v.reshape(-1, 2)[high] - v.reshape(-1, 2)[low])
        if apart[k] < TIGHT:  # both rims are one, and heads bear any couple
            between = (forces[high] - forces[low]) / 2.0
        forces[low], forces[high] = forces[low] + between, forces[high] - between
    sizes, out = np.linalg.norm(forces, axis=1), np.linalg.norm(v.reshape(-1, 2), axis=1)
    largest = float(sizes.max(initial=0.0))
    ways, stiffness, touching = [], [], 0
    for k, (radius, size) in enumerate(zip(rims, sizes, strict=True)):
        if radius < TIGHT:
            continue
        turns = size > NO_FORCE * largest and out[k] > 0.0  # in the middle of its hole a pin touches nothing
        touching += int(turns)
        x, y = v[2 * k : 2 * k + 2] / out[k] if turns else (0.0, 1.0)
        for way in ((-y, x), (x, y))[: 1 if turns else 2]:
            ways.append(np.zeros(len(v)))
            ways[-1][2 * k : 2 * k + 2] = way
            stiffness.append(size / radius if turns else 0.0)
    found, stiff = np.array(ways).reshape(-1, len(v)).T, np.array(stiffness)
    for (low, high), radius, force in zip(ties, apart, held, strict=True):
        if force > NO_FORCE * largest or radius < TIGHT:
            found, stiff = _between_heads(found, stiff, v, (int(low), int(high)), radius, force)
    return RimTangent(
        v=v,
        ways=found,
        stiffness=stiff,
        touching=touching,
        force=largest,
    )


def _along(vector: Real) -> Real:
    size = float(np.linalg.norm(vector))
    return vector / size if size > 0.0 else np.zeros_like(vector)


def _of_heads(radii: Real, apart: float, v: Real, forces: Real) -> float:
    """Force by which heads hold the places at both rims (2, 2) together, of forces (2, 2) with those of the rims."""
    if np.linalg.norm(v[1] - v[0]) < (1.0 - TOUCHES) * apart or apart < TIGHT:
        return 0.0
    normals = [np.concatenate([-_along(v[1] - v[0]), _along(v[1] - v[0])])]
    for rim in (0, 1):
        if np.linalg.norm(v[rim]) >= (1.0 - TOUCHES) * radii[rim]:
            normals.append(np.zeros(4))
            normals[-1][2 * rim : 2 * rim + 2] = _along(v[rim])
    return max(0.0, float(np.linalg.lstsq(np.array(normals).T, forces.ravel(), rcond=None)[0][0]))


def _between_heads(
    ways: Real, stiffness: Real, v: Real, rims: tuple[int, int], radius: float, force: float
) -> tuple[Real, Real]:
    """Motions (4 h, k) and their stiffness with heads that touch a link, from those that its rims leave."""
    own = np.abs(ways.reshape(-1, 2, ways.shape[1])[list(rims)]).sum(axis=(0, 1)) > 0.0
    pairs = ways[:, own].reshape(-1, 2, int(own.sum()))
    moved = pairs[rims[1]] - pairs[rims[0]]  # of the difference, by each motion
    normal = _along(v.reshape(-1, 2)[rims[1]] - v.reshape(-1, 2)[rims[0]])
    closed = moved if radius < TIGHT else normal[None] @ moved
    _, sizes, rows = np.linalg.svd(closed)
    left = rows[int((sizes > TOUCHES).sum()) :].T
    held = np.diag(stiffness[own]) + (0.0 if radius < TIGHT else force / radius) * moved.T @ moved
    values, turned = np.linalg.eigh(left.T @ held @ left)
    return np.hstack([ways[:, ~own], ways[:, own] @ left @ turned]), np.concatenate([stiffness[~own], values])
