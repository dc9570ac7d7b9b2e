"""A link from a STEP file bears what the same link bears that alula draws; bores off the plane of forces balance."""

import numpy as np
import pytest
from imported_case import imported_case

from fea.common.link_loads import PinLoad
from fea.solid.quadrature import surface_quadrature
from fea.solid.space import displacement_space
from fea.solid.traction import bore_middle, pin_traction
from geometry.meshing.mesh import COARSE, mesh_body
from loads.case.case_file import read_case
from loads.records.bearing import WIDE

NAMED = 'bores = { O4 = "bore 2", B = "bore 1" }'


def test_a_bore_off_the_plane_of_forces_takes_the_moment_too(tmp_path):
    """The hub of the bell crank is 12 mm long, its arms 5 mm: their middles lie 3.5 mm apart."""
    points = '{ O4 = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] }'
    case = read_case(str(imported_case(tmp_path, file="bell_crank.step", points=points, entries=NAMED)))
    body = case.body("rocker")
    space = displacement_space(mesh_body(body, COARSE))
    middles = [pin.ring.middle for pin in body.pins]
    assert abs(middles[0] - middles[1]) == pytest.approx(3.5)
    for pin in body.pins:
        bore, centre = surface_quadrature(space, f"bore:{pin.name}"), np.array([pin.x, pin.y, 0.0])
        assert bore_middle(bore, centre)[2] == pytest.approx(pin.ring.middle, abs=1e-3)
        wrench = np.array([30.0, -20.0, 0.0, 0.0, 0.0, 0.0])
        load = PinLoad(name=pin.name, centre=centre, diameter=pin.diameter, wrench=wrench)
        density = pin_traction(bore, load, WIDE)
        assert bore.wrench(density, centre) == pytest.approx(wrench, abs=1e-9)
        # The pressure is linear along the bore: no traction but what uneven facets need runs along its wall.
        along = density - (density * bore.normals).sum(axis=-1, keepdims=True) * bore.normals
        assert np.abs(along).max() < 0.05 * np.abs(density).max()
