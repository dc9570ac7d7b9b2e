"""A link from a STEP file bears what the same link bears that alula draws; bores off the plane of forces balance."""

import dataclasses

import numpy as np
import pytest
import rocker_case
from imported_case import imported_case, strut_case

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import check_beam
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.outcomes.compare import compare_sections
from alula.fea.outcomes.limits import layers_of
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.tractions.bore_wall import bore_middle
from alula.fea.tractions.traction import pin_traction
from alula.geometry.meshing.mesh import COARSE, MeshSettings, export_step, mesh_body
from alula.loads.case.case_file import read_case
from alula.loads.records.bearing import WIDE
from alula.loads.states.masses import part_mass

NAMED = 'bores = { O4 = "bore 2", B = "bore 1" }'

FORCE = (
    'forces = [{ link = "rocker", at = "B", force = ["30 N", "-20 N"] }], '
    'spread = [{ link = "rocker", start = "O4", end = "B", total = ["0 N", "-8 N"] }]'
)


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
    # By hand it has the same forces and, beyond its eyes, the same section, also if it lies the other way up.
    for ours, theirs in ((one.beam.n, other.beam.n), (one.beam.v_y, other.beam.v_y), (one.beam.m_z, other.beam.m_z)):
        assert np.interp(20.0, other.beam.x, theirs) == pytest.approx(np.interp(20.0, one.beam.x, ours), rel=1e-6)
    drawn_stress, cut_stress = one.beam.stress_at(20.0), other.beam.stress_at(20.0)
    assert dataclasses.astuple(cut_stress) == pytest.approx(dataclasses.astuple(drawn_stress), rel=1e-6, abs=1e-9)


def angle_bending(x: float) -> float:
    """Largest bending stress of the angle under M_z = 200 N·mm: at the tip of its wide leg, by Mohr's formula.

    Two rectangles of 16 by 2 and 2 by 8 mm about their common centroid; σ = M (I_yz z - I_y y)/(I_y I_z - I_yz²).
    """
    y, z = 17.0 / 3.0, 8.0 / 3.0
    i_y = 16.0 * 8.0 / 12.0 + 32.0 * (1.0 - z) ** 2 + 2.0 * 512.0 / 12.0 + 16.0 * (6.0 - z) ** 2
    i_z = 2.0 * 4096.0 / 12.0 + 32.0 * (8.0 - y) ** 2 + 8.0 * 8.0 / 12.0 + 16.0 * (1.0 - y) ** 2
    i_yz = 32.0 * (8.0 - y) * (1.0 - z) + 16.0 * (1.0 - y) * (6.0 - z)
    corners = [(16.0, 0.0), (16.0, 2.0), (0.0, 0.0), (0.0, 10.0), (2.0, 10.0)]
    stresses = [(i_yz * (c - z) - i_y * (b - y)) / (i_y * i_z - i_yz**2) for b, c in corners]
    return 200.0 * max(map(abs, stresses))


def taper_bending(x: float) -> float:
    """6 M/(t b²) with the width b of the taper and the moment of 5 N at its wide end."""
    return 6.0 * 5.0 * (100.0 - x) / (6.0 * (10.0 + x / 10.0) ** 2)


@pytest.mark.parametrize(
    ("file", "length", "ends", "expected", "within"),
    [
        ("angle.step", 140.0, ([0, 0, 0, 0, 0, -200.0], [0, 0, 0, 0, 0, 200.0]), angle_bending, 3e-3),
        ("taper.step", 100.0, ([0, -5.0, 0, 0, 0, -500.0], [0, 5.0, 0, 0, 0, 0]), taper_bending, 1e-2),
    ],
)
def test_sections_of_a_part_bear_what_theory_and_its_solid_say(tmp_path, file, length, ends, expected, within):
    """Under moments of its bores; and a pull on them bends the angle, whose centroid lies beside them."""
    body = read_case(str(strut_case(tmp_path, file=file, length=length))).body("rocker")
    loads = {
        name: LinkLoads(
            name=name,
            pins=tuple(
                PinLoad(name=pin.name, centre=np.array([pin.x, 0.0, 0.0]), diameter=4.0, wrench=np.array(end, float))
                for pin, end in zip(body.pins, wrenches, strict=True)
            ),
        )
        for name, wrenches in {"bend": ends, "pull": ([-40.0, 0, 0, 0, 0, 0], [40.0, 0, 0, 0, 0, 0])}.items()
    }
    material = {"E": 2400.0, "nu": 0.38}
    found = solve_solid(
        mesh_body(body, MeshSettings(size=0.9, bore_elements=8)),
        **material,
        density=1e-9,
        loads=list(loads.values()),
        line=("bore:O4", "bore:B"),
        laws=[WIDE],
        transfers=["bore-shear"],
        threads=1,
    )
    assert [case.load for case in found.cases] == ["bend", "pull"]
    for case in found.cases:
        beam = check_beam(beam_loads(loads[case.load], body, 1e-9), body.part.section, 1.0, 0.38, body.cuts)
        compared = compare_sections(body, beam, stress_field(found.space, case.displacement, **material))
        assert len(compared) >= 9
        assert max(abs(row.difference) for row in compared) < within
        if case.load == "bend":
            assert [row.hand for row in compared] == pytest.approx([expected(row.x) for row in compared], rel=1e-6)


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
