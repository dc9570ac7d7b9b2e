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

from fea.study.store import Store

COMMAND = (
    *(sys.executable, "-m", "alula", "study", "four-bar-synthesis", "--analysis", "motion", "--workers", "2"),
    *("--vary", "motion.poses=40..79 by 1", "--no-mass"),
)
POINTS = 40


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


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes are found by /proc")
@pytest.mark.parametrize("kills", [4, pytest.param(200, marks=pytest.mark.converged)])
def test_nothing_is_lost_and_nothing_twice(kills, tmp_path):
    """Half of the kills hit a worker, half the parent; afterwards the same command ends the study."""
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    subprocess.run([*COMMAND, "-o", str(whole)], check=True, capture_output=True, cwd=programs.ROOT)
    chance = random.Random(5)
    hit, before = 0, dict[int, tuple[object, ...]]()
    while hit < kills:
        command = [*COMMAND, "-o", str(broken), "--retry"]
        study = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=programs.ROOT)
        time.sleep(chance.uniform(0.0, 2.5))
        while study.poll() is None and hit < kills:
            workers = children(study.pid)
            target = chance.choice(workers) if workers and chance.random() < 0.5 else study.pid
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
    assert rows(broken) == rows(whole)
    assert not [left for left in broken.iterdir() if left.name.startswith(".alula-work-")]
