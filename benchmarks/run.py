"""Runs every benchmark in turn, draws the figures and fills in the tables of benchmarks/README.md.

    python -m benchmarks.run [--quick] [--only accuracy peers ...] [--ngsolve PYTHON]

On two quiet cores all of it takes an hour or so, most of it the slowest peers at 1.5 million unknowns; ``--quick``
keeps to small sizes. A benchmark that fails is named at the end; the others run all the same. On a machine whose load
average is above 0.5 before it starts nothing runs, unless ``--busy`` says so; the tables then tell it.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.record import LOAD, QUIET, save

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

# Name -> whether its result is what it prints (then in one thread), arguments for all and for the quick run.
BENCHMARKS: dict[str, tuple[bool, list[str], list[str]]] = {
    "motion": (True, [], []),
    "solvers": (False, ["--solvers", "auto", "pardiso"], ["--solvers", "auto", "--sizes", "20k", "160k"]),
    "envelope": (False, [], ["--sizes", "2"]),
    "growth": (False, [], ["--mesh", "3", "--counts", "30", "5", "5"]),
    "accuracy": (False, ["--largest", "150000"], ["--largest", "20000"]),
    "stages": (False, [], []),
    "studies": (False, ["--points", "40", "--solids", "2"], ["--points", "16", "--solids", "0", "--rows", "1000"]),
    "commits": (False, [], ["--repeats", "1"]),
    "iterations": (False, [], []),
    "trade": (False, [], ["--accuracies", "0.2", "0.05"]),
    "page": (False, [], ["--repeats", "2"]),
    "workbench": (False, [], ["--case", "owl-wing-static"]),
    "peers": (False, ["--repeats", "1", "--time-limit", "150"], ["--sizes", "20k", "160k", "--repeats", "1"]),
}


def run(name: str, arguments: list[str]) -> tuple[int, float]:
    """Exit status and wall seconds of one benchmark."""
    command = [sys.executable, str(HERE / f"{name}.py"), *arguments]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "ALULA_BENCH_LOAD": str(LOAD), "ALULA_CACHE": ""}
    start = time.perf_counter()
    if BENCHMARKS[name][0]:
        one_thread = {"OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
        ended = subprocess.run(command, cwd=ROOT, env=environment | one_thread, check=False, stdout=subprocess.PIPE)
        if ended.returncode == 0:
            save(name, json.loads(ended.stdout))
    else:
        ended = subprocess.run(command, cwd=ROOT, env=environment, check=False)
    return ended.returncode, time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small sizes")
    parser.add_argument("--only", nargs="+", choices=list(BENCHMARKS), default=list(BENCHMARKS))
    parser.add_argument("--ngsolve", help="an interpreter that can import ngsolve, for the peers")
    parser.add_argument("--busy", action="store_true", help="measure on a busy machine all the same")
    options = parser.parse_args()
    if LOAD > QUIET and not options.busy:
        parser.error(f"the load average is {LOAD:.2f}, above {QUIET:g}: wait until the machine is quiet, or add --busy")
    summary = []
    for name in options.only:
        _, usual, quick = BENCHMARKS[name]
        arguments = list(quick if options.quick else usual)
        if name == "peers" and options.ngsolve:
            arguments += ["--ngsolve", options.ngsolve]
        print(f"== {name} {' '.join(arguments)}", flush=True)
        summary.append((name, *run(name, arguments)))
    # Imported late: figures need matplotlib, the benchmarks do not.
    from benchmarks import tables
    from benchmarks.figures import drawn

    print("== figures and tables", flush=True)
    for path in (*drawn(), tables.filled_in()):
        print(path.relative_to(ROOT))
    print("== summary")
    for name, status, seconds in summary:
        print(f"{name:10} {'done' if status == 0 else f'failed with status {status}':26} {seconds:8.1f} s")
    sys.exit(any(status for _, status, _ in summary))


if __name__ == "__main__":
    main()
