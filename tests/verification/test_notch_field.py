"""Stress ahead of notches and over the volume, beside closed forms.

Kirsch's hole across its pull: σ = S/2 (2 + 1/r² + 3/r⁴), whose mean from 1 to 1 + 2 L follows by integration. A crack
of half length a in a wide plate has S x/√(x² - a²) ahead of it (Westergaard), whose mean over 2 L is S √(1 + a/L).
Bending of a rectangle: half of it is pulled, ∫ (y/h)^m dV = V/(2 (m + 1)).
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import solid_meshes
from known_solutions import NU, TENSION, E, kirsch, solved

from alula.fea.elements.elasticity import basis_at
from alula.fea.elements.space import displacement_space
from alula.fea.solid import notch_field
from alula.fea.solid.notch_field import NotchField, element_finder, line_depths
from alula.fea.solid.stress import stress_field
from alula.geometry.materials.brittle_notch import NotchStrength, critical_distance


@cache
def hole():
    """Ring of radii 1 and 5 under the tractions of Kirsch's plate, plane strain, 0.5 thick."""
    mesh = solid_meshes.ring(1.0, 5.0, 0.5, around=32, radial=12, layers=2, grading=1.6)
    space, moved = solved(mesh, kirsch)
    return NotchField(field=stress_field(space, moved, E=E, nu=NU))


def bar(move, cells=(6, 2, 12)):
    """Bar 6 by 1 by 2 whose nodes move by a law (x, y, z) -> (3,)."""
    space = displacement_space(solid_meshes.box((0.0, -0.5, -1.0), (6.0, 0.5, 1.0), cells))
    return NotchField(field=stress_field(space, np.stack(move(*space.nodes.T), axis=-1), E=E, nu=NU))


def pulled(x, y, z):
    """σ = 10."""
    strain = TENSION / E
    return strain * x, -NU * strain * y, -NU * strain * z


def bent(x, y, z):
    """σ = 10 z about the middle of the height."""
    k = TENSION / E
    return k * x * z, -NU * k * y * z, -k / 2.0 * (x**2 + NU * (z**2 - y**2))


def strength(distance, inherent=100.0, ultimate=100.0):
    return NotchStrength(distance=distance, inherent=inherent, ultimate=ultimate)


@pytest.mark.parametrize("distance", [0.05, 0.2, 0.5])
def test_kirschs_hole_by_point_and_line(distance):
    """Rims and flat faces beside the hole do not keep its peak: lines run along them."""

    def stress(r):
        return TENSION / 2.0 * (2.0 + 1.0 / r**2 + 3.0 / r**4)

    def whole(r):
        return TENSION / 2.0 * (2.0 * r - 1.0 / r - 1.0 / r**3)

    point, line = hole().worst(strength(distance))
    end = 1.0 + 2.0 * distance
    assert point.ahead == pytest.approx(stress(1.0 + distance / 2.0), rel=0.02)
    assert line.ahead == pytest.approx((whole(end) - whole(1.0)) / (2.0 * distance), rel=0.02)
    wall = end + 2.0 * distance * (3.0 if distance == 0.5 else 7.0)  # the ring ends at 5
    straight = stress(end) + (stress(end) - stress(min(wall, 5.0))) / (3.0 if distance == 0.5 else 7.0)
    assert point.plain == pytest.approx(straight, rel=0.02)
    assert point.counts
    assert np.hypot(*hole().field.space.nodes[point.node, :2]) == pytest.approx(1.0, abs=0.01)


def test_beyond_the_line_a_plain_part_has_its_tensile_strength():
    """An inherent strength far above the tensile one does not lift the stress that no notch makes.

    Of all lines that begin about the hole the worst ends nearer to it than the one across the pull; the ring ends at 4
    lengths of the line.
    """
    point, line = hole().worst(strength(0.5, inherent=1000.0))
    assert point.counts
    assert point.use == line.use == pytest.approx(TENSION * (1.219 + (1.219 - 1.022) / 3.0) / 100.0, rel=0.08)


def test_a_line_does_not_run_along_the_pull():
    """A hanging bar, σ = 10 x: stress falls along itself alone, across which it is even."""

    def hung(x, y, z):
        k = TENSION / E
        return k / 2.0 * (x**2 + NU * (y**2 + z**2)), -NU * k * x * y, -NU * k * x * z

    point, _ = bar(hung, (3, 1, 1)).worst(strength(0.2))
    assert not point.counts
    assert point.use == pytest.approx(0.6)


def test_the_sharpest_peak_is_not_the_one_that_breaks():
    """Half of the bar has 30 that falls to nothing within 0.5, the other half 20 throughout."""
    field = bar(pulled, (12, 4, 12)).field
    x, _, z = field.space.nodes.T
    nodal = np.zeros_like(field.nodal)
    nodal[:, 0] = np.where(x < 2.9, np.maximum(30.0 * (1.0 - (1.0 - z) / 0.5), 0.0), 20.0)
    point, _ = NotchField(field=replace(field, nodal=nodal)).worst(strength(0.4))
    assert field.space.nodes[point.node, 0] > 2.9
    assert point.use == pytest.approx(0.2)


