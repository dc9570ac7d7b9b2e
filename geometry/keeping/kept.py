"""What pure functions found, kept in files for later runs: by the content of all that enters, and of alula's code.

``kept`` marks functions whose result their arguments alone decide, and that take long: meshes, solutions, shares.
Nothing is kept unless ``keeping`` says so, which ``alula check`` and ``alula open`` do, and no function of the library
by itself. What is wrong with the folder or a file never stops a run: what cannot be read is computed, what cannot be
written is not kept.

A result is pickled, since it is a tree of records, and is read only from a folder into which this user alone may write
(``alula.geometry.keeping.cache_folder``). It is written to a temporary file, and moved to its name at once, so that a
process that is killed leaves no half of it, and two that write the same one do no harm. A digest tells a file that is
not what was written; it is removed. The name is the key: files of other versions are never met, and go when the folder
is full, as the least recently used do.
"""

import functools
import hashlib
import inspect
import os
import pickle
import platform
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar, cast

from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.geometry.keeping.cache_folder import cache_folder
from alula.geometry.keeping.content import digest
from alula.geometry.keeping.whole_file import write_whole

P = ParamSpec("P")
T = TypeVar("T")

LIMIT = "1 GB"
"""Of the folder, unless ``SIZE`` says otherwise."""
SIZE = "ALULA_CACHE_SIZE"
"""Of the environment: the limit, with its unit."""
HEAD = b"alula: kept result, 1\n"
"""Of every file; the number goes with the form of files."""
_SUM = 32  # bytes of a SHA-256
_ABANDONED = 3600.0  # s, after which nobody writes a temporary file any more
_MISSING = object()
LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "shapely", "pyamg", "pypardiso", "mkl", "pydantic")
"""Their versions count: they mesh, solve, and make the records."""


@dataclass(frozen=True)
class NotKept(Generic[T]):
    """What a function returns in place of a result that is not to be kept, such as one that a time limit cut short.

    Attributes
    ----------
    found : object
        The result.
    """

    found: T


@dataclass
class KeptResults:
    """Results in a folder.

    Attributes
    ----------
    folder : Path
        In which this user alone may write.
    limit : float
        Of all its files [bytes].
    found, asked : int
        How many results were there from earlier runs, and how many were asked for.
    """

    folder: Path
    limit: float
    found: int = 0
    asked: int = 0
    _own: set[str] = field(default_factory=set)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def get(self, key: str) -> Any:
        """Return a result; a file that is not what was written is removed.

        Parameters
        ----------
        key : str

        Returns
        -------
        object
            ``_MISSING`` where there is none.
        """
        path = self.folder / key
        result: Any = _MISSING
        try:
            content = path.read_bytes()
            body = memoryview(content)[len(HEAD) + _SUM :]
            if content.startswith(HEAD) and content[len(HEAD) : len(HEAD) + _SUM] == hashlib.sha256(body).digest():
                result = pickle.loads(body)
                os.utime(path)  # used now
        except (OSError, MemoryError):
            return _MISSING
        except Exception:
            pass
        if result is _MISSING:
            with suppress(OSError):
                path.unlink(missing_ok=True)
        return result

    def put(self, key: str, result: object) -> None:
        """Keep a result, if that can be done.

        Parameters
        ----------
        key : str
        result : object
        """
        with suppress(Exception):  # a full disk, a folder that went, a result that cannot be pickled
            body = pickle.dumps(result, protocol=pickle.HIGHEST_PROTOCOL)
            if len(body) > self.limit / 4.0:  # it would drive out all else
                return
            write_whole(self.folder / key, HEAD, hashlib.sha256(body).digest(), body, lasting=False)
            self._own.add(key)
            self._tidy()

    def counted(self, key: str, *, found: bool) -> None:
        """Count a result that was asked for; one of this run's own is none of an earlier one.

        Parameters
        ----------
        key : str
        found : bool
        """
        with self._lock:
            self.asked += 1
            self.found += found and key not in self._own

    def _tidy(self) -> None:
        """Remove what was used the longest ago until the rest is within the limit, and drafts of killed processes."""
        with self._lock, os.scandir(self.folder) as entries:
            files, now = [], time.time()
            for entry in entries:
                with suppress(OSError):  # another process removed it
                    state = entry.stat(follow_symlinks=False)
                    if not entry.name.startswith("."):
                        files.append((state.st_mtime, state.st_size, entry.path))
                    elif now - state.st_mtime > _ABANDONED:
                        Path(entry.path).unlink(missing_ok=True)
            size = sum(one for _, one, _ in files)
            for _, one, path in sorted(files):
                if size <= self.limit:
                    break
                with suppress(OSError):
                    Path(path).unlink(missing_ok=True)
                size -= one


