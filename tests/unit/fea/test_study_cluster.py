"""A study on Dask's workers, in processes of their own: the same answers, and it survives what dies."""

import gc
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, nullcontext
from pathlib import Path

import programs
import pytest
import studies

from alula.fea.study import cluster as on_cluster
from alula.fea.study.cluster import _require_fit, cluster_engine
from alula.fea.study.compute import compute_study
from alula.fea.study.evaluate import versions
from alula.fea.study.store import Store
from alula.fea.study.study import Study
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants

# Sockets to schedulers and workers that are gone are left to the garbage collector by distributed, which closes them
# with a warning in whatever test runs then; what it calls that is deprecated depends on its version and Python's.
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
    """What every point has, but for times; numbers as text, where what is not a number is like itself."""
    return [(position, values, a.state, repr(a.numbers)) for position, values, a, _ in store.rows()]


@pytest.mark.converged
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


@pytest.fixture
def other_server():
    """The address of a server that is no scheduler: it answers as the web's do."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve():
            while True:
                try:
                    asking, _ = server.accept()
                except OSError:  # closed
                    return
                asking.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n" * 10)

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
        server.shutdown(socket.SHUT_RDWR)


@pytest.mark.parametrize("who", ["nobody", "another server"])
def test_what_is_no_scheduler_is_one_sentence_in_time(who, other_server, monkeypatch, capfd):
    """The remedy is the command that starts one.

    The first bytes of another server were taken for a length, for which memory did not suffice; then the client waited
    a minute for its own end, and told of that with a traceback.
    """
    monkeypatch.setattr(on_cluster, "CONNECTING", 0.5)
    begun = time.monotonic()
    with (
        pytest.raises(CannotRunError, match=r"no Dask scheduler answers at .*dask scheduler"),
        cluster_engine("tcp://127.0.0.1:9" if who == "nobody" else other_server, {}),
    ):
        pass
    gc.collect()
    assert time.monotonic() - begun < 10.0
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize("address", ["file:///tmp/x", "nonsense", "tcp://", "tcp://host", "host:port", "tcp://h:99999"])
def test_an_address_of_another_form_is_refused_before_anything_is_written(address, tmp_path):
    with pytest.raises(CaseError, match=f"--scheduler: it is '{address}', but .*tcp://host:8786"):
        compute_study(variants("5..8 by 1"), tmp_path / "out", scheduler=address)
    assert not (tmp_path / "out").exists()
