"""Cook's membrane in plane stress and, nearly incompressible, in plane strain.

R. D. Cook, Improved two-dimensional finite element, J. Struct. Div. ASCE 100 (1974) 1851-1863: corners (0,0), (48,44),
(48,60), (0,44), left side clamped, an even shear F on the right, thickness 1.

plane stress   E 1, ν 1/3, F 1: uy(48, 52) 23.9677 (recomputed with an independent code of high order).
plane strain   E 240.565, ν 0.4999, F 100: uy(48, 52) 7.6952, uy(48, 60) 8.0761 (recomputed).

One layer of tetrahedra, all displacements along z held; plane stress by the elastic constants that belong to it. The
stress is singular at (0, 44) and jumps where the shear ends. In plane strain meshes are graded towards the corners; in
plane stress they are even, which shows the order that the singularity leaves (1.4 in the displacement), and most of
the error is at that corner, where recovered stresses are too smooth: the estimate reaches 0.42 of the true error on
one mesh, and 0.94 to 1.07 of it with the energies of two.

Quadratic tetrahedra lock little at ν = 0.4999: 2 % too stiff at 10,000 unknowns, 0.5 % at 38,000, where linear ones
reach a third of the deflection at most.
"""

import numpy as np
from benchmark_tests import *  # noqa: F403
from solid_problems import Benchmark, Problem, Reading, even, graded, single

PLANE_STRAIN = (240.565, 0.4999)
# Plane stress with E 1 and ν 1/3 is plane strain with ν/(1 + ν) and E (1 + 2ν)/(1 + ν)².
PLANE_STRESS = (0.9375, 0.25)


def membrane(count, grading):
    """Elements in the middle of a side are ``grading`` times as long as those at its ends."""

    def warp(u, v, w):
        bottom, top = 44.0 * u, 44.0 + 16.0 * u
        return np.stack([48.0 * u, bottom + (top - bottom) * v, w], axis=-1)

    half = count // 2
    fine = np.concatenate([graded(half, grading, 0.0, 0.5), 0.5 + graded(half, 1.0 / grading, 0.0, 0.5)[1:]])
    return single(fine, fine, even(1), warp)


def problem(count, grading, E, nu, F, order=2):
    p = Problem(mesh=membrane(count, grading), E=E, nu=nu, order=order)
    p.fix(p.nodes_on("u0"), "xy")
    p.fix(np.arange(len(p.space.nodes)), "z")
    p.force("u1", (0.0, F, 0.0))
    return p


def at(problem, x, y):
    """Nodes on the line through the thickness at (x, y)."""
    return problem.nodes_where(lambda px, py, pz: (abs(px - x) < 1e-6) & (abs(py - y) < 1e-6))


def plane_stress(n):
    solved = problem(8 * n, 1.0, *PLANE_STRESS, 1.0).solve()
    return [(solved, {"uy(48, 52)": Reading(value=float(solved.u[at(solved.problem, 48.0, 52.0), 1].mean()))})]


def plane_strain(n):
    solved = problem(8 * n, 6.0, *PLANE_STRAIN, 100.0).solve()
    reads = {f"uy(48, {y})": Reading(value=float(solved.u[at(solved.problem, 48.0, y), 1].mean())) for y in (52, 60)}
    return [(solved, reads)]


BENCHMARKS = (
    Benchmark(
        name="Cook's membrane, plane stress",
        source="Cook 1974; recomputed",
        solve=plane_stress,
        coarse=1,
        series=(2, 4, 6),
        converged=8,
        targets={"uy(48, 52)": (23.9677, "")},
        within={"coarse": 0.02, "converged": 0.002},
    ),
    Benchmark(
        name="Cook's membrane, plane strain, ν 0.4999",
        source="literature; recomputed",
        solve=plane_strain,
        coarse=2,
        series=(2, 3, 4),
        converged=8,
        targets={"uy(48, 52)": (7.6952, ""), "uy(48, 60)": (8.0761, "")},
        within={"coarse": 0.05, "converged": 0.01},
    ),
)


def test_linear_tetrahedra_lock():
    linear, quadratic = (
        p.solve().u[at(p, 48.0, 52.0), 1].mean()
        for p in (problem(16, 6.0, *PLANE_STRAIN, 100.0, order) for order in (1, 2))
    )
    assert linear < 0.4 * 7.6952
    assert quadratic > 0.97 * 7.6952
