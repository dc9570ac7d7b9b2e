import numpy as np
import pytest
import solid_meshes

from alula.fea.elements.space import displacement_space
from alula.fea.refine.error_estimate import energy_density
from alula.fea.solid.stress import extreme_principal, principal, stress_field, von_mises
from alula.geometry.base.errors import CannotRunError

E, NU = 2900.0, 0.38


def test_von_mises_in_closed_form():
    assert von_mises(np.array([7.0, 0, 0, 0, 0, 0])) == pytest.approx(7.0)
    assert von_mises(np.array([0, 0, 0, 2.0, 0, 0])) == pytest.approx(2.0 * np.sqrt(3.0))
    assert von_mises(np.array([5.0, 5.0, 5.0, 0, 0, 0])) == 0.0
    assert von_mises(np.array([100.0, -60.0, 0, 0, 0, 0])) == pytest.approx(140.0)


def test_principal_stresses_keep_their_sign():
    # Shigley, 10th ed., chapter 3: 80 MPa along x with 50 MPa of clockwise shear give 104 and -24 MPa.
    np.testing.assert_allclose(principal(np.array([80.0, 0, 0, -50.0, 0, 0])), [104.031, 0.0, -24.031], atol=1e-3)
    np.testing.assert_allclose(principal(np.array([[-3.0, -1.0, -2.0, 0, 0, 0]])), [[-1.0, -2.0, -3.0]])


@pytest.mark.parametrize(("order", "curved"), [(1, False), (2, False), (2, True)])
def test_even_strain_gives_even_stress(order, curved):
    space = displacement_space(solid_meshes.box(amount=0.05, curved=curved), order=order)
    slope = np.array([[1.0, 0.4, -0.2], [0.1, -0.5, 0.3], [0.0, 0.2, 0.7]]) * 1e-3
    field = stress_field(space, space.nodes @ slope.T, E=E, nu=NU)
    lam, mu = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    strain = (slope + slope.T) / 2.0
    tensor = lam * np.trace(strain) * np.eye(3) + 2.0 * mu * strain
    expected = tensor[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    np.testing.assert_allclose(field.nodal, np.broadcast_to(expected, field.nodal.shape), atol=1e-11)
    np.testing.assert_allclose(field.at_points, np.broadcast_to(expected, field.at_points.shape), atol=1e-11)
    energy = 0.5 * np.tensordot(tensor, strain) * 3.0 * 1.1 * 0.9
    stored = float((field.weights * energy_density(field.at_points, E, NU)).sum()) / 2.0
    assert stored == pytest.approx(energy, rel=2e-3 if curved else 1e-10)


@pytest.fixture(scope="module")
def bent():
    """Pure bending about z and y with tension: σxx = 2 + 3 y − 5 z exactly (Timoshenko-Goodier, art. 102)."""
    space = displacement_space(
        solid_meshes.box(lower=(0, -1.0, -0.6), upper=(8.0, 1.0, 0.6), counts=(8, 3, 3), amount=0.05)
    )
    x, y, z = space.nodes.T
    a, b, c = 2.0 / E, 3.0 / E, -5.0 / E
    u = a * x + b * x * y + c * x * z
    v = -NU * a * y - b * (x**2 + NU * (y**2 - z**2)) / 2.0 - c * NU * y * z
    w = -NU * a * z - c * (x**2 + NU * (z**2 - y**2)) / 2.0 - b * NU * y * z
    return stress_field(space, np.column_stack([u, v, w]), E=E, nu=NU)


def test_section_stress_of_bending_and_tension(bent):
    section = bent.section(x=4.0, half_length=0.8, half_y=1.0, half_z=0.6)
    assert section.axial == pytest.approx(2.0, rel=1e-9)
    assert section.bending_z == pytest.approx(3.0, rel=1e-9)
    assert section.bending_y == pytest.approx(-3.0, rel=1e-9)
    assert section.scatter < 1e-9


def test_peak_is_found_where_it_is(bent):
    assert bent.peak.value == pytest.approx(8.0, rel=1e-9)
    np.testing.assert_allclose(bent.peak.location[1:], [1.0, -0.6], atol=1e-12)
    inside = bent.peak_at_points
    assert 7.0 < inside.value < 8.0
    _, y, z = inside.location
    assert inside.value == pytest.approx(2.0 + 3.0 * y - 5.0 * z, rel=1e-9)
    np.testing.assert_allclose(bent.principal[:, 0], np.maximum(bent.nodal[:, 0], 0.0), atol=1e-9)


def test_section_beside_the_body_is_refused(bent):
    with pytest.raises(CannotRunError, match=r"too coarse for a section of 0\.2 mm at x = 40 mm"):
        bent.section(x=40.0, half_length=0.1, half_y=1.0, half_z=0.6)


def test_extreme_principal_stresses_are_the_eigenvalues():
    rng = np.random.default_rng(5)
    scale = np.logspace(-6, 6, 4000)
    sigma = rng.normal(size=(4000, 6)) * scale[:, None]
    sigma[0] = 0.0
    sigma[1] = [3.0, 3.0, 3.0, 0.0, 0.0, 0.0]
    sigma[2] = [5.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    sigma[3] = [0.0, -5.0, 0.0, 0.0, 0.0, 0.0]
    sigma[4] = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0]
    exact, (first, last) = principal(sigma), extreme_principal(sigma)
    size = np.abs(exact).max(axis=1) + 1e-300
    assert (np.abs(first - exact[:, 0]) < 1e-7 * size).all()
    assert (np.abs(last - exact[:, 2]) < 1e-7 * size).all()
