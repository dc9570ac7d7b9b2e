"""NAFEMS LE1 and LE10 on solid elements.

The Standard NAFEMS Benchmarks, TNSB, rev. 3, 1990: quarter of an elliptic membrane, ellipses 2 × 1 m (inside) and
3.25 × 2.75 m (outside), E 210 GPa, ν 0.3.

LE1   thickness 0.1 m, 10 MPa outwards on the outer edge, symmetry on x = 0 and y = 0, plane stress. At D (2, 0):
      σyy 92.7 MPa; with an independent code of high order σyy 92.658 MPa, ux −0.10221 mm. Here a solid with free
      faces, half of it by symmetry about its mid-plane; plane stress is its limit for small thickness, so stress and
      displacement are means through the thickness.
LE10  thickness 0.6 m, 1 MPa on top, ux = 0 on x = 0, uy = 0 on y = 0, ux = uy = 0 on the outer face, uz = 0 on its
      mid line. At D (2, 0, 0.6): σyy −5.38 MPa. A line support is not well posed in three dimensions: uz drifts as the
      mesh is refined there, so σyy alone is tested, on meshes that are not graded towards that line, and no energy.
"""

import numpy as np
from benchmark_tests import *  # noqa: F403
from solid_problems import Benchmark, Problem, Reading, even, graded, single

E, NU = 210_000.0, 0.3


def elliptic(thickness, radial, around, layers, ratio):
    """Quarter plate in mm: u0 the inner edge, v0 on y = 0, v1 on x = 0, w0 at z = 0."""

    def warp(u, v, w):
        angle = v * np.pi / 2.0
        x = (2000.0 + 1250.0 * u) * np.cos(angle)
        y = (1000.0 + 1750.0 * u) * np.sin(angle)
        return np.stack([x, y, w * thickness], axis=-1)

    return single(graded(radial, ratio), graded(around, ratio), even(layers), warp)


def le1_problem(radial, around, layers):
    p = Problem(mesh=elliptic(50.0, radial, around, layers, 6.0), E=E, nu=NU)
    p.fix(p.nodes_on("v1"), "x")
    p.fix(p.nodes_on("v0"), "y")
    p.fix(p.nodes_on("w0"), "z")
    p.traction("u1", lambda q: 10.0 * q.normals)
    return p


def le1(n):
    solved = le1_problem(2 * n, 3 * n, max(1, n // 6)).solve()
    edge = solved.problem.nodes_where(lambda x, y, z: (abs(x - 2000.0) < 1e-6) & (abs(y) < 1e-6))
    return [
        (
            solved,
            {
                "σyy(D)": Reading(value=float(solved.field.nodal[edge, 1].mean()), nodes=edge),
                "ux(D)": Reading(value=float(solved.u[edge, 0].mean())),
            },
        )
    ]


def le10_problem(radial, around, layers):
    p = Problem(mesh=elliptic(600.0, radial, around, layers, 3.0), E=E, nu=NU)
    p.fix(p.nodes_on("v1"), "x")
    p.fix(p.nodes_on("v0"), "y")
    outer = p.nodes_on("u1")
    p.fix(outer, "xy")
    p.fix(outer[np.abs(p.space.nodes[outer, 2] - 300.0) < 1e-6], "z")
    p.traction("w1", (0.0, 0.0, -1.0))
    return p


def le10(n):
    solved = le10_problem(3 * n, 4 * n, 2 * n).solve()
    node = solved.problem.node_at(2000.0, 0.0, 600.0)
    return [(solved, {"σyy(D)": Reading(value=float(solved.field.nodal[node, 1]), nodes=np.array([node]))})]


BENCHMARKS = (
    Benchmark(
        name="NAFEMS LE1, elliptic membrane",
        source="NAFEMS, TNSB rev. 3, 1990; 92.658 recomputed",
        solve=le1,
        coarse=4,
        series=(3, 4, 6),
        converged=12,
        targets={"σyy(D)": (92.658, "MPa"), "ux(D)": (-0.10221, "mm")},
        within={"coarse": 0.02, "converged": 0.005},
    ),
    Benchmark(
        name="NAFEMS LE10, thick plate",
        source="NAFEMS, TNSB rev. 3, 1990",
        solve=le10,
        finite_energy=False,
        coarse=2,
        series=(1, 2, 3),
        converged=5,
        targets={"σyy(D)": (-5.38, "MPa")},
        within={"coarse": 0.04, "converged": 0.02},
    ),
)
