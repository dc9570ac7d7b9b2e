"""The server itself: one port of this machine, a token, and an end that waits for nobody."""

import asyncio
import contextlib
import os
import secrets
import socket
from collections.abc import Callable
from pathlib import Path

import uvicorn

from alula.geometry.base.errors import CaseError
from alula.reports.workbench.app import Guard, application
from alula.reports.workbench.session import Session


def listening(port: int) -> socket.socket:
    """Return a socket that this machine alone can reach.

    Parameters
    ----------
    port : int
        Its port; 0 for one that is free.

    Returns
    -------
    socket.socket

    Raises
    ------
    CaseError
        For a port that is in use or forbidden.
    """
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if os.name == "posix":
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # one that was closed a minute ago is free
    try:
        made.bind(("127.0.0.1", port))
        made.listen()
    except OSError as error:
        made.close()
        why = f"it cannot be had ({error.strerror}); choose another, or leave it out"
        raise CaseError(f"--port {port}: {why}") from None
    return made


def serve(case: Path | None, folder: Path, port: int, ready: Callable[[str], None]) -> None:
    """Serve a case, or what one can start from, until a signal ends it.

    Parameters
    ----------
    case : Path or None
        The case, in ``folder``; one that is missing is to be made.
    folder : Path
        In which cases are opened.
    port : int
        0 for one that is free.
    ready : callable
        Is told the address once it answers.

    Raises
    ------
    CaseError
        As ``listening``, and for a case that cannot be read.
    """
    with contextlib.closing(listening(port)) as bound:
        asyncio.run(_serve(case, folder, bound, ready))


class _Server(uvicorn.Server):
    """Ends streams and workers before it waits for open connections, and says when it answers."""

    session: Session
    ready: Callable[[], None]

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self.ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await self.session.close()
        await super().shutdown(sockets)


async def _serve(case: Path | None, folder: Path, bound: socket.socket, ready: Callable[[str], None]) -> None:
    session = Session(folder)
    try:
        if case is not None and case.exists():
            session.load(case)
        elif case is not None:
            session.new = case.name
    except BaseException:
        await session.close()
        raise
    port, token = bound.getsockname()[1], secrets.token_urlsafe(24)
    config = uvicorn.Config(
        Guard(application(session), token, port), http="h11", ws="none", loop="asyncio", lifespan="off",
        log_config=None, log_level="critical", access_log=False, server_header=False, proxy_headers=False,
        limit_concurrency=64, timeout_graceful_shutdown=1,
    )  # fmt: skip
    server = _Server(config)
    server.session, server.ready = session, lambda: ready(f"http://127.0.0.1:{port}/{token}/")
    await server.serve(sockets=[bound])
