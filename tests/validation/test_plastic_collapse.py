"""Known limit loads of perfectly plastic bodies, within 2 %, and bounds of others.

Hill, The Mathematical Theory of Plasticity (1950): the thick cylinder in plane strain, p = (2 σ/√3) ln(b/a), and
plastic moments, Z σ. Those of a circle and a tube follow from the first moment of half the area: Z = (D³ - d³)/6, over
the elastic π (D⁴ - d⁴)/(32 D): 16/(3π) = 1.70 for a rod. A strip with a hole, in plane stress, bears at least σ on its
net section (a stress field of two straight ties) and at most 2/√3 times that (a straight neck across each ligament:
its rate of strain along the neck is zero, so that the stress is that of plane strain).

Two cases of the validation manual of Code_Aster were read, in its English edition: SSNV231 (V6.04.231), a hollow sphere
under pressure up to its limit, and FORMA03 (V6.03.114), the limit load of a plate with a hole. The sizes of that plate
were read in another of its cases alone (V3.02.326: a hole of a tenth of the width), the curve of its steel not at all;
its numbers are taken over one another.
"""

import numpy as np
import pytest
from holed_problems import cylinder_problem, strip_problem
from plastic_problems import NU, YIELD, E, bent, eighth_in_tension, law, limit, loaded
from solid_problems import Problem, block, even, graded, joined, single

from alula.fea.plastic.load_path import follow


def test_hills_cylinder():
    """On a coarse mesh: plane strain, where elements that keep their volume lock first."""
    p = cylinder_problem(4, 5, 1, held=True, ratio=1.0)  # 100 mm, 200 mm, 60 MPa
    strength = 60.0 * np.sqrt(3.0) / 2.0 / np.log(2.0)
    load = loaded(p, type(law())(E=200_000.0, nu=0.3, strength=strength))
    path = follow(load)
    assert path.ended == "limit"
    assert path.factor == pytest.approx(1.0, abs=0.01)
    assert path.low <= path.factor <= path.high
    assert load.solves < 40


def eighth_of_a_sphere(inner, outer, radial, around):
    """Three patches, each about an axis, under a pressure of 1 MPa inside."""

    def patch(order):
        def warp(u, v, w):
            towards = np.stack([np.ones_like(v), np.tan(v * np.pi / 4.0), np.tan(w * np.pi / 4.0)], axis=-1)
            towards /= np.linalg.norm(towards, axis=-1, keepdims=True)
            return (inner + (outer - inner) * u)[..., None] * towards[..., order]

        return block(graded(radial, outer / inner), even(around), even(around), warp)

    p = Problem(
        mesh=joined(
            [patch([0, 1, 2]), patch([2, 0, 1]), patch([1, 2, 0])],
            [{"u0": "inner", "v0": low, "w0": other} for low, other in ("yz", "zx", "xy")],
        ),
        E=200_000.0,
        nu=0.3,
    )
    for axis in "xyz":
        p.fix(p.nodes_on(axis), axis)
    p.traction("inner", lambda q: -q.normals)
    return p


def test_the_sphere_of_ssnv231():
    """Radii 0.2 and 1 m, E 200 GPa, ν 0.3, 150 MPa; p = 2 σ ln(b/a) where all of it flows.

    Before, up to a radius c: the shell outside is elastic and just yields there, so that its bore bears
    (2 σ/3) (1 - c³/b³) and its outside moves by σ (1 - ν) c³/(E b²); inside, dσ_r/dr = 2 σ/r adds 2 σ ln(c/a).
    """
    inner, outer, strength = 0.2, 1.0, 150.0
    p = eighth_of_a_sphere(inner, outer, 4, 2)
    path = follow(loaded(p, type(law())(E=200_000.0, nu=0.3, strength=strength)))
    assert path.ended == "limit"
    assert path.factor == pytest.approx(2.0 * strength * np.log(outer / inner), rel=0.01)
    seen = 0
    for state in path.states:
        moved = state.displacement.reshape(-1, 3)[p.node_at(outer, 0.0, 0.0), 0]
        cube = moved * 200_000.0 * outer**2 / (strength * 0.7)
        if inner**3 < cube < outer**3:
            seen += 1
            shell = 2.0 * strength / 3.0 * (1.0 - cube / outer**3)
            assert state.factor == pytest.approx(shell + 2.0 * strength * np.log(np.cbrt(cube) / inner), rel=0.015)
    assert seen >= 5


