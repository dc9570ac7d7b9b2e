"""What no input may cause while it is read and validated: files touched, programs started, code evaluated, a hang.

An audit hook sees what the interpreter is asked to do, whoever asks; it cannot be removed, so it is switched.
"""

import os
import signal
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

TIME_LIMIT = 1.0
"""Seconds of processor time for one input: another program's load does not count."""
_ROOT = Path(__file__).resolve().parents[2]
_READ_ONLY = tuple(str(_ROOT / package) for package in ("geometry", "loads", "fea", "reports"))
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_FORBIDDEN = (
    "compile",
    "exec",
    "import",
    "subprocess.",
    "socket.",
    "shutil.",
    "ctypes.",
    "urllib.",
    "pickle.",
    "marshal.",
)
_FORBIDDEN_OS = ("remove", "rename", "rmdir", "mkdir", "link", "symlink", "chmod", "chown", "truncate", "utime",
                 "exec", "fork", "forkpty", "posix_spawn", "spawn", "startfile", "system", "kill", "putenv",
                 "chdir")  # fmt: skip


class Violated(BaseException):
    """An input did what no input may do; no ``except Exception`` can swallow it."""


class _State:
    active = False
    readable: str = ""
    broken: str = ""


def _hook(event: str, arguments: tuple[Any, ...]) -> None:
    if not _State.active:
        return
    if event == "open":
        path, mode, flags = arguments
        shown = os.fsdecode(path) if isinstance(path, str | bytes) else str(path)
        wrong = bool((flags or 0) & _WRITING) or any(c in (mode or "") for c in "wax+")
        if not wrong and (shown == _State.readable or shown.startswith(_READ_ONLY)):
            return
        what = f"opened {shown!r} ({mode}, {flags})"
    elif event.startswith(_FORBIDDEN) or (event.startswith("os.") and event[3:] in _FORBIDDEN_OS):
        what = f"{event}{arguments!r:.200}"
    else:
        return
    _State.broken = _State.broken or what
    raise Violated(what)


def _too_long(number: int, frame: object) -> None:
    raise Violated(f"took more than {TIME_LIMIT:g} s of processor time")


def install() -> None:
    """Switch the hook in for this process, once."""
    sys.addaudithook(_hook)
    signal.signal(signal.SIGPROF, _too_long)


@contextmanager
def watched(readable: Path | None = None) -> Iterator[None]:
    """Run one input; raises ``Violated`` where it did what none may, ``Warning`` where a library complained."""
    _State.readable, _State.broken = str(readable or ""), ""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        signal.setitimer(signal.ITIMER_PROF, TIME_LIMIT)
        _State.active = True
        try:
            yield
        finally:
            _State.active = False
            signal.setitimer(signal.ITIMER_PROF, 0.0)
    if _State.broken:
        raise Violated(_State.broken)
