"""Dead points of n samples of a linkage, and poses next to them.

Next to a dead point of the coordinate, unknowns go with the square root of the coordinate, and Newton's iteration with
the coordinate held fails. The branch itself is smooth there: with s along it, the closure G(q) = 0 gives the tangent t
by J t = 0 and the curvature k by J k = -Q(t), where J is the Jacobian and Q the second derivative's quadratic part.
The coordinate's part of t vanishes at a dead point, where the coordinate is c(s) = c* + k_c s²/2: beyond c* there is no
assembly on that branch (Allgower & Georg, Introduction to Numerical Continuation Methods, 2003, chapters 2 and 8).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.continuation import DeadPointError, follow
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.pose_record import CLOSED, Pose

Real = NDArray[np.float64]

_ITERATIONS = 30
_LARGEST_STEP = 0.2
_TURNED = 1e-9
"""Largest part of the tangent along the coordinate at a dead point [rad, longest link]."""
_BEYOND = 1e-3
"""How far beyond a dead point the branch is asked to go, which it refuses [rad, longest link]."""
_SAME = 1e-5
"""Agreement of two ways to find a dead point [rad, longest link]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DeadPoints:
    """A dead point of the coordinate in each of n samples.

    Attributes
    ----------
    q : ndarray, shape (n, unknowns)
        Unknowns there [rad, mm].
    tangent, curvature : ndarray, shape (n, unknowns)
        Derivatives of the unknowns along the branch, by a length of which travels count in longest links.
    found : ndarray of bool, shape (n,)
    column : int
        Of the coordinate.
    """

    q: Real
    tangent: Real
    curvature: Real
    found: NDArray[np.bool_]
    column: int

    def short(self, wanted: Real) -> Real:
        """Return by how much the branches end before values of the coordinate.

        Parameters
        ----------
        wanted : ndarray, shape (n,)
            [rad, mm]

        Returns
        -------
        ndarray, shape (n,)
            [rad, mm]; not above zero for values that a branch reaches, NaN where no dead point was found.
        """
        off = -np.sign(self.curvature[:, self.column]) * (wanted - self.q[:, self.column])
        return np.where(self.found, off, np.nan)

    def beside(self, wanted: Real, side: Real) -> Real:
        """Return unknowns next to the dead points, to second order.

        Parameters
        ----------
        wanted : ndarray, shape (n,)
            Values of the coordinate that the branches reach [rad, mm].
        side : ndarray, shape (unknowns,)
            From a dead point into the part of the branch that is meant.

        Returns
        -------
        ndarray, shape (n, unknowns)
        """
        bend = self.curvature[:, self.column]
        with np.errstate(invalid="ignore", divide="ignore"):
            length = np.sqrt(np.maximum(2.0 * (wanted - self.q[:, self.column]) / bend, 0.0))
        length = np.where(np.isfinite(length), length, 0.0) * np.where(self.tangent @ side < 0.0, -1.0, 1.0)
        found = self.q + length[:, None] * self.tangent + 0.5 * length[:, None] ** 2 * self.curvature
        found[:, self.column] = wanted
        return np.asarray(found)


def dead_points(closure: LoopClosure, start: Real, column: int) -> DeadPoints:
    """Find dead points by Newton's iteration along the branches.

    Parameters
    ----------
    closure : LoopClosure
        Of n samples.
    start : ndarray, shape (n, unknowns)
        Unknowns not far from them.
    column : int
        Of the coordinate.

    Returns
    -------
    DeadPoints
    """
    scale, moving = closure.linkage.longest, len(closure.linkage.moving)
    sizes = np.where(np.arange(closure.unknowns) < moving, 1.0, scale)
    q, found = start.copy(), np.zeros(len(start), dtype=np.bool_)
    tangent = np.linalg.svd(closure.jacobian(q) * (sizes / scale))[2][:, -1] if len(start) else start.copy()

    def solved(right: Real, last: float) -> Real:
        """Solve with the Jacobian, and the tangent before as its last row."""
        J = np.concatenate([closure.jacobian(q) * (sizes / scale), tangent[:, None]], axis=1)
        right = np.concatenate([right / scale, np.full((len(q), 1), last)], axis=1)
        try:
            return np.asarray(np.linalg.solve(J, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            return np.full(q.shape, np.nan)

    for _ in range(_ITERATIONS):
        q = q - solved(closure.residual(q), 0.0) * sizes
        tangent = solved(np.zeros((len(q), closure.unknowns - 1)), 1.0)
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
        curvature = -solved(closure.quadratic(q, tangent * sizes), 0.0)
        gap = np.abs(closure.residual(q)).max(axis=-1, initial=0.0)
        found = (np.abs(tangent[:, column]) <= _TURNED) & (gap <= CLOSED * scale)
        if found.all():
            break
        with np.errstate(invalid="ignore", divide="ignore"):
            step = np.clip(-tangent[:, column] / curvature[:, column], -_LARGEST_STEP, _LARGEST_STEP)
        step = np.where(np.isfinite(step) & ~found, step, 0.0)[:, None]
        q = q + (step * tangent + 0.5 * step**2 * curvature) * sizes
    tangent, curvature = tangent * sizes, curvature * sizes
    return DeadPoints(q=q, tangent=tangent, curvature=curvature, found=found, column=column)


def own_dead_point(pose: Pose) -> Real | None:
    """Find the dead point that a pose's branch comes to, if Newton's iteration finds one.

    Parameters
    ----------
    pose : Pose
        With a coordinate.

    Returns
    -------
    ndarray, shape (unknowns,), or None
        The unknowns there; None also where following the branch does not come to the same place.
    """
    if pose.coordinate is None or pose.closure.jacobian(pose.q).shape[-2] != pose.closure.unknowns - 1:
        return None
    column = pose.held_column
    nearest = dead_points(pose.closure, pose.q[None], column)
    if not nearest.found[0]:
        return None
    driven = DrivenClosure(pose.closure, pose.coordinate)
    here, there = float(pose.q[column]), float(nearest.q[0, column])
    beyond = there - np.sign(nearest.curvature[0, column]) * _BEYOND * driven.size
    try:
        follow(driven, pose.q, min(here, beyond), max(here, beyond))
    except DeadPointError as error:
        return nearest.q[0] if abs(error.angle - there) <= _SAME * driven.size else None
    return None
