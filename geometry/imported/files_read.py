"""Which files are read while a case is read, with the digest of what stood in them."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

_READING: ContextVar[dict[str, str] | None] = ContextVar("_READING", default=None)


@contextmanager
def files_read() -> Iterator[dict[str, str]]:
    """Collect the files that are read within the block.

    Yields
    ------
    dict of str to str
        Path -> SHA-256 of its bytes, in hexadecimal; filled while the block runs.
    """
    found: dict[str, str] = {}
    before = _READING.set(found)
    try:
        yield found
    finally:
        _READING.reset(before)


def note_read(path: str | Path, digest: str) -> str:
    """Note that a file was read, for the innermost ``files_read``; without one, nothing is noted.

    Parameters
    ----------
    path : str or Path
    digest : str
        SHA-256 of its bytes, in hexadecimal.

    Returns
    -------
    str
        The digest.
    """
    if (found := _READING.get()) is not None:
        found[str(path)] = digest
    return digest
