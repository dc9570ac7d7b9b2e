import numpy as np
import pytest
import solid_meshes
from known_solutions import law, tensor
from skfem import Basis, ElementVector
from skfem.models.elasticity import linear_elasticity

from alula.fea.common import memory
from alula.fea.elements import elasticity
from alula.fea.elements.elasticity import CURVED_DEGREE, assemble_stiffness, lame_constants
from alula.fea.elements.space import displacement_space
from alula.fea.solid.stress import components
from alula.geometry.base.errors import CannotRunError

E, NU = 2900.0, 0.38


def test_lame_constants_of_a_known_material():
    # Steel: shear modulus 79.3 GPa and λ = 121.15 GPa belong to E = 206.18 GPa, ν = 0.3.
    lam, mu = lame_constants(206_180.0, 0.3)
    assert mu == pytest.approx(79_300.0, rel=1e-12)
    assert lam == pytest.approx(206_180.0 * 0.3 / 0.52, rel=1e-12)


def test_law_in_tension_shear_and_compression():
    tension = np.diag([1.0, -NU, -NU]) * 1e-3
    np.testing.assert_allclose(components(tension, E, NU), [E * 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0], atol=1e-12)
    slide = np.zeros((3, 3))
    slide[0, 1] = 2e-3
    expected = [0.0, 0.0, 0.0, E / (2.0 * (1.0 + NU)) * 2e-3, 0.0, 0.0]
    np.testing.assert_allclose(components(slide, E, NU), expected, atol=1e-12)
    bulk = E / (3.0 * (1.0 - 2.0 * NU))
    np.testing.assert_allclose(components(-1e-3 * np.eye(3), E, NU), [-3e-3 * bulk] * 3 + [0.0] * 3, rtol=1e-12)
    gradient = np.random.default_rng(2).normal(size=(4, 3, 3))
    np.testing.assert_allclose(tensor(components(gradient, E, NU)), law(gradient, E, NU), rtol=1e-12)


def test_rotation_is_free_of_stress():
    spin = np.array([[0.0, -0.3, 0.1], [0.3, 0.0, -0.2], [-0.1, 0.2, 0.0]])
    np.testing.assert_allclose(components(spin, E, NU), 0.0, atol=1e-12)


@pytest.mark.parametrize(("order", "curved"), [(1, False), (2, False), (2, True)])
def test_stiffness_equals_scikit_fem(order, curved):
    space = displacement_space(solid_meshes.box(amount=0.06, curved=curved), order=order)
    assert space.curved.all() == curved
    basis = Basis(solid_meshes.scikit_fem_mesh(space), ElementVector(space.element), intorder=CURVED_DEGREE)
    reference = linear_elasticity(*lame_constants(E, NU)).assemble(basis)
    K = assemble_stiffness(space, E=E, nu=NU)
    assert K.size == space.unknowns == basis.N
    assert abs(K.full() - reference).max() < 1e-12 * abs(reference).max()


def test_mixed_straight_and_curved_elements_equal_scikit_fem():
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=12))
    assert 0 < np.count_nonzero(space.curved) < len(space.cells)
    basis = Basis(solid_meshes.scikit_fem_mesh(space), ElementVector(space.element), intorder=CURVED_DEGREE)
    reference = linear_elasticity(*lame_constants(E, NU)).assemble(basis)
    difference = assemble_stiffness(space, E=E, nu=NU).full() - reference
    assert abs(difference).max() < 1e-12 * abs(reference).max()


def test_chunks_do_not_change_the_matrix(monkeypatch):
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=12))
    whole = assemble_stiffness(space, E=E, nu=NU)
    monkeypatch.setattr(elasticity, "_CHUNK", 17)
    monkeypatch.setattr(elasticity, "_GROUP", 40)
    chunked = assemble_stiffness(space, E=E, nu=NU)
    np.testing.assert_allclose(chunked.blocks, whole.blocks, atol=1e-13 * np.abs(whole.blocks).max())


def test_matrix_is_stored_as_upper_triangle_and_multiplies_as_the_whole():
    K = assemble_stiffness(displacement_space(solid_meshes.box(amount=0.05)), E=E, nu=NU)
    rows = np.repeat(np.arange(K.size // 3), np.diff(K.indptr))
    assert (K.indices >= rows).all()
    np.testing.assert_array_equal(K.indices[K.indptr[:-1]], np.arange(K.size // 3))
    x = np.random.default_rng(3).normal(size=(K.size, 2))
    np.testing.assert_allclose(K @ x, K.full() @ x, atol=1e-9)
    np.testing.assert_allclose(K @ x[:, 0], (K @ x)[:, 0], atol=1e-9)


def test_folded_element_is_refused():
    mesh = solid_meshes.ring(3.0, 5.0, 2.0, around=12, radial=2)
    space = displacement_space(mesh)
    space.nodes[space.cells[np.flatnonzero(space.curved)[0], 4:]] += 1.5
    with pytest.raises(CannotRunError, match=r"folded over"):
        assemble_stiffness(space, E=E, nu=NU)


@pytest.mark.parametrize(("young", "nu"), [(0.0, 0.3), (-1.0, 0.3), (2900.0, 0.5), (2900.0, -0.1), (np.nan, 0.3)])
def test_impossible_material_is_refused(young, nu):
    with pytest.raises(CannotRunError, match=r"no stable compressible material"):
        assemble_stiffness(displacement_space(solid_meshes.box()), E=young, nu=nu)


def test_matrix_beyond_the_memory_limit_is_refused():
    space = displacement_space(solid_meshes.box())
    with pytest.raises(CannotRunError, match=r"stiffness matrix of \d+ unknowns needs about .* raise the limit"):
        assemble_stiffness(space, E=E, nu=NU, memory_limit=memory.resident() + 1e4)
    assemble_stiffness(space, E=E, nu=NU, memory_limit=memory.resident() + 1e9)
