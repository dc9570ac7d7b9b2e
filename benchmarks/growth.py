"""How cost grows with poses and with load cases; writes benchmarks/results/growth.json.

Growth with unknowns is in solvers.py. Here: the six-bar's motion with its statics at 36 to 36,000 poses; the envelope
of one of its links at 36 to 3,600 poses, beside one direct solution of that link; and 1 to 16 right-hand sides
by factorisation and by iteration. One thread.

    python benchmarks/growth.py [--mesh 2] [--counts 45 8 8]
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from record import Stopwatch, save  # noqa: E402
from solvers import NU, E, grid  # noqa: E402

from alula.fea.common.threads import bounded  # noqa: E402
from alula.fea.elements.elasticity import assemble_stiffness  # noqa: E402
from alula.fea.elements.space import displacement_space  # noqa: E402
from alula.fea.elements.supports import isostatic_supports  # noqa: E402
from alula.fea.motion.link_envelope import LinkMotion  # noqa: E402
from alula.fea.motion.link_history import link_histories  # noqa: E402
from alula.fea.solid.solution import solve_solid  # noqa: E402
from alula.fea.solid.stress import stress_field  # noqa: E402
from alula.fea.solvers.solve import available_methods, factorise  # noqa: E402
from alula.fea.solvers.two_level import LinearLevel  # noqa: E402
from alula.geometry.meshing.mesh import MeshSettings, mesh_body  # noqa: E402
from alula.geometry.meshing.tagged_mesh import TaggedMesh  # noqa: E402
from alula.loads.case.case_file import read_case  # noqa: E402
from alula.loads.records.bearing import WIDE  # noqa: E402
from alula.loads.states.case_motion import solve_case_motion  # noqa: E402

MOTION, ENVELOPE, LOADS = (36, 360, 3600, 36_000), (36, 360, 3600), (1, 2, 4, 8, 16)
LINK = "AE"


def least(task: Callable[[], Any], repeats: int) -> dict[str, float]:
    """Seconds of the repetition that took the least of the processor."""
    found = []
    for _ in range(repeats):
        watch = Stopwatch()
        task()
        found.append(watch.read())
    return min(found, key=lambda seconds: seconds["cpu_s"])


def moved(poses: int) -> Any:
    """The owl wing in one plane, driven at its first link, with the forces at every pose."""
    driven = ['layer_spacing="0 mm"', "drive.link=GF", "drive.joint=G", f"motion.poses={poses}"]
    return solve_case_motion(read_case("owl-wing-static", driven))


def motion() -> list[dict[str, Any]]:
    moved(MOTION[0])
    return [{"poses": poses, **least(lambda: moved(poses), 2)} for poses in MOTION]  # noqa: B023


def envelope(scale: float) -> dict[str, Any]:
    """Envelopes of one link on one mesh, and one direct solution of it."""
    case = read_case("owl-wing-static")
    material, body = case.material_of(LINK), case.body(LINK)
    mesh = mesh_body(body, MeshSettings().scaled(scale))
    line = tuple(f"bore:{body.pins[i].name}" for i in (0, -1))

    def direct(history: Any) -> None:
        solution = solve_solid(
            mesh,
            E=material.youngs_modulus,
            nu=material.poissons_ratio,
            density=material.density,
            loads=[history.chosen(0)],
            line=line,
            laws=[WIDE],
            transfers=["eye-faces"],
            threads=1,
        )
        stress_field(solution.space, solution.cases[0].displacement, E=solution.E, nu=solution.nu)

    def whole(history: Any, returns: bool) -> None:
        LinkMotion(
            displacement_space(mesh),
            link=LINK,
            body=body,
            material=material,
            histories=[history],
            evaluated=np.ones(history.poses, dtype=np.bool_),
            stated="eye-faces",
            returns=returns,
        ).envelope()

    rows = []
    for poses in ENVELOPE:
        found = moved(poses)
        (history,) = link_histories(found, LINK)
        if not rows:
            direct(history)
            once = least(lambda: direct(history), 2)  # noqa: B023
        rows.append({"poses": poses, **least(lambda: whole(history, found.motion.returns), 1)})  # noqa: B023
    return {"link": LINK, "unknowns": 3 * len(mesh.points), "direct": once, "runs": rows}


def load_cases(counts: tuple[int, int, int]) -> dict[str, Any]:
    """Set-up and solution of a bar under several loads at once, method by method."""
    points, cells = grid(counts, False)
    mesh = TaggedMesh(points=points, cells=cells, surfaces={}, areas={}, volume=0.0, centroid=np.zeros(3))
    space = displacement_space(mesh)
    fixed = isostatic_supports(space.nodes, space.corners)
    K = assemble_stiffness(space, E=E, nu=NU).with_fixed(fixed)
    level = LinearLevel(space=space, E=E, nu=NU, fixed=fixed)
    rhs = np.random.default_rng(1).normal(size=(space.unknowns, max(LOADS)))
    rhs[fixed] = 0.0
    rows = []
    for method in (available_methods()[0], "two-level"):
        watch = Stopwatch()
        factor = factorise(K, level=level, method=method, threads=1)
        ready = watch.read()
        factor.solve(rhs[:, 0])
        for count in LOADS:
            solution = least(lambda: factor.solve(rhs[:, :count]), 1)  # noqa: B023
            rows.append({"method": method, "load_cases": count, "set_up": ready, "solution": solution})
    return {"unknowns": space.unknowns, "runs": rows}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesh", type=float, default=2.0, help="factor on the mesher's own sizes")
    parser.add_argument("--counts", type=int, nargs=3, default=(45, 8, 8), help="cubes of the bar along each axis")
    options = parser.parse_args()
    with bounded(1):
        record = {
            "benchmark": "growth with poses and load cases",
            "threads": 1,
            "motion": motion(),
            "envelope": envelope(options.mesh),
            "load_cases": load_cases(tuple(options.counts)),
        }
    save("growth", record)
    for row in record["motion"]:
        print(f"motion, {row['poses']:,} poses: {row['cpu_s']:.3f} s of processor")
    once = record["envelope"]["direct"]["cpu_s"]
    for row in record["envelope"]["runs"]:
        print(f"envelope, {row['poses']:,} poses: {row['cpu_s']:.2f} s of processor, {row['cpu_s'] / once:.2f} direct")
    for row in record["load_cases"]["runs"]:
        seconds = row["set_up"]["cpu_s"] + row["solution"]["cpu_s"]
        print(f"{row['method']}, {row['load_cases']} load cases: {seconds:.2f} s of processor")


if __name__ == "__main__":
    main()
