"""Locks on folders, by which a run tells what a killed one left from what a living one is writing."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory


def locked(folder: Path, *, wait: bool = True) -> int | None:
    """Lock a folder and return the descriptor that holds the lock; None where that is not to be had.

    The system takes the lock from a process that ends, however it ends. Programs that do not ask are not kept out.
    """
    try:
        import fcntl
    except ImportError:  # not a Unix
        return None
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # held by another, or a network disk without locks
        os.close(descriptor)
        return None
    return descriptor


@contextmanager
def scratch_beside(folder: Path, prefix: str) -> Iterator[Path]:
    """Make a folder inside another for drafts, and remove it; removes what killed runs left under the same prefix too.

    Raises ``OSError`` where the disk refuses.
    """
    for left in folder.glob(f"{prefix}*"):
        held = locked(left, wait=False) if left.is_dir() and not left.is_symlink() else None
        if held is not None:
            shutil.rmtree(left, ignore_errors=True)
            os.close(held)
    with TemporaryDirectory(dir=folder, prefix=prefix, ignore_cleanup_errors=True) as name:
        mine = locked(Path(name))
        try:
            yield Path(name)
        finally:
            if mine is not None:
                os.close(mine)
