"""Questions to the child process in which the geometry kernel runs, with limits of time and memory.

The kernel can crash or loop for ever, which no exception reports; a child that does so becomes a ``CannotRunError``.
One that answers waits for a further request, with the solids that it has.
"""

import pickle
import signal
import subprocess
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any

from alula.geometry.base import child, child_memory
from alula.geometry.base.child_server import ChildEndedError, ServerPool
from alula.geometry.base.errors import CannotRunError, CaseError

_workers = ServerPool()


@dataclass(frozen=True, kw_only=True)
class KernelWords:
    """What is said where the kernel does not answer.

    Attributes
    ----------
    who : str
        Who is at work, such as "the mesher".
    late : str
        What to do where it takes too long.
    large : str
        What to do where it takes too much memory.
    crashed : str
        What to do where it crashes.
    failed : str
        What to do where gmsh fails at the shape: faces whose edges do not close, surfaces that cross.
    """

    who: str
    late: str
    large: str
    crashed: str
    failed: str


def ask_kernel(
    task: str,
    subject: Hashable,
    *arguments: Any,
    words: KernelWords,
    time_limit: float,
    memory: float,
) -> Any:
    """Do a task of ``alula.geometry.meshing.mesh_worker`` in a child process and return its result.

    Parameters
    ----------
    task : str
        Its name.
    subject : hashable
        What it is about, a body or a file; a child that has worked on it before is asked first.
    *arguments : object
        What else the task takes.
    words : KernelWords
        For the sentence of an error.
    time_limit : float
        Time after which the child is killed [s].
    memory : float
        What it may take [bytes].

    Returns
    -------
    object
        The result.

    Raises
    ------
    CaseError
        If the subject is wrong.
    CannotRunError
        If the kernel fails, crashes or exceeds a limit.
    """
    memory = child_memory.allowed(memory)
    request = pickle.dumps((memory, task, subject, *arguments))
    environment = child.environment(PYDANTIC_DISABLE_PLUGINS="__all__")
    try:
        with _workers.server(_command(), environment, subject) as worker:
            kind, result = pickle.loads(worker.ask(request, time_limit))
            if kind != "done":  # who knows in which state the kernel is
                worker.end()
    except subprocess.TimeoutExpired:
        raise CannotRunError(
            f"{words.who} was stopped after its time limit of {time_limit:g} s; {words.late}"
        ) from None
    except ChildEndedError as ended:
        raise CannotRunError(_obituary(ended.status, ended.told, words)) from None
    except OSError as error:
        raise CannotRunError(f"{words.who} could not be started ({error.strerror or error})") from None
    if kind == "case":
        raise CaseError(result)
    if kind == "cannot":
        raise CannotRunError(result)
    if kind == "failed":
        raise CannotRunError(f"gmsh failed: {str(result).rstrip('.')}; {words.failed}")
    if kind == "memory":
        raise CannotRunError(
            f"{words.who} needed more than the {memory / 1e9:.3g} GB of memory that it may take; {words.large}"
        )
    return result


def _command() -> list[str]:
    return child.module_command("alula.geometry.meshing.mesh_worker")


def _obituary(status: int, told: str, words: KernelWords) -> str:
    if status == -signal.SIGKILL:
        return f"{words.who} was killed (SIGKILL), as the system does when memory runs out; {words.large}"
    if status < 0:
        return f"{words.who} crashed ({signal.Signals(-status).name}); {words.crashed}"
    return f"{words.who} ended with status {status} and no answer: {told}"
