"""Speed against accuracy on three parts with reference solutions; writes benchmarks/results/accuracy.json.

Hand calculation, frame, linear and quadratic elements, straight and curved, on meshes of one size and on meshes that
follow the estimated error. The time is that of mesh, assembly, solution and recovered stress, and for adaptive meshes
that of all meshes before as well, in one thread of one warm process. The error is that of the largest von Mises stress
of all nodes and of one displacement.

    python benchmarks/accuracy.py [--largest 100000] [--adaptive-steps 7] [--parts tube cylinder strip]
"""

import argparse
import sys
import timeit
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

import accuracy_parts  # noqa: E402
from record import Stopwatch, save  # noqa: E402
from solid_problems import Problem, Solved  # noqa: E402

from alula.fea.common.threads import bounded  # noqa: E402
from alula.fea.refine.target_sizes import LocalGoal, next_sizes, reduction  # noqa: E402
from alula.geometry.base.errors import AlulaError  # noqa: E402

TARGETS = (0.10, 0.05, 0.02, 0.01)
STEP = 1.4
"""Size of one mesh over that of the next."""
AIM = 0.01
"""Error that the adaptive meshes aim at."""
TURN = 8
"""Elements a turn, at least, on round surfaces."""
ELEMENTS = {
    "linear": {"order": 1, "curved": False},
    "quadratic, straight": {"order": 2, "curved": False},
    "quadratic, curved": {"order": 2, "curved": True},
}


def solved_on(part: accuracy_parts.Part, size: Any, *, order: int, curved: bool, turn: int = TURN) -> Solved:
    """Mesh, solve and recover the stress."""
    p = Problem(mesh=accuracy_parts.mesh(part, size, curved=curved, turn=turn), E=part.E, nu=part.nu, order=order)
    part.hold_and_load(p)
    solved = p.solve()
    assert solved.field.peak.value > 0.0
    return solved


def run(part: accuracy_parts.Part, solved: Solved, spent: dict[str, float]) -> dict[str, Any]:
    """One point of a curve."""
    return {
        "unknowns": solved.unknowns,
        "elements": len(solved.problem.space.cells),
        "stress_error": solved.field.peak.value / part.reference[0] - 1.0,
        "displacement_error": part.displacement(solved) / part.reference[1] - 1.0,
        **spent,
    }


def uniform(part: accuracy_parts.Part, elements: dict[str, Any], largest: int) -> Iterator[dict[str, Any]]:
    """Meshes of one size, ever smaller, up to a number of unknowns."""
    size, unknowns = part.size, 0
    while unknowns * STEP**3 <= largest:
        watch = Stopwatch()
        solved = solved_on(part, size, **elements)
        yield run(part, solved, watch.read())
        # Coarse meshes of a thin wall hardly grow with a smaller size.
        unknowns, size = solved.unknowns, size / STEP


def adaptive(part: accuracy_parts.Part, elements: dict[str, Any], largest: int, steps: int) -> Iterator[dict[str, Any]]:
    """Meshes that follow the estimate of the one before, towards ``AIM`` in stress and displacement."""
    size: Any = part.size
    spent, turn = {"wall_s": 0.0, "cpu_s": 0.0}, TURN
    for _ in range(steps):
        watch = Stopwatch()
        solved = solved_on(part, size, turn=turn, **elements)
        spent = {key: seconds + watch.read()[key] for key, seconds in spent.items()}
        yield run(part, solved, spent)
        watch = Stopwatch()
        estimate, field, space = solved.estimate, solved.field, solved.problem.space
        goal = LocalGoal(
            location=field.peak.location,
            value=field.peak.value,
            stress=field.von_mises[space.cells].max(axis=1),
            estimate=estimate.stress,
            allowed=AIM / 1.5,
        )
        factor = reduction(estimate.energy, estimate.energy_norm, np.sqrt(AIM) / 2.0, float(elements["order"]))
        size = next_sizes(space, [factor], [goal])
        if not elements["curved"]:  # straight sides miss the round of a surface, which sizes alone would leave
            turn = round(1.5 * turn)
        spent = {key: seconds + watch.read()[key] for key, seconds in spent.items()}
        # The next mesh has 1 to 3 times the unknowns of this one.
        if 2.0 * solved.unknowns > largest:
            break


