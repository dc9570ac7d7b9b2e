"""Observed orders of convergence on distorted meshes, against a chosen displacement field.

u = a exp(k·x) with the body force that belongs to it; theory: order p in energy, p + 1 in displacement
(Brenner-Scott, The Mathematical Theory of Finite Element Methods, 3rd ed., sec. 5.4).
"""

import numpy as np
import pytest
import solid_meshes
from known_solutions import law

from alula.fea.elements.elasticity import assemble_stiffness, jacobians, lame_constants, reference_basis
from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.solid.stress import stress_field
from alula.fea.solvers.solve import factorise

E, NU = 2900.0, 0.38
A, WAVE = np.array([1.0, -0.6, 0.8]) * 1e-2, np.array([0.9, 0.5, -0.7])


def exact(x):
    return np.exp(x @ WAVE)[..., None] * A


def slope(x):
    return np.exp(x @ WAVE)[..., None, None] * np.outer(A, WAVE)


def body_force(x):
    lam, mu = lame_constants(E, NU)
    return -np.exp(x @ WAVE)[..., None] * ((lam + mu) * (A @ WAVE) * WAVE + mu * (WAVE @ WAVE) * A)


def errors(order, count, curved):
    """Return errors in displacement (L2), energy norm, and recovered nodal stress (largest)."""
    mesh = solid_meshes.box(upper=(1.0, 1.0, 1.0), counts=(count, count, count), amount=0.01, curved=curved)
    space = displacement_space(mesh, order=order)
    volume = volume_quadrature(space)
    load = volume.load_vector(body_force(volume.x), len(space.nodes))
    sides = surface_quadrature(space, "end:1", "sides")
    load += sides.load_vector(np.einsum("kqij,kqj->kqi", law(slope(sides.x), E, NU), sides.normals), len(space.nodes))
    K = assemble_stiffness(space, E=E, nu=NU)
    held = np.unique(space.faces("end:0"))
    fixed = (3 * held[:, None] + np.arange(3)).ravel()
    prescribed = np.zeros_like(space.nodes)
    prescribed[held] = exact(space.nodes[held])
    rhs = load - K @ prescribed.ravel()
    rhs[fixed] = 0.0
    u = factorise(K.with_fixed(fixed), threads=1).solve(rhs).reshape(-1, 3) + prescribed
    gap = np.einsum("qb,kbi->kqi", volume.phi, u[space.cells]) - exact(volume.x)
    _, _, _, gradient = reference_basis(space, 5)
    inverse, _ = jacobians(space.nodes[space.cells], gradient)
    slopes = np.einsum("kqib,kbj->kqji", inverse @ gradient.transpose(0, 2, 1), u[space.cells])
    difference = slopes - slope(volume.x)
    energy = np.einsum("kq,kqij,kqij->", volume.w, law(difference, E, NU), difference)
    recovered = stress_field(space, u, E=E, nu=NU).nodal
    true = law(slope(space.nodes), E, NU)[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    return np.array(
        [np.sqrt(np.einsum("kq,kqi,kqi->", volume.w, gap, gap)), np.sqrt(energy), np.abs(recovered - true).max()]
    )


@pytest.mark.parametrize(("order", "curved", "counts"), [(1, False, (7, 14)), (2, False, (3, 6)), (2, True, (4, 8))])
def test_orders(order, curved, counts):
    found = np.array([errors(order, n, curved) for n in counts])
    orders = np.log(found[-2] / found[-1]) / np.log(counts[-1] / counts[-2])
    assert order + 0.75 < orders[0] < order + 1.5
    assert order - 0.25 < orders[1] < order + 0.4
    assert orders[2] > order - 0.4
