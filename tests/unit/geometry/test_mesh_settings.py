from dataclasses import replace

import numpy as np

from geometry.meshing.mesh_settings import MeshSettings


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
