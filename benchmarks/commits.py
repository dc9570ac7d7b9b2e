"""Whole commands at this commit beside an earlier one, in turn; writes benchmarks/results/commits.json.

The earlier commit gets a work tree and an environment of its own under out/commits, by its ``make setup``. Wall time
is that of the whole process, processor time that of it and of its children. Each row states the share of the
processors that other programs took meanwhile.

    python benchmarks/commits.py [--before COMMIT] [--repeats 3] [--only "check owl-wing-static" ...]
"""

import argparse
import os
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

from record import Others, save

ROOT = Path(__file__).resolve().parents[1]
BEFORE = "9a88ccd2"
"""The last commit of alula 0.1."""
STARTER = "starter.toml"
COMMANDS = [
    "check owl-wing-static",
    "check owl-wing-static --fidelity solid",
    "check owl-wing-static --fidelity beam",
    f"check {STARTER}",
    "check owl-wing-flight",
    "envelope flapping-wing-chosen",
    "envelope ornithopter",
    "statics owl-wing-static",
    "motion owl-wing-static",
]
FOLDER = ("check", "motion", "envelope")
ENDED = (0, 1, 3)
"""Exit statuses of a command that did its work: passed, failed, undecided."""


def git(*arguments: str) -> str:
    """Output of a git command in this repository."""
    told = subprocess.run(["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True)
    return told.stdout.strip()


def tree(commit: str) -> Path:
    """Work tree of a commit with its environment, made if it is not there."""
    folder = ROOT / "out" / "commits" / git("rev-parse", "--short", commit)
    if not folder.exists():
        git("worktree", "prune")
        git("worktree", "add", "--detach", str(folder), commit)
    subprocess.run(["make", "--silent", "setup"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return folder


def run(alula: Path, command: str) -> dict[str, Any]:
    """One command in an empty folder: wall and processor seconds, and what others took of the processors."""
    arguments = command.split()
    with tempfile.TemporaryDirectory() as folder:
        if STARTER in arguments:
            subprocess.run([alula, "new", STARTER], cwd=folder, check=True, capture_output=True)
        if arguments[0] in FOLDER:
            arguments += ["--output", "result"]
        before, others, start = resource.getrusage(resource.RUSAGE_CHILDREN), Others(), time.perf_counter()
        ended = subprocess.run([alula, *arguments], cwd=folder, check=False, capture_output=True, text=True)
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if ended.returncode not in ENDED:
        raise SystemExit(f"{alula} {command} ended with status {ended.returncode}: {ended.stderr.strip()[-500:]}")
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"wall_s": round(wall, 3), "cpu_s": round(cpu, 3), "others": others.share(cpu), "status": ended.returncode}


def row(command: str, trees: dict[str, Path], repeats: int) -> dict[str, Any]:
    """Medians of one command at both commits, and their ratios."""
    runs: dict[str, list[dict[str, Any]]] = {name: [] for name in trees}
    for _ in range(repeats):
        for name, folder in trees.items():
            runs[name].append(run(folder / ".venv" / "bin" / "alula", command))
    found: dict[str, Any] = {"command": command, "runs": runs}
    for key in ("wall_s", "cpu_s"):
        medians = {name: statistics.median(one[key] for one in own) for name, own in runs.items()}
        found[key] = medians | {"ratio": round(medians["now"] / medians["before"], 3)}
    found["others"] = max((one["others"] or 0.0 for own in runs.values() for one in own), default=0.0)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", default=BEFORE, help="the earlier commit")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", nargs="+", default=COMMANDS, help="commands")
    options = parser.parse_args()
    os.environ.pop("PYTHONPATH", None)
    os.environ["ALULA_CACHE"] = ""  # each run solves all anew
    trees = {"before": tree(options.before), "now": ROOT}
    commits = {"before": git("rev-parse", "--short", options.before), "now": git("rev-parse", "--short", "HEAD")}
    changed = bool(git("status", "--porcelain", "--untracked-files=no", "--", "*.py", "*.toml"))
    rows = []
    for command in options.only:
        rows.append(row(command, trees, options.repeats))
        told = rows[-1]
        print(f"{command}: wall {told['wall_s']}, processor {told['cpu_s']}, others {told['others']}", flush=True)
    save("commits", {"benchmark": "commands at two commits", "commits": commits, "changed": changed, "rows": rows})


if __name__ == "__main__":
    main()