def cheap(part: accuracy_parts.Part, answer: Callable[[], accuracy_parts.Answer]) -> list[dict[str, Any]]:
    """Hand calculation or frame, timed by repetition."""
    stress, displacement = answer()
    clock = timeit.Timer(answer)
    calls, _ = clock.autorange()
    seconds = min(clock.repeat(repeat=3, number=calls)) / calls
    return [
        {
            "unknowns": 0,
            "stress_error": stress / part.reference[0] - 1.0,
            "displacement_error": displacement / part.reference[1] - 1.0,
            "wall_s": seconds,
            "cpu_s": seconds,
        }
    ]


def time_to(runs: list[dict[str, Any]], quantity: str) -> dict[str, float | None]:
    """Target -> processor seconds of the cheapest of the last runs that all stay within it; None for none."""
    found: dict[str, float | None] = {}
    for target in TARGETS:
        within = None
        for one in reversed(runs):
            if not abs(one[quantity]) <= target:
                break
            within = min(one["cpu_s"], within or one["cpu_s"])
        found[f"{target:.0%}"] = within
    return found


def curves(part: accuracy_parts.Part, largest: int, steps: int) -> Iterator[dict[str, Any]]:
    """All models of a part."""
    yield {"model": "hand", "runs": cheap(part, part.by_hand)}
    if part.by_frame is not None:
        yield {"model": "frame", "runs": cheap(part, part.by_frame)}
    for name, elements in ELEMENTS.items():
        for kind, series in (
            ("uniform", uniform(part, elements, largest)),
            ("adaptive", adaptive(part, elements, largest, steps)),
        ):
            curve: dict[str, Any] = {"model": f"{name}, {kind}", "runs": []}
            try:
                for one in series:
                    curve["runs"].append(one)
                    print(f"  {curve['model']}: {told(one)}", flush=True)
            except (AlulaError, MemoryError) as error:
                curve["end"] = str(error) or "out of memory"
                print(f"  {curve['model']}: {curve['end']}", flush=True)
            yield curve


def told(one: dict[str, Any]) -> str:
    """One line for the terminal."""
    errors = f"stress {one['stress_error']:+.2%}, displacement {one['displacement_error']:+.3%}"
    return f"{one['unknowns']:,} unknowns, {one['cpu_s']:.2f} s of processor ({one['wall_s']:.2f} s): {errors}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--largest", type=int, default=100_000, help="unknowns of the finest mesh")
    parser.add_argument("--adaptive-steps", type=int, default=7)
    names = [make.__name__ for make in accuracy_parts.PARTS]
    parser.add_argument("--parts", nargs="+", choices=names, default=names)
    options = parser.parse_args()
    parts = []
    with bounded(1):
        solved_on(accuracy_parts.cylinder(), 5.0, order=2, curved=True)  # imports and warms all that the others use
        for make in accuracy_parts.PARTS:
            if make.__name__ not in options.parts:
                continue
            part = make()
            print(part.name, flush=True)
            found = list(curves(part, options.largest, options.adaptive_steps))
            for curve in found:
                curve["time_to"] = {q: time_to(curve["runs"], f"{q}_error") for q in ("stress", "displacement")}
            parts.append(
                {
                    "part": part.name,
                    "about": (make.__doc__ or "").strip(),
                    "source": part.source,
                    "peak_von_mises_mpa": part.reference[0],
                    "displacement_mm": part.reference[1],
                    "curves": found,
                }
            )
    save("accuracy", {"benchmark": "speed against accuracy", "threads": 1, "parts": parts})


if __name__ == "__main__":
    main()
