"""Howland's strip in tension with a central hole.

R. C. J. Howland, On the stresses in the neighbourhood of a circular hole in a strip under tension, Phil. Trans. Roy.
Soc. A 229 (1930) 49-86; Pilkey, Peterson's Stress Concentration Factors, 3rd ed., chart 4.1: the largest stress over
the mean of the net section is 2.734, 2.362 and 2.174 at d/H = 0.1, 0.3, 0.5 (recomputed). The stress in the plane does
not depend on Poisson's ratio, so plane strain serves: one layer of elements between held faces, a quarter by symmetry.
"""

import numpy as np
from benchmark_tests import *  # noqa: F403
from holed_problems import strip_problem
from solid_problems import Benchmark, Reading

TARGETS = {0.1: 2.734, 0.3: 2.362, 0.5: 2.174}


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
