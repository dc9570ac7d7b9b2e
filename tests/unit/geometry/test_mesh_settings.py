from dataclasses import replace

import numpy as np
import pytest

from alula.fea.refine.refinement import START
from alula.geometry.meshing.mesh import mesh_body
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.parts.part import Body, Pin, Tube


def test_a_factor_scales_every_size() -> None:
    usual = MeshSettings()
    half, double = usual.scaled(0.5), usual.scaled(2.0)
    assert (half.size, half.fillet_size) == (usual.size / 2, usual.fillet_size / 2)
    assert (half.bore_elements, half.hole_elements, half.turn_elements) == (32, 16, 16)
    assert (double.bore_elements, double.hole_elements, double.turn_elements) == (8, 6, 6)
    assert usual.scaled(1.0) == usual
    field = replace(usual, size_points=np.zeros((2, 3)), size_values=np.array([1.0, 3.0])).scaled(0.5)
    assert field.size_values is not None
    assert field.size_values.tolist() == [0.5, 1.5]


@pytest.mark.parametrize(
    ("fill", "radius"), [({"plug_length": "10 mm"}, 0.25), ({"bush_diameter": "3.5 mm"}, 0.5)], ids=["plug", "bush"]
)
def test_the_first_mesh_is_fine_along_the_fillet_of_a_plug_or_bush(fill: dict[str, str], radius: float) -> None:
    """Elements grow from 1.2 radii by their distance from the fillet; 1 in 100 may be more than twice as large."""
    sizes = {"outer_diameter": "8 mm", "inner_diameter": "7 mm", "fillet_radius": f"{radius} mm"} | fill
    part = Tube.model_validate({"shape": "tube", "material": "any", "eyes": "none"} | sizes)
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=2.5) for name, x in (("A", 0.0), ("B", 22.0)))
    mesh = mesh_body(Body(part=part, pins=pins, ends=(), holes=()), START)
    corners = mesh.points[mesh.cells[:, :4]]
    edges = np.cbrt(np.sqrt(72.0) * np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0)
    x, y, z = corners.mean(axis=1).T
    at_plug, at_bush = np.abs(x - 5.0), np.abs(np.hypot(x, y) - 1.75)
    across = at_plug if "plug_length" in fill else at_bush
    away = np.maximum(np.hypot(np.hypot(y, z) - 3.5, across) - radius, 0.0)
    near = away < 2.0 * radius
    assert near.sum() > 500
    assert np.percentile(edges[near] / (1.2 * radius + away[near]), 99.0) < 2.0
