"""Lamé's thick-walled cylinder: a 0.1 m, b 0.2 m, 60 MPa inside, E 200 GPa, ν 0.3.

Timoshenko-Goodier, Theory of Elasticity, 3rd ed., art. 28; Code_Aster SSLV04 (V3.04.004). σθ = 100 MPa at a and
40 MPa at b whether the ends are free or held; ur(a) 0.0590 mm with free ends (plane stress), 0.0572 mm with held ends
(plane strain). A quarter by symmetry, curved elements.
"""

import numpy as np
from benchmark_tests import *  # noqa: F403
from holed_problems import CYLINDER as SIZES
from holed_problems import cylinder_problem
from solid_problems import Benchmark, Reading

A, B, PRESSURE, E, NU = SIZES


def exact_stress(x, *, held):
    """Lamé's stress (..., 6): along the axis nothing with free ends, ν (σr + σθ) with held ones."""
    r2 = x[..., 0] ** 2 + x[..., 1] ** 2
    k = PRESSURE * A * A / (B * B - A * A)
    radial, hoop = k * (1.0 - B * B / r2), k * (1.0 + B * B / r2)
    cos2, sin2, sincos = x[..., 0] ** 2 / r2, x[..., 1] ** 2 / r2, x[..., 0] * x[..., 1] / r2
    zero = np.zeros_like(r2)
    axial = NU * (radial + hoop) if held else zero
    return np.stack(
        [radial * cos2 + hoop * sin2, radial * sin2 + hoop * cos2, axial, (radial - hoop) * sincos, zero, zero], axis=-1
    )


def cylinder(n, *, held):
    """Worst of all nodes at the bore and outside, not a chosen one."""
    solved = cylinder_problem(4 * n, 5 * n, max(1, n // 2), held=held).solve()
    x, y, _ = solved.problem.space.nodes.T
    radius = np.hypot(x, y)
    cos, sin = x / radius, y / radius
    s = solved.field.nodal
    hoop = s[:, 0] * sin**2 + s[:, 1] * cos**2 - 2.0 * s[:, 3] * sin * cos
    moved = solved.u[:, 0] * cos + solved.u[:, 1] * sin
    inside, outside = solved.problem.nodes_on("u0"), solved.problem.nodes_on("u1")

    def worst(values, nodes, exact, *, stress=True):
        node = nodes[np.argmax(np.abs(values[nodes] - exact))]
        return Reading(value=float(values[node]), nodes=np.array([node]) if stress else None)

    reads = {
        "σθ(a)": worst(hoop, inside, 100.0),
        "σθ(b)": worst(hoop, outside, 40.0),
        "ur(a)": worst(moved, inside, 0.0572 if held else 0.059, stress=False),
    }
    return [(solved, reads)]


BENCHMARKS = tuple(
    Benchmark(
        name=f"Lamé's cylinder, ends {'held' if held else 'free'}",
        source="Timoshenko-Goodier, art. 28; Code_Aster SSLV04",
        solve=lambda n, held=held: cylinder(n, held=held),
        coarse=1,
        series=(1, 2, 3),
        converged=5,
        targets={"σθ(a)": (100.0, "MPa"), "σθ(b)": (40.0, "MPa"), "ur(a)": (0.0572 if held else 0.059, "mm")},
        within={"coarse": 0.03, "converged": 0.005},
        remark="worst node of each surface",
        stress=lambda x, held=held: exact_stress(x, held=held),
    )
    for held in (False, True)
)


def test_the_closed_form_is_in_equilibrium_with_the_pressure():
    bore = cylinder_problem(2, 2, 1, held=True)
    at = bore.space.nodes[bore.nodes_on("u0")]
    s = exact_stress(at, held=True)
    np.testing.assert_allclose((s[:, 0] * at[:, 0] + s[:, 3] * at[:, 1]) / A, -PRESSURE * at[:, 0] / A, atol=1e-9)
