"""An output folder: alula replaces there what alula wrote, all of it or nothing, and leaves every other file alone.

Each command keeps a list of its files and their digests in the folder, ``.alula-COMMAND.json``. A run fills a hidden
folder inside of the output folder. When that is whole, the files of the earlier run are moved out and the new ones in,
the list last. Where a run was killed before that, the list is still in its hidden folder, and by it the next run takes
the moves back.
"""

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Any

from alula.geometry.base import child
from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError, unwritable
from alula.geometry.base.locks import locked
from alula.geometry.base.tidying import tidied

MARK = "result.json"
"""The last file to be put and the first to be taken: a folder that holds it holds a whole result."""
EXPORT = "export"
"""The command whose runs add to a folder: parts of several cases may stand side by side."""
_TOP = ("check", EXPORT)
"""Commands that write into the folder itself; the others write into a subfolder of their own name."""
_PREFIX = ".alula-"
_NEW, _OLD, _LIST = "new", "old", "list.json"


def folder_named(name: str | os.PathLike[str]) -> Path:
    """Return the folder of a name that a user stated.

    Parameters
    ----------
    name : str or path

    Returns
    -------
    Path

    Raises
    ------
    CaseError
        For an empty name, which would mean the current folder.
    """
    if not os.fspath(name):
        raise CaseError("output: the name of the folder is empty; name a folder, or '.' for the current one")
    return Path(name)


def place(output: Path, command: str) -> Path:
    """Return the folder that receives a command's files.

    Parameters
    ----------
    output : Path
        The folder that the user named.
    command : str
        Its name.

    Returns
    -------
    Path
    """
    target = Path(os.path.abspath(output))
    return target if command in _TOP else target / command


def write_folder(output: Path, command: str, fill: Callable[[Path], object]) -> None:
    """Write a command's files into an empty folder, then put them in their place.

    Files of the command's earlier run are replaced, or removed where this run has no such file (``export`` keeps them),
    if they are as alula left them. The last of several runs into one folder stays.

    Parameters
    ----------
    output : Path
        The folder that the user named.
    command : str
        Its name.
    fill : callable
        Writes the files into the folder that it is given.

    Raises
    ------
    CaseError
        For a file in the way, and a folder that cannot be made there.
    CannotRunError
        Where the disk refuses; nothing is changed then.
    """
    target = place(output, command)
    made = [folder for folder in (target, *target.parents) if not os.path.lexists(folder)]
    work: Path | None = None

    def tidy() -> None:
        if work is not None and not (work / _LIST).exists():
            shutil.rmtree(work, ignore_errors=True)
        for folder in made:
            with contextlib.suppress(OSError):  # it holds the result
                folder.rmdir()

    def begin() -> None:
        nonlocal work
        target.mkdir(parents=True, exist_ok=True)
        with _alone_in(target):
            _recover(target)
            _refuse_in_the_way(target, command, ())
            work = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=target))
            held.enter_context(_alone_in(work))

    with contextlib.ExitStack() as held, tidied(tidy):
        try:
            _refuse_no_folder(output, target)
            try:
                begin()
            except FileNotFoundError:  # another run, which had made the folder, has failed and removed it
                begin()
        except OSError as error:
            raise _unwritable(target, error) from None
        assert work is not None
        try:
            _replace(target, command, work, fill)
        except OSError as error:
            begun = (work / _LIST).exists()
            state = "the next run into it restores what was there" if begun else "nothing was changed there"
            raise CannotRunError(f"output: writing to '{target}' failed ({error.strerror or error}); {state}") from None


