"""The loop closure with one unknown driven: rates of all others by it, and Newton with it held."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.pose_record import CLOSED

Real = NDArray[np.float64]

_SETTLED = 1e-8
"""Newton's last step [rad]: the next one would be some 1e-16, since it converges quadratically."""
_RANK_TOLERANCE = 1e-12
"""Singular values of the scaled Jacobian below this share of the largest count as zero."""


@dataclass(frozen=True)
class DrivenClosure:
    """The loop closure with one coordinate prescribed.

    Attributes
    ----------
    closure : LoopClosure
        The loop closure.
    coordinate : Coordinate
        The driven angle or travel.
    """

    closure: LoopClosure
    coordinate: Coordinate

    @cached_property
    def column(self) -> int:
        """Column of the driven angle or travel among the unknowns."""
        return self.coordinate.column(self.closure)

    @property
    def size(self) -> float:
        """Size by which the driven unknown is measured: 1 rad, or the longest link [mm]."""
        return self.coordinate.measure.scale(self.closure.linkage)

    def told(self, value: float) -> str:
        """Return a driven angle or travel for people.

        Parameters
        ----------
        value : float
            Angle [rad] or travel [mm].

        Returns
        -------
        str
            The value with its unit, for people.
        """
        measure = self.coordinate.measure
        return f"{_plain(float(measure.told(value)))} {measure.unit}"

    @cached_property
    def _free(self) -> NDArray[np.intp]:
        return np.delete(np.arange(self.closure.unknowns), self.column)

    @cached_property
    def sizes(self) -> Real:
        """Size (unknowns,) by which each unknown is measured: 1 rad, or the longest link for travels [mm]."""
        moving = len(self.closure.linkage.moving)
        sizes = np.ones(self.closure.unknowns)
        sizes[moving:] = self.closure.linkage.longest
        return sizes

    def jacobian(self, q: Real) -> Real:
        """Jacobian (..., equations, unknowns) without dimensions.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            Matrices (..., equations, unknowns).
        """
        return np.asarray(self.closure.jacobian(q) * (self.sizes / self.closure.linkage.longest))

    def gaps(self, q: Real) -> Real:
        """Closure residual (..., equations) as a share of the longest link.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            Residuals (..., equations).
        """
        return np.asarray(self.closure.residual(q) / self.closure.linkage.longest)

    def _solve(self, matrix: Real, rhs: Real) -> Real:
        """Rates or steps (..., unknowns) of all unknowns, the driven one's zero."""
        held = matrix[..., self._free]
        if held.shape[-1] == held.shape[-2]:
            found = np.linalg.solve(held, rhs[..., None])[..., 0]
        else:  # more equations than unknowns, but not independent: a redundant linkage that moves
            found = (np.linalg.pinv(held, rcond=_RANK_TOLERANCE) @ rhs[..., None])[..., 0]
        out = np.zeros((*rhs.shape[:-1], self.closure.unknowns))
        out[..., self._free] = found * self.sizes[self._free]
        return out

    def coefficients(self, q: Real) -> tuple[Real, Real]:
        """First and second derivatives (..., unknowns) of all unknowns by the driven angle.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        tuple of ndarray
            First and second derivatives (..., unknowns).

        Raises
        ------
        numpy.linalg.LinAlgError
            Exactly at a dead point.
        """
        matrix = self.jacobian(q)
        first = self._solve(matrix, -matrix[..., self.column]) / self.size
        first[..., self.column] = 1.0
        quadratic = self.closure.quadratic(q, first) / self.closure.linkage.longest
        return first, self._solve(matrix, -quadratic)

    def correct(self, q: Real, iterations: int = 8) -> tuple[Real, bool]:
        """Newton from ``q`` (..., unknowns) with the driven angle held; also tell whether all poses settled.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        iterations : int
            Largest number of steps.

        Returns
        -------
        tuple
            The unknowns (..., unknowns), and whether all poses closed.
        """
        for _ in range(iterations):
            step = self._solve(self.jacobian(q), -self.gaps(q))
            q = q + step
            size = float(np.max(np.abs(step / self.sizes), initial=0.0))
            if not size < 1.0:
                return q, False
            if size <= _SETTLED:
                return q, bool(np.max(np.abs(self.gaps(q)), initial=0.0) <= CLOSED)
        return q, False

    def complement(self, q: Real) -> Real:
        """Orthonormal directions (equations, n) that no motion of the free unknowns reaches.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].

        Returns
        -------
        ndarray
            Directions (equations, n).
        """
        held = self.jacobian(q)[..., self._free]
        if held.shape[0] <= held.shape[1]:
            return np.zeros((held.shape[0], 0))
        left, _, _ = np.linalg.svd(held)
        return np.asarray(left[:, held.shape[1] :])

    def orientation(self, q: Real, complement: Real) -> float:
        """Sign of the determinant of the free columns, squared up by ``complement`` where equations are redundant.

        Parameters
        ----------
        q : ndarray
            Unknowns (..., unknowns): angles of the moving links [rad], travels in the slots [mm].
        complement : ndarray
            Directions by ``complement`` of a pose nearby.

        Returns
        -------
        float
            1, -1 or 0.
        """
        held = np.hstack([self.jacobian(q)[..., self._free], complement])
        return float(np.sign(np.linalg.det(held)))


def _plain(value: float) -> str:
    return f"{round(value, 6) + 0.0:.6f}".rstrip("0").rstrip(".")
