"""A body that is symmetric about z = 0 as the mesh of its upper half and that mesh's image."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.element_geometry import TETRA_EDGES
from alula.geometry.meshing.tagged_mesh import IMAGE_ORDER, REFLECTION, TaggedMesh

_OPPOSITE = {"top": "bottom", "bottom": "top"}
_ON_PLANE = 1e-9  # of the body's size: the mesher rounds to some 1e-11


def mirrored(half: TaggedMesh) -> TaggedMesh:
    """Return the mesh of a whole body from that of its half z ≥ 0.

    Points and elements of the half come first, then their images, in the same order; nodes on the plane are shared and
    have z = 0 exactly. The image of ``top:A`` is ``bottom:A`` and the other way round; that of any other surface bears
    its name. Areas and volume are those of both halves.

    Parameters
    ----------
    half : TaggedMesh
        Of the upper half, cut at z = 0; the cut itself bears no name.

    Returns
    -------
    TaggedMesh
        Of the whole, which knows its symmetry (``mirror``).

    Raises
    ------
    CannotRunError
        For a point below the plane, no face on it, or an edge between two of its nodes that bulges out of it.
    """
    points = half.points.copy()
    near = _ON_PLANE * half.size
    plane = np.abs(points[:, 2]) <= near
    points[plane, 2] = 0.0
    if (points[:, 2] < 0.0).any():
        raise CannotRunError(f"the mesh of the upper half reaches down to z = {points[:, 2].min():.6g} mm")
    if (np.count_nonzero(plane[half.cells[:, :4]], axis=1) < 3).all():
        raise CannotRunError("the mesh of the upper half has no face on the plane z = 0")
    if half.curved and any(
        (plane[half.cells[:, (a, b)]].all(axis=1) & ~plane[half.cells[:, 4 + local]]).any()
        for local, (a, b) in enumerate(TETRA_EDGES)
    ):
        raise CannotRunError("an edge between two nodes on the plane z = 0 bulges out of it: refine the mesh there")
    image = np.arange(len(points))
    image[~plane] = len(points) + np.arange(np.count_nonzero(~plane))
    back = np.concatenate([image, np.flatnonzero(~plane)])
    swap = list(IMAGE_ORDER[: half.cells.shape[1]])
    names = dict.fromkeys([*half.surfaces, *(_image_name(name) for name in half.surfaces)])
    return replace(
        half,
        points=np.concatenate([points, points[~plane] * REFLECTION]),
        cells=np.concatenate([half.cells, image[half.cells][:, swap]]),
        surfaces={name: _joined(half, name, image) for name in names},
        areas={name: half.areas.get(name, 0.0) + half.areas.get(_image_name(name), 0.0) for name in names},
        volume=2.0 * half.volume,
        centroid=half.centroid * (1.0, 1.0, 0.0),
        mirror=back,
    )


def _image_name(name: str) -> str:
    kind, colon, place = name.partition(":")
    return _OPPOSITE.get(kind, kind) + colon + place


def _joined(half: TaggedMesh, name: str, image: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the triangles of a surface of the whole: its own in the half, and the images of its counterpart's."""
    own = [half.surfaces[name]] if name in half.surfaces else []
    other = _image_name(name)
    images = [image[half.surfaces[other]][:, ::-1]] if other in half.surfaces else []
    return np.concatenate([*own, *images])
