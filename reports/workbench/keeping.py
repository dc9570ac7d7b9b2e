"""Files of an open case: what stands on the disk, saving it whole, and drafts of what is not saved yet."""

import contextlib
import hashlib
import importlib.util
import json
import os
from pathlib import Path

from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError
from alula.geometry.base.locks import locked
from alula.geometry.keeping.cache_folder import cache_folder
from alula.geometry.keeping.whole_file import write_whole
from alula.loads.text.explain import printable
from alula.loads.text.file_text import file_text

_DRAFT = "draft.json"


def writable(path: Path) -> bool:
    """Return whether a file may be written; its bits count for those as well whom the system lets write all the same.

    Parameters
    ----------
    path : Path
        Of a file that is there.

    Returns
    -------
    bool
    """
    return bool(path.stat().st_mode & 0o222) and os.access(path, os.W_OK)


def case_text(path: Path) -> str:
    """Return the text of a case file as it stands there, with its line ends and its byte order mark.

    Parameters
    ----------
    path : Path

    Returns
    -------
    str

    Raises
    ------
    CaseError
        As ``file_text``.
    """
    missing = "there is no such file; name a case file, or start from 'alula open' alone"
    return file_text(str(path), "case", missing=missing, empty="the file is empty; start from 'alula new'", mark=True)


def is_missing(path: Path) -> bool:
    """Return whether nothing stands at a path; False where the system does not let it be known.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bool
    """
    try:
        path.stat()
    except (OSError, ValueError) as error:
        return isinstance(error, FileNotFoundError)
    return False


def is_plain(name: str, suffix: str) -> bool:
    """Return whether ``plain_name`` takes a name.

    Parameters
    ----------
    name, suffix : str

    Returns
    -------
    bool
    """
    plain = name.isprintable() and not set(name) & set('/\\:*?"<>|') and not name.startswith(".") and len(name) <= 120
    return plain and Path(name).name == name and name.lower().endswith(suffix) and len(name) > len(suffix)


def plain_name(name: str, suffix: str) -> str:
    """Return the name of a file in the folder of a case.

    Parameters
    ----------
    name : str
        As a page sends it.
    suffix : str
        How it has to end, such as ``.toml``.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For a path, a hidden file, another suffix, and what no system takes for a name.
    """
    if not is_plain(name, suffix):
        raise CaseError(f"'{printable(name)}' must be the plain name of a file that ends in {suffix}; write another")
    return name


def write_file(path: Path, text: str, over: str | None = None) -> None:
    """Write a file, all of it or nothing.

    Parameters
    ----------
    path : Path
    text : str
    over : str, optional
        What must stand there so far.

    Raises
    ------
    CannotRunError
        Where the disk refuses, as ``alula.geometry.keeping.whole_file.write_whole`` does; the file is as it was then.
    """
    try:
        write_whole(path, text.encode(), over=None if over is None else over.encode())
    except OSError as error:
        why = error.strerror or error
        raise CannotRunError(f"'{printable(path.name)}' cannot be written ({why}); your changes stay here") from None


def digest(text: str) -> str:
    """Return the SHA-256 of a text.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    return hashlib.sha256(text.encode()).hexdigest()


class Drafts:
    """Where unsaved changes of a case are kept: a folder of alula's cache, which one server holds at a time.

    Parameters
    ----------
    path : Path
        Of the case.

    Attributes
    ----------
    alone : bool
        False where another server has the case open as well, whose draft stays as it is.
    """

    def __init__(self, path: Path) -> None:
        self.alone = True
        self._folder: Path | None = None
        self._lock: int | None = None
        home = cache_folder("drafts")
        if home is not None:
            folder = home / digest(os.path.realpath(path))[:32]
            with contextlib.suppress(OSError):
                folder.mkdir(mode=0o700, exist_ok=True)
                self._lock = locked(folder, wait=False)
                self.alone = self._lock is not None or importlib.util.find_spec("fcntl") is None
                self._folder = folder if self.alone else None

    def kept(self) -> tuple[str | None, str, float]:
        """Return what an earlier server kept.

        Returns
        -------
        text : str or None
            None where there is none.
        base : str
            The digest of the text on the disk that it was made from.
        since : float
            When it was kept, in seconds since 1970.
        """
        try:
            file = (self._folder or Path(os.devnull)) / _DRAFT
            text, base = json.loads(file.read_text(encoding="utf-8"))
            return text, base, file.stat().st_mtime
        except (OSError, ValueError):
            return None, "", 0.0

    def keep(self, text: str, base: str) -> None:
        """Keep a text.

        Parameters
        ----------
        text : str
        base : str
            The text on the disk that it was made from.
        """
        if self._folder is not None:
            write_file(self._folder / _DRAFT, json.dumps((text, digest(base))))

    def drop(self) -> None:
        """Keep nothing any more."""
        if self._folder is not None:
            with contextlib.suppress(OSError):
                (self._folder / _DRAFT).unlink(missing_ok=True)

    def set_aside(self, text: str) -> Path | None:
        """Give a draft that is not taken a file of its own, which no later one replaces.

        Parameters
        ----------
        text : str

        Returns
        -------
        Path or None
            Where it stands; None where there is no place.
        """
        if self._folder is None:
            return None
        aside = self._folder / f"{digest(text)[:8]}.toml"
        with contextlib.suppress(AlulaError):
            write_file(aside, text)
            self.drop()
            return aside
        return None

    def close(self) -> None:
        """Let another server have the place."""
        if self._folder is not None:
            with contextlib.suppress(OSError):
                self._folder.rmdir()  # unless something is kept
        if self._lock is not None:
            os.close(self._lock)
        self._folder = self._lock = None
