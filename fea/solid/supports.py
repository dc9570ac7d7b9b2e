"""The 3-2-1 support that holds a free body without straining it, and the rigid-body motions."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CannotRunError

SMALLEST_SINGULAR_VALUE = 1e-6
"""Of the scaled rigid-body motions at the six supports; at length over diameter 1000 a well-spread set has 1e-3."""


def rigid_motions(nodes: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Three unit translations and three unit rotations about ``point`` as nodal fields (6, n, 3)."""
    motions = np.zeros((6, len(nodes), 3))
    for i in range(3):
        motions[i, :, i] = 1.0
        motions[3 + i] = np.cross(np.eye(3)[i], nodes - point)
    return motions


@dataclass(frozen=True, kw_only=True, eq=False)
class Supports:
    """Six fixed unknowns and the smallest singular value of the scaled rigid-body motions there."""

    unknowns: NDArray[np.int64]
    rank_margin: float


def isostatic_supports(nodes: NDArray[np.float64], corners: int) -> Supports:
    """Fix three components at one corner node, two at a second and one at a third, all far apart.

    The component left free at the second node is the one nearest to the line to the first; the one
    fixed at the third is nearest to the normal of the plane of the three.

    Raises ``CannotRunError`` if these supports leave a rigid-body motion free.
    """
    points = nodes[:corners]
    first = int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))
    arm = points - points[first]
    second = int(np.argmax(np.linalg.norm(arm, axis=1)))
    axis = arm[second] / np.linalg.norm(arm[second])
    across = arm - np.outer(arm @ axis, axis)
    third = int(np.argmax(np.linalg.norm(across, axis=1)))
    normal = np.cross(axis, across[third])
    free = int(np.argmax(np.abs(axis)))
    fixed = [3 * first, 3 * first + 1, 3 * first + 2]
    fixed += [3 * second + i for i in range(3) if i != free]
    # With the axis near x, y or z, a normal near that same axis cannot occur: it is normal to it.
    fixed.append(3 * third + int(np.argmax(np.abs(normal))))
    return checked_supports(nodes, np.array(fixed))


def checked_supports(nodes: NDArray[np.float64], unknowns: NDArray[np.int64]) -> Supports:
    """Return the supports, or raise ``CannotRunError`` if they leave a rigid-body motion free.

    Rotations are scaled by the body's size, so that the singular values have no unit.
    """
    centre = nodes.mean(axis=0)
    motions = rigid_motions(nodes, centre).reshape(6, -1)[:, unknowns]
    motions[3:] /= np.linalg.norm(np.ptp(nodes, axis=0)) / 2.0
    singular = np.linalg.svd(motions, compute_uv=False)
    margin = float(singular[5]) if len(singular) == 6 else 0.0
    if margin < SMALLEST_SINGULAR_VALUE:
        raise CannotRunError(
            f"the supports leave a rigid-body motion free (smallest singular value {margin:.1e}, "
            f"least {SMALLEST_SINGULAR_VALUE:g}): the body is degenerate"
        )
    return Supports(unknowns=unknowns, rank_margin=margin)
