"""Lists which printed numbers are older than the code, and renews them.

    python -m benchmarks.renew [all | stale | NAME ...]

Without a name it lists every result with the version and the sources of alula that it stands on, and measures nothing.
A name is that of a file in results/, or ``pages``: what commands print in the tutorial and the recipes. Only where the
words stay are these written anew; other differences are told. README is held by tests alone. Times want a quiet
machine.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from alula.geometry.base.version import alula_version
from benchmarks.record import COMMANDED, QUIET, RESULTS, sources
from benchmarks.run import BENCHMARKS
from benchmarks.stability import ROWS

ROOT = Path(__file__).resolve().parents[1]
PAGES = "pages"
ALONE = (
    "verification",
    "tiers",
    "draws",
    "tolerances",
    "plastic_peers",
    "collapse_meshes",
    "link_frequencies",
    "second_opinion",
)
"""Results that modules of their names make, without arguments."""
COMMANDS: dict[str, list[str]] = {
    **{name: ["benchmarks.run", "--only", name] for name in BENCHMARKS},
    **{f"stability-{row}": ["benchmarks.stability", row] for row in ROWS},
    **{name: [f"benchmarks.{name}"] for name in ALONE},
    "coverage": ["benchmarks.coverage", "--anew"],
    "widths_auto": ["benchmarks.widths", "--fidelity", "auto"],
    PAGES: ["pages"],
}
"""Result -> what makes it anew, as a module and its arguments."""


def results() -> dict[str, dict[str, Any]]:
    """Return every result by its name, without a number where it was never made or notes nothing of its making."""
    files = {name: RESULTS / f"{name}.json" for name in COMMANDS if name != PAGES}
    return {name: json.loads(file.read_text(encoding="utf-8")) if file.exists() else {} for name, file in files.items()}


def older(record: dict[str, Any], version: str) -> str:
    """Return of which other version a result is; empty where it is of this one."""
    made = record.get("alula")
    if not made:
        return "it was made before results noted their sources"
    return "" if made["version"] == version else f"of alula {made['version']}"


def stale(name: str, record: dict[str, Any], version: str, now: dict[str, str]) -> str:
    """Return why a result is older than the code that it runs; empty where it is not."""
    if why := older(record, version):
        return why
    changed = [kind for kind in ("sources", "commands") if record["alula"].get(kind) != now[kind]]
    return f"{changed[0]} have changed since" if changed and (name in COMMANDED or changed != ["commands"]) else ""


def main() -> None:
    """List, or renew what is named."""
    found, version = results(), alula_version()
    why = {name: stale(name, record, version, sources(name)) for name, record in found.items()}
    names = sys.argv[1:]
    if not names:
        for name, record in found.items():
            busy = name in BENCHMARKS and record.get("load_average", 0.0) > QUIET
            told = [why[name] or "of these sources", *["on a busy machine"] * busy]
            print(f"{name:26} {record.get('date', ''):21} {'; '.join(told)}")
        print(f"{sum(map(bool, why.values()))} of {len(why)} are older than the code. make numbers RENEW=stale")
        return
    if names == ["stale"]:
        names = [name for name in why if why[name]]
    elif names == ["all"]:
        names = list(COMMANDS)
    if unknown := [name for name in names if name not in COMMANDS]:
        sys.exit(f"{unknown[0]}: there is no such result, but {', '.join(COMMANDS)}")
    environment = os.environ | {"PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tests'}"}
    failed = []
    for name in names:
        print(f"== {name}", flush=True)
        if subprocess.run([sys.executable, "-m", *COMMANDS[name]], cwd=ROOT, env=environment, check=False).returncode:
            failed.append(name)
    sys.exit(f"failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main()
