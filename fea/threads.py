"""A bound on the threads of the numerical libraries that do the work: numpy's and scipy's OpenBLAS, MKL, OpenMP.

threadpoolctl finds and sets them at run time. The environment variables that do the same are read once,
when numpy is imported, which is too late for an option of a function; MKL alone could be set by a call.
"""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def bounded(threads: int | None) -> Iterator[None]:
    """Let each library use at most that many threads; None leaves what it would use. It is never raised."""
    if threads is None:
        yield
        return
    from threadpoolctl import ThreadpoolController

    controller = ThreadpoolController()
    current: dict[str, int] = {}
    for pool in controller.info():
        current[pool["user_api"]] = max(pool["num_threads"], current.get(pool["user_api"], 1))
    with controller.limit(limits={api: min(threads, used) for api, used in current.items()}):
        yield