_store: KeptResults | None = None


@contextmanager
def keeping(*, anew: bool = False) -> Iterator[KeptResults | None]:
    """Keep what marked functions find during a block, in all threads of this process, and take what was kept before.

    Parameters
    ----------
    anew : bool, optional
        True where nothing is taken and nothing is kept.

    Yields
    ------
    KeptResults or None
        None where nothing is kept, and where there is no folder for it.

    Raises
    ------
    CaseError
        Where the environment states no size.
    """
    global _store
    folder = None if anew else cache_folder("solved")
    before, _store = _store, None if folder is None else KeptResults(folder, _limit())
    try:
        yield _store
    finally:
        _store = before


def tally() -> tuple[int, int]:
    """Return how many results were kept from earlier runs, and how many were asked for, in the present block.

    Returns
    -------
    tuple of 2 int
        Zeros where nothing is kept.
    """
    return (0, 0) if _store is None else (_store.found, _store.asked)


def _limit() -> float:
    text = os.environ.get(SIZE, LIMIT)
    try:
        return parse(text, "memory")
    except PydanticCustomError as error:
        raise CaseError(f"{SIZE}: it is '{text}', but {error.message()}") from None


def kept(*, but: tuple[str, ...] = ()) -> Callable[[Callable[P, T | NotKept[T]]], Callable[P, T]]:
    """Return what marks a function whose results may be kept.

    Parameters
    ----------
    but : tuple of str, optional
        Parameters that do not change what it finds, beyond rounding: threads, limits of time.

    Returns
    -------
    callable
    """

    def mark(function: Callable[P, T | NotKept[T]]) -> Callable[P, T]:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def marked(*given: P.args, **named: P.kwargs) -> T:
            store, key = _store, None
            if store is not None:
                bound = signature.bind(*given, **named)
                bound.apply_defaults()
                entering = {name: value for name, value in bound.arguments.items() if name not in but}
                with suppress(TypeError):  # of something whose content is not known
                    key = digest([surroundings(), function.__module__, function.__qualname__, entering])
            if store is None or key is None:
                return _plain(function(*given, **named))
            found = store.get(key)
            store.counted(key, found=found is not _MISSING)
            if found is not _MISSING:
                return cast(T, found)
            result = function(*given, **named)
            if not isinstance(result, NotKept):
                store.put(key, result)
            return _plain(result)

        return marked

    return mark


def _plain(result: T | NotKept[T]) -> T:
    return result.found if isinstance(result, NotKept) else result


@functools.cache
def surroundings() -> str:
    """Return the digest of what decides results besides arguments: alula's sources, libraries, Python and processor.

    Returns
    -------
    str
    """
    versions = [" ".join(one) for one in library_versions().items()]
    return digest([sources_digest(), versions, sys.version, sys.platform, platform.machine()])


@functools.cache
def sources_digest(packages: tuple[str, ...] = ("geometry", "loads", "fea")) -> str:
    """Return the SHA-256 of the names and contents of sources of alula.

    Parameters
    ----------
    packages : tuple of str, optional
        Whose sources; of all that compute unless given.

    Returns
    -------
    str
        In hexadecimal.
    """
    found = hashlib.sha256()
    root = Path(__file__).parents[2]
    for package in packages:
        for path in sorted((root / package).rglob("*")):
            if path.suffix in (".py", ".toml"):
                found.update(f"{path.relative_to(root).as_posix()}\n".encode() + path.read_bytes())
    return found.hexdigest()


def library_versions() -> dict[str, str]:
    """Return the version of every library that meshes, solves or makes records, as far as it is installed.

    Returns
    -------
    dict of str to str
    """
    found = {}
    for name in LIBRARIES:
        with suppress(metadata.PackageNotFoundError):
            found[name] = metadata.version(name)
    return found
