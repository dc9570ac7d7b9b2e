"""Files that are written whole or not at all."""

import contextlib
import errno
import os
import secrets
import shutil
from pathlib import Path


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
        if (
            over is not None and (target.read_bytes() if target.exists() else b"") != over
        ):  # last, as a write takes long
            raise FileExistsError(errno.EEXIST, "another program has just changed it")
        made.replace(target)
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
