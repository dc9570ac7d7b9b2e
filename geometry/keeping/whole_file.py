"""Files that are written whole or not at all."""

import contextlib
import ctypes
import errno
import os
import secrets
import shutil
import sys
from pathlib import Path

_FROM_HERE, _EXCHANGE = -100, 2
"""``AT_FDCWD`` and ``RENAME_EXCHANGE`` of Linux."""


def write_whole(path: Path, *content: bytes, lasting: bool = True, over: bytes | None = None) -> None:
    """Write a file, all of it or nothing; a link is followed, and owner and permissions stay.

    A kill leaves the file as it was, and at most a draft beside it whose name begins with a dot.

    Parameters
    ----------
    path : Path
        Missing, or a file.
    *content : bytes
        One after the other.
    lasting : bool, optional
        Whether it has to be on the disk at the end, so that it outlives a loss of power.
    over : bytes, optional
        What the file must hold until its name is taken: b"" where it may be empty or missing, as None anything.

    Raises
    ------
    OSError
        Where the disk refuses, and for a file that is marked read-only, also for those whom the system lets write all
        the same; and for one that holds something else than ``over``. The file is as it was then.
    """
    target = Path(os.path.realpath(path))
    if not target.name or target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "it is a folder")
    made = target.with_name(f".{target.name[:80]}.{secrets.token_hex(4)}")
    if target.exists() and not (target.stat().st_mode & 0o222 and os.access(target, os.W_OK)):
        raise PermissionError(errno.EACCES, "it is read-only")
    try:
        with made.open("xb") as stream:
            for piece in content:
                stream.write(piece)
            stream.flush()
            if lasting:
                os.fsync(stream.fileno())
        if target.exists():
            with contextlib.suppress(OSError):  # the file of another user, who lets this one write
                shutil.chown(made, target.stat().st_uid, target.stat().st_gid)
            shutil.copymode(target, made)
        _take_place(made, target, over)
    except BaseException:
        made.unlink(missing_ok=True)
        raise
    if lasting:
        with contextlib.suppress(OSError):  # not every system can be asked to hold the names of a folder
            folder = os.open(target.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)


def _take_place(made: Path, target: Path, over: bytes | None) -> None:
    """Give a new file the name of another, where that holds what it is meant to hold."""
    changed = FileExistsError(errno.EEXIST, "another program has just changed it")
    if over is not None and (target.read_bytes() if target.exists() else b"") != over:
        raise changed
    if over is None or not _exchanged(made, target):
        made.replace(target)
        return
    if made.read_bytes() != over:  # it was changed between the look and the exchange
        _exchanged(made, target)
        raise changed
    made.unlink()


def _exchanged(one: Path, other: Path) -> bool:
    """Let two files have each other's name, in one step; false where the system cannot, or one is missing."""
    if sys.platform != "linux":
        return False
    exchange = getattr(ctypes.CDLL(None), "renameat2", None)
    names = os.fsencode(one), os.fsencode(other)
    return bool(exchange and exchange(_FROM_HERE, names[0], _FROM_HERE, names[1], _EXCHANGE) == 0)
