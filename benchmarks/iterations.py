"""Iterations of conjugate gradients on the last meshes of built-in links; writes benchmarks/results/iterations.json.

The whole body, whatever solver and half of it the check would take, under the loads of all cases.

    python benchmarks/iterations.py [--threads 2]
"""

import argparse
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

import numpy as np  # noqa: E402
from record import save  # noqa: E402
from trade import LINKS, task_of  # noqa: E402

from alula.fea.elements.elasticity import assemble_stiffness  # noqa: E402
from alula.fea.elements.supports import isostatic_supports  # noqa: E402
from alula.fea.refine.refinement import START, Effort, refine_links  # noqa: E402
from alula.fea.solvers.solve import factorise  # noqa: E402
from alula.fea.solvers.two_level import TOLERANCE, linear_level  # noqa: E402

MORE = (("owl-wing-static", "CF"), ("owl-wing-static", "ED"), ("flapping-wing-chosen", "crank"), ("ornithopter", "rod"))


def counted(name: str, link: str, threads: int) -> dict[str, Any]:
    """Iterations on the last mesh of one link."""
    task = task_of(name, link)
    solid = refine_links({link: task}, START, Effort(), threads=threads)[link].solution
    space, elastic = solid.space, {"E": solid.E, "nu": solid.nu}
    K, fixed = assemble_stiffness(space, **elastic), isostatic_supports(space.nodes, space.corners)
    F = np.column_stack([K @ case.displacement.ravel() for case in solid.cases])
    F[fixed] = 0.0
    K.fix(fixed)
    level = linear_level(space, **elastic, fixed=fixed)
    found = factorise(K, level=level, right_hand_sides=F.shape[1], method="two-level", threads=threads).solved(F)
    told = {"unknowns": space.unknowns, "loads": F.shape[1], "iterations": found.iterations, "error": found.error}
    return {"case": name, "link": link, "poissons_ratio": solid.nu, **told}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    rows = []
    for name, link in (*LINKS, *MORE):
        rows.append(counted(name, link, options.threads))
        print(rows[-1], flush=True)
    save("iterations", {"tolerance": TOLERANCE, "threads": options.threads, "rows": rows})


if __name__ == "__main__":
    main()
