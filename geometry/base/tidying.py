"""What a process clears away before it ends: its scratch folders, and whatever else must not outlive it.

Usually the block that made them clears them away. A process whose threads do not come back from native code is ended
from outside of these blocks (``alula.reports.commands.ending``), and ``tidy_all`` does it then.
"""

import shutil
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_owed: list["_Duty"] = []


class _Duty:
    """Something that is done by the first who asks for it; others wait until it is."""

    def __init__(self, act: Callable[[], object]) -> None:
        self._act = act
        self._lock = threading.RLock()
        _owed.append(self)

    def __call__(self) -> None:
        with self._lock:
            if self in _owed:
                self._act()
                _owed.remove(self)  # only now: what is interrupted is done anew


def owed(act: Callable[[], object]) -> Callable[[], None]:
    """Have something done before the process ends.

    Parameters
    ----------
    act : callable
        Does it, also where it was begun before.

    Returns
    -------
    callable
        Does it now, unless that has been done.
    """
    return _Duty(act)


@contextmanager
def tidied(act: Callable[[], object]) -> Iterator[None]:
    """Do something at the end of a block, or before the process ends in the midst of it.

    Parameters
    ----------
    act : callable
        As for ``owed``.

    Yields
    ------
    None
        Before it is done.
    """
    duty = owed(act)
    try:
        yield
    finally:
        duty()


@contextmanager
def scratch_folder(prefix: str, folder: Path | None = None) -> Iterator[Path]:
    """Make a folder that is gone afterwards.

    Parameters
    ----------
    prefix : str
        Of its name.
    folder : Path, optional
        In which it is made; the system's for temporary files unless given.

    Yields
    ------
    Path
        The folder, empty.
    """
    made = Path(tempfile.mkdtemp(prefix=prefix, dir=folder))
    with tidied(lambda: shutil.rmtree(made, ignore_errors=True)):
        yield made


def tidy_all() -> None:
    """Do all that is owed, the latest first. For a process that is ended at once thereafter."""
    for duty in reversed(tuple(_owed)):
        with suppress(Exception):
            duty()
