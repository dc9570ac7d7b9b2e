"""Limits of threads and memory, as the command line states them."""

from collections.abc import Iterator
from contextlib import contextmanager

from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse


@contextmanager
def limited(threads: int, memory: str | None = None) -> Iterator[None]:
    """Limit the threads of all libraries, the number of child processes, and the memory.

    Parameters
    ----------
    threads : int
        Threads per library, and child processes at a time.
    memory : str, optional
        Memory of this process with its unit, such as ``"4 GB"``.

    Returns
    -------
    Iterator[None]

    Raises
    ------
    CaseError
        For a text that is not a positive amount of memory, and less than alula holds before it solves anything.
    """
    from alula.fea.common import memory as process_memory
    from alula.fea.common.threads import bounded

    with bounded(threads), process_memory.limited(None if memory is None else _enough(memory)):
        yield


def _enough(memory: str) -> float:
    """Return a limit [bytes] that leaves something beside the libraries."""
    from alula.fea.common.memory import with_libraries

    limit, held = _bytes(memory), with_libraries()
    if limit <= held:
        raise CaseError(
            f"memory: it is '{memory}', but alula and its libraries hold {1e-6 * held:.0f} MB before anything is "
            'solved; write more, for example "4 GB"'
        )
    return limit


def _bytes(memory: str) -> float:
    try:
        found = parse(memory, "memory")
    except PydanticCustomError as error:
        raise CaseError(f"memory: it is '{memory}', but {error.message()}") from None
    if not found > 0.0:
        raise CaseError(f"memory: it is '{memory}', but must be positive; write for example \"4 GB\"")
    return found
