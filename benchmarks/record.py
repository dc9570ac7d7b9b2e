"""What every result records beside its numbers: when, on what, in which versions."""

import json
import os
import platform
import time
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results"
LOAD = float(os.environ.get("ALULA_BENCH_LOAD", os.getloadavg()[0]))
"""How busy the machine was before; of several benchmarks in turn, before the first."""
QUIET = 0.5
"""Load average above which no time means much."""


def circumstances() -> dict[str, Any]:
    """Date, machine, versions, and how busy the machine was (load average over a minute)."""
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
        "processor": processor(),
        "load_average": round(LOAD, 2),
        "versions": f"Python {platform.python_version()}, "
        + ", ".join(f"{name} {version(name)}" for name in ("alula", "numpy", "scipy", "scikit-fem", "gmsh")),
    }


def processor() -> str:
    """The processor's name where Linux tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def save(name: str, record: dict[str, Any]) -> Path:
    """Write results/<name>.json with the circumstances in front."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / f"{name}.json"
    path.write_text(json.dumps(circumstances() | record, indent=1) + "\n", encoding="utf-8")
    return path


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
