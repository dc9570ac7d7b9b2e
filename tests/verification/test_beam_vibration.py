"""Natural frequencies of single beams against closed forms.

Blevins, Formulas for Natural Frequency and Mode Shape, 1979: tables 8-1 (beams), 8-16 (rods and shafts), 8-8 (mass at
the tip); Timoshenko's beam after Huang, J. Appl. Mech. 28 (1961) 579-584, simply supported, where every half wave
n π/L gives one quadratic in ω².
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from vibrating_frames import DENSITY, LENGTH, POISSON, YOUNG, eigenvalues, frequencies, rectangle, straight

from alula.fea.frame.model import ALL_DOFS
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import buckling_factor, stiffness_parts
from alula.fea.vibration.linkage_modes import frame_modes
from alula.fea.vibration.mass_matrix import MassMatrix, beam_mass, body_mass
from alula.fea.vibration.modes import frequency

SLENDER = rectangle(0.5, 0.8)
HINGED = {"ux", "uy", "uz", "rx", "ry"}
ROLLER = {"uy", "uz", "ry"}
IN_PLANE = {"uz", "rx", "ry"}
"""Held so that bending in the linkage's plane alone is left."""
LINE = DENSITY * SLENDER.area


def bending(beta, section=SLENDER):
    """f = β²/(2π) √(E I/(m L⁴))."""
    return beta**2 / (2.0 * math.pi) * math.sqrt(YOUNG * section.i_z / (DENSITY * section.area * LENGTH**4))


def roots(function, count):
    """First positive roots of a frequency equation, each between two grid places of unlike sign."""
    x = np.linspace(0.2, 4.0 * count + 4.0, 4000)
    y = function(x)
    ends = [i for i in range(len(x) - 1) if y[i] * y[i + 1] < 0.0]
    return [brentq(function, x[i], x[i + 1]) for i in ends][:count]


@pytest.mark.parametrize(
    ("first", "last", "equation"),
    [
        (ALL_DOFS, IN_PLANE, lambda b: np.cos(b) + 1.0 / np.cosh(b)),
        (ALL_DOFS, ALL_DOFS - {"ux"}, lambda b: np.cos(b) - 1.0 / np.cosh(b)),
        (HINGED, ROLLER | {"rx"}, np.sin),
        (ALL_DOFS, ROLLER | {"rx"}, lambda b: np.tanh(b) * np.cos(b) - np.sin(b)),
    ],
    ids=["cantilever", "clamped", "simply supported", "clamped and hinged"],
)
def test_slender_beams_ring_as_euler_and_bernoulli_say(first, last, equation):
    model = straight(SLENDER, first, last)
    expected = [bending(beta) for beta in roots(equation, 3)]
    found = [f for f in frequencies(model, 8, parts=12) if min(abs(f / e - 1.0) for e in expected) < 0.01]
    assert found == pytest.approx(expected, rel=1e-3)


def test_a_free_beam_rings_as_a_clamped_one():
    """Same equation cos b cosh b = 1; its first motions are rigid."""
    divided = subdivide(straight(SLENDER, IN_PLANE, IN_PLANE), 8)
    path = EquilibriumPath(divided)
    K, _ = stiffness_parts(path, np.zeros((8, 2, 6)), np.zeros(0))
    mass = MassMatrix(model=divided, beams=np.array([beam_mass(divided, i, np.full(4, LINE)) for i in range(8)]))
    found = [frequency(value) for value in frame_modes(path, K, mass, 8).values]
    expected = [bending(beta) for beta in roots(lambda b: np.cos(b) - 1.0 / np.cosh(b), 2)]
    assert found[:3] == pytest.approx([0.0, 0.0, 0.0], abs=1e-3 * expected[0])
    assert [min(found, key=lambda f, e=e: abs(f - e)) for e in expected] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("width", [12.0, 25.0])
