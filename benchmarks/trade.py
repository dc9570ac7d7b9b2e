"""Time to a verdict over the accuracy asked for, CalculiX beside it; writes benchmarks/results/trade.json.

One link of each of four built-in cases, refined until its deciding stress has the accuracy under every load case. The
time covers all meshes, their making included, all distributions of pin pressure and all ways a torque enters; it leaves
out the start of the program, reading the case and the report. CalculiX is given the last mesh for free and solves one
load case in one of these variants. Every run is a process of its own; both use as many threads. Processor time leaves
out the mesher, whose process outlives the measurement; wall time has it.

    python benchmarks/trade.py [--accuracies 0.2 0.1 0.05 0.02] [--threads 2]
"""

import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from record import save  # noqa: E402

from alula.fea.calculix import program as calculix  # noqa: E402
from alula.fea.calculix.second_opinion import write_model  # noqa: E402
from alula.fea.links.link_by_hand import cut_link  # noqa: E402
from alula.fea.links.solid_result import link_task  # noqa: E402
from alula.fea.nonlinear.large_displacement import examine  # noqa: E402
from alula.fea.refine.discretisation import judged  # noqa: E402
from alula.fea.refine.link_series import STRESS  # noqa: E402
from alula.fea.refine.link_task import LinkTask  # noqa: E402
from alula.fea.refine.refinement import START, Effort, RefinedSolid, refine_links  # noqa: E402
from alula.fea.standing.case_statics import solve_case_statics  # noqa: E402
from alula.geometry.base.errors import CannotRunError  # noqa: E402
from alula.loads.case.case_file import read_case  # noqa: E402

LINKS = (
    ("owl-wing-static", "AE"),
    ("four-bar-synthesis", "b"),
    ("flapping-wing-chosen", "inner-left"),
    ("ornithopter", "lever-left"),
)
ACCURACIES = [0.2, 0.1, 0.05, 0.02]
MOST_UNKNOWNS, TIME_LIMIT = 1_500_000, 600.0


def spent() -> float:
    """Processor seconds of this process and of its children."""
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def task_of(name: str, link: str) -> LinkTask:
    """What is to be solved of a link, under all load cases."""
    case = read_case(name)
    statics = solve_case_statics(case, name)
    cut = []
    for load_case, loads in statics.loads.items():
        moved = examine(case, load_case, statics.forces[load_case], loads)
        cut += cut_link(case, link, load_case, moved, statics.reactions[load_case], loads)
    return link_task(case, link, cut)


def one(name: str, link: str, accuracy: float, threads: int) -> dict[str, Any]:
    """One link to one accuracy, and CalculiX on its last mesh."""
    task = task_of(name, link)
    effort = Effort(accuracy=accuracy, stated=True, max_unknowns=MOST_UNKNOWNS, time_limit=TIME_LIMIT)
    start, before = time.perf_counter(), spent()
    solid = refine_links({link: task}, START, effort, threads=threads)[link]
    told = {"wall_s": time.perf_counter() - start, "cpu_s": spent() - before}
    cases = [judged(solid, number, STRESS[task.brittle]) for number in range(len(solid.precision))]
    worst = max(range(len(cases)), key=lambda number: cases[number].stress.value)
    reached = max(case.stress.index if case.known else math.inf for case in cases)
    found = {
        "case": name,
        "link": link,
        "accuracy": accuracy,
        "reached": reached if math.isfinite(reached) else None,
        "status": cases[worst].status,
        "stress_mpa": cases[worst].stress.value,
        "meshes": len(solid.meshes),
        "unknowns": solid.meshes[-1].unknowns,
        "variants": len(cases),
        **{key: round(value, 3) for key, value in told.items()},
    }
    return found | asked(solid, worst, threads)


def asked(solid: RefinedSolid, worst: int, threads: int) -> dict[str, Any]:
    """CalculiX's seconds on the last mesh, or why there are none."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "link.inp"
        write_model(deck, solid.solution, solid.solution.cases[worst], "trade")
        scratch = Path(folder) / "run"
        scratch.mkdir()
        start, before = time.perf_counter(), spent()
        try:
            calculix.run(deck, scratch, threads=threads, time_limit=TIME_LIMIT)
        except CannotRunError as error:
            return {"calculix": str(error)}
        return {"calculix_wall_s": round(time.perf_counter() - start, 3), "calculix_cpu_s": round(spent() - before, 3)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--accuracies", nargs="+", type=float, default=ACCURACIES)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--one", nargs=3, metavar=("CASE", "LINK", "ACCURACY"), help="print one run as JSON")
    options = parser.parse_args()
    if options.one:
        name, link, accuracy = options.one
        print(json.dumps(one(name, link, float(accuracy), options.threads)))
        return
    rows = []
    for name, link in LINKS:
        for accuracy in options.accuracies:
            command = [sys.executable, __file__, "--threads", str(options.threads), "--one", name, link, str(accuracy)]
            ended = subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ)
            rows.append(json.loads(ended.stdout))
            print(ended.stdout.strip(), flush=True)
            save("trade", {"benchmark": "time to a verdict over accuracy", "threads": options.threads, "rows": rows})


if __name__ == "__main__":
    main()
