"""Loads on a named face of an imported part: an even traction with the stated resultant, on link and mesh."""

import numpy as np
import pytest
from imported_case import imported_case

from alula.fea.beam.cut_free import link_loads
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.tractions.traction import wrench_density
from alula.geometry.base.errors import CaseError
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.loads.case.case_file import read_case
from alula.loads.records.bearing import WIDE

STRIP = '{ O4 = ["0 mm", "0 mm"], B = ["50.8 mm", "0 mm"] }'
"""Of 76.2 by 25.4 by 6.35 mm, with bores of 6.35 mm, 50.8 mm apart."""
STRIP_ENTRIES = 'bores = { O4 = "bore 1", B = "bore 2" }\nfaces.P = "face 6"'
SECTION = 25.4 * 6.35


def laden(folder, loads, *, file="inch.step", points=STRIP, entries=STRIP_ENTRIES):
    """Read the case of an imported rocker under other loads."""
    path = imported_case(folder, file=file, points=points, entries=entries)
    stated = 'forces = [{ link = "rocker", at = "B", force = ["30 N", "-20 N"] }]'
    text = path.read_text().replace(stated, loads)
    if file == "inch.step":
        text = text.replace('pin_diameter = "5 mm"', 'pin_diameter = "6.35 mm"').replace('"6 mm" }', '"6.35 mm" }')
    path.write_text(text)
    return read_case(str(path))


def on_rocker(case):
    """Return the loads on the cut-free rocker."""
    solved = solve_case_statics(case)
    return link_loads("turn", "rocker", case.body("rocker"), solved.reactions["turn"], solved.loads["turn"])


PULLED = 'forces = [{ link = "rocker", at = "P", force = ["1000 N", "0 N"], axes = "link" }]'


@pytest.mark.parametrize(
    "loads", [PULLED, f'pressures = [{{ link = "rocker", at = "P", pressure = "-{1000.0 / SECTION!r} MPa" }}]']
)
def test_a_bar_pulled_at_its_end_face_bears_force_over_area(tmp_path, loads):
    """The pull has a line through both bores, so that the far one holds it all: N = F between them, F/A at the face."""
    case = laden(tmp_path, loads)
    assert case.links["rocker"].points["P"] == pytest.approx((63.5, 0.0))
    cut = on_rocker(case)
    assert cut.resultant() == pytest.approx(np.zeros(6), abs=1e-6)
    body = case.body("rocker")
    mesh = mesh_body(body, COARSE)
    assert mesh.mirror is not None
    assert mesh.areas["end:P"] == pytest.approx(SECTION, rel=1e-9)
    found = solve_solid(mesh, E=2000.0, nu=0.3, density=0.0, loads=[cut], line=("bore:O4", "bore:B"), laws=(WIDE,))
    stress = stress_field(found.space, found.cases[0].displacement, E=2000.0, nu=0.3)
    face = np.unique(found.space.faces("end:P"))
    assert stress.nodal[face][:, 0] == pytest.approx(np.full(len(face), 1000.0 / SECTION), rel=0.03)


@pytest.mark.parametrize(("face", "area"), [("face 4", 1073.5509), ("face 6", 300.0), ("face 3", 25.0 * np.pi)])
def test_a_face_bears_its_resultant_evenly_where_it_lies_off_the_plane_too(tmp_path, face, area):
    """Faces with the rings of both bores imprinted, beside the pins, and on a boss: 7 N per mm² times the area."""
    case = laden(
        tmp_path,
        'pressures = [{ link = "rocker", at = "P", pressure = "7 MPa" }], '
        'forces = [{ link = "rocker", at = "P", force = ["11 N", "-5 N", "2 N"], axes = "link" }]',
        file="plate.step",
        points='{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] }',
        entries=f'faces.P = "{face}"',
    )
    body = case.body("rocker")
    [end] = body.ends
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["end:P"] == pytest.approx(area, rel=1e-6)
    wrench = next(one.wrench for one in on_rocker(case).ends if one.name == "P")
    traction = np.array([11.0, -5.0, 2.0]) / area - 7.0 * np.array(end.face.normal)
    patch = surface_quadrature(displacement_space(mesh), "end:P")
    point = np.array([end.x, end.y, 0.0])
    density = wrench_density(patch, point, wrench)
    # The circles of the bores are arcs of quadratic elements.
    assert density == pytest.approx(np.broadcast_to(traction, density.shape), abs=1e-4 * np.abs(traction).max())
    assert patch.wrench(density, point) == pytest.approx(wrench, abs=1e-6)


@pytest.mark.parametrize(
    ("entries", "points", "said"),
    [
        (
            'faces.P = "face 9"',
            "",
            "faces.P: the part has no flat face 'face 9'; its flat faces are face 1 .161.3 mm² at ",
        ),
        ('faces.B = "face 6"', "", "faces.B: the point B is that of a bore; name another point for face 6"),
        ('faces.P = "face 6"', ', P = ["60 mm", "0 mm"]', "P stands 3.5 mm from the centre of face 6 at .63.5, 0. mm"),
    ],
)
def test_a_face_that_does_not_fit_is_refused_in_a_sentence(tmp_path, entries, points, said):
    named = STRIP_ENTRIES.split("\n")[0]
    with pytest.raises(CaseError, match=said) as found:
        laden(tmp_path, PULLED, points=STRIP.replace(" }", f"{points} }}"), entries=f"{named}\n{entries}")
    assert "\n" not in str(found.value)


def test_a_pressure_needs_a_named_face_and_a_mesh_has_none(tmp_path):
    with pytest.raises(CaseError, match=r"pressures\.0\.at: a pressure acts on a named face, but point 'B'"):
        laden(tmp_path, 'pressures = [{ link = "rocker", at = "B", pressure = "1 MPa" }]')
    (tmp_path / "own.msh").touch()
    path = tmp_path / "case.toml"
    path.write_text(path.read_text().replace('"step"', '"mesh"').replace("inch.step", "own.msh"))
    with pytest.raises(CaseError, match=r"faces: a mesh has no faces with names; give the part as a STEP file"):
        read_case(str(path))
