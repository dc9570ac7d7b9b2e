"""Patch tests: a field of even strain is reproduced exactly, whatever the shape of the elements."""

import numpy as np
import pytest
import solid_meshes

from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.solid.solution import solve_free
from alula.fea.solid.stress import stress_field
from alula.fea.solvers.solve import factorise
from alula.geometry.meshing.mirror import mirrored

E, NU = 2900.0, 0.38
SLOPE = np.array([[1.0, 0.4, -0.2], [0.1, -0.5, 0.3], [0.0, 0.2, 0.7]]) * 1e-3


@pytest.fixture(params=["linear", "quadratic straight", "quadratic curved", "ring", "two halves"])
def space(request):
    if request.param == "ring":
        return displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=12))
    if request.param == "two halves":
        return displacement_space(mirrored(solid_meshes.raised(solid_meshes.ring(3.0, 5.0, 1.0, around=12, layers=1))))
    mesh = solid_meshes.box(amount=0.07, curved=request.param.endswith("curved"))
    return displacement_space(mesh, order=1 if request.param == "linear" else 2)


def even_stress():
    lam, mu = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    strain = (SLOPE + SLOPE.T) / 2.0
    return lam * np.trace(strain) * np.eye(3) + 2.0 * mu * strain


def test_displacement_patch(space):
    """Boundary displaced linearly: the inner nodes follow, and no inner node is loaded."""
    exact = space.nodes @ SLOPE.T
    K = assemble_stiffness(space, E=E, nu=NU)
    edge = np.unique(space.boundary)
    inner = np.setdiff1d(np.arange(len(space.nodes)), edge)
    assert len(inner) > 0
    forces = (K @ exact.ravel()).reshape(-1, 3)
    assert np.abs(forces[inner]).max() < 1e-12 * np.abs(forces).max()
    fixed = (3 * edge[:, None] + np.arange(3)).ravel()
    prescribed = np.zeros_like(exact)
    prescribed[edge] = exact[edge]
    rhs = -(K @ prescribed.ravel())
    rhs[fixed] = 0.0
    solved = factorise(K.with_fixed(fixed), threads=1).solve(rhs).reshape(-1, 3) + prescribed
    np.testing.assert_allclose(solved, exact, atol=1e-11 * np.abs(exact).max())


def test_traction_patch(space):
    """Tractions of an even stress on the whole boundary: the stress is even, in a free body, by halves or not."""
    sigma = even_stress()
    faces = surface_quadrature(space, *space.surfaces)
    load = faces.load_vector(faces.normals @ sigma, len(space.nodes))
    free = solve_free(space, load[:, None], E=E, nu=NU, threads=1)
    assert np.abs(free.reactions).max() < 1e-9 * np.abs(load).max()
    field = stress_field(space, free.displacement.reshape(-1, 3), E=E, nu=NU)
    expected = sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    np.testing.assert_allclose(field.nodal, np.broadcast_to(expected, field.nodal.shape), atol=1e-8)


def test_whole_stiffness_has_six_rigid_motions_and_no_other(space):
    full = assemble_stiffness(space, E=E, nu=NU).full().toarray()
    values = np.linalg.eigvalsh(full)
    assert np.abs(values[:6]).max() < 1e-11 * values[-1]
    assert values[6] > 1e-7 * values[-1]
