"""The one mesh record: tetrahedra with named surfaces, checked against the geometry they stand for."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError

IMAGE_ORDER = (1, 0, 2, 3, 4, 6, 5, 8, 7, 9)
"""Nodes of an element, or the first four of a straight one, in the order in which its image is positive."""
REFLECTION = np.array([1.0, 1.0, -1.0])
"""What the reflection in z = 0 multiplies a vector with."""


@dataclass(frozen=True, kw_only=True)
class TaggedMesh:
    """Tetrahedra in mm, straight (4 nodes) or curved (10 nodes), with named boundary surfaces.

    The ten nodes stand in VTK's order, which is scikit-fem's too: corners 0-3, then the edges
    01, 12, 02, 03, 13, 23. A surface is an array of triangles, each by its three corner nodes.

    Attributes
    ----------
    points : ndarray
        Nodes (n, 3) [mm].
    cells : ndarray
        Elements (m, 4) or (m, 10), node numbers.
    surfaces : mapping of str to ndarray
        Corner nodes (k, 3) of the boundary triangles of each surface: ``bore:A`` is the pin hole at A, ``top:A`` and
        ``bottom:A`` the flat faces of the eye at A (towards +z and -z) where it has such, ``end:H`` the loaded
        patch of a plain end at H.
    areas : mapping of str to float
        Area of every surface by the geometry kernel [mm²].
    volume : float
        Volume by the geometry kernel [mm³].
    centroid : ndarray
        Centroid (3,) by the geometry kernel [mm].
    notes : tuple of str
        What the mesher had to do to make every element valid, for the report.
    mirror : ndarray of int or None, shape (n,)
        Number of every point's image at -z, its own on the plane z = 0; None where the mesh has no such symmetry. The
        first half of the elements then lies at z ≥ 0, and the second holds their images in the same order
        (``alula.geometry.meshing.mirror``).

    Raises
    ------
    CannotRunError
        If a surface is empty or if arrays do not fit each other.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    surfaces: Mapping[str, NDArray[np.int64]]
    areas: Mapping[str, float]
    volume: float
    centroid: NDArray[np.float64]
    notes: tuple[str, ...] = ()
    mirror: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit each other."""
        if self.cells.ndim != 2 or self.cells.shape[1] not in (4, 10) or len(self.cells) == 0:
            raise CannotRunError(f"the mesh has cells of shape {self.cells.shape}; expected (m, 4) or (m, 10)")
        if self.cells.min() < 0 or self.cells.max() >= len(self.points):
            raise CannotRunError("the mesh names nodes that it does not have")
        if set(self.surfaces) != set(self.areas):
            raise CannotRunError("the mesh has surfaces without an area, or areas without a surface")
        for name, triangles in self.surfaces.items():
            if len(triangles) == 0:
                raise CannotRunError(f"the mesh has no triangle on surface '{name}'")
        if self.mirror is not None and not self._symmetric(self.mirror):
            raise CannotRunError("the mesh is not the image of its upper half")

    def _symmetric(self, mirror: NDArray[np.int64]) -> bool:
        upper, lower = np.array_split(self.cells, 2)
        return (
            len(mirror) == len(self.points)
            and len(upper) == len(lower)
            and np.array_equal(mirror[mirror], np.arange(len(mirror)))
            and np.array_equal(self.points[mirror], self.points * REFLECTION)
            and bool((self.points[upper, 2] >= 0.0).all())
            and np.array_equal(mirror[upper][:, list(IMAGE_ORDER[: upper.shape[1]])], lower)
        )

    @property
    def curved(self) -> bool:
        """True where edges carry a mid-node."""
        return bool(self.cells.shape[1] == 10)

    @cached_property
    def size(self) -> float:
        """Diagonal of the bounding box [mm]."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))
