"""Surfaces of a solid that move as rigid bodies: the reduction of all displacements to those of the rest and to theirs.

Every region has six unknowns in place of its nodes': orthogonal sums of the displacement t of its place and of its
rotation w times the region's size, of which the first are those that are held. A node at r from the place moves by
u = t + w × r.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]
SAME = 1e-6
"""Share of what is held below which it is held already."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidRegion:
    """Nodes that move as one rigid body, and the masses that it bears.

    Attributes
    ----------
    name : str
        For messages.
    nodes : ndarray of int
        Their numbers.
    place : ndarray, shape (3,)
        Whose displacement is unknown [mm].
    held : ndarray, shape (k, 6)
        Sums of the place's displacement and rotation, by rows, that are zero.
    inertia : ndarray, shape (6, 6)
        Mass matrix of what it carries, about the place and in global axes [tonne, tonne mm, tonne mm²].
    """

    name: str
    nodes: NDArray[np.int64]
    place: Real
    held: Real
    inertia: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class Reduction:
    """All displacements from the unknowns q, u = T q.

    Attributes
    ----------
    matrix : csr_array, shape (3 n, m)
        T; m is a multiple of 3.
    held : ndarray of int
        Unknowns that are zero.
    inertia : csr_array, shape (m, m)
        Mass matrix of what the regions carry.
    motions : tuple of ndarray, shape (6, 6)
        Of each region: from its unknowns to displacement and rotation of its place, in global axes.
    first : tuple of int
        Of each region: number of its first unknown.
    """

    matrix: Any
    held: NDArray[np.int64]
    inertia: Any
    motions: tuple[Real, ...]
    first: tuple[int, ...]


def reduced(nodes: Real, regions: Sequence[RigidRegion]) -> Reduction:
    """Return the reduction of a body whose regions are rigid.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Of the body [mm].
    regions : sequence of RigidRegion
        Without common nodes.

    Returns
    -------
    Reduction

    Raises
    ------
    CannotRunError
        Where two regions have a node in common.
    """
    from scipy.sparse import coo_array, csr_array

    owner = np.full(len(nodes), -1)
    for number, region in enumerate(regions):
        if (taken := owner[region.nodes].max(initial=-1)) >= 0:
            raise CannotRunError(
                f"{regions[taken].name} and {region.name} touch, so that they cannot be held apart from each other; "
                "move them apart"
            )
        owner[region.nodes] = number
    free = np.flatnonzero(owner < 0)
    size = 3 * (len(free) + 2 * len(regions))
    same = (3 * free[:, None] + np.arange(3)).ravel()
    rows, columns, values = [same], [np.arange(len(same))], [np.ones(len(same))]
    held: list[int] = []
    motions, firsts = [], []
    inertia = np.zeros((6 * len(regions), 6 * len(regions)))
    for number, region in enumerate(regions):
        first = len(same) + 6 * number
        arm = nodes[region.nodes] - region.place
        reach = float(np.linalg.norm(arm, axis=1).max())
        unit = np.array([1.0, 1.0, 1.0, *[1.0 / reach] * 3])
        axes, fixed = _axes(region.held * unit)
        motion = unit[:, None] * axes.T
        carried = np.concatenate(
            [np.broadcast_to(np.eye(3), (len(arm), 3, 3)), np.cross(np.eye(3), arm[:, None])], axis=1
        )
        moved = np.einsum("cj,kci->kji", motion, carried)  # displacement of each node (k, 6, 3) by each unknown
        rows.append((3 * region.nodes[:, None, None] + np.arange(3) + np.zeros((6, 1), dtype=int)).ravel())
        columns.append(np.broadcast_to(first + np.arange(6)[:, None], moved.shape).ravel())
        values.append(moved.ravel())
        held += range(first, first + fixed)
        motions.append(motion)
        firsts.append(first)
        inertia[6 * number : 6 * number + 6, 6 * number : 6 * number + 6] = motion.T @ region.inertia @ motion
    matrix = coo_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (3 * len(nodes), size)
    )
    i, j = np.nonzero(inertia)
    return Reduction(
        matrix=matrix.tocsr(),
        held=np.array(held, dtype=np.int64),
        inertia=csr_array((inertia[i, j], (i + len(same), j + len(same))), shape=(size, size)),
        motions=tuple(motions),
        first=tuple(firsts),
    )


def _axes(held: Real) -> tuple[Real, int]:
    """Orthogonal unit vectors (6, 6), by rows, of which the first span what is held, and how many these are."""
    if not len(held):
        return np.eye(6), 0
    _, sizes, axes = np.linalg.svd(held)
    return axes, int(np.count_nonzero(sizes > SAME * sizes[0]))
