"""What every result records beside its numbers: when, on what, in which versions, of which sources of alula."""

import ast
import hashlib
import json
import os
import platform
import re
import time
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from alula.geometry.keeping.kept import sources_digest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
RESULTS = HERE / "results"
LOAD = float(os.environ.get("ALULA_BENCH_LOAD", os.getloadavg()[0]))
"""How busy the machine was before; of several benchmarks in turn, before the first."""
COMMANDED = frozenset(("stages", "page", "workbench", "commits"))
"""Results that run whole commands, pages or the workbench: these stand on all sources, and on ``reports``, too."""
QUIET = 0.5
"""Load average above which no time means much."""
COMPUTING = ("geometry", "loads", "fea")
"""Packages whose sources count, with the tables of numbers that stand in them."""
CASES = ROOT / "loads" / "cases"
"""Built-in cases, which are read by their names."""
_FOLDERS = (ROOT, ROOT / "benchmarks", *(ROOT / "tests" / name for name in (".", "verification", "validation")))
_SCRIPT = re.compile(r"[a-z_]+\.py|test_[a-z_]+|[a-z_]+(\.[a-z_]+)+")


def circumstances(name: str) -> dict[str, Any]:
    """Date, machine, versions and sources of a result, and how busy the machine was (load average over a minute)."""
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
        "processor": processor(),
        "load_average": round(LOAD, 2),
        "alula": {"version": version("alula")} | sources(name),
        "versions": f"Python {platform.python_version()}, "
        + ", ".join(f"{name} {version(name)}" for name in ("alula", "numpy", "scipy", "scikit-fem", "gmsh")),
    }


def sources(name: str) -> dict[str, str]:
    """Digests of alula's own sources: of those that a result stands on, and of the commands and pages around them."""
    script = "eye_limits" if name == "eyes" else re.split("-|_auto|_beam|_solid", name)[0]  # of stability-scale
    own = sources_digest() if name in COMMANDED else sources_of(script)
    return {"sources": own, "commands": sources_digest(("reports",))}


def stamp(record: dict[str, Any]) -> str:
    """When, on what and of which sources; the load average tells whether the machine was quiet."""
    told = [str(record[key]) for key in ("date", "processor", "machine", "versions") if key in record]
    if "threads" in record:
        told.append(f"{record['threads']} thread{'s' if str(record['threads']) != '1' else ''}")
    if "load_average" in record:
        busy = record["load_average"] > QUIET
        told.append(f"load average before {record['load_average']:.1f}{', a busy machine' if busy else ''}")
    if "alula" in record:
        told.append(f"sources {record['alula']['sources'][:12]}")
    return f"Measured: {'; '.join(told)}.\n"


def processor() -> str:
    """The processor's name where Linux tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def sources_of(script: str) -> str:
    """Return the SHA-256 of the sources that a benchmark stands on: what it imports, and what that imports.

    A result is older than the code where one of these has changed, and not where any has: a number of a solver stays as
    a check of pins is mended. Imports within functions count.

    Parameters
    ----------
    script : str
        Its name, such as "solvers".

    Returns
    -------
    str
        In hexadecimal.
    """
    return _digest(frozenset(_reached(ROOT / "benchmarks" / f"{script}.py")))


@cache
def _digest(files: frozenset[Path]) -> str:
    own = {file for file in files if file.relative_to(ROOT).parts[0] in COMPUTING}
    tables = {table for folder in {file.parent for file in own} | {CASES} for table in folder.rglob("*.toml")}
    found = hashlib.sha256()
    for path in sorted(own | tables):
        found.update(f"{path.relative_to(ROOT).as_posix()}\n".encode() + path.read_bytes())
    return found.hexdigest()


@cache
def _reached(script: Path) -> set[Path]:
    """All files that a script imports, runs or names, and those that these import."""
    found, left = {script}, [script]
    while left:
        new = _imported(left.pop()) - found
        found |= new
        left += new
    return found


@cache
def _imported(file: Path) -> set[Path]:
    """Files that a file imports; of a benchmark also scripts and modules whose names are texts in it."""
    names = set[str]()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and file.parent.name == "benchmarks":
            names |= {node.value.removesuffix(".py")} if _SCRIPT.fullmatch(node.value) else set()
    return {found for name in names if (found := _file(name)) is not None}


def _file(module: str) -> Path | None:
    """The file of a module of alula, of the benchmarks or of the tests; that of ``import alula`` is its face."""
    if module == "alula":
        return ROOT / "alula" / "__init__.py"
    parts = module.removeprefix("alula.").split(".")
    for folder in _FOLDERS:
        if (file := folder.joinpath(*parts).with_suffix(".py")).is_file():
            return file
    return None


def save(name: str, record: dict[str, Any]) -> Path:
    """Write results/<name>.json with the circumstances in front."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / f"{name}.json"
    path.write_text(json.dumps(circumstances(name) | record, indent=1) + "\n", encoding="utf-8")
    return path


def stamped(name: str) -> str:
    """Keep with what a table was made that has no result beside it, and return the line to put below it."""
    return stamp(json.loads(save(name, {}).read_text(encoding="utf-8")))


def between(page: Path, name: str, told: str) -> None:
    """Write a table between the marks of its name on a page."""
    before, _, after = _parts(page, name)
    page.write_text(f"{before}\n{told.strip()}\n\n{after}", encoding="utf-8")


def printed(page: Path, name: str) -> str:
    """What stands between the marks of a name on a page."""
    return _parts(page, name)[1].strip()


def _parts(page: Path, name: str) -> tuple[str, str, str]:
    """A page up to the mark where a table begins, the table, and the page from the mark where it ends."""
    begin, end = (f"<!-- {name}: {side} -->\n" for side in ("begin", "end"))
    before, rest = page.read_text(encoding="utf-8").split(begin)
    told, after = rest.split(end)
    return before + begin, told, end + after


class Stopwatch:
    """Wall and processor seconds since it was made."""

    def __init__(self) -> None:
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def read(self) -> dict[str, float]:
        """Return both, as ``wall_s`` and ``cpu_s``."""
        return {"wall_s": time.perf_counter() - self._wall, "cpu_s": time.process_time() - self._cpu}


class Others:
    """What other programs take of the processors while it lives; on Linux alone."""

    def __init__(self) -> None:
        self._start, self._busy = time.perf_counter(), _busy()

    def share(self, own: float) -> float | None:
        """Return the share of all processors that others took, given our own processor seconds."""
        busy = _busy()
        if busy is None or self._busy is None:
            return None
        whole = (time.perf_counter() - self._start) * (os.cpu_count() or 1)
        return round(max(0.0, busy - self._busy - own) / whole, 3)


def _busy() -> float | None:
    """Processor seconds of all programs since the machine started: all but idle and waiting (proc(5))."""
    try:
        ticks = [float(x) for x in Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:9]]
    except OSError:
        return None
    return (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK")
