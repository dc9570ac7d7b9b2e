"""A link that is made of a volume mesh, and what is found in mesh files."""

import hashlib
from dataclasses import replace

import meshio
import numpy as np
import pytest
from imported_case import STEP, imported_case
from scipy.spatial.transform import Rotation

from alula.fea.check.run import check_case
from alula.fea.refine.refinement import START, Effort
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.imported.read import part_facts
from alula.geometry.meshing.element_geometry import jacobian_coefficients
from alula.geometry.meshing.file_mesh import read_mesh
from alula.geometry.meshing.mesh import export_step, mass_properties, mesh_body, reentrant_edges
from alula.loads.case.case_file import read_case
from alula.loads.exchange.part import part_entries
from alula.reports.sentences import told
from alula.reports.tools.part import inspect_file

FORMATS = {"msh": "gmsh", "vtu": "vtu", "inp": "abaqus"}
STAND = Rotation.from_rotvec(np.radians(50.0) * np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0))
SHIFT = np.array([30.0, -20.0, 55.0])
UNIT_TETRA = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
EDGES = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]


@pytest.fixture(scope="module")
def step(tmp_path_factory):
    """The rocker that is a plate with a boss, from a STEP file."""
    return read_case(str(imported_case(tmp_path_factory.mktemp("step"))))


@pytest.fixture(scope="module")
def mesh(step):
    """Its first mesh."""
    return mesh_body(step.body("rocker"), START)


def write(path, points, cells, kind="tetra10"):
    """Write one kind of cells; return the path."""
    meshio.write(path, meshio.Mesh(points, [(kind, np.asarray(cells))]), file_format=FORMATS[path.suffix[1:]])
    return path


def of_mesh(folder, mesh, **changes):
    """The case of the imported rocker, its part the mesh."""
    write(folder / "own.msh", mesh.points, mesh.cells)
    path = imported_case(folder, file="own.msh", **changes)
    path.write_text(path.read_text().replace('"step"', '"mesh"'), encoding="utf-8")
    return path


def test_elements_may_all_be_numbered_the_other_way_round(tmp_path, mesh):
    """As Netgen does: the fourth corner then lies behind the first three, which run clockwise."""
    mirrored = mesh.cells[:, [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]]
    facts = part_facts(write(tmp_path / "own.msh", mesh.points, mirrored), 1.0)
    assert facts.volume == pytest.approx(mesh.volume, rel=1e-4)
    mirrored[0] = mesh.cells[0]
    with pytest.raises(CaseError, match=f"{len(mirrored) - 1} of {len(mirrored)} elements .* are inverted"):
        part_facts(write(tmp_path / "mixed.msh", mesh.points, mirrored), 1.0)


@pytest.mark.parametrize("end", FORMATS)
def test_bores_and_volume_of_a_rotated_mesh_in_cm_are_those_of_its_solid(tmp_path, mesh, end):
    """The plate of 60 x 20 x 5 mm has bores of 5 and 6 mm 40 mm apart, and a boss that is none."""
    path = write(tmp_path / f"own.{end}", (STAND.apply(mesh.points) + SHIFT) / 10.0, mesh.cells)
    facts = part_facts(path, 10.0)
    found = sorted(facts.bores, key=lambda bore: bore.diameter)
    assert [bore.diameter for bore in found] == pytest.approx([5.0, 6.0], rel=1e-4)
    for bore, x in zip(found, (0.01, 40.01), strict=True):  # stated 40.02 mm apart
        assert bore.centre == pytest.approx(STAND.apply([x, 0.0, 0.0]) + SHIFT, abs=1e-4)
        assert abs(np.dot(bore.axis, STAND.apply([0.0, 0.0, 1.0]))) == pytest.approx(1.0, abs=1e-8)
        assert (bore.length, bore.through, bore.around) == (pytest.approx(5.0, rel=1e-4), True, False)
    assert facts.volume == pytest.approx(
        jacobian_coefficients(mesh.points, mesh.cells).mean(axis=1).sum() / 6.0, rel=1e-6
    )
    expected = part_facts(STEP / "plate.step")
    assert facts.volume == pytest.approx(expected.volume, rel=1e-5)
    assert facts.surface == pytest.approx(expected.surface, rel=1e-5)


def test_a_hub_is_found_as_in_its_solid_and_its_fillet_is_no_bore(tmp_path):
    """Names, walls and ends are those that the geometry kernel's faces give."""
    points = '{ O4 = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] }'
    path = imported_case(
        tmp_path, file="bell_crank.step", points=points, entries='bores = { O4 = "bore 2", B = "bore 1" }'
    )
    body = read_case(str(path)).body("rocker")
    mesh = mesh_body(body, START)
    turn, shift = np.array(body.part.turn), np.array(body.part.shift)
    found = part_facts(write(tmp_path / "own.vtu", (mesh.points - shift) @ turn, mesh.cells), 1.0).bores
    for one, other in zip(found, part_facts(STEP / "bell_crank.step").bores, strict=True):
        assert (one.name, one.through, one.around) == (other.name, other.through, other.around)
        assert one.diameter == pytest.approx(other.diameter, rel=1e-4)
        assert one.centre == pytest.approx(other.centre, abs=1e-4)
        assert np.allclose(one.spans, other.spans, atol=1e-4)


