"""Where the time of a whole check goes: the owl wing by each fidelity; writes benchmarks/results/stages.json.

python benchmarks/stages.py [--case owl-wing-static] [--fidelities auto frame solid] [--threads 2]
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from record import save

ROOT = Path(__file__).resolve().parents[1]


def check(case: str, fidelity: str, threads: int) -> dict[str, Any]:
    """One check in a process of its own, with the stages that its result tells."""
    with tempfile.TemporaryDirectory() as folder:
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        command = [sys.executable, "-c", "from alula.reports.commands.cli import main; main()", "check", case]
        ended = subprocess.run(
            [*command, "--fidelity", fidelity, "--threads", str(threads), "--output", folder],
            cwd=ROOT,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=False,
        )
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        row: dict[str, Any] = {"fidelity": fidelity, "wall_s": round(wall, 2), "cpu_s": round(cpu, 2)}
        if ended.returncode not in (0, 1, 3):  # the check could not be done
            return row | {"end": (ended.stderr.strip().splitlines() or [f"status {ended.returncode}"])[-1]}
        result = json.loads((Path(folder) / "result.json").read_text(encoding="utf-8"))
    stages = {name: round(seconds, 3) for name, seconds in result["timings"].items()}
    meshes = {
        link: [{key: mesh[key] for key in ("unknowns", "seconds")} for mesh in told["discretisation"]["meshes"]]
        for link, told in result["links"].items()
        if told and told.get("discretisation")
    }
    return row | {"verdict": result["verdict"], "stages": stages, "meshes": meshes}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", default="owl-wing-static")
    parser.add_argument("--fidelities", nargs="+", default=["auto", "frame", "solid"])
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    rows = []
    for fidelity in options.fidelities:
        rows.append(check(options.case, fidelity, options.threads))
        print(json.dumps(rows[-1]), flush=True)
    save("stages", {"benchmark": "stages of a check", "case": options.case, "threads": options.threads, "runs": rows})


if __name__ == "__main__":
    main()
