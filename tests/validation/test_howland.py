"""Howland's strip in tension with a central hole.

R. C. J. Howland, On the stresses in the neighbourhood of a circular hole in a strip under tension, Phil. Trans. Roy.
Soc. A 229 (1930) 49-86; Pilkey, Peterson's Stress Concentration Factors, 3rd ed., chart 4.1: the largest stress over
the mean of the net section is 2.734, 2.362 and 2.174 at d/H = 0.1, 0.3, 0.5 (recomputed). The stress in the plane does
not depend on Poisson's ratio, so plane strain serves: one layer of elements between held faces, a quarter by symmetry.
"""

import numpy as np
from benchmark_tests import *  # noqa: F403
from solid_problems import Benchmark, Problem, Reading, block, even, graded, joined

TARGETS = {0.1: 2.734, 0.3: 2.362, 0.5: 2.174}
WIDTH, LENGTH, THICKNESS = 2.0, 6.0, 0.1  # strip of half-width 1, half-length 3 widths


def strip_problem(ratio, around, radial, along, E=2900.0, nu=0.38):
    """Quarter: a square around the hole (u radial, v around from the x axis) and the rest of the strip."""
    hole = ratio * WIDTH / 2.0

    def square(u, v, w):
        angle = v * np.pi / 2.0
        # The outer edge runs up the side x = 1, then back along y = 1.
        x, y = np.minimum(1.0, 2.0 - 2.0 * v), np.minimum(1.0, 2.0 * v)
        edge = [(1.0 - u) * hole * np.cos(angle) + u * x, (1.0 - u) * hole * np.sin(angle) + u * y]
        return np.stack([*edge, THICKNESS * w], axis=-1)

    def rest(u, v, w):
        return np.stack([u, v, THICKNESS * w], axis=-1)

    v = even(2 * around)
    mesh = joined(
        [
            block(graded(radial, 2.0 / hole), v, even(1), square),
            block(graded(along, 4.0, 1.0, LENGTH), even(around), even(1), rest),
        ],
        [{"u0": "hole", "v0": "y=0", "v1": "x=0", "w0": "faces", "w1": "faces"},
         {"u1": "end", "v0": "y=0", "w0": "faces", "w1": "faces"}],
    )  # fmt: skip
    p = Problem(mesh=mesh, E=E, nu=nu)
    p.fix(p.nodes_on("x=0"), "x")
    p.fix(p.nodes_on("y=0"), "y")
    p.fix(p.nodes_on("faces"), "z")
    p.traction("end", (1.0, 0.0, 0.0))
    return p


def strip(n, ratio):
    """Largest recovered σxx of all nodes over the net section's mean."""
    solved = strip_problem(ratio, 3 * n, 5 * n, 3 * n).solve()
    node = int(np.argmax(solved.field.nodal[:, 0]))
    value = float(solved.field.nodal[node, 0]) * (1.0 - ratio)
    return [(solved, {"net factor": Reading(value=value, nodes=np.array([node]))})]


BENCHMARKS = tuple(
    Benchmark(
        name=f"Howland's strip, d/H {ratio}",
        source="Howland 1930; recomputed",
        solve=lambda n, ratio=ratio: strip(n, ratio),
        coarse=2,
        series=(1, 2, 3),
        converged=7,
        targets={"net factor": (target, "")},
        within={"coarse": 0.05, "converged": 0.01},
    )
    for ratio, target in TARGETS.items()
)
