"""What a run may take of the machine holds for all of it: libraries that are loaded or not yet, and children."""

import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits
from typer.testing import CliRunner

from alula.fea.check.run import check_case
from alula.fea.common.threads import VARIABLES, bounded, bounded_run
from alula.geometry.base import child
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case
from alula.reports.commands.cli import app


def threads_of_libraries() -> set[int]:
    assert np.ones(2) @ np.ones(2) == 2.0  # numpy's own is loaded
    return {pool["num_threads"] for pool in threadpool_info()}


@pytest.fixture(autouse=True)
def _environment(monkeypatch):
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)


def test_libraries_children_and_what_is_loaded_later_are_bounded_and_given_back(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    monkeypatch.setenv("MKL_NUM_THREADS", "of no use")
    before = threads_of_libraries()
    with bounded(2):
        assert max(threads_of_libraries()) <= 2
        assert [os.environ[name] for name in VARIABLES] == ["2", "1", "2"], "OpenBLAS takes one"
        with bounded(5):
            assert [os.environ[name] for name in VARIABLES] == ["2", "1", "2"], "an inner bound raises nothing"
        with bounded(1):
            assert threads_of_libraries() == {1}
            assert [os.environ[name] for name in VARIABLES] == ["1", "1", "1"]
    assert threads_of_libraries() == before
    assert [os.environ.get(name) for name in VARIABLES] == ["3", None, "of no use"]


def test_what_openmp_may_take_is_raised_for_no_library_that_is_loaded_later(monkeypatch):
    """OpenBLAS heeds its own variable before OpenMP's, so that a larger number there gave it more threads."""
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    code = "import scipy.linalg, threadpoolctl as t; print({pool['num_threads'] for pool in t.threadpool_info()})"
    with bounded(2):
        found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert found == "{1}\n"


def test_dense_algebra_has_one_thread_where_it_had_two():
    """The tests run with one for each library, so that two are set first."""
    with threadpool_limits(2):
        assert max(dense_threads()) == min(2, os.cpu_count() or 1)
        with bounded(2):
            assert dense_threads() == {1}


def dense_threads() -> set[int]:
    assert np.ones(2) @ np.ones(2) == 2.0  # numpy's own is loaded
    return {pool["num_threads"] for pool in threadpool_info() if pool["internal_api"] == "openblas"}


def test_nothing_is_bounded_without_a_number():
    with bounded(None):
        assert not any(name in os.environ for name in VARIABLES)


@pytest.mark.parametrize(("options", "seen"), [({"threads": 1}, "1"), ({}, "2")])
def test_a_whole_run_is_bounded_by_its_keyword_or_default(options, seen):
    @bounded_run
    def run(*, threads: int = 2) -> str:
        return os.environ["OMP_NUM_THREADS"]

    assert run(**options) == seen


@pytest.mark.parametrize(
    ("stage", "arguments"),
    [
        ("alula.fea.check.run.solve_case_statics", ("check", "--threads", "1")),
        ("alula.fea.motion.envelope.rubbed_motion", ("envelope", "--threads", "1")),
        ("alula.fea.whole.rubbed_motion.rubbed_motion", ("motion", "--threads", "1")),
        ("alula.fea.claims.sources.check_claims", ("claims", "--threads", "1")),
    ],
)
def test_commands_are_bounded_as_a_whole(monkeypatch, stage, arguments):
    """Their first stages already are; the solver is the last of them."""
    monkeypatch.setenv("OMP_NUM_THREADS", "4")
    seen = []

    def first_stage(*_, **__):
        seen.append((os.environ["OMP_NUM_THREADS"], threads_of_libraries()))
        raise CaseError("enough seen")

    monkeypatch.setattr(stage, first_stage)
    ended = CliRunner().invoke(app, [arguments[0], "owl-wing-static", *arguments[1:]])
    assert isinstance(ended.exception, CaseError)
    assert seen == [("1", {1})]


def test_a_check_is_bounded_without_the_command(monkeypatch):
    seen = []
    monkeypatch.setattr(
        "alula.fea.check.run.solve_case_statics", lambda *_: seen.append(threads_of_libraries()) or 1 / 0
    )
    with pytest.raises(ZeroDivisionError):
        check_case(read_case("owl-wing-static"), threads=1)
    assert seen == [{1}]


def test_a_failed_run_gives_back_its_bound():
    with pytest.raises(ValueError, match="of its own"), bounded(1):
        raise ValueError("of its own")
    assert not any(name in os.environ for name in VARIABLES)


def test_child_libraries_use_one_thread_each():
    found = child.environment()
    assert {found[name] for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "LP_NUM_THREADS")} == {"1"}


@pytest.mark.parametrize(("threads", "together"), [(1, 1), (2, 2)])
def test_as_many_children_run_at_once_as_threads_are_allowed(tmp_path, threads, together):
    code = (
        "import pathlib, sys, time\n"
        "folder = pathlib.Path(sys.argv[1]); mine = folder / sys.argv[2]\n"
        "mine.touch(); time.sleep(0.1)\n"
        "print(len(list(folder.iterdir())), file=sys.stderr); time.sleep(0.1); mine.unlink()\n"
    )
    most = []

    def one(name: str) -> None:
        command = [sys.executable, "-c", code, str(tmp_path), name]
        most.append(int(child.run(command, environment=child.environment(), time_limit=60.0)[1]))

    with bounded(threads), bounded(4):
        workers = [threading.Thread(target=one, args=(str(n),)) for n in range(4)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
    assert len(most) == 4
    assert max(most) <= together


def test_the_time_limit_of_a_child_begins_when_it_may_run():
    waits = [sys.executable, "-c", "import time; time.sleep(0.5)"]
    ended = []

    def one() -> None:
        ended.append(child.run(waits, environment=child.environment(), time_limit=20.0)[0])

    with bounded(1):
        first = threading.Thread(target=one)
        first.start()
        time.sleep(0.1)
        begin = time.perf_counter()
        one()
        assert time.perf_counter() - begin > 0.5, "it waited for the other"
        first.join()
    assert ended == [0, 0]