def test_integrals_are_those_of_a_tetrahedron(tmp_path):
    """∫x dV = 1/24, ∫x² dV = 1/60 and ∫xy dV = 1/120 over the unit tetrahedron; an edge is hardly bent."""
    points = np.vstack([UNIT_TETRA, UNIT_TETRA[EDGES].mean(axis=1)])
    points[8] += 1e-4 * np.array([1.0, 0.0, 1.0])  # just bent, or it would be refused
    facts = part_facts(write(tmp_path / "one.vtu", points, [range(10)]), 1.0)
    square, product = 1.0 / 60.0 - 1.0 / 96.0, 1.0 / 120.0 - 1.0 / 96.0
    expected = 2.0 * square * np.eye(3) - product * (1.0 - np.eye(3))
    assert facts.volume == pytest.approx(1.0 / 6.0, rel=1e-3)
    assert facts.centroid == pytest.approx((0.25, 0.25, 0.25), rel=1e-3)
    assert np.allclose(facts.inertia, expected, rtol=2e-3)


def test_a_link_of_a_mesh_has_its_mass_sections_and_bores(tmp_path, step, mesh):
    case = read_case(str(of_mesh(tmp_path, mesh)))
    body = case.body("rocker")
    one, other = mass_properties(body), mass_properties(step.body("rocker"))
    assert one.volume == pytest.approx(other.volume, rel=1e-5)
    assert one.centroid == pytest.approx(other.centroid, abs=1e-3)
    assert np.allclose(one.inertia, other.inertia, rtol=1e-4, atol=1.0)
    cut, same = (found.body("rocker").cuts[2] for found in (case, step))  # of the plate alone, 20 x 5 mm
    assert (cut.area, cut.width, cut.height) == pytest.approx((100.0, 20.0, 5.0), rel=1e-6)
    assert (cut.i_y, cut.i_z) == pytest.approx((20.0 * 5.0**3 / 12.0, 5.0 * 20.0**3 / 12.0), rel=1e-6)
    assert cut.plain == same.plain
    through, exact = (found.body("rocker").cuts[0] for found in (case, step))  # beside the bore's axis
    assert (through.pieces, exact.pieces) == (2, 2)
    assert through.i_z == pytest.approx(exact.i_z, rel=1e-3)
    placed = mesh_body(body)
    assert set(placed.surfaces) == {"bore:O4", "bore:B"}
    for name, diameter in (("bore:O4", 5.0), ("bore:B", 6.0)):
        assert len(placed.surfaces[name]) == len(mesh.surfaces[name])
        assert placed.areas[name] == pytest.approx(np.pi * diameter * 5.0, rel=1e-3)


def test_the_foot_of_the_boss_is_its_only_sharp_inner_edge(tmp_path, mesh):
    """A circle of 10 mm in diameter about the middle, at the plate's top, where the material spans 270 degrees."""
    body = read_case(str(of_mesh(tmp_path, mesh))).body("rocker")
    [edge] = reentrant_edges(body)
    assert np.hypot(*(edge.points - [20.01, 0.0, 0.0])[:, :2].T) == pytest.approx(5.0, abs=1e-3)
    assert edge.points[:, 2] == pytest.approx(2.5, abs=1e-6)
    assert edge.points[0] == pytest.approx(edge.points[-1])
    assert np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum() == pytest.approx(10.0 * np.pi, rel=0.01)
    assert edge.angle == pytest.approx(1.5 * np.pi, abs=0.05)


def test_it_bears_what_the_same_mesh_bears_and_is_not_refined(tmp_path, step, mesh):
    case = read_case(str(of_mesh(tmp_path, mesh)))
    effort = Effort(accuracy=0.01, stated=True)
    links = [
        check_case(one, fidelity="solid", effort=two).load_cases["turn"].links["rocker"]
        for one, two in ((case, effort), (step, replace(effort, max_meshes=1)))
    ]
    stress, same = (link.von_mises_max for link in links)
    assert stress.value == pytest.approx(same.value, rel=1e-6)
    assert len(links[0].discretisation.meshes) == 1
    assert "the mesh is that of the part's file, which is not refined" in told(links[0].discretisation.reason)
    assert any("four times the estimated error" in told(note) for note in links[0].notes)


def test_there_is_no_step_file_of_a_mesh_and_no_load_beside_its_bores(tmp_path, mesh):
    case = read_case(str(of_mesh(tmp_path, mesh)))
    with pytest.raises(CaseError, match="the part is a mesh, which has no faces or edges for a STEP file"):
        export_step({"rocker": case.body("rocker")}, tmp_path)
    points = '{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"], P = ["50 mm", "0 mm"] }'
    with pytest.raises(CaseError, match="a part of shape mesh takes no load points without a pin"):
        read_case(str(of_mesh(tmp_path, mesh, points=points)))


