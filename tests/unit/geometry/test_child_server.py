"""Child processes that answer several requests: what they keep, and how they end."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator

import programs
import pytest

from alula.geometry.base import child, child_server
from alula.geometry.base.child_server import ChildEndedError, ServerPool

SERVICE = """
import os, sys, time
from alula.geometry.base.child_server import ChildService
service = ChildService()
def answer(request):
    print("noise of a library", flush=True)
    if request == b"crash":
        sys.exit("no more of this")
    if request == b"sleep":
        time.sleep(60.0)
    if request == b"twice":
        service.reply(b"first")
    service.reply(b"%d" % os.getpid() if request == b"who" else request)
service.run(answer)
"""
COMMAND = [sys.executable, "-c", SERVICE]


@pytest.fixture
def pool() -> Iterator[ServerPool]:
    pool = ServerPool()
    yield pool
    pool.close()


def ask(pool: ServerPool, request: bytes, topic: str = "", time_limit: float = 30.0) -> bytes:
    with pool.server(COMMAND, child.environment(), topic) as server:
        return server.ask(request, time_limit)


def test_one_child_answers_several_requests_whole(pool: ServerPool) -> None:
    large = os.urandom(5_000_000)
    assert ask(pool, b"who") == ask(pool, b"who")
    assert ask(pool, large) == large
    assert ask(pool, b"") == b""
    assert ask(pool, b"twice") == b"first"
    assert ask(pool, b"again") == b"again"


def test_a_child_that_ends_says_why_and_the_next_request_has_another(pool: ServerPool) -> None:
    first = ask(pool, b"who")
    with pytest.raises(ChildEndedError) as ended:
        ask(pool, b"crash")
    assert (ended.value.status, ended.value.told) == (1, "no more of this")
    assert ask(pool, b"who") != first


def test_the_time_limit_is_of_each_request(pool: ServerPool) -> None:
    first = ask(pool, b"who", time_limit=10.0)
    with pytest.raises(subprocess.TimeoutExpired):
        ask(pool, b"sleep", time_limit=0.3)
    assert ask(pool, b"who") != first
    assert programs.ended(int(first))


def test_a_child_that_waits_holds_no_place_and_keeps_its_topic(pool: ServerPool) -> None:
    with child.at_most(2):
        with (
            pool.server(COMMAND, child.environment(), "a") as one,
            pool.server(COMMAND, child.environment(), "b") as other,
        ):
            pids = {"a": one.ask(b"who", 30.0), "b": other.ask(b"who", 30.0)}
        assert pids["a"] != pids["b"]
        for topic in "abba":
            assert ask(pool, b"who", topic) == pids[topic]
        waits = [sys.executable, "-c", "pass"]
        assert child.run(waits, environment=child.environment(), time_limit=30.0)[0] == 0
    with child.at_most(1):  # two wait, and none at work
        assert ask(pool, b"who", "c") in pids.values()


def test_another_environment_has_another_child(pool: ServerPool, monkeypatch: pytest.MonkeyPatch) -> None:
    first = ask(pool, b"who")
    monkeypatch.setenv("ALULA_TEST", "1")
    assert ask(pool, b"who") != first


def test_a_child_that_waits_long_is_ended(pool: ServerPool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(child_server, "IDLE", 0.2)
    first = ask(pool, b"who")
    _until_gone(first)
    assert ask(pool, b"who") != first


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_fork_leaves_the_children_of_its_parent_alone(pool: ServerPool) -> None:
    first = ask(pool, b"who")
    fork = os.fork()
    if not fork:
        other = ask(pool, b"who")
        pool.close()
        os._exit(0 if other != first else 1)
    assert os.waitpid(fork, 0)[1] == 0
    assert ask(pool, b"who") == first


HALF = "import pickle, sys; out = sys.stdout.buffer; out.write(pickle.dumps(bytes(10**6))[:{length}]); sys.exit('half')"


@pytest.mark.parametrize("length", [0, 1, 9, 500_000, 10**6])
def test_half_an_answer_is_none(pool: ServerPool, length: int) -> None:
    command = [sys.executable, "-c", HALF.format(length=length)]
    with pytest.raises(ChildEndedError, match="half"), pool.server(command, child.environment(), "") as server:
        server.ask(b"", 30.0)


def test_an_exception_beside_the_request_ends_the_child(pool: ServerPool) -> None:
    lent = pool.server(COMMAND, child.environment(), "")
    first = lent.__enter__().ask(b"who", 30.0)
    assert not lent.__exit__(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert programs.ended(int(first))


STOPPED = f"""
import sys, threading, time
from alula.geometry.base import child
from alula.geometry.base.child_server import ServerPool
from alula.geometry.base.errors import CannotRunError
pool = ServerPool()
def ask(request):
    with pool.server([sys.executable, "-c", {SERVICE!r}], child.environment(), "") as server:
        return server.ask(request, 60.0)
print(ask(b"who").decode(), flush=True)
"""


@pytest.mark.parametrize(
    "ends",
    [
        "",  # as any process does
        "import os; os._exit(0)",  # as if killed
        "child.stop_all(); time.sleep(60.0)",
        "threading.Thread(target=ask, args=(b'sleep',), daemon=True).start(); time.sleep(0.5); import os; os._exit(0)",
    ],
)
def test_children_end_with_their_parent(ends: str) -> None:
    command = [sys.executable, "-c", STOPPED + ends]
    with subprocess.Popen(command, stdout=subprocess.PIPE, env=child.environment()) as parent:
        assert parent.stdout is not None
        pid = parent.stdout.readline()
        try:
            _until_gone(pid)
        finally:
            parent.kill()


def test_a_request_that_waits_for_its_answer_ends_when_all_are_stopped() -> None:
    ends = (
        "threading.Timer(0.5, child.stop_all).start(); begun = time.monotonic()\n"
        "try: ask(b'sleep')\n"
        "except Exception as error: print(type(error).__name__, time.monotonic() - begun < 10.0)\n"
        "try: ask(b'who')\n"
        "except CannotRunError as error: print(error)\n"
    )
    command = [sys.executable, "-c", STOPPED + ends]
    done = subprocess.run(command, capture_output=True, text=True, env=child.environment(), timeout=60, check=True)
    assert done.stdout.splitlines()[1:] == ["ChildEndedError True", "interrupted"]


def _until_gone(pid: bytes) -> None:
    deadline = time.monotonic() + 10.0
    while not programs.ended(int(pid)):
        assert time.monotonic() < deadline, "it lives on"
        time.sleep(0.05)


def test_all_tests_have_one_environment() -> None:
    """Of servers that wait none would serve another test, and each test would start its own (``conftest``)."""
    assert "PYTEST_CURRENT_TEST" not in os.environ
