import dataclasses
import math
from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from skfem import Basis, ElementVector

from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.geometry.base.errors import CannotRunError


@pytest.mark.parametrize(("order", "curved"), [(1, False), (2, False), (2, True)])
def test_numbering_is_that_of_scikit_fem(order, curved):
    space = displacement_space(solid_meshes.box(amount=0.05, curved=curved), order=order)
    basis = Basis(solid_meshes.scikit_fem_mesh(space), ElementVector(space.element))
    expected = 3 * np.sort(space.cells, axis=1)
    np.testing.assert_array_equal(np.sort(basis.dofs.element_dofs[::3].T, axis=1), expected)
    if order == 2:
        np.testing.assert_allclose(basis.mesh.doflocs.T, space.nodes)


def test_mirrored_elements_are_turned_round():
    mesh = solid_meshes.ring(3.0, 5.0, 2.0, around=12)
    mirrored = dataclasses.replace(mesh, points=mesh.points * (1.0, 1.0, -1.0))
    one, other = displacement_space(mesh), displacement_space(mirrored)
    assert volume_quadrature(other).measure == pytest.approx(volume_quadrature(one).measure, rel=1e-12)


def test_points_that_no_element_uses_are_left_out():
    mesh = solid_meshes.box()
    spare = dataclasses.replace(
        mesh,
        points=np.vstack([[9.0, 9.0, 9.0], mesh.points]),
        cells=mesh.cells + 1,
        surfaces={name: triangles + 1 for name, triangles in mesh.surfaces.items()},
    )
    space = displacement_space(spare)
    expected = displacement_space(mesh)
    np.testing.assert_allclose(space.nodes, expected.nodes)
    np.testing.assert_array_equal(space.cells, expected.cells)
    assert surface_quadrature(space, "end:1").measure == pytest.approx(1.1 * 0.9, rel=1e-12)


def test_rounding_of_a_mesher_leaves_edges_straight_and_a_bow_does_not():
    mesh = solid_meshes.box(counts=(3, 2, 2), curved=True)
    middle = mesh.cells[:, 4:]
    noise = np.zeros_like(mesh.points)
    noise[np.unique(middle)] = 1e-11 * np.random.default_rng(1).normal(size=(len(np.unique(middle)), 3))
    space = displacement_space(replace(mesh, points=mesh.points + noise))
    assert not space.curved.any()
    np.testing.assert_array_equal(space.nodes[space.cells[:, 4]], space.nodes[space.cells[:, :2]].mean(axis=1))
    noise[middle[0, 0]] = 1e-6
    bowed = displacement_space(replace(mesh, points=mesh.points + noise))
    assert set(np.flatnonzero(bowed.curved)) == set(np.flatnonzero((middle == middle[0, 0]).any(axis=1)))


def test_curved_volume_and_surface_come_near_the_circle():
    curved = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=16))
    straight = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=16, curved=False))
    area, volume = 2.0 * math.pi * 3.0 * 2.0, math.pi * 16.0 * 2.0
    assert surface_quadrature(curved, "bore:A").measure == pytest.approx(area, rel=1e-4)
    assert volume_quadrature(curved).measure == pytest.approx(volume, rel=1e-4)
    assert volume_quadrature(straight).measure < 0.98 * volume


def test_normals_point_out_of_the_body():
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=16))
    for name, sign in (("bore:A", -1.0), ("outside", 1.0)):
        face = surface_quadrature(space, name)
        radial = face.x * (1.0, 1.0, 0.0)
        cosine = np.einsum("kqi,kqi->kq", radial / np.linalg.norm(radial, axis=2)[..., None], face.normals)
        np.testing.assert_allclose(cosine, sign, atol=1e-2)
    assert (surface_quadrature(space, "top:A").normals[..., 2] > 0.999).all()
    assert (surface_quadrature(space, "bottom:A").normals[..., 2] < -0.999).all()


def test_closed_boundary_has_no_resultant():
    # Gauss: the integral of the normal over a closed surface vanishes, that of x·n is three volumes.
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=12))
    whole = surface_quadrature(space, "bore:A", "outside", "top:A", "bottom:A")
    np.testing.assert_allclose(np.einsum("kq,kqi->i", whole.w, whole.normals), 0.0, atol=1e-11)
    flux = float(np.einsum("kq,kqi,kqi->", whole.w, whole.x, whole.normals))
    assert flux / 3.0 == pytest.approx(volume_quadrature(space).measure, rel=1e-10)


def test_unknown_surface_is_named():
    space = displacement_space(solid_meshes.box())
    with pytest.raises(CannotRunError, match=r"no surface 'bore:Q'; it has end:0, end:1, sides"):
        space.faces("bore:Q")


def test_triangle_inside_the_body_is_refused():
    mesh = solid_meshes.box()
    inside = {**mesh.surfaces, "end:0": mesh.cells[:, :3]}
    with pytest.raises(CannotRunError, match=r"'end:0' holds triangles that are no boundary faces"):
        displacement_space(dataclasses.replace(mesh, surfaces=inside))


def test_flat_element_is_refused():
    mesh = solid_meshes.box()
    points = mesh.points.copy()
    points[:, 2] = 0.0
    with pytest.raises(CannotRunError, match=r"flat"):
        displacement_space(dataclasses.replace(mesh, points=points))
