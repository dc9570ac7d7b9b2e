"""Which files are read while a case is read, with the digest of what stood in them, and which may be."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from alula.geometry.base.errors import CaseError

_READING: ContextVar[dict[str, str] | None] = ContextVar("_READING", default=None)
_WITHIN: ContextVar[tuple[Path, ...]] = ContextVar("_WITHIN", default=())


@contextmanager
def reading_within(*folders: Path) -> Iterator[None]:
    """Let files be read below some folders alone within the block, whatever names them.

    Parameters
    ----------
    *folders : Path
        Links in them are followed.

    Yields
    ------
    None
    """
    before = _WITHIN.set(folders)
    try:
        yield
    finally:
        _WITHIN.reset(before)


def refuse_elsewhere(path: str | Path) -> None:
    """Refuse a file that ``reading_within`` does not let be read, before anything of it is looked at.

    Parameters
    ----------
    path : str or Path
        Links are followed.

    Raises
    ------
    CaseError
        For a file outside of the folders.
    """
    folders = _WITHIN.get()
    if folders and not lies_within(path, *folders):
        name = "".join(c if c.isprintable() else "?" for c in str(path))
        raise CaseError(f"'{name}' is not in the folder of this server, which reads no other; copy it there")


def lies_within(path: str | Path, *folders: Path) -> bool:
    """Return True where a file lies below one of some folders.

    Parameters
    ----------
    path : str or Path
    *folders : Path
        Links in all of them are followed.

    Returns
    -------
    bool
    """
    place = Path(os.path.realpath(str(path).replace("\0", "")))
    return any(place.is_relative_to(os.path.realpath(folder)) for folder in folders)


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
