"""A study that is killed at any moment, workers or parent, loses nothing, computes nothing twice, and goes on."""

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import programs
import pytest
import studies
from edited_cases import PLANAR

from alula.fea.study.store import Store
from alula.fea.study.study import Study
from alula.geometry.base.errors import AlulaError
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants

PLAN = {"case": "four-bar-synthesis", "analysis": "motion", "mass": False, "set": {"layer_spacing": "0 mm"}}
COMMAND = (sys.executable, "-m", "alula", "study", "four-bar-synthesis", "--analysis", "motion", "--no-mass")


def rows(folder: Path) -> dict[int, tuple[object, ...]]:
    """What every point has, but for times and attempts; numbers as text, where what is not a number is like itself."""
    with Store.reading(folder) as store:
        return {position: (v, a.state, a.verdict, repr(a.numbers)) for position, v, a, _ in store.rows()}


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


def computed_here(folder: Path, poses: str) -> dict[int, tuple[object, ...]]:
    """The rows of the study, computed in this process from beginning to end."""
    with Store.writing(folder) as store:
        Study(variants=Variants(plan_of(PLAN | {"vary": {"motion.poses": poses}}), folder), store=store).run(
            studies.here
        )
    return rows(folder)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes are found by /proc")
@pytest.mark.parametrize(("kills", "points"), [(2, 8), pytest.param(200, 20, marks=pytest.mark.converged)])
def test_nothing_is_lost_and_nothing_twice(kills, points, tmp_path):
    """Every other kill hits a worker, the rest the parent; afterwards the same command ends the study.

    Two kills hit a study of one worker in which some points have an answer; of 200, of two workers, each comes at any
    time.
    """
    poses, workers = f"40..{39 + points} by 1", "1" if kills == 2 else "2"
    asked = [*COMMAND, "--set", PLANAR, "--vary", f"motion.poses={poses}", "--threads", workers, "--retry"]
    whole, broken = computed_here(tmp_path / "whole", poses), tmp_path / "broken"
    chance = random.Random(5)
    hit, before = 0, dict[int, tuple[object, ...]]()
    while hit < kills:
        study = subprocess.Popen(
            [*asked, "-o", str(broken)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=programs.ROOT
        )
        if kills > 2:
            time.sleep(chance.uniform(0.0, 2.5))
        while study.poll() is None and hit < kills:
            if kills == 2 and answered(broken) < 2 * hit + 1:
                time.sleep(0.05)
                continue
            running = children(study.pid)
            target = chance.choice(running) if running and hit % 2 == 0 else study.pid
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
        if len(before) == points and hit < kills:
            broken = broken.with_name(f"broken-{hit}")
            before = {}
    end = subprocess.run([*asked, "-o", str(broken)], capture_output=True, text=True, cwd=programs.ROOT)
    assert end.returncode == 0, end.stderr
    assert rows(broken) == whole
    assert not [left for left in broken.iterdir() if left.name.startswith(".alula-work-")]