def test_points_are_found_in_curved_elements():
    space = displacement_space(solid_meshes.ring(1.0, 3.0, 0.5, around=8, radial=2, layers=1))
    place = np.random.default_rng(1).dirichlet(np.ones(4), len(space.cells))[:, :3]
    phi, _ = basis_at(space, place.T)
    element, found = element_finder(space)(np.einsum("kb,kbi->ki", phi, space.nodes[space.cells]))
    assert (element == np.arange(len(space.cells))).all()
    assert np.abs(found - place).max() < 1e-6


def test_a_line_that_leaves_a_thin_wall_takes_nothing_off():
    point, line = bar(bent).worst(strength(1.1))
    assert not point.counts
    assert point.use == line.use == pytest.approx(TENSION / 100.0, rel=0.01)


def test_a_crack_breaks_at_its_toughness():
    toughness, inherent, crack = 32.0, 40.0, 3.0
    distance = critical_distance(toughness, inherent)
    depths, weights = line_depths(distance)
    at_tip = toughness / np.sqrt(2.0 * np.pi * np.array([distance / 2.0, *depths]))
    assert at_tip[0] == pytest.approx(inherent)
    assert weights @ at_tip[1:] == pytest.approx(inherent)
    x = crack + depths
    mean = weights @ (x / np.sqrt(x**2 - crack**2))
    assert mean == pytest.approx(np.sqrt(1.0 + crack / distance), rel=1e-4)
    # S = σ0/mean: K = S √(π (a + L)) is the toughness, as of a crack longer by L
    assert inherent / mean * np.sqrt(np.pi * (crack + distance)) == pytest.approx(toughness, rel=1e-4)


def test_a_small_hole_is_not_felt():
    """Kirsch's hole of 1/50 of the critical distance: what is ahead of it is the pull itself."""
    depths, weights = line_depths(50.0)
    r = 1.0 + np.array([25.0, *depths])
    stress = 0.5 * (2.0 + 1.0 / r**2 + 3.0 / r**4)
    assert stress[0] == pytest.approx(1.0, abs=0.001)
    assert weights @ stress[1:] == pytest.approx(1.0, abs=0.02)


def test_even_tension_uses_the_tensile_strength_and_the_whole_volume():
    field = bar(pulled, (3, 1, 1))
    point, line = field.worst(strength(0.1, inherent=150.0))
    assert (point.counts, line.counts) == (False, False)
    assert point.use == pytest.approx(0.1)
    assert field.effective_volume(7.0) == pytest.approx(12.0)


@pytest.mark.parametrize("modulus", [3.0, 8.0])
def test_the_effective_volume_of_pure_bending(modulus):
    assert bar(bent).effective_volume(modulus) == pytest.approx(12.0 / (2.0 * (modulus + 1.0)), rel=0.02)


@pytest.mark.parametrize("axial", [0.0, 0.5, -0.5, 1.5])
@pytest.mark.parametrize(("distance", "inherent"), [(0.1, 100.0), (0.2, 100.0), (0.4, 150.0)])
def test_a_plain_strip_bent_and_pulled_has_no_notch(axial, distance, inherent):
    """Stress falls straight through its height, in tension all of it or not: it breaks at the tensile strength."""

    def both(x, y, z):
        return tuple(np.add(bent(x, y, z), np.multiply(axial, pulled(x, y, z))))

    for one in bar(both, (3, 1, 4)).worst(strength(distance, inherent)):
        assert not one.counts
        assert one.use == pytest.approx(TENSION * (1.0 + axial) / 100.0, rel=0.01)


def test_an_inherent_strength_below_the_tensile_one_is_looked_for_everywhere(monkeypatch):
    """The cooler half has the blunter notch: below the surface stress that the other's reaches by its strength."""
    monkeypatch.setattr(notch_field, "_BATCH", 1)
    field = bar(pulled, (12, 4, 12)).field
    x, _, z = field.space.nodes.T
    nodal = np.zeros_like(field.nodal)
    nodal[:, 0] = np.where(x < 2.9, 30.0 * np.exp((z - 1.0) / 0.2), 15.0 * np.exp((z - 1.0) / 0.8))
    point, _ = NotchField(field=replace(field, nodal=nodal)).worst(strength(0.4, inherent=50.0))
    assert field.space.nodes[point.node, 0] > 2.9
    assert point.use == pytest.approx(15.0 * np.exp(-0.25) / 50.0, rel=0.02)


def test_nothing_in_tension_breaks_nowhere():
    def pressed(x, y, z):
        return tuple(-1e-3 * (1.0 - 2.0 * NU) * a for a in (x, y, z))

    assert bar(pressed, (2, 1, 1)).worst(strength(0.1)) is None
