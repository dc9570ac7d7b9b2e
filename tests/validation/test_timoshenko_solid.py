"""Timoshenko's cantilever: a tube 5 over 2.5 mm, 88 mm long, 1 N at the tip, E 2900 MPa, ν 0.38.

Tip deflection P L³/(3 E I) + P L/(κ G A) with κ after G. R. Cowper, The shear coefficient in Timoshenko's beam theory,
J. Appl. Mech. 33 (1966) 335-340: κ 0.626817, tip 2.732449 mm, of which bending 2.723376 mm. Half of the tube by
symmetry; the root is held along the axis alone and its mean is the reference across it, so that it contracts freely
as in Saint-Venant's solution. A root that is clamped whole deflects 0.5 % less, as measured.
"""

import numpy as np
import pytest
from benchmark_tests import *  # noqa: F403
from solid_problems import Benchmark, Problem, Reading, even, single

E, NU, LENGTH, OUTER, INNER, FORCE = 2900.0, 0.38, 88.0, 2.5, 1.25, 1.0
AREA = np.pi * (OUTER**2 - INNER**2)
SECOND = np.pi * (OUTER**4 - INNER**4) / 4.0


def exact():
    """Tip deflection, of which bending, by Cowper's κ for a hollow circle."""
    m2 = (INNER / OUTER) ** 2
    kappa = 6.0 * (1.0 + NU) * (1.0 + m2) ** 2 / ((7.0 + 6.0 * NU) * (1.0 + m2) ** 2 + (20.0 + 12.0 * NU) * m2)
    bending = FORCE * LENGTH**3 / (3.0 * E * SECOND)
    return bending + FORCE * LENGTH / (kappa * E / (2.0 * (1.0 + NU)) * AREA), bending, kappa


def tube_problem(around, radial, along):
    """Half tube y ≥ 0 along x, loaded along z; v runs around from +z to -z."""

    def warp(u, v, w):
        radius, angle = INNER + (OUTER - INNER) * w, v * np.pi
        return np.stack([LENGTH * u, radius * np.sin(angle), radius * np.cos(angle)], axis=-1)

    p = Problem(mesh=single(even(along), even(around), even(radial), warp), E=E, nu=NU)
    p.fix(p.nodes_on("u0"), "x")
    p.fix(p.nodes_on("v0", "v1"), "y")
    p.fix(p.node_at(0.0, 0.0, OUTER), "z")  # reacts with nothing: the root carries its shear as a traction
    p.force("u0", (0.0, 0.0, -FORCE / 2.0))
    p.force("u1", (0.0, 0.0, FORCE / 2.0))
    return p


def tube(n):
    solved = tube_problem(4 * n, n, 25 * n).solve()
    return [(solved, {"tip": Reading(value=float(solved.mean("u1")[2] - solved.mean("u0")[2]))})]


BENCHMARKS = (
    Benchmark(
        name="Timoshenko's cantilever, tube",
        source="Cowper 1966",
        solve=tube,
        coarse=2,
        series=(1, 2, 3),
        converged=4,
        targets={"tip": (2.732449, "mm")},
        within={"coarse": 0.02, "converged": 0.001},
    ),
)


def test_closed_form():
    assert exact() == pytest.approx((2.732449, 2.723376, 0.626817), rel=1e-6)
