"""A mesh that differs from the geometry is refused: one tetrahedron beside what the kernel says of it."""

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh_settings import COARSE
from alula.geometry.meshing.mesh_target import MeshTarget
from alula.geometry.meshing.mesher import _checked
from alula.geometry.meshing.tagged_mesh import TaggedMesh

POINTS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def checked(*, area: float = 0.5, volume: float = 1.0 / 6.0, cell: tuple[int, ...] = (0, 1, 2, 3)) -> TaggedMesh:
    """What the mesher makes of the unit tetrahedron, whose face below is ``top:A``, if the kernel states these."""
    gmsh = SimpleNamespace(model=SimpleNamespace(mesh=SimpleNamespace(getElementsByType=lambda *_: (None, [0, 1, 2]))))
    solid: Any = SimpleNamespace(unit=1.0)
    target = MeshTarget(
        solid=solid,
        tag=1,
        cut=[],
        areas={7: area},
        surfaces={"top:A": [7]},
        volume=volume,
        centroid=np.full(3, 0.25),
    )
    settings = dataclasses.replace(COARSE, curved=False)
    return _checked(gmsh, target, settings, POINTS, np.array([cell]), np.arange(4), (), settings.chord_error)


def test_a_mesh_that_agrees_is_taken() -> None:
    assert checked().areas == {"top:A": 0.5}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"area": 1.0}, "surface 'top:A' has 0.5 mm² in the mesh, but 1 mm² in the geometry"),
        ({"volume": 0.5}, "the mesh has 0.166667 mm³, but the geometry 0.5 mm³"),
        ({"cell": (0, 2, 1, 3)}, "holds an inverted element"),
    ],
)
def test_a_mesh_that_differs_is_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(CannotRunError, match=message):
        checked(**wrong)


def test_a_surface_without_triangles_is_refused() -> None:
    with pytest.raises(CannotRunError, match="no triangle on surface 'top:A'"):
        dataclasses.replace(checked(), surfaces={"top:A": np.empty((0, 3), dtype=np.int64)})
