"""alula beside CalculiX, NGSolve and scikit-fem: one straight-sided mesh, one material, one load, one run.

A clamped bar (6:1:1) of quadratic tetrahedra under 1 N at its far end. Every program is a process of its own, from
mesh file to displacements and stresses; wall time and peak memory are the operating system's. The programs take
turns, so that a noisy machine troubles all alike. What runs out of time or memory is not tried at a larger size.
The curved sizes bend the same grid (mid-nodes off the middle); they go to those that read such a mesh: alula and
CalculiX (C3D10). Writes benchmarks/results/peers.json.

    python benchmarks/peers.py [--sizes 160k 160k-curved 550k 1500k] [--repeats 3] [--time-limit 900] [--ngsolve PYTHON]

CalculiX (``ccx``, Debian's calculix-ccx) is taken from PATH; NGSolve (PyPI) from the interpreter named by --ngsolve.
A program that is missing is left out and named.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from record import circumstances
from solvers import COUNTS, bent, grid

HERE = Path(__file__).parent
RESULTS = HERE / "results" / "peers.json"
SIZES = ["160k", "160k-curved", "550k", "1500k"]
CURVED = "-curved"
READ_CURVED = ("alula", "alula, PARDISO", "CalculiX")
MEMORY = 16_000_000_000
"""Bytes that a program may map before it counts as out of memory."""


def write_mesh(path: Path, size: str) -> None:
    """Write points, tetrahedra and the triangles of both ends."""
    curved = size.endswith(CURVED)
    points, cells = grid(COUNTS[size.removesuffix(CURVED)], curved)
    faces = np.concatenate([cells[:, [0, 2, 1]], cells[:, [0, 1, 3]], cells[:, [1, 2, 3]], cells[:, [0, 3, 2]]])

    def at(x: float) -> np.ndarray:
        return faces[(points[faces][:, :, 0] == x).all(axis=1)]

    extent = np.ptp(points, axis=0)
    area = 4.0 * extent[1] * extent[2]
    placed = 2.0 * (bent(points) if curved else points)
    np.savez(path, points=placed, cells=cells, start=at(0.0), end=at(extent[0]), area=area)


def write_deck(mesh: Path, deck: Path) -> None:
    """Write the same problem for CalculiX (not part of its time: its mesh file)."""
    from peer_alula import NU, E, problem

    from alula.fea.calculix.program import write_deck as write

    space, fixed, load = problem(str(mesh))
    write(deck, space, E=E, nu=NU, loads=load.reshape(-1, 3), supports=fixed, title="clamped bar")


def calculix_answer(mesh: Path, deck: Path) -> dict[str, Any]:
    """CalculiX's own displacement and largest stress, read from its printed results (not part of its time)."""
    from peer_alula import problem

    from alula.fea.calculix.program import read_dat
    from alula.fea.solid.stress import von_mises

    space, *_ = problem(str(mesh))
    u, stress = read_dat(deck.with_suffix(".dat"), nodes=len(space.nodes), elements=len(space.cells), points=4)
    return {
        "unknowns": space.unknowns,
        "solver": "CalculiX",
        "tip_mm": float(u[np.unique(space.faces("end")), 2].min()),
        "von_mises_mpa": float(von_mises(stress).max()),
    }


def commands(ngsolve: str | None) -> dict[str, list[str]]:
    """Program -> command, with {mesh}, {job} and {threads} to fill in."""
    own = sys.executable
    found = {
        "alula": [own, str(HERE / "peer_alula.py"), "{mesh}", "auto", "{threads}"],
        "alula, PARDISO": [own, str(HERE / "peer_alula.py"), "{mesh}", "pardiso", "{threads}"],
        "scikit-fem, spsolve": [own, str(HERE / "peer_scikit_fem.py"), "{mesh}", "-", "{threads}"],
    }
    if ngsolve:
        script = str(HERE / "peer_ngsolve.py")
        found["NGSolve, direct"] = [ngsolve, script, "{mesh}", "direct", "{threads}"]
        found["NGSolve, BDDC"] = [ngsolve, script, "{mesh}", "bddc", "{threads}"]
    if shutil.which("ccx"):
        found["CalculiX"] = ["ccx", "-i", "{job}"]
    return found


