"""An output folder that is written completely or not at all."""

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from geometry.errors import CannotRunError, CaseError

MARK = "result.json"
"""The file by which alula knows a folder as its own."""


def write_folder(target: Path, fill: Callable[[Path], None]) -> None:
    """Let ``fill`` write into a fresh folder beside ``target``, then put it in the target's place.

    An existing folder is replaced only if it is empty or holds an earlier result of alula's, and only
    once the new one is whole. Raises ``CaseError`` for a target that is something else, and
    ``CannotRunError`` where the disk refuses.
    """
    target = Path(os.path.abspath(target))
    _check(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        fresh = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise CannotRunError(
            f"output: '{target}' cannot be written ({error.strerror}); choose another folder"
        ) from None
    try:
        fill(fresh)
        for path in fresh.rglob("*"):
            if path.is_file():
                _flush(path)
        fresh.chmod(0o755)
        _replace(target, fresh)
    except OSError as error:
        raise CannotRunError(
            f"output: writing to '{target}' failed ({error.strerror or error}); nothing was changed there"
        ) from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


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
    with path.open("rb") as stream:
        os.fsync(stream.fileno())


def _replace(target: Path, fresh: Path) -> None:
    """Swap the folders by two renames; the old one is put back if the second fails."""
    if not target.exists():
        fresh.rename(target)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{target.name}.old.", dir=target.parent))
    moved = old / target.name
    target.rename(moved)
    try:
        fresh.rename(target)
    except OSError:
        moved.rename(target)
        raise
    finally:
        shutil.rmtree(old, ignore_errors=True)
