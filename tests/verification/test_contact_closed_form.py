"""A pin in a hole of the same material: the closed form against its own conditions, Hertz, and contact by elements."""

import numpy as np
import pytest
from scipy.integrate import quad

from alula.loads.records.contact import CONFORMAL, half_angle, pressure, tightness
from benchmarks import contact_plane

ANGLES = [0.05, 0.3, 1.0, CONFORMAL, 2.2]


@pytest.mark.parametrize("alpha", ANGLES)
def test_resultant_is_the_force(alpha):
    """∫ p cos θ t R dθ = F, hence 1/2 ∫ (p d t/F) cos θ dθ = 1."""
    assert quad(lambda a: 0.5 * float(pressure(a, alpha)) * np.cos(a), -alpha, alpha)[0] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("alpha", ANGLES)
def test_walls_meet_where_they_touch_and_nowhere_else(alpha):
    """By series of the walls' motions under cos nθ, in units of R F/(E d t); ΔR is E c t/F in these.

    The motion of wall and disc under cos nθ is 4 n/(n² - 1) together, from Michell's solution, and 2 for n = 0.
    """
    theta = (np.arange(40_000) + 0.5) * 2.0 * np.pi / 40_000 - np.pi
    n = np.arange(2, 4_000)
    p = pressure(theta, alpha)
    coefficient = 2.0 * (np.exp(-1j * n * theta[0]) * np.fft.fft(p)[n]).real / len(theta)

    def gap(angle):
        own = (4.0 * n / (n**2 - 1.0) * coefficient * np.cos(np.multiply.outer(angle, n))).sum(axis=-1)
        return float(tightness(alpha)) + 2.0 * p.mean() + own

    shift = gap(0.0)
    inside, outside = np.linspace(0.0, 0.98 * alpha, 9), np.linspace(1.02 * alpha, 3.1, 9)
    assert gap(inside) == pytest.approx(shift * np.cos(inside), rel=1e-6, abs=2e-5 * abs(shift))
    assert np.all(gap(outside) > shift * np.cos(outside))


def test_far_from_fitting_it_is_hertz():
    """Johnson, equations 4.43 and 4.45: half width² = 4 P R'/(π E*), p0 = 2P/(π a), with 1/E* = 2/E, 1/R' = ΔR/R²."""
    d, c, t, E, F = 3.0, 0.03, 4.0, 2500.0, 0.5
    reduced, modulus = (d / 2) ** 2 / (c / 2), E / 2
    a = np.sqrt(4.0 * F / t * reduced / (np.pi * modulus))
    alpha = half_angle(E * c * t / F)
    assert alpha == pytest.approx(a / (d / 2), rel=4e-3)
    assert pressure(0.0, alpha) * F / (d * t) == pytest.approx(2.0 * F / t / (np.pi * a), rel=4e-3)


def test_conformal_pin():
    """Without clearance the half angle does not depend on the load; it is far from 90°, and the pressure no cosine."""
    assert half_angle(0.0) == pytest.approx(CONFORMAL, abs=1e-12)
    assert tightness(CONFORMAL) == pytest.approx(0.0, abs=1e-12)
    assert np.degrees(CONFORMAL) == pytest.approx(84.83, abs=0.01)


def test_angle_falls_with_clearance_and_is_found_again():
    clearances = np.geomspace(1e-3, 1e5, 30)
    found = half_angle(clearances)
    assert np.all(np.diff(found) < 0.0)
    assert tightness(found) == pytest.approx(clearances, rel=1e-9)


@pytest.fixture(scope="module")
def plate():
    hole = contact_plane.plate(20.0, finest=0.8)
    return hole, contact_plane.pin(hole.corners)


@pytest.mark.parametrize("clearance", [0.0, 1.0, 10.0, 100.0])
def test_against_contact_by_elements(plate, clearance):
    """Quadratic elements and active sets, in a disc of 20 diameters, ν = 0.3, of which the closed form has nothing.

    The finest elements are 0.8°; at the end of contact, where the pressure is a root, one hat takes part of it.
    """
    hole, pin = plate
    found = contact_plane.contact(hole, clearance, pin)
    expected = pressure(hole.corners, half_angle(clearance))
    assert found.max() == pytest.approx(expected.max(), rel=5e-3)
    assert np.sqrt((hole.widths * (found - expected) ** 2).sum() / (hole.widths * expected**2).sum()) < 0.03
