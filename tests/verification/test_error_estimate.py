"""The recovery-based estimate against true errors: a smooth field on distorted meshes, a cylinder, a hole."""

import known_solutions as known
import numpy as np
import pytest
import solid_meshes
from known_solutions import NU, E

from alula.fea.elements.elasticity import jacobians, reference_basis
from alula.fea.refine.error_estimate import energy_density, estimate_error
from alula.fea.solid.stress import stress_field

DEGREE = 5


def true_error(space, displacement, exact):
    """Energy norm of σ − σ_h by a rule of degree 5, from the displacements alone."""
    _, W, phi, gradient = reference_basis(space, DEGREE)
    nodes = space.nodes[space.cells]
    inverse, determinant = jacobians(nodes, gradient)
    slopes = np.einsum("kqij,qbj,kba->kqai", inverse, gradient, displacement[space.cells], optimize=True)
    gap = known.tensor(exact(np.einsum("qb,kbi->kqi", phi, nodes))) - known.law(slopes, E, NU)
    compliance = ((1.0 + NU) * gap - NU * np.trace(gap, axis1=-2, axis2=-1)[..., None, None] * np.eye(3)) / E
    return float(np.sqrt(np.einsum("kq,kqij,kqij->", determinant * W, gap, compliance)))


def effectivity(mesh, exact, order=2):
    space, displacement = known.solved(mesh, exact, order=order)
    field = stress_field(space, displacement, E=E, nu=NU)
    estimate = estimate_error(field, displacement, E=E, nu=NU)
    true = true_error(space, displacement, exact)
    relative = true / np.hypot(estimate.energy_norm, true)
    return estimate.total / true, estimate.relative / relative, relative


def saddle(x):
    """Antiplane and plane parts of harmonic stress functions: smooth, in equilibrium and compatible."""
    a, b, c = x[..., 0], x[..., 1], x[..., 2]
    out = np.zeros((*x.shape[:-1], 6))
    growth = np.exp(1.5 * a)
    out[..., 5], out[..., 4] = growth * np.sin(1.5 * b), growth * np.cos(1.5 * b)  # u_z harmonic in x, y
    # Airy's function e^(2x) cos 2y with plane strain
    plane = 4.0 * np.exp(2.0 * a) * np.cos(2.0 * b)
    out[..., 0], out[..., 1] = -plane, plane
    out[..., 3] = 4.0 * np.exp(2.0 * a) * np.sin(2.0 * b)
    return out + 0.0 * c[..., None]


@pytest.mark.parametrize(
    ("order", "count", "amount", "curved"),
    [(1, 5, 0.01, False), (2, 2, 0.01, False), (2, 4, 0.02, False), (2, 3, 0.01, True), (2, 5, 0.02, True)],
)
def test_smooth_field_on_distorted_boxes(order, count, amount, curved):
    mesh = solid_meshes.box(upper=(1.0, 1.0, 1.0), counts=(count,) * 3, amount=amount, curved=curved)
    absolute, relative, size = effectivity(mesh, saddle, order)
    assert 1e-3 < size < 0.5
    assert 0.5 < absolute < 2.0
    assert 0.5 < relative < 2.0


@pytest.mark.parametrize(("around", "radial", "layers"), [(8, 1, 1), (12, 3, 1), (24, 6, 2)])
@pytest.mark.parametrize("curved", [True])
def test_cylinder_under_pressure(around, radial, layers, curved):
    mesh = solid_meshes.ring(1.0, 2.0, 0.5, around=around, radial=radial, layers=layers, curved=curved)
    absolute, _, size = effectivity(mesh, known.lame)
    assert size > 0.01
    assert 0.5 < absolute < 2.0


@pytest.mark.parametrize(("around", "radial", "grading"), [(8, 2, 1.0), (16, 4, 1.0), (16, 5, 1.5), (24, 6, 1.5)])
def test_hole_in_tension(around, radial, grading):
    mesh = solid_meshes.ring(1.0, 4.0, 0.6, around=around, radial=radial, layers=1, grading=grading)
    absolute, _, size = effectivity(mesh, known.kirsch)
    assert size > 0.01
    assert 0.5 < absolute < 2.0


def test_a_linear_displacement_has_no_error():
    def constant(x):
        return np.broadcast_to([3.0, -1.0, 2.0, 0.5, 0.0, 1.0], (*x.shape[:-1], 6))

    mesh = solid_meshes.box(counts=(3, 2, 2), amount=0.02, curved=True)
    space, displacement = known.solved(mesh, constant)
    field = stress_field(space, displacement, E=E, nu=NU)
    estimate = estimate_error(field, displacement, E=E, nu=NU)
    assert estimate.relative < 1e-9
    assert estimate.stress.max() < 1e-8
    stored = float((field.weights * energy_density(field.at_points, E, NU)).sum())
    assert estimate.energy_norm**2 == pytest.approx(stored)


def test_energy_density_is_stress_times_strain():
    sigma = np.array([3.0, -1.0, 2.0, 0.5, -0.7, 1.0])
    gradient = np.array([[0.01, 0.02, 0.0], [-0.004, -0.02, 0.003], [0.006, 0.0, 0.005]])
    strain = (gradient + gradient.T) / 2.0
    whole = known.law(gradient, E, NU)
    sigma = np.array([whole[0, 0], whole[1, 1], whole[2, 2], whole[0, 1], whole[1, 2], whole[0, 2]])
    assert energy_density(sigma, E, NU) == pytest.approx((whole * strain).sum())