@pytest.mark.parametrize("ratio", [0.1, 0.6])
def test_plastic_moment_of_a_tube(ratio):
    """Stress blocks on its ends, whose moment is the plastic one at σ; a tenth of a bore is a rod within 0.1 %."""
    path = limit(bent(ratio, 1.0, radial=3, around=4, along=2, length=4.0))
    assert path.factor == pytest.approx(YIELD, rel=0.02)
    shape = path.factor / YIELD * 16.0 * (1.0 - ratio**3) / (3.0 * np.pi * (1.0 - ratio**4))
    assert shape == pytest.approx({0.1: 1.70, 0.6: 1.528}[ratio], rel=0.02)


def test_a_bent_rectangle_on_its_way_to_its_plastic_moment():
    """M = 1.5 Me (1 - (κe/κ)²/3): moment and curvature of the middle of a beam, on each state of the path."""
    p = Problem(
        mesh=single(even(4, 0.0, 6.0), even(3), even(1, 0.0, 0.3), lambda u, v, w: np.stack([u, v, w], -1)), E=E, nu=NU
    )
    p.fix(p.nodes_on("u0"), "x")
    p.fix(p.nodes_on("v0"), "x")  # the neutral axis: half the height is modelled
    p.fix(p.nodes_on("w0"), "z")
    p.fix(p.node_at(0.0, 0.0, 0.0), "y")
    p.traction("u1", (1.0, 0.0, 0.0))
    path = limit(p)
    elastic = YIELD / E  # of κ, half the height is 1
    seen = 0
    for state in path.states[1:]:
        u = state.displacement.reshape(-1, 3)
        far, near = p.node_at(2.25, 0.0, 0.0), p.node_at(0.0, 0.0, 0.0)
        curvature = 2.0 * abs(u[far, 1] - u[near, 1]) / 2.25**2
        if curvature > elastic:
            seen += 1
            assert state.factor / YIELD == pytest.approx(1.0 - (elastic / curvature) ** 2 / 3.0, abs=0.02)
    assert seen >= 2
    assert 1.5 * path.factor / YIELD == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.5])
def test_a_strip_with_a_hole_lies_between_its_bounds(ratio):
    """That of 0.1 is FORMA03: there 243 MPa is the lower bound, and 246 MPa what a path led by a displacement bears."""
    p = strip_problem(ratio, 4, 6, 4, E=E, nu=NU)
    for node in np.flatnonzero(p.space.nodes[:, 2] > 1e-9):
        p.fixed.pop(3 * int(node) + 2, None)  # one face is free: plane stress
    path = limit(p)
    net = (1.0 - ratio) * YIELD
    assert 0.99 * net < path.factor < 2.0 / np.sqrt(3.0) * net
    assert path.factor < 1.03 * net  # close to the lower bound
    if ratio == 0.1:
        assert path.factor / net == pytest.approx(246.0 / 243.0, rel=0.02)


def test_the_factor_goes_with_the_yield_stress_and_not_with_the_modulus():
    strip = bent(0.6, 1.0, radial=1, around=3, along=1, length=3.0)
    one = limit(strip, law())
    other = limit(strip, type(law())(E=10.0 * E, nu=NU, strength=2.0 * YIELD))
    assert other.factor == pytest.approx(2.0 * one.factor, rel=1e-6)


@pytest.mark.parametrize("plateau", [(), ((0.02, 1.0),)])
def test_a_hardening_tie_ends_at_its_largest_strain(plateau):
    """σ at 5 % is 1.5 times that at yield: a bar in tension bears it, and no more. A plateau does not end it."""
    path = follow(loaded(eighth_in_tension(), law(hardening=(*plateau, (0.05, 1.5)))), largest_strain=0.05)
    assert path.ended == "strain"
    assert path.factor == pytest.approx(1.5 * YIELD, rel=0.02)
    assert path.low <= 1.5 * YIELD <= path.high
