"""Locks on folders, by which a run tells what a killed one left from what a living one is writing."""

import os
from pathlib import Path


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
