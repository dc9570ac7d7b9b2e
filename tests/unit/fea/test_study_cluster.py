"""A study on Dask's workers, in processes of their own: the same answers, and it survives what dies."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager, nullcontext
from pathlib import Path

import programs
import pytest
import studies

from fea.study.cluster import _require_fit, cluster_engine
from fea.study.evaluate import versions
from fea.study.store import Store
from fea.study.study import Study
from geometry.base.errors import CannotRunError
from loads.plans.plan import plan_of
from loads.plans.variants import Variants

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")


@contextmanager
def cluster(folder: Path):
    """A scheduler and two workers of one thread, as the documentation starts them; yields address and processes."""
    environment = programs.environment(folder, DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0")
    dask = (sys.executable, "-m", "distributed.cli.dask_scheduler")
    quiet = {"cwd": folder, "env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    file = folder / "scheduler.json"
    started = [subprocess.Popen([*dask, "--port", "0", "--no-dashboard", "--scheduler-file", str(file)], **quiet)]
    worker = (sys.executable, "-m", "distributed.cli.dask_worker", "--nthreads", "1", "--no-dashboard")
    try:
        started += [
            subprocess.Popen([*worker, "--nworkers", "1", "--no-nanny", "--scheduler-file", str(file)], **quiet)
            for _ in range(2)
        ]
        yield file, started
    finally:
        for process in started:
            process.kill()
            process.wait()


def address_of(file: Path) -> str:
    """The address that the scheduler wrote, once it has."""
    import json
    import time

    for _ in range(600):
        if file.exists() and file.read_text(encoding="utf-8").strip():
            return str(json.loads(file.read_text(encoding="utf-8"))["address"])
        time.sleep(0.1)
    raise AssertionError("the scheduler did not start")


def variants(poses: str) -> Variants:
    """Motions of a four-bar with different numbers of poses."""
    plan = {"case": "four-bar-synthesis", "analysis": "motion", "vary": {"motion.poses": poses}}
    plan |= {"mass": False, "set": {"layer_spacing": "0 mm"}}
    return Variants(plan_of(plan), Path())


def rows(store: Store):
    """What every point has, but for times."""
    return [(position, values, a.state, a.numbers) for position, values, a, _ in store.rows()]


def test_a_cluster_answers_as_this_machine_does_and_survives_what_dies(tmp_path):
    """A killed worker costs its point an attempt; a killed scheduler ends the study, and this machine goes on."""
    few, many = variants("5..8 by 1"), variants("5..24 by 1")
    with Store.writing(tmp_path / "here") as store:
        Study(variants=few, store=store).run(studies.here)
        expected = rows(store)
    with cluster(tmp_path) as (file, (scheduler, killed, _)):
        address = address_of(file)
        with Store.writing(tmp_path / "few") as store:
            Study(variants=few, store=store).run(lambda: cluster_engine(address, {}))
            assert rows(store) == expected

        def kill(progress):
            if progress.computed == 3:
                os.kill(killed.pid, signal.SIGKILL)
            if progress.computed == 8:
                os.kill(scheduler.pid, signal.SIGKILL)

        with Store.writing(tmp_path / "many") as store:
            with pytest.raises(CannotRunError, match=r"goes? on with the study"):
                Study(variants=many, store=store, tell=kill).run(lambda: cluster_engine(address, {}, patience=2.0))
            stood = rows(store)
            assert 8 <= len(stood) < 20
    with Store.writing(tmp_path / "many") as store:
        done = Study(variants=many, store=store).run(studies.here)
        assert done.stood >= len([row for row in stood if row[2] == "done"])
        assert [(position, state) for position, _, state, _ in rows(store)] == [(i, "done") for i in range(20)]
        assert {repr(row) for row in stood if row[2] == "done"} <= set(map(repr, rows(store)))


class Client:
    """What a scheduler says of its workers, without any."""

    def __init__(self, threads, found):
        self.threads, self.found = threads, found

    def wait_for_workers(self, count, timeout):
        pass

    def nthreads(self):
        return {"tcp://one:1": 1, "tcp://two:2": self.threads}

    def run(self, asked):
        return {"tcp://one:1": asked(), "tcp://two:2": self.found}


@pytest.mark.parametrize(
    ("threads", "found", "sentence"),
    [
        (1, versions(), None),
        (1, list(versions()), None),  # as a message may bring them
        (2, versions(), r"tcp://two:2 has several threads; .*--nthreads 1"),
        (1, ("0.0.9", versions()[1]), r"tcp://two:2 has alula 0\.0\.9 with gmsh .*install equal versions"),
        (1, (versions()[0], "4.0"), r"tcp://two:2 has alula .* with gmsh 4\.0, but here .*install equal versions"),
    ],
)
def test_workers_that_would_answer_otherwise_are_refused(threads, found, sentence):
    """One of several threads, whose limits would hold for all of them, or of another version of alula or gmsh."""
    refused = nullcontext() if sentence is None else pytest.raises(CannotRunError, match=sentence)
    with refused:
        _require_fit(Client(threads, found), "tcp://one:0", 1.0)


def test_what_answers_at_no_address_is_one_sentence():
    """Nobody is there; the remedy is the command that starts a scheduler."""
    with (
        pytest.raises(CannotRunError, match="dask scheduler"),
        cluster_engine("tcp://127.0.0.1:9", {}, patience=0.5),
    ):
        pass
