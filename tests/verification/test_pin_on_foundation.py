"""The pressure along a hole by a pin that bends in it: closed forms against Hetényi's and finite differences."""

import math
from dataclasses import replace

import numpy as np
import pytest

from alula.geometry.bodies.features import Ring
from alula.geometry.bodies.seat import Seat
from alula.loads.statics.foundation import STIFF, Foundation
from alula.loads.statics.pressing import pressing
from benchmarks import bore_stiffness

SOFT = [1.5, 2.0, 3.0, 5.0]
L = 4.0


def differences(softness, force, couple, both=False, n=1500):
    """Pressure per length at n points by finite differences of E I w'''' + k w = 0 in units of L = 1 and 4 E I = 1.

    The loads are at the upper rim: a force, and a couple that adds to the first moment; ``both`` puts half of the force
    at either rim, without couples.
    """
    h, k = 1.0 / (n - 1), softness**4
    # Energy: 1/2 Σ (EI w''² + k w²) h - work, which has the rims' conditions in itself.
    bend = np.zeros((n - 2, n))
    for i in range(n - 2):
        bend[i, i : i + 3] = np.array([1.0, -2.0, 1.0]) / h**2
    weight = np.full(n, h)
    weight[[0, -1]] = h / 2.0
    load = np.zeros(n)
    load[-1] += force / 2.0 if both else force
    load[0] += force / 2.0 if both else 0.0
    load[-1] += couple / h
    load[-2] -= couple / h
    w = np.linalg.solve(0.25 * h * bend.T @ bend + k * np.diag(weight), load)
    return np.linspace(-0.5, 0.5, n), k * w


@pytest.mark.parametrize("softness", SOFT)
@pytest.mark.parametrize(
    ("force", "couple", "both"), [(1.0, 0.0, False), (0.0, 1.0, False), (1.0, -0.5, False), (1.0, 0.0, True)]
)
def test_against_finite_differences(softness, force, couple, both):
    z, expected = differences(softness, force, couple, both)
    first = couple + (0.0 if both else 0.5 * force)
    even, turning = Foundation(length=1.0, softness=softness, side=0 if both else 1).shapes(z)
    assert force * even + first * turning == pytest.approx(expected, abs=6e-3 * np.abs(expected).max())


@pytest.mark.parametrize("softness", SOFT)
def test_rim_pressure_of_hetenyi(softness):
    """Of a beam with free ends, a force P and a couple M at one (Hetényi, 1946, equations 22 and 24).

    q = 2 P β (sinh cosh - sin cos)/(sinh² - sin²), and -2 M β² (sinh² + sin²)/(sinh² - sin²).
    """
    sh, ch, s, c = math.sinh(softness), math.cosh(softness), math.sin(softness), math.cos(softness)
    even, turning = Foundation(length=L, softness=softness, side=1).shapes(L / 2.0)
    beta, below = softness / L, sh**2 - s**2
    assert even + L / 2.0 * turning == pytest.approx(2.0 * beta * (sh * ch - s * c) / below)
    assert turning == pytest.approx(2.0 * beta**2 * (sh**2 + s**2) / below)


@pytest.mark.parametrize("side", [-1, 0, 1])
def test_resultants_and_the_limit_of_a_stiff_pin(side):
    x, w = np.polynomial.legendre.leggauss(60)
    z, w = x * L / 2.0, w * L / 2.0
    for softness in (0.5, *SOFT):
        even, turning = Foundation(length=L, softness=softness, side=side).shapes(z)
        assert [w @ even, w @ (z * even), w @ turning, w @ (z * turning)] == pytest.approx(
            [1.0, 0.0, 0.0, 1.0], abs=1e-9
        )
    even, turning = Foundation(length=L, softness=0.1, side=side).shapes(z)
    assert even == pytest.approx(np.full(60, 1.0 / L), rel=1e-4)
    assert turning == pytest.approx(12.0 * z / L**3, rel=1e-3)


@pytest.mark.parametrize(("softness", "ratio"), [(1.5, 1.12), (2.0, 1.36), (3.0, 2.40)])
def test_peak_over_that_of_the_linear_pressure(softness, ratio):
    """A force and a couple at one rim, the force's line 1.5 lengths from the middle: 1.1, 1.4 and 2.4 are published."""
    even, turning = Foundation(length=1.0, softness=softness, side=1).shapes(0.5)
    assert (even + 1.5 * turning) / (1.0 + 6.0 * 1.5) == pytest.approx(ratio, abs=0.01)


def test_sides_mirror_each_other():
    z = np.linspace(-2.0, 2.0, 9)
    (up, turn), (down, back) = (Foundation(length=L, softness=2.5, side=side).shapes(z) for side in (1, -1))
    assert down == pytest.approx(up[::-1])
    assert back == pytest.approx(-turn[::-1])


def test_pin_of_the_links_material_bends_from_a_length_of_0_9_diameters_on():
    seat = Seat(young=70e3, pin_young=70e3, diameter=3.0, length=2.6, eye=8.0, side=1)
    assert Foundation.of(seat) is None
    found = Foundation.of(replace(seat, length=2.72))
    assert found is not None
    assert STIFF <= found.softness < 1.52
    assert Foundation.of(replace(seat, length=6.0, side=None)) is None
    assert Foundation.of(replace(seat, length=6.0, pin_young=30.0 * 70e3)) is None


def test_what_presses_is_the_integral_of_the_size():
    rng, ring = np.random.default_rng(3), Ring(diameter=0.0, low=-L / 2.0, high=L / 2.0)
    z = (np.arange(40_000) + 0.5) * L / 40_000 - L / 2.0
    for side in (-1, 0, 1):
        foundation = Foundation(length=L, softness=2.2, side=side)
        even, turning = foundation.shapes(z)
        for _ in range(5):
            force, moment = complex(*rng.normal(size=2)), complex(*rng.normal(size=2)) * 3.0
            expected = max(np.abs(force * even - 1j * moment * turning).mean() * L, abs(force))
            assert pressing(np.array(force), np.array(moment), ring, foundation) == pytest.approx(expected, rel=1e-4)


def test_against_a_solid_eye():
    """Bricks of their own: a stiff pin presses linearly, one of the eye's modulus as on a foundation of some 1.5 E.

    An eye of 2.67 bores, 1.6 bores thick. At the rim the solid's pressure has a peak that no foundation has.
    """
    length = 3.2
    wall = bore_stiffness.wall_compliance(length, 2.67, around=16, radial=4, high=7)
    z = np.linspace(-0.5, 0.5, 8) * length
    for load, first in (((1.0, 0.0), length / 2.0), ((0.0, 1.0), 1.0)):
        linear = load[0] / length + first * 12.0 * z / length**3
        stiff, soft = (bore_stiffness.pressure(wall, length, modulus, *load) for modulus in (1e4, 1.0))
        assert stiff == pytest.approx(linear, abs=0.05 * linear.max())
        found = Foundation.of(Seat(young=1.0, pin_young=1.0, diameter=2.0, length=length, eye=5.3, side=1))
        assert found is not None
        even, turning = found.shapes(z)
        bent = load[0] * even + first * turning
        inner = slice(1, -1)
        missed, gained = (float(np.sqrt(np.mean((soft - one)[inner] ** 2))) for one in (bent, linear))
        assert missed < 0.45 * gained
        assert linear[-1] < bent[-1] < soft[-1]
