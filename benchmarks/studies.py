"""What a study costs beside its checks: a point, a second worker, the store; writes benchmarks/results/studies.json.

python benchmarks/studies.py [--points 200] [--solids 8] [--rows 5000]

Every worker has computed some points before a time is taken, so that its start does not count.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from record import Others, Stopwatch, save

from alula.fea.study.engine import Engine, local_engine
from alula.fea.study.numbers import VariantResult
from alula.fea.study.store import NAME, Store
from alula.fea.study.study import Study, task_of
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants

CASE, ENTRY = "owl-wing-static", "parts.tube.outer_diameter"
AT_ONCE = 2
"""Workers whose efficiency is measured."""


def variants(count: int, first: float, fidelity: str) -> Variants:
    """Points that no other call has, near the case's own diameter of 5 mm."""
    values = [f"{first + 1e-4 * i:.4f} mm" for i in range(count)]
    plan = plan_of({"case": CASE, "vary": {ENTRY: values}, "fidelity": fidelity, "mass": False})
    return Variants(plan, Path())


@contextmanager
def warm(workers: int, folder: Path) -> Iterator[Engine]:
    """Local workers that have computed some points by hand calculation."""
    with local_engine(workers, {}, folder=folder) as engine:
        first = variants(2 * workers, 4.5, "beam")
        for future in [engine.submit(task_of(first.plan, first.tables(point))) for point in first.points]:
            future.result()
        yield engine


def study(count: int, workers: int, fidelity: str) -> tuple[dict[str, Any], list[VariantResult]]:
    """One study from its first point to its last, by warm workers."""
    with (
        tempfile.TemporaryDirectory() as name,
        Store.writing(Path(name)) as store,
        warm(workers, Path(name)) as engine,
    ):
        others, watch = Others(), Stopwatch()
        Study(variants=variants(count, 5.0, fidelity), store=store).run(lambda: nullcontext(engine))
        spent = watch.read()
        answers = [answer for _, _, answer, _ in store.rows()]
        share = others.share(spent["cpu_s"] + sum(answer.processor for answer in answers))
    if any(answer.state != "done" for answer in answers):
        raise SystemExit(f"a point was not computed: {answers[0].sentence}")
    checks = {key: sum(getattr(answer, key) for answer in answers) for key in ("seconds", "processor")}
    return {
        "fidelity": fidelity,
        "points": count,
        "workers": workers,
        "wall_s": spent["wall_s"],
        "check_wall_s": checks["seconds"] / count,
        "check_cpu_s": checks["processor"] / count,
        "parent_cpu_s": spent["cpu_s"] / count,
        "beside_wall_s": spent["wall_s"] / count - checks["seconds"] / count / workers,
        "others": share,
    }, answers


def stored(answer: VariantResult, rows: int) -> dict[str, Any]:
    """Rows a second into the store, each a transaction as in a study, and bytes a row."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with Store.writing(folder) as store:
            store.begin({"plan": {}, "versions": [], "points": rows}, [ENTRY])
            watch = Stopwatch()
            for row in range(rows):
                store.add(row, f"{row:064x}", {ENTRY: f"{5.0 + 1e-4 * row:.4f} mm"}, answer)
            spent = watch.read()
        size = (folder / NAME).stat().st_size
        start = time.perf_counter()
        with Store.reading(folder) as store:
            read = sum(1 for _ in store.rows())
        reading = time.perf_counter() - start
    assert read == rows
    return {
        "rows": rows,
        "numbers_a_row": len(answer.numbers),
        "rows_a_second": rows / spent["wall_s"],
        "cpu_s_a_row": spent["cpu_s"] / rows,
        "bytes_a_row": size / rows,
        "read_rows_a_second": rows / reading,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=200, help="points by hand calculation")
    parser.add_argument("--solids", type=int, default=8, help="points by solids; 0 for none")
    parser.add_argument("--rows", type=int, default=5000)
    options = parser.parse_args()
    runs: list[dict[str, Any]] = []
    answers: list[VariantResult] = []
    for fidelity, count in (("beam", options.points), ("auto", options.solids)):
        for workers in (1, AT_ONCE) if count else ():
            run, answers = study(count, workers, fidelity)
            runs.append(run)
            print(json.dumps(run), flush=True)
    store = stored(answers[0], options.rows)
    print(json.dumps(store), flush=True)
    save("studies", {"benchmark": "studies", "case": CASE, "runs": runs, "store": store, "threads": 1})


if __name__ == "__main__":
    main()
