"""Time and memory of assembly, set-up, solution and stress against the number of unknowns.

A bar of quadratic tetrahedra, free and in bending, from a mesh file to displacements and stresses, each
run in a process of its own. Prints a table and writes benchmarks/results/solvers.json.

    python benchmarks/solvers.py [--sizes 160k 550k 1500k] [--solvers auto pardiso] [--threads 2] [--curved]
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from record import circumstances

ROOT = Path(__file__).resolve().parents[1]
RESULTS = Path(__file__).parent / "results" / "solvers.json"
COUNTS = {"20k": (30, 5, 5), "160k": (60, 10, 10), "550k": (90, 16, 15), "1500k": (126, 22, 22)}
E, NU = 2900.0, 0.38


def grid(counts: tuple[int, int, int], curved: bool) -> tuple[np.ndarray, np.ndarray]:
    """Points and tetrahedra of a box of unit cubes, six to each (Kuhn); curved ones have mid-nodes, to be ``bent``."""
    nx, ny, nz = (n + 1 for n in counts)
    number = np.arange(nx * ny * nz).reshape(nx, ny, nz)
    cells = []
    for axes in ((0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)):
        corner = np.zeros(3, dtype=int)
        path = [corner.copy()]
        for axis in axes:
            corner[axis] += 1
            path.append(corner.copy())
        ends = [number[a : a + nx - 1, b : b + ny - 1, c : c + nz - 1].ravel() for a, b, c in path]
        cells.append(np.column_stack(ends))
    points = np.stack(np.meshgrid(*(np.arange(n, dtype=float) for n in (nx, ny, nz)), indexing="ij"), -1).reshape(-1, 3)
    corners = np.vstack(cells)
    if not curved:
        return points, corners
    pairs = corners[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]]
    edges, place = np.unique(np.sort(pairs.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    points = np.vstack([points, points[edges].mean(axis=1)])
    return points, np.hstack([corners, nx * ny * nz + place.reshape(-1, 6)])


def bent(points: np.ndarray) -> np.ndarray:
    """The points of a grid, moved by a smooth field that leaves no edge straight."""
    return points + 0.03 * np.sin(2.0 * points[:, [1, 2, 0]] + points)


def measured(path: Path, solver: str, threads: int) -> dict[str, Any]:
    """Seconds, processor seconds and peak memory [GB] of each stage of one run."""
    stages: list[dict[str, Any]] = []

    def stage(name: str, task: Callable[[], Any]) -> Any:
        wall, cpu = time.perf_counter(), time.process_time()
        value = task()
        stages.append(
            {
                "stage": name,
                "wall_s": round(time.perf_counter() - wall, 3),
                "cpu_s": round(time.process_time() - cpu, 3),
                "peak_gb": round(peak(), 3),
            }
        )
        return value

    def imported() -> None:
        import alula.fea.solid.solution  # noqa: F401

    stage("import", imported)
    from alula.fea.common.threads import bounded
    from alula.fea.elements.elasticity import assemble_stiffness
    from alula.fea.elements.space import displacement_space
    from alula.fea.elements.supports import isostatic_supports, rigid_motions
    from alula.fea.solid.stress import stress_field
    from alula.fea.solvers.solve import factorise
    from alula.fea.solvers.two_level import LinearLevel
    from alula.geometry.meshing.tagged_mesh import TaggedMesh
    from alula.reports.sentences import told

    def read() -> TaggedMesh:
        with np.load(path) as file:
            return TaggedMesh(
                points=file["points"], cells=file["cells"], surfaces={}, areas={}, volume=0.0, centroid=np.zeros(3)
            )

    with bounded(threads):
        mesh = stage("read", read)
        space = stage("space", lambda: displacement_space(mesh))
        fixed = isostatic_supports(space.nodes, space.corners)
        K = stage("assembly", lambda: assemble_stiffness(space, E=E, nu=NU))
        K.fix(fixed)

        def load() -> np.ndarray:
            """Bending in both planes and twist, balanced by what the rigid-body motions say."""
            motions = rigid_motions(space.nodes, space.nodes.mean(axis=0)).reshape(6, -1)
            x = space.nodes / np.ptp(space.nodes, axis=0)
            force = np.column_stack(
                [np.sin(2.0 * x[:, 1]), np.cos(2.0 * np.pi * x[:, 0]), np.sin(5.0 * x[:, 0])]
            ).ravel()
            force -= motions.T @ np.linalg.solve(motions @ motions.T, motions @ force)
            force[fixed] = 0.0
            return force

        rhs = stage("load", load)
        level = LinearLevel(space=space, E=E, nu=NU, fixed=fixed)
        method = None if solver == "auto" else solver
        factor = stage("set-up", lambda: factorise(K, level=level, method=method, threads=threads))
        solved = stage("solution", lambda: factor.solved(rhs))
        stage("stress", lambda: stress_field(space, solved.x.reshape(-1, 3), E=E, nu=NU))
    return {
        "unknowns": space.unknowns,
        "elements": len(space.cells),
        "name": factor.name,
        "reason": told(factor.reason),
        "iterations": solved.iterations,
        "error": solved.error,
        "stages": stages,
    }


def peak() -> float:
    """Largest memory that this process has held [GB]."""
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="+", choices=COUNTS, default=["160k", "550k", "1500k"])
    parser.add_argument("--solvers", nargs="+", choices=["auto", "pardiso", "superlu", "two-level"], default=["auto"])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--curved", action="store_true")
    parser.add_argument("--child", nargs=2, metavar=("MESH", "SOLVER"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        json.dump(measured(Path(options.child[0]), options.child[1], options.threads), sys.stdout)
        return
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        for size in options.sizes:
            path = Path(folder) / f"{size}.npz"
            points, cells = grid(COUNTS[size], options.curved)
            np.savez(path, points=bent(points) if options.curved else points, cells=cells)
            for solver in options.solvers:
                runs.append(run(path, solver, options.threads))
                report(runs[-1])
    for solver in options.solvers:
        own = [r for r in runs if r["solver"] == solver and "stages" in r]
        if len(own) > 1:
            first, last = own[0], own[-1]
            growth = math.log(last["cpu_s"] / first["cpu_s"]) / math.log(last["unknowns"] / first["unknowns"])
            print(f"{solver}: processor time grows with power {growth:.2f} of the unknowns")
    RESULTS.parent.mkdir(exist_ok=True)
    record = circumstances("solvers") | {"threads": options.threads, "curved": options.curved, "runs": runs}
    RESULTS.write_text(json.dumps(record, indent=1) + "\n")


def run(path: Path, solver: str, threads: int) -> dict[str, Any]:
    """One run in a process of its own; wall and processor time of the whole process."""
    import resource

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    wall = time.perf_counter()
    command = [sys.executable, __file__, "--threads", str(threads), "--child", str(path), solver]
    ended = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment())
    wall = time.perf_counter() - wall
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    total = {"mesh": path.stem, "solver": solver, "wall_s": round(wall, 2), "cpu_s": round(cpu, 2)}
    if ended.returncode:
        return total | {"failed": (ended.stderr.strip().splitlines() or [f"status {ended.returncode}"])[-1]}
    return total | json.loads(ended.stdout)


def environment() -> dict[str, str]:
    import os

    return os.environ | {"PYTHONPATH": str(ROOT)}


def report(result: dict[str, Any]) -> None:
    print(f"{result['mesh']} {result['solver']}: {result['wall_s']} s wall, {result['cpu_s']} s of processor", end="")
    if "failed" in result:
        print(f": {result['failed']}")
        return
    print(f", {result['stages'][-1]['peak_gb']} GB, {result['unknowns']:,} unknowns")
    print(f"  {result['name']} ({result['reason']}); {result['iterations']} iterations, error {result['error']:.0e}")
    for entry in result["stages"]:
        seconds = f"{entry['wall_s']:8.2f} s wall {entry['cpu_s']:8.2f} s cpu"
        print(f"  {entry['stage']:10} {seconds} {entry['peak_gb']:6.2f} GB")


if __name__ == "__main__":
    main()