def refuse_unusable(output: Path | None, command: str, names: Iterable[str] = (MARK,)) -> None:
    """Refuse an output folder before anything is computed for it.

    Parameters
    ----------
    output : Path, optional
        The folder that the user named, if any.
    command : str
        Its name.
    names : iterable of str, optional
        The files that the command will write, as far as they are known.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    if output is None:
        return
    target = place(output, command)
    try:
        _refuse_no_folder(output, target)
        if target.is_dir():
            with _alone_in(target):
                _recover(target)
                _refuse_in_the_way(target, command, names)
        nearest = next(folder for folder in (target, *target.parents) if folder.exists())
        with tempfile.TemporaryDirectory(prefix=_PREFIX, dir=nearest, ignore_cleanup_errors=True):
            pass
    except OSError as error:
        raise _unwritable(target, error) from None


def _unwritable(target: Path, error: OSError) -> AlulaError:
    return unwritable(f"output: '{target}' cannot be written ({error.strerror}); choose another folder", error)


def _refuse_no_folder(output: Path, target: Path) -> None:
    for folder in (Path(os.path.abspath(output)), target):
        if folder.is_symlink():
            real = os.path.realpath(folder)
            remedy = f"give '{real}' itself" if os.path.isdir(real) else "choose another name"
            raise CaseError(f"output: '{folder}' is a symbolic link, and alula writes through none; {remedy}")
        if folder.exists() and not folder.is_dir():
            raise CaseError(f"output: '{folder}' exists and is not a folder; choose another name")


def _refuse_in_the_way(target: Path, command: str, names: Iterable[str]) -> None:
    """Refuse files that would be lost: the user's own under a name that is needed, and alula's that were edited."""
    left = _written(target, command)
    for name in sorted({_list_of(command), *names, *(() if command == EXPORT else left)}):
        path = target / name
        if (above := _no_folder_above(target, name)) is not None:
            raise CaseError(
                f"output: '{above}' must be a folder, but is something else; rename it or choose another "
                "folder for the output"
            )
        if os.path.lexists(path) and not (name in left and _is(path, left[name])):
            raise CaseError(
                f"output: '{path}' was not written by alula, or was edited since, and is not overwritten; rename it or "
                "choose another folder"
            )


def _replace(target: Path, command: str, work: Path, fill: Callable[[Path], object]) -> None:
    """Fill the working folder and exchange its files for those of the earlier run."""
    new = work / _NEW
    new.mkdir()
    fill(new)
    files = {path.relative_to(new).as_posix(): _digest(path) for path in sorted(new.rglob("*")) if path.is_file()}
    with _alone_in(target):
        _refuse_in_the_way(target, command, files)
        own, left = _list_of(command), _written(target, command)
        kept = {name: left[name] for name in left if command == EXPORT and name not in {own, *files}}
        leaving = [name for name in left if name not in kept and _is(target / name)]
        try:
            listed = json.dumps({"files": files | kept, "kept": [*kept]}, indent=1)
            (work / _LIST).write_text(listed + "\n", encoding="utf-8")
            for path in (*work.rglob("*"), work):
                _flush(path)
            if child.stopped():
                raise KeyboardInterrupt
            for name in reversed(_mark_last(leaving)):
                _move(target / name, work / _OLD / name)
            for name in _mark_last(files):
                _move(new / name, target / name)
            _move(work / _LIST, target / own)  # from here on the new result stands
        except BaseException:
            _take_back(target, work)
            raise
        _remove_empty(target, leaving)


def _mark_last(names: Iterable[str]) -> list[str]:
    return sorted(names, key=lambda name: (name == MARK, name))


def _take_back(target: Path, work: Path) -> None:
    """Undo the moves of a run whose list is still in its working folder, as far as they were made."""
    new, old = work / _NEW, work / _OLD
    if not _is(work / _LIST):  # killed before the first move, or after the last
        return
    try:
        table = json.loads((work / _LIST).read_text(encoding="utf-8"))
        entering = {name: digest for name, digest in _files_in(table["files"]).items() if name not in table["kept"]}
    except (ValueError, LookupError, TypeError):  # half a list, and nothing was moved
        entering = {}
    for name in reversed(_mark_last(entering)):
        stands = all(_no_folder_above(folder, name) is None for folder in (target, new))
        if stands and not os.path.lexists(new / name) and _is(target / name, entering[name]):
            _move(target / name, new / name)
    for name in _mark_last(path.relative_to(old).as_posix() for path in old.rglob("*") if _is(path)):
        if _no_folder_above(target, name) is None and not os.path.lexists(target / name):
            _move(old / name, target / name)
    (work / _LIST).unlink()
    _remove_empty(target, entering)


def _recover(target: Path) -> None:
    """Take back what killed runs began, and remove their working folders: those that no process holds."""
    for left in target.glob(f"{_PREFIX}*"):
        held = None
        with contextlib.suppress(FileNotFoundError):  # its run has ended meanwhile and removed it
            if left.is_dir() and not left.is_symlink() and _is_working_folder(left):
                held = locked(left, wait=False)
        if held is not None:
            try:
                _take_back(target, left)
                shutil.rmtree(left, ignore_errors=True)
            finally:
                os.close(held)


def _is_working_folder(folder: Path) -> bool:
    return all(path.name in (_NEW, _OLD, _LIST) and not path.is_symlink() for path in folder.iterdir())


def _list_of(command: str) -> str:
    return f"{_PREFIX}{command}.json"


def _written(target: Path, command: str) -> dict[str, str]:
    """Return name -> digest of the files that the command's earlier run left, and of the list itself."""
    path = target / _list_of(command)
    if not _is(path):
        return {}
    try:
        found = _files_in(json.loads(path.read_text(encoding="utf-8"))["files"])
    except (ValueError, LookupError, TypeError):
        return {}  # no list of ours, so that it is in the way itself
    return found | {path.name: _digest(path)}


def _files_in(found: Any) -> dict[str, str]:
    """Return name -> digest as read from a file; raises ``ValueError`` for a name that leaves the folder."""
    if not isinstance(found, Mapping):
        raise ValueError("no table of files")
    for name, digest in found.items():
        pure = PurePosixPath(name)
        if pure.is_absolute() or ".." in pure.parts or not pure.parts or not isinstance(digest, str):
            raise ValueError(f"{name!r} is no file of this folder")
    return dict(found)


def _is(path: Path, digest: str | None = None) -> bool:
    """Return True for a file, no link, with this digest where one is given."""
    return not path.is_symlink() and path.is_file() and digest in (None, _digest(path))


def _digest(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _no_folder_above(target: Path, name: str) -> Path | None:
    """Return the outermost of what the name has above it in the target that is there and is no folder, or a link."""
    above = (target / part for part in reversed(PurePosixPath(name).parents[:-1]))
    return next((one for one in above if one.is_symlink() or (one.exists() and not one.is_dir())), None)


def _move(source: Path, to: Path) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    source.rename(to)


def _remove_empty(target: Path, names: Iterable[str]) -> None:
    """Remove the subfolders that nothing is left in, of those that held these files."""
    for folder in sorted({above for name in names for above in PurePosixPath(name).parents}, reverse=True):
        if folder != PurePosixPath() and _no_folder_above(target, str(folder)) is None:
            with contextlib.suppress(OSError):  # something is left in it, or it is gone
                (target / folder).rmdir()


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder: of the output while names change, of a working folder while its run lives."""
    held = locked(folder)
    try:
        yield
    finally:
        if held is not None:
            os.close(held)


def _flush(path: Path) -> None:
    """Have a file, or the names in a folder, written to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
