"""Files of an open case: what stands on the disk, saving it whole, and drafts of what is not saved yet."""

import contextlib
import hashlib
import importlib.util
import json
import os
import secrets
import shutil
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import NamedTuple

from alula.geometry.base.cache_folder import cache_folder
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.locks import locked
from alula.loads.text.explain import printable
from alula.loads.text.file_text import LARGEST_FILE, file_text


class Stamp(NamedTuple):
    """What the disk says of a file without reading it: another content comes with another stamp."""

    inode: int
    size: int
    modified: int
    changed: int
    writable: bool


def stamp_of(path: Path) -> Stamp | None:
    """Return the stamp of a file.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Stamp or None
        None where there is no such file.
    """
    try:
        state = path.stat()
    except (OSError, ValueError):
        return None
    # The bits count for those as well whom the system lets write all the same.
    writable = bool(state.st_mode & 0o222) and os.access(path, os.W_OK)
    return Stamp(state.st_ino, state.st_size, state.st_mtime_ns, state.st_ctime_ns, writable)


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
    plain = name.isprintable() and not set(name) & set('/\\:*?"<>|') and not name.startswith(".") and len(name) <= 120
    if not plain or Path(name).name != name or not name.lower().endswith(suffix) or len(name) == len(suffix):
        raise CaseError(f"'{printable(name)}' must be the plain name of a file that ends in {suffix}; write another")
    return name


def write_whole(path: Path, text: str) -> None:
    """Write a text into a file, all of it or nothing; a link is followed, and owner and permissions stay.

    Parameters
    ----------
    path : Path
        Missing, or a file.
    text : str
        Its line ends are kept.

    Raises
    ------
    CaseError
        For a text that would not be read again.
    CannotRunError
        Where the disk refuses; the file is as it was then.
    """
    shown, data = printable(path.name), text.encode()
    if not text.strip() or len(data) > LARGEST_FILE:
        raise CaseError(f"'{shown}': the text is empty or larger than 1 MiB, the limit; it was not saved")
    target = Path(os.path.realpath(path))
    made = target.with_name(f".{target.name[:80]}.{secrets.token_hex(4)}")
    try:
        before = stamp_of(target)
        if before is not None and not before.writable:
            raise CannotRunError(f"'{shown}' is read-only; allow writing to it, and save again")
        try:
            with open(os.open(made, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
            if before is not None:
                with contextlib.suppress(OSError):  # the file of another user, who lets this one write
                    shutil.chown(made, target.stat().st_uid, target.stat().st_gid)
                shutil.copymode(target, made)
            os.replace(made, target)
        except BaseException:
            made.unlink(missing_ok=True)
            raise
        _flush(target.parent)
    except OSError as error:
        raise CannotRunError(
            f"'{shown}' cannot be written ({error.strerror or error}); the file is as it was, your changes stay here"
        ) from None


def _flush(folder: Path) -> None:
    """Have the disk hold the entries of a folder, where a system can be asked to."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@dataclass(frozen=True)
class Draft:
    """A text that was not saved.

    Attributes
    ----------
    text : str
    base : str
        SHA-256 of the text on the disk that it was made from.
    """

    text: str
    base: str


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
        self._stem = path.stem
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

    @property
    def _file(self) -> Path | None:
        return None if self._folder is None else self._folder / "draft.json"

    def kept(self) -> Draft | None:
        """Return what an earlier server kept.

        Returns
        -------
        Draft or None
        """
        try:
            return None if self._file is None else Draft(**json.loads(self._file.read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError):
            return None

    def keep(self, text: str, base: str) -> None:
        """Keep a text.

        Parameters
        ----------
        text : str
        base : str
            The text on the disk that it was made from.

        Raises
        ------
        CaseError, CannotRunError
            As ``write_whole``.
        """
        if self._file is not None:
            write_whole(self._file, json.dumps(asdict(Draft(text, digest(base)))))

    def drop(self) -> None:
        """Keep nothing any more."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.unlink(missing_ok=True)

    def set_aside(self, draft: Draft) -> Path | None:
        """Give a draft that is not taken a file of its own, so that the next one does not replace it.

        Parameters
        ----------
        draft : Draft

        Returns
        -------
        Path or None
            Where its text stands; None where there is no place.
        """
        if self._folder is None:
            return None
        aside = self._folder / f"{self._stem}-{digest(draft.text)[:8]}.toml"
        write_whole(aside, draft.text)
        self.drop()
        return aside

    def close(self) -> None:
        """Let another server have them."""
        if self._folder is not None:
            with contextlib.suppress(OSError):
                self._folder.rmdir()  # unless something is kept
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None
