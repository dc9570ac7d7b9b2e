"""A text file that a user names: a regular one, of at most 1 MiB, in UTF-8."""

import hashlib
import os
import stat
from pathlib import Path

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.files_read import note_read, refuse_elsewhere
from alula.loads.text.explain import printable

LARGEST_FILE = 1 << 20
"""Bytes; a case file is some kilobytes."""


def file_text(path: str, what: str, *, missing: str, empty: str, mark: bool = False) -> str:
    """Read a text file.

    Parameters
    ----------
    path : str
        Its path.
    what : str
        What it should be, such as ``case``, for sentences.
    missing, empty : str
        What is the matter, and the remedy, where there is no such file and where nothing stands in it.
    mark : bool, optional
        True to keep a byte order mark, for a text that is written back.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For a file that is missing, too large, unreadable, empty or no text.
    """
    refuse_elsewhere(path)
    file, shown = Path(path), f"{what} '{printable(path)}'"
    try:
        exists = stat.S_ISREG(file.stat().st_mode)
    except PermissionError as error:  # a folder above it may not be entered
        raise CaseError(f"{shown}: it cannot be read ({error.strerror}); check its permissions") from None
    except (OSError, ValueError):
        exists = False
    if not exists:
        if os.path.lexists(path):
            kind = "it is a folder" if os.path.isdir(path) else "it is no regular file that can be reached"
            missing = f"{kind};{missing.partition(';')[2]}"
        raise CaseError(f"{shown}: {missing}")
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise CaseError(f"{shown}: the file is larger than 1 MiB, the limit; check that it is a {what} file")
        content = file.read_bytes()
        text = content.decode("utf-8" if mark else "utf-8-sig")  # Windows editors put a byte order mark
    except OSError as error:
        raise CaseError(f"{shown}: it cannot be read ({error.strerror}); check its permissions") from None
    except UnicodeDecodeError:
        raise CaseError(f"{shown}: it is not UTF-8 text; save it as UTF-8") from None
    if not text.strip():
        raise CaseError(f"{shown}: {empty}")
    note_read(path, hashlib.sha256(content).hexdigest())
    return text
