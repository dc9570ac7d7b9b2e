"""The equations of equilibrium [A][R] = [b] of a linkage, with their names, scales and solution."""

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage

Real = NDArray[np.float64]

ROUNDING = 1e-13
"""Share of the largest force below which a value is rounding."""


@dataclass(frozen=True, kw_only=True)
class System:
    """The equilibrium equations [A][R] = [b], with a name for every row and column.

    Attributes
    ----------
    matrix : array (..., 3 links, unknowns)
        Force rows in N, moment rows in N mm.
    rhs : array (..., 3 links)
        The applied loads with opposite sign.
    rows : tuple of (link, "Fx" | "Fy" | "Mz")
        Names of the rows.
    columns : tuple of str
        Names of the unknowns: RAx, RAy, ..., T.
    scale : float
        Length by which moments are divided before singular values are taken [mm].
    """

    matrix: Real
    rhs: Real
    rows: tuple[tuple[str, str], ...]
    columns: tuple[str, ...]
    scale: float

    @cached_property
    def row_scale(self) -> Real:
        """Divisors (rows,) of the equations: 1 for forces, ``scale`` for moments."""
        return np.array([self.scale if kind == "Mz" else 1.0 for _, kind in self.rows])

    @cached_property
    def column_scale(self) -> Real:
        """Factors (unknowns,) from the unknowns of the scaled system to those in N and N mm."""
        return np.array([self.scale if name == "T" or name.startswith("M:") else 1.0 for name in self.columns])

    @cached_property
    def scaled(self) -> Real:
        """The matrix without dimensions: moments and the torque divided by ``scale``."""
        return np.asarray(self.matrix * (self.column_scale / self.row_scale[:, None]))

    @cached_property
    def singular_values(self) -> Real:
        """Singular values (..., unknowns) of the scaled matrix, falling."""
        return np.asarray(np.linalg.svd(self.scaled, compute_uv=False), dtype=float)

    def regular(self, least: float) -> NDArray[np.bool_]:
        """Tell which states have a smallest singular value of at least a number.

        The Frobenius norm of the inverse is no less than 1 over it. Singular values are calculated where that does not
        tell.

        Parameters
        ----------
        least : float

        Returns
        -------
        bool array (...)
        """
        found = np.zeros(self.matrix.shape[:-2], dtype=np.bool_)
        with suppress(np.linalg.LinAlgError):  # not square, or one is singular to the last digit
            found = np.asarray(np.linalg.norm(np.linalg.inv(self.scaled), axis=(-2, -1)) * 2.0 * least <= 1.0)
        if not found.all():
            found[~found] = np.linalg.svd(self.scaled[~found], compute_uv=False)[..., -1] >= least
        return found

    @property
    def condition(self) -> float:
        """Condition number of the scaled matrix (2-norm)."""
        smallest = float(self.singular_values[-1])
        return float(self.singular_values[0]) / smallest if smallest > 0.0 else math.inf

    def solved(self, sound: NDArray[np.bool_]) -> tuple[Real, Real]:
        """Solve the equations of the states that have a solution.

        An unknown below ``ROUNDING`` of the largest is set to zero, since as a load on a link it would not balance.

        Parameters
        ----------
        sound : bool array (...)
            Which states these are; numbers of the others are NaN.

        Returns
        -------
        unknowns : array (..., unknowns)
            In N and N mm.
        residual : array (...)
            The largest of the scaled equations, as a share of the load.
        """
        right = self.rhs / self.row_scale
        matrix = self.scaled if sound.all() else np.where(sound[..., None, None], self.scaled, np.eye(right.shape[-1]))
        unknowns = np.where(sound[..., None], np.linalg.solve(matrix, right[..., None])[..., 0], np.nan)
        largest = np.abs(unknowns).max(axis=-1, keepdims=True, initial=0.0)
        unknowns = np.where(np.abs(unknowns) <= ROUNDING * largest, 0.0, unknowns)
        left = (matrix @ unknowns[..., None])[..., 0] - right
        size = np.maximum(np.abs(right).max(axis=-1, initial=0.0), 1e-300)
        return unknowns * self.column_scale, np.abs(left).max(axis=-1) / size


def require_determinate(linkage: Linkage, system: System) -> None:
    """Require as many equations as unknowns.

    Parameters
    ----------
    linkage : Linkage
    system : System
        Its equations.

    Raises
    ------
    CaseError
        Where equilibrium alone does not give the joint forces.
    """
    rows, columns = system.matrix.shape[-2:]
    if rows != columns:
        raise CaseError(
            f"drive: statics has {rows} equilibrium equations for {columns} unknowns, so joint forces do not follow "
            "from equilibrium; remove redundant joints or links, or drive as many links as the linkage has degrees of "
            f"freedom (mobility {linkage.mobility})"
        )
