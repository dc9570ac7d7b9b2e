"""The memory that a child process may take for a request, so that a runaway fails itself and not the machine."""

import math
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


class MemoryGuard:
    """Ends this process once it holds more memory than its present request may take (on Linux; elsewhere never).

    What counts is private memory that can be written, as for ``RLIMIT_DATA``. That limit alone would not do: libraries
    to which it refuses memory say so, say something else, or crash.

    Parameters
    ----------
    tell : callable
        Called without arguments before the process ends; it returns False where no request is at work, so that the
        process goes on.
    """

    def __init__(self, tell: Callable[[], bool]) -> None:
        self._tell, self._limit = tell, math.inf
        if not sys.platform.startswith("linux"):
            return
        import resource

        self._inherited = resource.getrlimit(resource.RLIMIT_DATA)
        threading.Thread(target=self._watch, daemon=True).start()

    def allow(self, limit: float) -> None:
        """Set the limit.

        Parameters
        ----------
        limit : float
            Largest amount of memory [bytes].
        """
        self._limit = limit
        if not sys.platform.startswith("linux"):
            return
        import resource

        soft, hard = self._inherited
        bounds = [most for most in (soft, hard) if most != resource.RLIM_INFINITY]
        least = min([int(_HARD * limit), *bounds]) if math.isfinite(limit) else soft
        resource.setrlimit(resource.RLIMIT_DATA, (least, hard))

    def _watch(self) -> None:
        page = os.sysconf("SC_PAGE_SIZE")
        with _STATM.open("rb", buffering=0) as file:
            while page * int(os.pread(file.fileno(), 200, 0).split()[5]) <= self._limit or not self._tell():
                time.sleep(_PERIOD)
        os._exit(1)
