"""What a run may take of the machine, as the command line states it."""

from collections.abc import Iterator
from contextlib import contextmanager

from pydantic_core import PydanticCustomError

from geometry.base.errors import CaseError
from geometry.base.units import parse


@contextmanager
def limited(threads: int, memory: str | None = None) -> Iterator[None]:
    """Bound the threads of all libraries, the number of child processes and the memory [text with its unit].

    Raises ``CaseError`` for a memory that is none.
    """
    from fea.common import memory as process_memory
    from fea.common.threads import bounded

    with bounded(threads), process_memory.limited(None if memory is None else _bytes(memory)):
        yield


def _bytes(memory: str) -> float:
    try:
        found = parse(memory, "memory")
    except PydanticCustomError as error:
        raise CaseError(f"memory: it is '{memory}', but {error.message()}") from None
    if not found > 0.0:
        raise CaseError(f"memory: it is '{memory}', but nothing runs without memory; write for example \"4 GB\"")
    return found