def run(command: list[str], folder: Path, threads: int, limit: float) -> dict[str, Any]:
    """Run one program once: wall seconds, processor seconds, peak memory [GB], its answer or its end."""
    environment = os.environ | {name: str(threads) for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS")}
    environment["CCX_NPROC_EQUATION_SOLVER"] = str(threads)
    start = time.perf_counter()
    with (folder / "stdout").open("wb") as out, (folder / "stderr").open("wb") as err:
        child = subprocess.Popen(
            command,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)),
        )
        deadline = start + limit
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.perf_counter() > deadline:
                child.kill()
                os.wait4(child.pid, 0)
                return {"end": "out of time", "limit_s": limit}
            time.sleep(0.02)
    record: dict[str, Any] = {
        "wall_s": round(time.perf_counter() - start, 2),
        "cpu_s": round(usage.ru_utime + usage.ru_stime, 2),
        "peak_gb": round(usage.ru_maxrss * 1024 / 1e9, 2),
    }
    if status != 0:
        said = (folder / "stderr").read_text(errors="replace").strip().splitlines()
        memory = any("memory" in line.lower() or "alloc" in line.lower() for line in said)
        return {**record, "end": "out of memory" if memory else f"status {os.waitstatus_to_exitcode(status)}"}
    text = (folder / "stdout").read_text(errors="replace")
    if text.startswith("{"):
        record["answer"] = json.loads(text[: text.index("}") + 1])
    return record


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="+", choices=[*COUNTS, *(f"{name}{CURVED}" for name in COUNTS)], default=SIZES)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--time-limit", type=float, default=600.0)
    parser.add_argument("--ngsolve", help="an interpreter that can import ngsolve")
    parser.add_argument(
        "--repeated", nargs="*", default=SIZES[:2], help="sizes that are run --repeats times, the rest once"
    )
    options = parser.parse_args()
    programs = commands(options.ngsolve)
    rows: list[dict[str, Any]] = []
    beaten: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for size in options.sizes:
            mesh, deck = folder / f"{size}.npz", folder / f"{size}.inp"
            write_mesh(mesh, size)
            if "CalculiX" in programs:
                write_deck(mesh, deck)
            takers = [name for name in programs if name in READ_CURVED or not size.endswith(CURVED)]
            runs: dict[str, list[dict[str, Any]]] = {name: [] for name in takers}
            for name in takers:
                if name in beaten:
                    runs[name].append({"end": beaten[name]})
            for _ in range(options.repeats if size in options.repeated else 1):
                for name in takers:
                    if any("end" in r for r in runs[name]):
                        continue
                    command = programs[name]
                    filled = [
                        part.format(mesh=mesh, job=deck.with_suffix(""), threads=options.threads) for part in command
                    ]
                    runs[name].append(run(filled, folder, options.threads, options.time_limit))
                    if name == "CalculiX" and "end" not in runs[name][-1]:
                        runs[name][-1]["answer"] = calculix_answer(mesh, deck)
                    print(size, name, json.dumps(runs[name][-1]), flush=True)
                    if runs[name][-1].get("end") in ("out of time", "out of memory"):
                        beaten[name] = f"{runs[name][-1]['end']} at {size}"
            rows += [summary(size, name, found) for name, found in runs.items() if found]
            save(rows, options)


def summary(size: str, name: str, found: list[dict[str, Any]]) -> dict[str, Any]:
    """Medians of one program at one size."""
    whole = [r for r in found if "end" not in r]
    row: dict[str, Any] = {"size": size, "program": name, "runs": found}
    if whole:
        row |= {key: statistics.median(r[key] for r in whole) for key in ("wall_s", "cpu_s", "peak_gb")}
    else:
        row["end"] = found[-1]["end"]
    return row


def save(rows: list[dict[str, Any]], options: argparse.Namespace) -> None:
    """Write the rows with alula's time over each program's."""
    for row in rows:
        own = next((r for r in rows if r["size"] == row["size"] and r["program"] == "alula"), None)
        if own and "wall_s" in own and "wall_s" in row:
            row["alula_over_this"] = round(own["wall_s"] / row["wall_s"], 3)
            row["alula_cpu_over_this"] = round(own["cpu_s"] / row["cpu_s"], 3)
    RESULTS.parent.mkdir(exist_ok=True)
    record = circumstances("peers") | {"threads": options.threads, "rows": rows}
    RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
