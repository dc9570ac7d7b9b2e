"""Factorised equations of frames: one factorisation for all frames that differ in their loads alone.

So do a frame and those of unit loads, the ways in which pins tilt, a pose under several load cases and, as friction
goes in turns with joint forces, the turns of a pose (``alula.fea.frame.linear``).
"""

from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.model import FrameModel
from alula.fea.frame.system import FrameSystem, natural_deformations, refuse_mechanism

Floats = NDArray[np.float64]

KNOWN = 128
"""Factorised frames that are kept: more than poses of a motion whose frames are solved in turns."""


class _Stiffness:
    """All of a frame that its matrices depend on, by value: frames that differ in their loads are equal."""

    def __init__(self, model: FrameModel) -> None:
        self.model = model
        arrays = [model.nodes, *(array for e in model.elements for array in (e.z_axis, e.offsets))]
        arrays += [array for guide in model.guides for array in (guide.normal, guide.axis) if array is not None]
        arrays += [array for link in model.condensed for array in (link.places, link.flexibility)]
        self._key = (
            tuple(array.tobytes() for array in arrays),
            tuple((e.nodes, e.section, e.young, e.poisson, e.rigid) for e in model.elements),
            (model.supports, model.ties, model.size),
            tuple((guide.carrier, guide.pin, guide.axis is None) for guide in model.guides),
            tuple(link.nodes for link in model.condensed),
        )

    def __hash__(self) -> int:
        return hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Stiffness) and self._key == other._key


class Equations:
    """Factorised equations of a frame, in scaled unknowns.

    Parameters
    ----------
    model : FrameModel

    Attributes
    ----------
    system : FrameSystem
        Its numbering and scaling.
    scale : float
        Unit of the displacements.
    matrix : csc_matrix, shape (k, k)
    size : int
        Number of natural forces, which come before the displacements.
    natural : ndarray, shape (m, 12, 6)
        From natural forces to forces at beams' ends [N, N·mm].

    Raises
    ------
    CannotRunError
        Where the frame can move without strain, naming what moves most.
    """

    def __init__(self, model: FrameModel) -> None:
        from scipy.sparse import bmat, csc_matrix

        self.system = FrameSystem(model)
        B, F = self.system.equations()
        refuse_mechanism(self.system, B)
        # Displacements in units of the softest element's answer to unit force: no block outgrows the rest.
        self.scale = float(F.diagonal().max())
        self.matrix = csc_matrix(bmat([[-F / self.scale, B], [B.T, None]]))
        self.size = B.shape[0]
        deformed = natural_deformations(self.system.lengths)
        self.natural = deformed.swapaxes(-1, -2) * self.system.natural_units[:, None]

    @cached_property
    def factors(self) -> Any:
        """Those of the matrix by SuperLU, which do not go into a pickle, as of a result that keeps how pins stand."""
        from scipy.sparse.linalg import splu

        return splu(self.matrix)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "factors"}

    @cached_property
    def condition(self) -> float:
        """1-norm condition number (estimated)."""
        from scipy.sparse.linalg import LinearOperator, onenormest

        # The matrix is symmetric, and so is its inverse.
        solve = self.factors.solve
        inverse = LinearOperator(self.matrix.shape, matvec=solve, rmatvec=solve, dtype=np.float64)
        return float(abs(self.matrix).sum(axis=0).max() * onenormest(inverse, t=1))

    def solved(self, right: Floats) -> Floats:
        """Solve, and once more for what is left.

        Parameters
        ----------
        right : ndarray, shape (k, ...)

        Returns
        -------
        ndarray
            Unknowns, of the same shape.
        """
        found = self.factors.solve(right)
        return np.asarray(found + self.factors.solve(right - self.matrix @ found))


@lru_cache(maxsize=KNOWN)
def _known(stiffness: _Stiffness) -> Equations:
    return Equations(stiffness.model)


def equations_of(model: FrameModel) -> Equations:
    """Return the equations of a frame; those of one that differs in its loads where they are known.

    Parameters
    ----------
    model : FrameModel

    Returns
    -------
    Equations

    Raises
    ------
    CannotRunError
        As of ``Equations``.
    """
    found = _known(_Stiffness(model))
    return found if found.system.bears(model.loads) else Equations(model)
