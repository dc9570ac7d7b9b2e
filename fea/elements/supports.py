"""Rigid-body motions: the isostatic supports that take them, and displacements less their part."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.mouth import Mouth, mouth_motion
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.geometry.base.errors import CannotRunError

SMALLEST_SINGULAR_VALUE = 1e-6
"""Of the scaled rigid-body motions at the six supports; at length over diameter 1000 a well-spread set has 1e-3."""

IN_PLANE, OUT_OF_PLANE = (0, 1, 5), (2, 3, 4)
"""Of ``rigid_motions``: those that are their own image in z = 0, and those that are minus their image."""


def rigid_motions(nodes: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return three unit translations and three unit rotations as nodal fields.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    point : ndarray, shape (3,)
        About which the rotations turn [mm].

    Returns
    -------
    ndarray, shape (6, n, 3)
        Nodal fields.
    """
    motions = np.zeros((6, len(nodes), 3))
    for i in range(3):
        motions[i, :, i] = 1.0
        motions[3 + i] = np.cross(np.eye(3)[i], nodes - point)
    return motions


def isostatic_supports(nodes: NDArray[np.float64], corners: int) -> NDArray[np.int64]:
    """Fix three components at one corner node, two at a second and one at a third, all far apart.

    The component left free at the second node is the one nearest to the line to the first; the one
    fixed at the third is nearest to the normal of the plane of the three.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    corners : int
        Number of corner nodes, which come first.

    Returns
    -------
    ndarray of int, shape (6,)
        The fixed unknowns.

    Raises
    ------
    CannotRunError
        If these supports leave a rigid-body motion free.
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


def half_supports(nodes: NDArray[np.float64], corners: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Fix what the plane z = 0 leaves free of a half body, at corner nodes far apart.

    With u_z = 0 on the plane, as under symmetric loads, the half can still move along it and turn about z; with
    u_x = u_y = 0, as under antisymmetric ones, it can move along z and turn about x and y.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    corners : int
        Number of corner nodes, which come first.

    Returns
    -------
    tuple of 2 ndarray of int, shape (3,)
        The fixed unknowns under symmetric and under antisymmetric loads.

    Raises
    ------
    CannotRunError
        If these supports leave a rigid-body motion free.
    """
    points = nodes[:corners, :2]
    first = int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))
    arm = points - points[first]
    second = int(np.argmax(np.linalg.norm(arm, axis=1)))
    across = arm @ np.array([-arm[second, 1], arm[second, 0]])
    third = int(np.argmax(np.abs(across)))
    turning = 3 * second + int(np.argmin(np.abs(arm[second])))
    along = np.array([3 * first, 3 * first + 1, turning])
    out = 3 * np.array([first, second, third]) + 2
    return checked_supports(nodes, along, IN_PLANE), checked_supports(nodes, out, OUT_OF_PLANE)


def checked_supports(
    nodes: NDArray[np.float64], unknowns: NDArray[np.int64], motions: Sequence[int] = range(6)
) -> NDArray[np.int64]:
    """Refuse supports that leave a rigid-body motion free.

    Rotations are scaled by the body's size, so that the singular values have no unit.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    unknowns : ndarray of int
        To be fixed.
    motions : sequence of int, optional
        Those of ``rigid_motions`` that are free without them.

    Returns
    -------
    ndarray of int
        The same unknowns.

    Raises
    ------
    CannotRunError
        Where they leave a rigid-body motion free.
    """
    centre = nodes.mean(axis=0)
    moved = rigid_motions(nodes, centre).reshape(6, -1)[:, unknowns]
    moved[3:] /= np.linalg.norm(np.ptp(nodes, axis=0)) / 2.0
    singular = np.linalg.svd(moved[list(motions)], compute_uv=False)
    margin = float(singular[-1]) if len(singular) == len(motions) else 0.0
    if margin < SMALLEST_SINGULAR_VALUE:
        raise CannotRunError(
            f"the supports leave a rigid-body motion free (smallest singular value {margin:.1e}, "
            f"least {SMALLEST_SINGULAR_VALUE:g}): the body is degenerate"
        )
    return unknowns


class LineReference:
    """Takes the rigid-body part out of displacements.

    Six conditions: the first hole does not move on average (3), the last one stays on the line through
    both (2), and both together do not turn about it on average (1). Where both are the same hole, that of the only
    joint, it neither moves nor turns on average (3 + 3). At the mouth of a clamp neither does its section.
    """

    def __init__(self, space: DisplacementSpace, line: tuple[str, str] | Mouth) -> None:
        self._mouth = line if isinstance(line, Mouth) else None
        if isinstance(line, Mouth):
            line = line.surface, line.surface
        self._first, self._last = (surface_quadrature(space, name) for name in line)
        self._alone = line[0] == line[1]
        span = np.array([1.0, 0.0, 0.0]) if self._alone else self._last.centroid - self._first.centroid
        if np.linalg.norm(span) == 0.0:
            raise CannotRunError(
                f"the surfaces {line[0]} and {line[1]} have the same centre: no line runs through them"
            )
        self._axis = span / np.linalg.norm(span)
        self._across = np.linalg.svd(self._axis[None, :])[2][1:]
        self._motions = rigid_motions(space.nodes, space.nodes.mean(axis=0))
        self._conditions = np.linalg.inv(np.array([self._values(motion) for motion in self._motions]).T)

    def _values(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        if self._mouth is not None:
            return mouth_motion(self._first, np.array(self._mouth.point), field)
        if self._alone:
            hole = self._first
            moved = np.einsum("qb,kbi->kqi", hole.phi, field[hole.nodes])
            turned = np.einsum("kq,kqi->i", hole.w, np.cross(hole.x - hole.centroid, moved))
            return np.array([*hole.mean(field), *turned])
        twist = 0.0
        for hole in (self._first, self._last):
            lever = np.cross(self._axis, hole.x - self._first.centroid)
            moved = np.einsum("qb,kbi->kqi", hole.phi, field[hole.nodes])
            twist += float(np.einsum("kq,kqi,kqi->", hole.w, lever, moved))
        return np.array([*self._first.mean(field), *(self._across @ self._last.mean(field)), twist])

    def relative(self, field: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the displacements less their rigid-body part.

        Parameters
        ----------
        field : ndarray, shape (n, 3)
            Displacements [mm].

        Returns
        -------
        ndarray, shape (n, 3)
            Displacements [mm].
        """
        return np.asarray(field - np.tensordot(self._conditions @ self._values(field), self._motions, axes=1))
