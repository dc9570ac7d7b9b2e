"""The memory that a child process may take, so that a runaway fails itself and not the machine."""

import os
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

_STATM = Path("/proc/self/statm")
_PERIOD = 0.05
"""Seconds between looks: a mesher takes some ten megabytes meanwhile."""
_HARD = 1.25
"""Share of the limit beyond which the system refuses memory, which libraries survive or not."""


def allowed(wanted: float) -> float:
    """Return how much memory a child may hold: at most half of the machine's, since two may run.

    Parameters
    ----------
    wanted : float
        Limit that was asked for [bytes].

    Returns
    -------
    float
        The limit to apply [bytes].
    """
    try:
        return min(wanted, os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2.0)
    except (AttributeError, ValueError, OSError):  # not a Unix, or it does not tell
        return wanted


def bound(limit: float, tell: Callable[[], None]) -> None:
    """End this process once it holds more than a limit of memory (on Linux; elsewhere nothing happens).

    What counts is private memory that can be written, as for ``RLIMIT_DATA``. That limit alone would not do: libraries
    to which it refuses memory say so, say something else, or crash.

    Parameters
    ----------
    limit : float
        Largest amount of memory [bytes].
    tell : callable
        Called without arguments before the process ends.
    """
    if not sys.platform.startswith("linux"):
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    least = min([int(_HARD * limit), *(most for most in (soft, hard) if most != resource.RLIM_INFINITY)])
    resource.setrlimit(resource.RLIMIT_DATA, (least, hard))
    page = os.sysconf("SC_PAGE_SIZE")

    def watch() -> None:
        with _STATM.open("rb", buffering=0) as file:
            while page * int(os.pread(file.fileno(), 200, 0).split()[5]) <= limit:
                time.sleep(_PERIOD)
        tell()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
