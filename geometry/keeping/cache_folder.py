"""The folder below the user's cache folder in which alula keeps what it can do without."""

import os
import stat
import sys
from pathlib import Path

VARIABLE = "ALULA_CACHE"
"""Of the environment: another folder, or nothing, for none."""


def cache_folder(name: str = "") -> Path | None:
    """Return alula's cache folder, or one below it, and make it where it is missing.

    Whoever may write into it may change what alula reads from it: it is the user's alone, and another is not used.

    Parameters
    ----------
    name : str, optional
        Of the folder below it.

    Returns
    -------
    Path or None
        None where there is none: no home, a folder that cannot be made or written, or one that others may write.

    References
    ----------
    XDG Base Directory Specification: a path that is not absolute is ignored.
    """
    try:
        base = _place()
        found = base if base is None or not name else base / name
        if base is None or found is None:
            return None
        base.parent.mkdir(parents=True, exist_ok=True)
        for folder in dict.fromkeys((base, found)):
            folder.mkdir(mode=0o700, exist_ok=True)
            if not _is_own(folder):
                return None
    except (OSError, RuntimeError):  # RuntimeError: Path.home() without a home
        return None
    return found


def _place() -> Path | None:
    stated = os.environ.get(VARIABLE)
    if stated is not None:
        return Path(stated).absolute() if stated else None
    if sys.platform == "win32":
        local = os.environ.get("LOCALAPPDATA")
        return Path(local, "alula") if local else None
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "alula"
    stated = os.environ.get("XDG_CACHE_HOME", "")
    return (Path(stated) if os.path.isabs(stated) else Path.home() / ".cache") / "alula"


def _is_own(folder: Path) -> bool:
    """Whether this user alone may write into a folder; Windows keeps the user's own folders so by itself."""
    if not os.access(folder, os.W_OK | os.X_OK):
        return False
    if sys.platform == "win32":
        return True
    state = folder.stat()
    return state.st_uid == os.geteuid() and not state.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
