"""A link from a STEP file bears what the same link bears that alula draws; bores off the plane of forces balance."""

import numpy as np
import pytest
import rocker_case
from imported_case import imported_case

from fea.check.run import check_case
from fea.common.link_loads import PinLoad
from fea.elements.quadrature import surface_quadrature
from fea.elements.space import displacement_space
from fea.outcomes.limits import layers_of
from fea.solid.layers import Layers
from fea.tractions.traction import bore_middle, pin_traction
from geometry.meshing.mesh import COARSE, export_step, mesh_body
from loads.case.case_file import read_case
from loads.records.bearing import WIDE
from loads.states.masses import part_mass

NAMED = 'bores = { O4 = "bore 2", B = "bore 1" }'

FORCE = 'forces = [{ link = "rocker", at = "B", force = ["30 N", "-20 N"] }]'


def drawn_rocker(folder):
    """The case of ``rocker_case`` under a force at B, without its load point."""
    text = rocker_case.TOML.replace(', P = ["60 mm", "0 mm"]', "")
    text = text.replace('moments = [{ link = "rocker", at = "P", moment = "20 N*mm" }]', FORCE)
    path = folder / "drawn.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_drawn_link_that_comes_back_from_its_own_step_file_bears_the_same(tmp_path):
    """Both peaks lie in both bands; what bends agrees within half a percent, the mass within 1e-6."""
    path = drawn_rocker(tmp_path)
    drawn = read_case(str(path))
    export_step({"rocker": drawn.body("rocker")}, tmp_path)
    text = path.read_text().partition("[parts.bar]")[0].replace('part = "bar"', 'part = "own"')
    text += '[parts.own]\nshape = "step"\nfile = "rocker.step"\nmaterial = "pvc-paredes-2018"\nbores.B = "bore 2"\n'
    (tmp_path / "back.toml").write_text(text, encoding="utf-8")
    back = read_case(str(tmp_path / "back.toml"))
    assert back.links["rocker"].points["B"] == pytest.approx((40.0, 0.0), abs=1e-6)
    assert part_mass(back, "rocker").mass == pytest.approx(part_mass(drawn, "rocker").mass, rel=1e-6)
    assert mesh_body(back.body("rocker"), COARSE).mirror is not None
    one, other = (check_case(case, fidelity="solid").load_cases["turn"].links["rocker"] for case in (drawn, back))
    assert one.von_mises_max.low <= other.von_mises_max.value <= one.von_mises_max.high
    assert other.von_mises_max.low <= one.von_mises_max.value <= other.von_mises_max.high
    assert other.displacement_max.value == pytest.approx(one.displacement_max.value, rel=5e-3)


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


def test_layers_of_an_imported_part_lie_in_its_links_frame(tmp_path):
    points = '{ O4 = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] }'
    entries = f"{NAMED}\nbuild_direction = [0, 1, 0]"
    path = imported_case(tmp_path, file="bell_crank.step", points=points, entries=entries)
    case = read_case(str(path), ['parts.own.material="pla-fdm-xy"'])
    assert layers_of(case, "rocker") == Layers(normal=(0.0, 1.0, 0.0), across=12.0, between=6.0)
    assert case.body("rocker").part.scaled(lambda length: length / 3.0).build_direction == (0.0, 1.0, 0.0)