def test_a_stubby_beam_rings_as_timoshenko_says(width):
    """ρ²/(κ G E) ω⁴ - (ρ A/(E I) + k² ρ/E + k² ρ/(κ G)) ω² + k⁴ = 0 per half wave k = n π/L, with ρ per volume."""
    section = rectangle(width, 0.4 * width)
    shear = YOUNG / (2.0 + 2.0 * POISSON) * 10.0 * (1.0 + POISSON) / (12.0 + 11.0 * POISSON)
    expected = []
    for n in (1, 2, 3):
        k = n * math.pi / LENGTH
        a = DENSITY**2 / (shear * YOUNG)
        b = DENSITY * section.area / (YOUNG * section.i_z) + k**2 * DENSITY * (1.0 / YOUNG + 1.0 / shear)
        expected.append(math.sqrt((b - math.sqrt(b**2 - 4.0 * a * k**4)) / (2.0 * a)) / (2.0 * math.pi))
    found = frequencies(straight(section, HINGED | {"rx"}, ROLLER | {"rx"}), 12, parts=24)
    near = [min(found, key=lambda f, e=e: abs(f - e)) for e in expected]
    assert near == pytest.approx(expected, rel=4e-3)  # the element is of second order where it shears
    assert near[0] == pytest.approx(expected[0], rel=2e-4)
    assert near[0] < 0.99 * bending(math.pi, section)  # shear and rotary inertia count


@pytest.mark.parametrize("share", [0.3, 3.0])
def test_a_mass_at_the_tip_of_a_cantilever(share):
    """1 + cos b cosh b + r b (cos b sinh b - sin b cosh b) = 0, r the tip's mass over the beam's."""
    tip = share * LINE * LENGTH
    found = frequencies(straight(SLENDER, ALL_DOFS, IN_PLANE), 2, bodies=[(1, body_mass(tip, np.zeros(3)))])
    expected = roots(lambda b: 1.0 / np.cosh(b) + np.cos(b) + share * b * (np.cos(b) * np.tanh(b) - np.sin(b)), 2)
    assert found == pytest.approx([bending(b) for b in expected], rel=1e-3)


def test_rods_and_shafts():
    """Fixed and free: f = (2 n - 1)/(4 L) c, with c² = E/ρ, and G J/(ρ (I_y + I_z)) in torsion."""
    along = frequencies(straight(SLENDER, ALL_DOFS, ALL_DOFS - {"ux"}), 40)
    twist = frequencies(straight(SLENDER, ALL_DOFS, ALL_DOFS - {"rx"}), 40)
    shear = YOUNG / (2.0 + 2.0 * POISSON)
    speeds = math.sqrt(YOUNG / DENSITY), math.sqrt(shear * SLENDER.torsion / (DENSITY * (SLENDER.i_y + SLENDER.i_z)))
    for found, speed in zip((along, twist), speeds, strict=True):
        expected = speed / (4.0 * LENGTH)
        assert min(found, key=lambda f, e=expected: abs(f - e)) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("share", [-0.99, -0.5, 0.5, 3.0])
def test_tension_tunes_a_beam_and_compression_takes_it_to_buckling(share):
    """Simply supported: f = f0 √(1 + P/P_cr), of every half wave n with n² P_cr."""
    critical = math.pi**2 * YOUNG * SLENDER.i_z / LENGTH**2
    held = (HINGED, ROLLER | {"rx"})
    plain = frequencies(straight(SLENDER, *held), 1)[0]
    pulled = straight(SLENDER, *held, loads=[(1, [share * critical, 0, 0, 0, 0, 0])])
    assert frequencies(pulled, 1)[0] == pytest.approx(
        plain * math.sqrt(1.0 + share), rel=5e-3 if share < -0.9 else 1e-3
    )


def test_the_frequency_falls_to_nothing_at_the_buckling_load():
    held = (HINGED, ROLLER | {"rx"})
    factor = buckling_factor(straight(SLENDER, *held, loads=[(1, [-1.0, 0, 0, 0, 0, 0])]))
    values = [
        eigenvalues(straight(SLENDER, *held, loads=[(1, [-s * factor, 0, 0, 0, 0, 0])]), 1)[0]
        for s in (0.0, 1.0 - 1e-6, 1.0 + 1e-6, 2.0)
    ]
    assert 0.0 < values[1] < 1e-5 * values[0]
    assert -1e-5 * values[0] < values[2] < 0.0
    assert values[3] == pytest.approx(-values[0], rel=1e-4)
