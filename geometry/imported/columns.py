"""Where the material of a solid is along lines parallel to an axis, by the triangles of its surface."""

import math

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.facts import PartSurface
from alula.geometry.imported.walls import Line

Real = NDArray[np.float64]

_RING = math.tau * np.arange(8) / 8.0 + 0.1
"""Where around an axis eight lines stand [rad]; off the seams at which programs split cylinders."""


class Columns:
    """Lines parallel to an axis through a solid.

    Parameters
    ----------
    surface : PartSurface
        Triangles of the solid's surface.
    line : Line
        The axis.
    reach : float
        How far from it other lines may be [mm].
    """

    def __init__(self, surface: PartSurface, line: Line, reach: float) -> None:
        self._line = line
        first, second = line.across
        arms = surface.points - line.point
        flat = np.stack([arms @ first, arms @ second])
        a, b, c = np.moveaxis(flat[:, surface.triangles], 2, 0)  # (2, k) each
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        near = surface.triangles[((low <= reach) & (high >= -reach)).all(axis=0)]
        self._corners, self._heights = flat.T[near], (arms @ line.axis)[near]

    def offset(self, vector: Real) -> Real:
        """Return where a line stands in the plane across the axis.

        Parameters
        ----------
        vector : array
            (3,) from the axis to the line [mm].

        Returns
        -------
        array
            (2,) [mm].
        """
        first, second = self._line.across
        return np.array([vector @ first, vector @ second])

    def ring(self, radius: float) -> list[Real]:
        """Return where eight lines stand around the axis.

        Parameters
        ----------
        radius : float
            Their distance from it [mm].

        Returns
        -------
        list of array
            (2,) [mm].
        """
        return [radius * np.array([math.cos(angle), math.sin(angle)]) for angle in _RING]

    def material(self, at: Real, places: Real) -> NDArray[np.bool_]:
        """Return whether there is material at places of a line.

        Parameters
        ----------
        at : array
            Where the line stands (2,) [mm].
        places : array
            Along the axis (n,), from its own point [mm].

        Returns
        -------
        bool array
            (n,).
        """
        heights, steps = self._crossings(at)
        # Each face that is crossed upwards is left where its outside is above, and entered where it is below.
        return np.asarray((steps[None] * (heights[None] > places[:, None])).sum(axis=1) > 0)

    def first_material(self, at: Real, start: float, way: float) -> float:
        """Return how far from a place the material begins that one sees along a line.

        Parameters
        ----------
        at : array
            Where the line stands (2,) [mm].
        start : float
            The place, along the axis [mm].
        way : float
            1.0 to look up the axis, -1.0 to look down.

        Returns
        -------
        float
            [mm]; infinite where there is none.
        """
        if self.material(at, np.array([start]))[0]:
            return 0.0
        beyond = (self._crossings(at)[0] - start) * way
        return float(beyond[beyond > 0.0].min(initial=math.inf))

    def _crossings(self, at: Real) -> tuple[Real, Real]:
        """Return where a line meets the surface, and 1.0 where it leaves the material upwards, -1.0 where it enters."""
        a, b, c = np.moveaxis(self._corners - at, 1, 0)
        ab, bc, ca = (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((a, b), (b, c), (c, a)))
        area = ab + bc + ca
        inside = (np.sign(ab) == np.sign(bc)) & (np.sign(bc) == np.sign(ca)) & (area != 0.0)
        weights = np.column_stack([bc, ca, ab])[inside] / area[inside, None]
        return (weights * self._heights[inside]).sum(axis=1), np.sign(area[inside])
