"""Who computes: processes of this machine, or Dask's workers on several. Both hand out futures."""

import os
import pickle
import queue
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from alula.fea.study.evaluate import Task
from alula.fea.study.numbers import VariantResult
from alula.geometry.base import child
from alula.geometry.base.child_server import ChildEndedError, ChildServer
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.tidying import scratch_folder

IN_FLIGHT = 3
"""Tasks a worker that are handed out at once: one computed, two waiting."""
TIME_LIMIT = 3600.0
"""Seconds for one variant unless stated otherwise."""
_WORK = ".alula-work-"


class CrashError(Exception):
    """A variant got no answer: its worker ended, ran out of time, or could not go on. The study goes on."""


@dataclass(frozen=True, kw_only=True)
class Engine:
    """Computes tasks side by side.

    Attributes
    ----------
    submit : callable
        Task -> future of its answer, which raises ``CrashError``, or ``CannotRunError`` where the engine is gone.
    capacity : callable
        Returns how many tasks may be handed out at once.
    """

    submit: Callable[[Task], "Future[VariantResult]"]
    capacity: Callable[[], int]


@contextmanager
def local_engine(
    workers: int, contents: Mapping[str, bytes], *, folder: Path, time_limit: float = TIME_LIMIT
) -> Iterator[Engine]:
    """Compute in processes of this machine, each with one thread; one that dies is replaced.

    Parameters
    ----------
    workers : int
        How many processes.
    contents : mapping of str to bytes
        The files of the case's parts.
    folder : Path
        Of the study, which no other study writes to; a folder in it takes what the processes write meanwhile.
    time_limit : float
        After which a variant counts as crashed [s].

    Yields
    ------
    Engine
    """
    for left in folder.glob(f"{_WORK}*"):  # of a study that was killed
        shutil.rmtree(left, ignore_errors=True)
    command = child.module_command("alula.fea.study.worker")
    environment = child.environment(OMP_NUM_THREADS="1", MKL_NUM_THREADS="1")
    idle: queue.SimpleQueue[ChildServer] = queue.SimpleQueue()

    def take() -> ChildServer:
        try:
            return idle.get_nowait()
        except queue.Empty:
            server = ChildServer(command, environment | {"TMPDIR": str(work)})
            server.ask(pickle.dumps(dict(contents)), time_limit)
            return server

    def compute(task: Task) -> VariantResult:
        try:
            server = take()
            answer = server.ask(pickle.dumps(task), time_limit)
        except ChildEndedError as ended:
            raise CrashError(_why(ended)) from None
        except subprocess.TimeoutExpired:
            raise CrashError(f"no answer came within {time_limit:g} s, the limit for one point") from None
        except OSError as error:
            raise CannotRunError(f"a worker cannot be started ({error.strerror}); close other programs") from None
        idle.put(server)
        found: VariantResult = pickle.loads(answer)
        return found

    pool = ThreadPoolExecutor(workers)
    with scratch_folder(_WORK, folder) as work:
        try:
            yield Engine(submit=lambda task: pool.submit(compute, task), capacity=lambda: IN_FLIGHT * workers)
        finally:
            pool.shutdown(wait=not child.stopped(), cancel_futures=True)
            while not idle.empty():
                idle.get().end()


def _why(ended: ChildEndedError) -> str:
    if ended.status < 0:
        return f"its worker was ended by signal {-ended.status} (9 is what the system sends where memory runs out)"
    return f"its worker ended with status {ended.status}: {ended.told}"


def usable_cores() -> int:
    """Return how many cores this process may use.

    Returns
    -------
    int
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
