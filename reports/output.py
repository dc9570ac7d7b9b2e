"""An output folder that is written completely or not at all."""

import glob
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry import child
from geometry.errors import CannotRunError, CaseError
from geometry.locks import locked

MARK = "result.json"
"""The file by which alula knows a folder as its own."""


def write_folder(target: Path, fill: Callable[[Path], None]) -> None:
    """Let ``fill`` write into a fresh folder beside ``target``, then put it in the target's place.

    An existing folder is replaced only if it is empty or holds an earlier result of alula's, and only
    once the new one is whole. Of several runs into one folder the last to finish stays. What a killed run left
    is removed. Raises ``CaseError`` for a target that is something else, and ``CannotRunError`` where the disk
    refuses.
    """
    target = Path(os.path.abspath(target))
    try:
        _check(target)
        target.parent.mkdir(parents=True, exist_ok=True)
        with _alone_in(target.parent):
            _clear(target)
            fresh = Path(tempfile.mkdtemp(prefix=_prefix(target), dir=target.parent))
            mine = locked(fresh)
    except OSError as error:
        raise _unwritable(target, error) from None
    try:
        fill(fresh)
        for path in (*fresh.rglob("*"), fresh):
            _flush(path)
        fresh.chmod(0o755)
        if child.stopped():
            raise KeyboardInterrupt
        with _alone_in(target.parent):
            _check(target)
            _replace(target, fresh)
    except OSError as error:
        raise CannotRunError(
            f"output: writing to '{target}' failed ({error.strerror or error}); nothing was changed there"
        ) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
        if mine is not None:
            os.close(mine)


def refuse_unusable(target: Path | None) -> None:
    """Refuse an output folder before anything is computed for it.

    Raises ``CaseError`` for a target that is something else than a folder of results, and ``CannotRunError`` where
    the disk refuses to be written to.
    """
    if target is None:
        return
    target = Path(os.path.abspath(target))
    try:
        _check(target)
        parent = next(folder for folder in target.parents if folder.exists())
        with tempfile.TemporaryDirectory(prefix=_prefix(target), dir=parent):
            pass
    except OSError as error:
        raise _unwritable(target, error) from None


def _unwritable(target: Path, error: OSError) -> CannotRunError:
    return CannotRunError(f"output: '{target}' cannot be written ({error.strerror}); choose another folder")


def _prefix(target: Path) -> str:
    return f".{target.name}.alula-"


@contextmanager
def _alone_in(parent: Path) -> Iterator[None]:
    """Keep other runs from changing names in a folder meanwhile."""
    held = locked(parent)
    try:
        yield
    finally:
        if held is not None:
            os.close(held)


def _clear(target: Path) -> None:
    """Remove what killed runs left beside the target: folders of its prefix that no process holds.

    A run that was killed between its two renames left the earlier result in such a folder: it is put back.
    """
    for left in target.parent.glob(glob.escape(_prefix(target)) + "*"):
        held = locked(left, wait=False) if left.is_dir() and not left.is_symlink() else None
        if held is None:
            continue
        earlier = left / target.name
        if is_result(earlier) and not target.exists():
            earlier.rename(target)
        shutil.rmtree(left, ignore_errors=True)
        os.close(held)


def _check(target: Path) -> None:
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise CaseError(f"output: '{target}' exists and is not a folder; choose another name")
    if target.is_dir() and any(target.iterdir()) and not is_result(target):
        raise CaseError(
            f"output: '{target}' holds other files and no earlier result; choose another folder, lest something be lost"
        )


def is_result(folder: Path) -> bool:
    """Return True if a folder holds a result of alula's."""
    try:
        record = json.loads((folder / MARK).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    known = {"verdict", "motion", "coefficients"}  # of a check, a motion, a synthesis
    return isinstance(record, dict) and "schema_version" in record and not known.isdisjoint(record)


def _flush(path: Path) -> None:
    """Have a file, or the names in a folder, written to the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _replace(target: Path, fresh: Path) -> None:
    """Swap the folders by two renames; the old one is put back if the second fails."""
    if not target.exists():
        fresh.rename(target)
        return
    old = Path(tempfile.mkdtemp(prefix=_prefix(target), dir=target.parent))
    moved = old / target.name
    target.rename(moved)
    try:
        fresh.rename(target)
    except OSError:
        moved.rename(target)
        raise
    finally:
        shutil.rmtree(old, ignore_errors=True)
