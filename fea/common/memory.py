"""Memory that a solution will take, and what there is: a run is refused before the kernel ends it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from alula.geometry.base.errors import CannotRunError

_PROC = Path("/proc")
_CGROUP = Path("/sys/fs/cgroup")
_GIGA = 1e9
_limit: ContextVar[float | None] = ContextVar("memory limit", default=None)


@contextmanager
def limited(limit: float | None) -> Iterator[None]:
    """Limit the memory that this process may hold in what follows.

    Parameters
    ----------
    limit : float or None
        [bytes]; None leaves the limit that holds already.

    Yields
    ------
    None
    """
    if limit is None:
        yield
        return
    token = _limit.set(limit)
    try:
        yield
    finally:
        _limit.reset(token)


def resident() -> float:
    """Memory that this process holds [bytes]; 0 where the system does not tell."""
    try:
        pages = int((_PROC / "self/statm").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return 0.0
    return float(pages * os.sysconf("SC_PAGE_SIZE"))


def with_libraries() -> float:
    """Load the libraries that solve linkages and solids, and return the memory that this process holds with them.

    Returns
    -------
    float
        [bytes]; 0 where the system does not tell.
    """
    import skfem  # noqa: F401

    return resident()


def available() -> float:
    """Memory that this process can still take [bytes]: the least that the system, container and limits leave.

    Linux: MemAvailable of /proc/meminfo, memory.max of the control group, RLIMIT_AS. Elsewhere the whole
    physical memory less what this process holds; infinite where that is unknown too.
    """
    return min(_allowances(), default=float("inf"))


def _allowances() -> Iterator[float]:
    try:
        lines = (_PROC / "meminfo").read_text().splitlines()
        entries = dict(line.split(":", 1) for line in lines)
        yield 1024.0 * int(entries["MemAvailable"].split()[0])
    except (OSError, KeyError, ValueError):
        if "SC_PHYS_PAGES" in getattr(os, "sysconf_names", {}):
            yield float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")) - resident()
    try:
        most = (_CGROUP / "memory.max").read_text().strip()
        if most != "max":
            yield max(float(most) - float((_CGROUP / "memory.current").read_text()), 0.0)
    except (OSError, ValueError):
        pass
    try:
        import resource
    except ImportError:  # not a Unix
        return
    most_addresses = resource.getrlimit(resource.RLIMIT_AS)[0]
    if most_addresses != resource.RLIM_INFINITY:
        try:
            held = int((_PROC / "self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
        except (OSError, ValueError, IndexError):
            held = 0
        yield max(float(most_addresses - held), 0.0)


def room(limit: float | None) -> float:
    """Return the memory that may still be taken [bytes].

    Parameters
    ----------
    limit : float or None
        What the whole process may hold [bytes], beside the limit of ``limited``.

    Returns
    -------
    float
    """
    limit = _stated(limit)
    return available() if limit is None else max(min(limit - resident(), available()), 0.0)


def _stated(limit: float | None) -> float | None:
    return min((one for one in (limit, _limit.get()) if one is not None), default=None)


def require(needed: float, task: str, limit: float | None) -> None:
    """Refuse a task for which the memory does not suffice.

    Parameters
    ----------
    needed : float
        Estimate of what the task takes [bytes].
    task : str
        What is to be done, for people.
    limit : float or None
        What the whole process may hold [bytes].

    Raises
    ------
    CannotRunError
        Where more is needed than is left.
    """
    left, limit = room(limit), _stated(limit)
    if needed > left:
        raise CannotRunError(
            f"{task} needs about {needed / _GIGA:.2g} GB of memory and {left / _GIGA:.2g} GB are left"
            f"{'' if limit is None else f' of the limit of {limit / _GIGA:.3g} GB'}: use a coarser mesh"
            f"{' or ' if limit is None else ', raise the limit or use '}a machine with more memory"
        )
