"""Dask's workers on one machine or several compute the variants of a study (the extra ``alula[cluster]``).

Dask sends a task and the files of its parts, starts a task anew on another worker where one dies
(``distributed.scheduler.allowed-failures``), and takes workers that come and go. The study keeps the results.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from alula.fea.study.engine import IN_FLIGHT, Engine
from alula.fea.study.evaluate import evaluate, versions
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.version import extra_command

CONNECTING = 5.0
"""Seconds within which the scheduler must answer."""
PATIENCE = 30.0
"""Seconds within which a first worker must be there."""
_SCHEMES = ("tcp", "tls", "ws", "wss", "ucx")
_AGAIN = "the same command goes on with the study"


def require_address(address: str) -> None:
    """Refuse what is not the address of a scheduler on a network.

    Parameters
    ----------
    address : str
        Such as ``"tcp://host:8786"``, or ``"host:8786"``.

    Raises
    ------
    CaseError
        For another form.
    """
    try:
        found = urlsplit(address if "://" in address else f"tcp://{address}")
        if found.scheme in _SCHEMES and found.hostname and found.port:
            return
    except ValueError:  # a port that is none
        pass
    raise CaseError(
        f"--scheduler: it is '{address}', but must name protocol, host and port; write for example tcp://host:8786"
    )


@contextmanager
def cluster_engine(address: str, contents: Mapping[str, bytes], *, patience: float = PATIENCE) -> Iterator[Engine]:
    """Compute on the workers of a Dask scheduler.

    Parameters
    ----------
    address : str
        Of the scheduler, such as ``"tcp://host:8786"``.
    contents : mapping of str to bytes
        The files of the case's parts; they are sent once.
    patience : float
        Within which a first worker must be there [s].

    Yields
    ------
    Engine

    Raises
    ------
    CannotRunError
        Where ``distributed`` is missing, no scheduler answers, it has no workers, or these are not fit.
    """
    try:
        import distributed
    except ImportError:
        raise CannotRunError(f"--scheduler: Dask is not installed; run {extra_command('cluster')}") from None

    class Client(distributed.Client):
        def __del__(self) -> None:
            """Wait for nothing: one that was never connected would do so for a minute, and fail."""

    try:
        make: Any = Client
        client: Any = make(address, timeout=CONNECTING, set_as_default=False)
    except Exception as error:  # whatever Dask makes of the answer of another server
        why = type(error).__name__
        raise CannotRunError(
            f"--scheduler: no Dask scheduler answers at '{address}' ({why}); start one with: dask scheduler"
        ) from None
    try:
        _require_fit(client, address, patience)
        files = client.scatter(dict(contents), broadcast=False) if contents else {}
        executor = client.get_executor(pure=False)
        yield Engine(
            submit=lambda task: executor.submit(evaluate, task, files),
            capacity=lambda: IN_FLIGHT * max(len(client.nthreads()), 1),
        )
    except (OSError, RuntimeError) as error:
        if isinstance(error, CannotRunError):
            raise
        raise CannotRunError(f"--scheduler: '{address}' does not answer any more; {_AGAIN} once it does") from None
    finally:
        client.close(timeout=2)


def _require_fit(client: Any, address: str, patience: float) -> None:
    """Refuse workers with several threads, since limits hold for a whole process, and those of another version."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except OSError:
        raise CannotRunError(
            f"--scheduler: '{address}' has no workers; start some with: dask worker {address} --nthreads 1"
        ) from None
    if several := [worker for worker, threads in client.nthreads().items() if threads != 1]:
        raise CannotRunError(f"--scheduler: worker {several[0]} has several threads; start it with --nthreads 1")
    try:
        found = client.run(versions)
    except Exception as error:  # whatever a worker without alula says
        raise CannotRunError(f"--scheduler: a worker cannot run alula ({error}); install it there") from None
    for worker, there in found.items():
        if tuple(there) != versions():
            raise CannotRunError(
                f"--scheduler: worker {worker} has alula {there[0]} with gmsh {there[1]}, but here they are "
                f"{' and '.join(versions())}; install equal versions"
            )
