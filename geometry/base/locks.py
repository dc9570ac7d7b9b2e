"""Locks on folders, by which a run tells what a killed one left from what a living one is writing."""

import os
from pathlib import Path


def locked(folder: Path, *, wait: bool = True) -> int | None:
    """Lock a folder against other runs of alula.

    The system takes the lock from a process that ends, however it ends. Programs that do not ask are not kept out.

    Parameters
    ----------
    folder : Path
        An existing folder.
    wait : bool
        Whether to wait while another process holds the lock.

    Returns
    -------
    int or None
        Descriptor that holds the lock until it is closed; None where there is none to be had.
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
