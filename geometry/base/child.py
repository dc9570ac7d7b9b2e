"""Child processes for foreign code that can crash or never end, which no exception reports.

A child is stopped at its time limit and on an interruption. alula's own answer requests
(``alula.geometry.base.child_server``); other programs run once, and the system ends them with their parent
(``alula.geometry.base.leash``).
"""

import math
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any, cast
from weakref import WeakSet

from alula.geometry.base.errors import CannotRunError

_ROOT = str(Path(str(sys.modules["alula"].__file__)).resolve().parents[1])
"""The folder on the path in which the package ``alula`` stands."""
_lock = threading.RLock()
_running: WeakSet[subprocess.Popen[bytes]] = WeakSet()
_stopped = threading.Event()
_SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "VTK_SMP_MAX_THREADS", "LP_NUM_THREADS"), "1")
"""One thread for a child's libraries, VTK and Mesa's software renderer: children run beside each other instead."""
_most, _places = math.inf, cast("AbstractContextManager[object]", nullcontext())
"""How many children may be at work at once, and the context in which one is."""


def module_command(module: str, *arguments: str) -> list[str]:
    """Return the command that runs a module of alula's.

    Parameters
    ----------
    module : str
        Name of the module.
    *arguments : str
        Its command-line arguments.

    Returns
    -------
    list of str
        The command, for ``run``.
    """
    # -P: a file where the user stands must not be taken for a module of alula's, of a library or of Python.
    return [sys.executable, "-P", "-m", module, *arguments]


def foreign_command(program: str, *arguments: str) -> list[str]:
    """Return the command that runs a program which is not alula's, and ends it with this process.

    Parameters
    ----------
    program : str
        Path of the program.
    *arguments : str
        Its command-line arguments.

    Returns
    -------
    list of str
        The command, for ``run``.
    """
    return module_command("alula.geometry.base.leash", str(os.getpid()), os.path.abspath(program), *arguments)


def environment(**more: str) -> dict[str, str]:
    """Return the environment in which a child finds alula's modules.

    Parameters
    ----------
    **more : str
        Further variables.

    Returns
    -------
    dict of str to str
        All variables of this process, with what differs for the child.
    """
    paths = os.pathsep.join(filter(None, [_ROOT, os.environ.get("PYTHONPATH", "")]))
    return os.environ | {"PYTHONPATH": paths} | _SINGLE | more


@contextmanager
def at_most(children: int) -> Iterator[None]:
    """Bound how many children run at once; others wait, and their time limits start when they do.

    Parameters
    ----------
    children : int
        How many; an outer bound that is smaller stays.

    Yields
    ------
    None
        While the bound holds.
    """
    global _most, _places
    before = _most, _places
    if children < _most:
        _most, _places = children, threading.BoundedSemaphore(children)
    try:
        yield
    finally:
        _most, _places = before


def run(
    command: list[str],
    *,
    environment: dict[str, str],
    time_limit: float,
    folder: Path | None = None,
    output: Path | None = None,
) -> tuple[int, str]:
    """Run a program that is not alula's to its end, without standard input.

    Parameters
    ----------
    command : list of str
        Program and arguments.
    environment : dict of str to str
        Its environment variables.
    time_limit : float
        Time after which it is killed [s].
    folder : Path, optional
        Its working directory; this process's unless given.
    output : Path, optional
        File that takes its standard output, which is discarded otherwise.

    Returns
    -------
    status : int
        Exit status, or minus the number of the signal that ended it.
    message : str
        Last line of its standard error.

    Raises
    ------
    subprocess.TimeoutExpired
        At the time limit.
    OSError
        If it cannot be started.
    CannotRunError
        After ``stop_all``.
    """
    with place(), open(output or os.devnull, "wb") as told_out:
        pipes = {"stdin": subprocess.DEVNULL, "stdout": told_out, "stderr": subprocess.PIPE}
        with start(command, cwd=folder, env=environment, **pipes) as process:
            try:
                _, told = process.communicate(timeout=time_limit)
            except BaseException:
                process.kill()
                raise
    return process.returncode, last_line(told)


def last_line(told: bytes) -> str:
    """Return the last line of what a child wrote, or that it wrote nothing.

    Parameters
    ----------
    told : bytes
        Its standard error.

    Returns
    -------
    str
        The line.
    """
    return (told.decode(errors="replace").strip().splitlines() or ["it left no message"])[-1]


def place() -> AbstractContextManager[object]:
    """Return the context in which a child may be at work: it waits while as many are as ``at_most`` allows.

    Returns
    -------
    context manager
        For one use.
    """
    return _places


def start(command: list[str], **options: Any) -> subprocess.Popen[bytes]:
    """Start a child that ``stop_all`` will kill if it is still there.

    Parameters
    ----------
    command : list of str
        Program and arguments.
    **options : object
        As for ``subprocess.Popen``.

    Returns
    -------
    subprocess.Popen
        The child.

    Raises
    ------
    OSError
        If it cannot be started.
    CannotRunError
        After ``stop_all``.
    """
    with _lock:
        if _stopped.is_set():
            raise CannotRunError("interrupted")
        process = subprocess.Popen(command, **options)
        _running.add(process)
    return process


def stop_all() -> None:
    """Kill every child and start no other: threads that wait for one go on at once. For a process that is to end."""
    _stopped.set()
    with _lock:
        for process in tuple(_running):
            process.kill()


def stopped() -> bool:
    """Return True after ``stop_all``: a library may have swallowed the exception that was to end the process."""
    return _stopped.is_set()
