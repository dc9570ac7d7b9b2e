"""Fuzz all that reads a case: ``python -m fuzz [--share 1.0] [--seed 1] [--output out/fuzz]`` (``make fuzz``).

Exit status 1 if any input failed. Every engine runs in a process of its own, so that a crash of the interpreter is
a finding as well; two run at once, unless told otherwise.
"""

import argparse
import importlib.util
import json
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

PLAN = (
    ("guided", "case_bytes", 40_000),
    ("mutations", "case_tables", 60_000),
    ("mutations", "case_bytes", 30_000),
    ("properties", "case_tables", 10_000),
    ("properties", "override", 20_000),
    ("guided", "override", 90_000),
    ("properties", "expression", 40_000),
    ("properties", "claim", 30_000),
    ("properties", "quantity", 20_000),
    ("guided", "claim", 150_000),
    ("guided", "quantity", 200_000),
    ("guided", "expression", 400_000),
    ("mutations", "pylinkage", 30_000),
    ("mutations", "pmks", 30_000),
    ("properties", "companion", 5_000),
    ("properties", "varied", 30_000),
)
"""(engine, target, inputs), the slowest first."""
ENGINES = {"guided": "atheris", "mutations": "mutation", "properties": "hypothesis"}


def run(engine: str, target: str, inputs: int, seed: int, folder: Path) -> dict[str, object]:
    """Run one engine on one target and return its record; a process that died is a fault."""
    arguments = [sys.executable, "-m", f"fuzz.{engine}", target, str(inputs), str(seed), str(folder)]
    record = folder / f"{ENGINES[engine]}-{target}.json"
    record.unlink(missing_ok=True)
    done = subprocess.run(arguments, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if record.exists() and done.returncode == 0:
        found: dict[str, object] = json.loads(record.read_text(encoding="utf-8"))
        return found
    died = {"input": "unknown", "traceback": done.stderr[-4000:]}
    return {"engine": ENGINES[engine], "target": target, "tried": 0, "accepted": 0, "seconds": 0.0,
            "faults": {f"process ended with status {done.returncode}": died}}  # fmt: skip


def main() -> int:
    """Run the plan, print a table, write ``summary.json``."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--share", type=float, default=1.0, help="factor on every number of inputs")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2, help="engines that run at once")
    parser.add_argument("--output", type=Path, default=Path("out/fuzz"))
    options = parser.parse_args()
    plan = [(engine, target, max(1, round(inputs * options.share))) for engine, target, inputs in PLAN]
    if importlib.util.find_spec("atheris") is None:
        print("atheris is not installed (it has wheels for x86-64 Linux alone): its share is left out", file=sys.stderr)
        plan = [entry for entry in plan if entry[0] != "guided"]
    folder: Path = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    begun = time.perf_counter()

    def one(entry: tuple[str, str, int]) -> dict[str, object]:
        found = run(*entry, options.seed, folder)
        print(
            f"{found['engine']:<11}{found['target']:<12}{found['tried']:>9,} inputs {found['accepted']:>9,} valid "
            f"{found['seconds']:>8} s {len(found['faults']):>3} faults",  # type: ignore[arg-type]
            flush=True,
        )
        return found

    with ThreadPoolExecutor(max_workers=options.processes) as pool:
        records = list(pool.map(one, plan))
    tried, accepted = (sum(int(str(record[key])) for record in records) for key in ("tried", "accepted"))
    faults = [(record, place) for record in records for place in record["faults"]]  # type: ignore[attr-defined]
    seconds = time.perf_counter() - begun
    summary = {"tried": tried, "accepted": accepted, "seconds": round(seconds), "faults": len(faults), "runs": records}
    (folder / "summary.json").write_text(json.dumps(summary, indent=2), encoding="utf-8")
    for record, place in faults:
        print(f"FAULT {record['engine']} {record['target']}: {place}")
    print(f"{tried:,} inputs ({accepted:,} of them valid) in {seconds:,.0f} s, {len(faults)} faults; see {folder}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
