"""A bound on the threads of a run: numpy's and scipy's OpenBLAS, MKL, OpenMP, and how many children work at once.

OpenBLAS gets one thread in every bounded run. It multiplies and solves dense matrices of some hundred rows here;
numpy and scipy bring one OpenBLAS each, whose idle threads spin on each other's cores: with two a check of the owl wing
by hand took 5.7 s on two cores, with one 2.6 s. Sparse factors, which threads serve, are MKL's.

threadpoolctl sets libraries that are loaded; those that are loaded later read the environment. Children (the mesher,
the renderer) use one thread each (``alula.geometry.base.child``), so that bounding their number bounds them.
"""

import functools
import inspect
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

from alula.geometry.base import child

P = ParamSpec("P")
R = TypeVar("R")

OPENBLAS = "OPENBLAS_NUM_THREADS"
VARIABLES = ("OMP_NUM_THREADS", OPENBLAS, "MKL_NUM_THREADS")


@contextmanager
def bounded(threads: int | None, *, children: int | None = None) -> Iterator[None]:
    """Limit the threads of every library in what follows; their number is never raised.

    Parameters
    ----------
    threads : int or None
        Of each library at most; None leaves what it would use.
    children : int, optional
        Child processes at most; as many as threads unless given.

    Yields
    ------
    None
    """
    if threads is None:
        yield
        return
    from threadpoolctl import ThreadpoolController

    controller = ThreadpoolController()
    current: dict[str, int] = {}
    for pool in controller.info():
        current[pool["user_api"]] = max(pool["num_threads"], current.get(pool["user_api"], 1))
    before = {name: os.environ.get(name) for name in VARIABLES}
    every = _least(threads, before[VARIABLES[0]])  # what MKL takes where nothing of its own is stated
    os.environ.update({name: str(_least(every, value)) for name, value in before.items()})
    os.environ[OPENBLAS] = "1"
    try:
        limits = {api: min(threads, used) for api, used in current.items()}
        dense = controller.select(internal_api="openblas")
        with controller.limit(limits=limits), dense.limit(limits=1), child.at_most(children or threads):
            yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _least(threads: int, stated: str | None) -> int:
    """The smaller of both; what is stated may be anything."""
    return min(threads, int(stated)) if stated and stated.isdecimal() and int(stated) > 0 else threads


def bounded_run(run: Callable[P, R]) -> Callable[P, R]:
    """Limit the threads of a whole function by its keyword ``threads``.

    Parameters
    ----------
    run : callable
        With a keyword ``threads``.

    Returns
    -------
    callable
        With the same signature.
    """
    default = inspect.signature(run).parameters["threads"].default

    @functools.wraps(run)
    def within(*arguments: P.args, **options: P.kwargs) -> R:
        threads = options.get("threads", default)
        assert threads is None or isinstance(threads, int)
        with bounded(threads):
            return run(*arguments, **options)

    return within
