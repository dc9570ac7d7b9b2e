import meshio
import numpy as np
import pytest
import pyvista

from alula.geometry.base.errors import CannotRunError
from alula.reports.page.export import write_vtu


@pytest.fixture(scope="module")
def link(result):
    return result.load_cases["weight"].links["GF"]


@pytest.fixture(scope="module")
def path(link, tmp_path_factory):
    path = tmp_path_factory.mktemp("vtu") / "GF.vtu"
    write_vtu(path, link.governing_case.displacement, link.stress)
    return path


def test_fields_name_their_units(path):
    assert set(meshio.read(path).point_data) == {
        "displacement [mm]", "von Mises stress [MPa]", "first principal stress [MPa]",
        "second principal stress [MPa]", "third principal stress [MPa]", "stress xx [MPa]", "stress yy [MPa]",
        "stress zz [MPa]", "stress xy [MPa]", "stress yz [MPa]", "stress xz [MPa]",
    }  # fmt: skip


def test_values_come_back(path, link):
    read = meshio.read(path)
    assert np.array_equal(read.points, link.stress.space.nodes)
    wanted = {
        "displacement [mm]": link.governing_case.displacement,
        "von Mises stress [MPa]": link.stress.von_mises,
        "first principal stress [MPa]": link.stress.principal.max(axis=1),
        "third principal stress [MPa]": link.stress.principal.min(axis=1),
        "stress xz [MPa]": link.stress.nodal[:, 5],
    }
    for name, values in wanted.items():
        np.testing.assert_allclose(read.point_data[name], values, rtol=1e-6, atol=1e-12)


def test_vtk_reads_quadratic_tetrahedra_in_its_own_node_order(path, link):
    grid = pyvista.read(path)
    assert set(grid.celltypes) == {pyvista.CellType.QUADRATIC_TETRA}
    cells = grid.cells_dict[pyvista.CellType.QUADRATIC_TETRA]
    corners = grid.points[cells[:, :4]]
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    middle = np.stack([(corners[:, a] + corners[:, b]) / 2.0 for a, b in edges], axis=1)
    size = np.ptp(corners, axis=1).max(axis=1)
    # Curved edges bulge by less than a tenth of the element; swapped ones would be off by a half.
    assert (np.linalg.norm(grid.points[cells[:, 4:]] - middle, axis=2).max(axis=1) < 0.15 * size).all()
    volume = np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                       corners[:, 3] - corners[:, 0])  # fmt: skip
    assert (volume > 0.0).all()
    assert len(cells) == link.elements


def test_a_place_that_cannot_be_written_is_named(link, tmp_path):
    with pytest.raises(CannotRunError, match="cannot be written"):
        write_vtu(tmp_path / "missing" / "GF.vtu", link.governing_case.displacement, link.stress)
