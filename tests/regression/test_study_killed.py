"""A study that is killed at any moment, workers or parent, loses nothing, computes nothing twice, and goes on."""

import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from contextlib import nullcontext, suppress
from pathlib import Path

import programs
import pytest
from edited_cases import PLANAR

from fea.study.engine import Engine
from fea.study.evaluate import Task, evaluate
from fea.study.numbers import VariantResult
from fea.study.store import Store
from fea.study.study import Study
from geometry.base.errors import AlulaError
from loads.plans.plan import plan_of
from loads.plans.variants import Variants

POINTS = 20
PLAN = {
    "case": "four-bar-synthesis", "analysis": "motion", "mass": False, "set": {"layer_spacing": "0 mm"},
    "vary": {"motion.poses": "40..59 by 1"},
}  # fmt: skip
COMMAND = (
    *(sys.executable, "-m", "alula", "study", "four-bar-synthesis", "--analysis", "motion", "--workers", "2"),
    *("--vary", "motion.poses=40..59 by 1", "--no-mass", "--set", PLANAR),
)


def rows(folder: Path) -> dict[int, tuple[object, ...]]:
    """What every point has, but for times and attempts."""
    with Store.reading(folder) as store:
        return {position: (v, a.state, a.verdict, a.numbers) for position, v, a, _ in store.rows()}


def children(of: int) -> list[int]:
    """Processes whose parent is the given one."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            if int(status.read_text().rpartition(")")[2].split()[1]) == of:
                found.append(int(status.parent.name))
    return found


def answered(folder: Path) -> int:
    """How many points have an answer by now."""
    with suppress(AlulaError):
        return sum(row[1] == "done" for row in rows(folder).values())
    return 0


def computed_here(folder: Path) -> dict[int, tuple[object, ...]]:
    """The rows of the study, computed in this process from beginning to end."""

    def submit(task: Task) -> Future[VariantResult]:
        future: Future[VariantResult] = Future()
        future.set_result(evaluate(task, {}))
        return future

    with Store.writing(folder) as store:
        variants = Variants(plan_of(PLAN), folder)
        Study(variants=variants, store=store).run(lambda: nullcontext(Engine(submit=submit, capacity=lambda: 1)))
    return rows(folder)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes are found by /proc")
@pytest.mark.parametrize("kills", [2, pytest.param(200, marks=pytest.mark.converged)])
def test_nothing_is_lost_and_nothing_twice(kills, tmp_path):
    """Every other kill hits a worker, the rest the parent; afterwards the same command ends the study.

    Two kills hit a study in which some points have an answer; of 200, each comes at any time.
    """
    whole, broken = computed_here(tmp_path / "whole"), tmp_path / "broken"
    chance = random.Random(5)
    hit, before = 0, dict[int, tuple[object, ...]]()
    while hit < kills:
        command = [*COMMAND, "-o", str(broken), "--retry"]
        study = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=programs.ROOT)
        if kills > 2:
            time.sleep(chance.uniform(0.0, 2.5))
        while study.poll() is None and hit < kills:
            if kills == 2 and answered(broken) < 2 * hit + 1:
                time.sleep(0.05)
                continue
            workers = children(study.pid)
            target = chance.choice(workers) if workers and hit % 2 == 0 else study.pid
            with suppress(ProcessLookupError):
                os.kill(target, signal.SIGKILL)
                hit += 1
            if target == study.pid:
                break
            time.sleep(chance.uniform(0.0, 0.5))
        assert study.wait() in (0, -signal.SIGKILL), study.stderr.read()
        study.stderr.close()
        if (broken / "study.sqlite").exists():
            after = rows(broken)
            done = {position: row for position, row in before.items() if row[1] == "done"}
            assert done.items() <= after.items()
            before = after
        if len(before) == POINTS and hit < kills:
            broken = broken.with_name(f"broken-{hit}")
            before = {}
    end = subprocess.run([*COMMAND, "-o", str(broken), "--retry"], capture_output=True, text=True, cwd=programs.ROOT)
    assert end.returncode == 0, end.stderr
    assert rows(broken) == whole
    assert not [left for left in broken.iterdir() if left.name.startswith(".alula-work-")]