def curved():
    """One tetrahedron, one of its edges bent."""
    points = np.vstack([UNIT_TETRA, UNIT_TETRA[EDGES].mean(axis=1)])
    points[5] += 0.05
    return points, np.arange(10)[None]


def two_bodies():
    points, cells = curved()
    return np.vstack([points, points + 5.0]), np.vstack([cells, cells + 10])


def torn():
    """Two tetrahedra with a common face whose mid-nodes are not common."""
    points, cells = curved()
    other = points * (1.0, 1.0, -1.0)
    other_cells = np.arange(10, 20)[[1, 0, 2, 3, 4, 6, 5, 8, 7, 9]]
    both = np.vstack([cells, [other_cells]])
    both[both == 10], both[both == 11], both[both == 12] = 0, 1, 2
    return np.vstack([points, other]), both


def fanned():
    """Three tetrahedra on one face, two of them on the same side of it."""
    points, cells = torn()
    third = points[:10] * (1.0, 1.0, 2.0)
    of_third = np.where(np.isin(np.arange(10), [0, 1, 2, 4, 5, 6]), np.arange(10), np.arange(20, 30))
    cells = np.vstack([cells, [of_third]])
    cells[1, np.isin(cells[1], [14, 15, 16])] -= 10
    return np.vstack([points, third]), cells


@pytest.mark.parametrize(
    ("made", "kind", "said"),
    [
        (lambda: (UNIT_TETRA, [[0, 1, 2, 3]]), "tetra", "has linear tetrahedra .4 nodes.* export quadratic elements"),
        (
            lambda: (np.random.default_rng(1).random((8, 3)), [range(8)]),
            "hexahedron",
            "elements of other kinds .hexahed",
        ),
        (lambda: (UNIT_TETRA, [[0, 1, 2]]), "triangle", "holds no volume elements .triangle."),
        (lambda: (curved()[0] * np.nan, curved()[1]), "tetra10", "no finite numbers"),
        (two_bodies, "tetra10", "holds 2 bodies"),
        (torn, "tetra10", "have different mid-nodes on the edge that they share"),
        (fanned, "tetra10", "has faces that belong to more than two elements"),
        (lambda: (curved()[0][:9], curved()[1]), "tetra10", "elements with nodes that it does not state"),
        (lambda: (np.vstack([UNIT_TETRA, UNIT_TETRA[EDGES].mean(axis=1)]), [range(10)]), "tetra10", "are straight"),
    ],
)
def test_what_is_no_mesh_of_one_valid_quadratic_body_is_refused_in_a_sentence(tmp_path, made, kind, said):
    with pytest.raises(CaseError, match=said) as found:
        part_facts(write(tmp_path / "own.vtu", *made(), kind), 1.0)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("own.msh", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1", "cannot be read as a mesh"),
        ("own.vtu", b"\x00\xff<VTKFile>", "cannot be read as a mesh"),
        ("own.inp", b"*NODE\n1, 0., 0.\n*INCLUDE, INPUT=other.inp\n", "includes other files"),
        ("own.msh", b"", "cannot be read as a mesh"),
        ("own.stl", b"solid", "is no mesh file by its name"),
    ],
)
def test_a_file_that_is_no_mesh_is_refused_in_a_sentence(tmp_path, name, content, said):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(CaseError, match=said):
        part_facts(path, 1.0)


def test_a_mesh_that_changes_meanwhile_is_noticed(tmp_path):
    path = write(tmp_path / "own.msh", *curved())
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    with path.open("a", encoding="ascii") as stream:
        stream.write("\n")
    with pytest.raises(CannotRunError, match=r"own.msh.* changed while it was used"):
        read_mesh(str(path), digest, 1.0)


def test_faces_of_the_boundary_look_outwards(tmp_path, mesh):
    """Their areas as vectors add up to nothing, and they enclose the volume."""
    path = write(tmp_path / "own.msh", mesh.points, mesh.cells)
    found = read_mesh(str(path), hashlib.sha256(path.read_bytes()).hexdigest(), 1.0)
    a, b, c = np.moveaxis(found.points[found.boundary[:, :3]], 1, 0)
    assert np.abs(np.cross(b - a, c - a).sum(axis=0)).max() < 1e-6
    assert np.einsum("kx,kx->", a, np.cross(b, c)) / 6.0 == pytest.approx(mesh.volume, rel=0.01)


def test_inspect_reads_a_mesh_in_a_stated_unit(tmp_path, mesh):
    """An inch is 25.4 mm; the entries state it as the case file does."""
    path = write(tmp_path / "own.msh", mesh.points / 25.4, mesh.cells)
    found = inspect_file(path, None, "inch")
    assert found.facts.volume == pytest.approx(mesh.volume, rel=1e-5)
    assert 'unit = "in" ' in part_entries(found)
