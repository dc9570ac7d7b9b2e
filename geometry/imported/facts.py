"""Records of what is found in the file of a part, in mm in the file's own frame."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = tuple[float, float, float]
MESH_FORMATS = {".msh": "gmsh", ".inp": "abaqus", ".vtu": "vtu"}
"""Ends of the names of mesh files -> what meshio calls their format."""


@dataclass(frozen=True, kw_only=True)
class Bore:
    """A round or long hole of a solid.

    Attributes
    ----------
    name : str
        "bore 1", "bore 2", ...: along the part's longest direction, then across it.
    axis : tuple of 3 float
        Unit vector, its largest component positive.
    centre : tuple of 3 float
        Middle of the hole along its axis; of a slot, between its two ends as well [mm].
    diameter : float
        Of the hole; the width of a slot [mm].
    length : float
        From the first to the last of the wall, along the axis [mm].
    through : bool
        False where the hole ends in the material.
    spans : tuple of tuple of 2 float
        Where the wall is, along the axis from the centre [mm]: one span for a plain hole, two for a fork.
    slot : float
        Distance of the centres of a slot's round ends; 0.0 for a round hole [mm].
    slot_axis : tuple of 3 float
        Unit vector along a slot; zeros for a round hole.
    share : float
        Share of the circle that the wall takes: 1.0 for a hole that is round all the way, less for one with a keyway,
        with a slit, or open at a side.
    around : bool
        True where the part's outside is round about the same axis, as of a tube.
    """

    name: str
    axis: Vector
    centre: Vector
    diameter: float
    length: float
    through: bool
    spans: tuple[tuple[float, float], ...]
    slot: float
    slot_axis: Vector
    share: float = 1.0
    around: bool = False

    @property
    def told(self) -> str:
        """What kind of hole it is, in a few words, with its diameter."""
        kind = "slot of " if self.slot else "" if self.share == 1.0 else f"{self.share:.0%} of a circle of "
        return f"{self.name} ({kind}{self.diameter:.4g} mm)"


@dataclass(frozen=True, kw_only=True)
class Face:
    """A flat face of a solid.

    Attributes
    ----------
    name : str
        "face 1", "face 2", ...: in the order of bores, by its centre.
    normal : tuple of 3 float
        Unit vector, out of the material.
    centre : tuple of 3 float
        Centroid of its area [mm].
    area : float
        [mm²].
    tag : int
        Its number in ``PartSurface.faces``.
    """

    name: str
    normal: Vector
    centre: Vector
    area: float
    tag: int


@dataclass(frozen=True, kw_only=True, eq=False)
class PartSurface:
    """Triangles of a solid's surface.

    Attributes
    ----------
    points : array
        Corners (n, 3) [mm]; faces of the solid share none.
    triangles : int array
        (k, 3), counter-clockwise as seen from outside.
    faces : int array
        Tag (k,) of the face that each is of.
    """

    points: NDArray[np.float64]
    triangles: NDArray[np.int64]
    faces: NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class PartFacts:
    """What is found in a file that holds one solid.

    Attributes
    ----------
    volume : float
        [mm³].
    surface : float
        Area of the surface [mm²].
    centroid : tuple of 3 float
        [mm].
    inertia : tuple of 3 tuple of 3 float
        Inertia tensor about the centroid for unit density, products of inertia with their minus sign [mm⁵].
    low : tuple of 3 float
        Least coordinates [mm].
    high : tuple of 3 float
        Largest coordinates [mm].
    bores : tuple of Bore
        The holes, in the order of their names.
    faces : tuple of Face
        The flat faces, in the order of their names; none of a mesh.
    digest : str
        SHA-256 of the file's content, in hexadecimal.
    """

    volume: float
    surface: float
    centroid: Vector
    inertia: tuple[Vector, Vector, Vector]
    low: Vector
    high: Vector
    bores: tuple[Bore, ...]
    faces: tuple[Face, ...] = ()
    digest: str
