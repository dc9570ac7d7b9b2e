"""The server of the page to work in: its routes, and who may use them: pages that it gave to this machine itself."""

import asyncio
import contextlib
import json
import os
import secrets
import socket
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from functools import cache, partial
from importlib.resources import files
from pathlib import Path
from typing import Any, ClassVar, Literal
from urllib.parse import quote

import uvicorn
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.imported.read import LARGEST_FILE
from alula.geometry.keeping.kept import keeping
from alula.loads.case.case_file import built_in_cases, read_tables
from alula.loads.compose.entry_examples import schema_with_examples
from alula.loads.text.explain import printable
from alula.reports.words.limits import limited
from alula.reports.workbench import out
from alula.reports.workbench.keeping import is_plain
from alula.reports.workbench.parts import dropped
from alula.reports.workbench.session import DRAWING, ConflictError, Session

LARGEST_REQUEST = 8 << 20
"""Bytes: a case of 1 MiB, each of whose characters JSON may write with six."""
KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
"""Files that a page consists of, by how their names end."""
ELSEWHERE = {"viewer.js": "alula.reports.turnable", "turnable.css": "alula.reports.templates"}
"""Files of the page that stand in other packages."""
REPORT = "sandbox allow-scripts allow-downloads; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
"""Policy of a report beside its own by hashes: it is of no origin, so that nothing in it can ask this server."""
Entries = Mapping[str, tuple[type, Any]]
"""Entries of what a page posts, with their types and what stands for a missing one; ``...`` where it must be there."""
MOST_SILENT = 32
"""Connections that have asked nothing yet: a browser opens some ahead of what it will ask."""
_ON: Entries = {"revision": (int, ...), "gesture": (str, "")}
ACTIONS: Mapping[str, tuple[Callable[..., Awaitable[None]], Entries]] = {
    "edit": (Session.edit, {"operations": (list, ...), **_ON}),
    "text": (Session.write, {"text": (str, ...), **_ON}),
    "undo": (Session.undo, {"revision": (int, None), "gesture": (str, "")}),
    "redo": (partial(Session.undo, redo=True), {"revision": (int, None)}),
    "save": (Session.save, {"always": (bool, None)}),
    "reload": (Session.reload, {}),
    "overwrite": (Session.overwrite, {}),
    "draft": (Session.take_draft, {"take": (bool, ...)}),
    "open": (Session.open, {"path": (str, ""), "starter": (str, ""), "as_": (str, "")}),
    "solids": (Session.check_solids, {"do": (str, ...)}),
}
"""What a page may post, by the last part of its address."""


class Guard:
    """Lets through what a page of this server asks, and says to the browser what such a page may do.

    Parameters
    ----------
    app : ASGI application
        Sees paths without the token.
    token : str
        The first part of every path.
    port : int
        At which the server listens.

    Notes
    -----
    The names of a host are compared since another one may lead here as well (DNS rebinding), the origin since any page
    may post to any address, and the token since any program and any user of the machine may ask a port.
    """

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self._app = app
        self._token = token
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request.

        Parameters
        ----------
        scope, receive, send
            As ASGI has them.
        """
        headers = [(name.lower(), value.decode("latin-1")) for name, value in scope["headers"]]
        host = next((value for name, value in headers if name == b"host"), "")

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                message = {**message, "headers": [*message["headers"], *self._seals(host, message["headers"])]}
            await send(message)

        refused = self._refused(scope, headers, host)
        if refused is not None:
            refused.headers["connection"] = "close"  # who may not ask holds no connection
            await refused(scope, receive, sealed)
            return
        rest = "/" + scope["path"].removeprefix("/").partition("/")[2]
        await self._app({**scope, "path": rest, "raw_path": rest.encode(), "root_path": ""}, receive, sealed)

    def _refused(self, scope: Scope, headers: list[tuple[bytes, str]], host: str) -> Response | None:
        if host not in self._hosts or sum(name == b"host" for name, _ in headers) != 1:
            return _sentence(403, "this server answers at 127.0.0.1 alone")
        origins = {value for name, value in headers if name == b"origin"}
        own = origins == {f"http://{host}"} if scope["method"] not in ("GET", "HEAD") else origins <= {f"http://{host}"}
        if not own:
            return _sentence(403, "only a page of this server may ask this")
        token, sign, _ = scope["path"].removeprefix("/").partition("/")
        if not (secrets.compare_digest(token.encode(), self._token.encode()) and sign):
            return _sentence(404, "there is nothing at this address; open the one that 'alula open' printed")
        return None

    def _seals(self, host: str, headers: list[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
        own = f"http://{host}/{self._token}/page/" if host in self._hosts else "'none'"
        rules = (
            f"default-src 'none'; script-src {own}; style-src {own}; img-src 'self' data: blob:; connect-src 'self'; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )
        seals = {
            b"content-security-policy": rules,
            b"x-content-type-options": "nosniff",
            b"referrer-policy": "no-referrer",
            b"cache-control": "no-store",
            b"cross-origin-resource-policy": "same-origin",
            b"cross-origin-opener-policy": "same-origin",
        }
        stated = {name.lower() for name, _ in headers}
        return [(name, value.encode()) for name, value in seals.items() if name not in stated]


def application(session: Session) -> Starlette:
    """Return what serves a session, without who may use it.

    Parameters
    ----------
    session : Session

    Returns
    -------
    ASGI application
    """

    async def page(request: Request) -> Response:
        return _page(request.path_params.get("file", "index.html"))

    async def events(request: Request) -> Response:
        hearing = session.listen()

        async def stream() -> AsyncIterator[str]:
            try:
                async for message in hearing.messages():
                    yield message
            finally:
                session.leave(hearing)

        return StreamingResponse(stream(), media_type="text/event-stream")

    async def starters(request: Request) -> Response:
        names = (one.name for one in session.folder.glob("*.toml") if is_plain(one.name, ".toml") and one.is_file())
        told = {"starters": _starters(), "files": sorted(names), "folder": str(session.folder), "new": session.new}
        return JSONResponse(told)

    async def schema(request: Request) -> Response:
        return JSONResponse(schema_with_examples())

    async def model(request: Request) -> Response:
        return JSONResponse(session.solids.model(request.path_params["link"]))

    async def report(request: Request) -> Response:
        fidelity: Literal["beam", "solid"] = "solid" if request.query_params.get("fidelity") == "solid" else "beam"
        data = await asyncio.to_thread(out.report, session.opened().text, str(session.path), fidelity)
        return Response(data, media_type="text/html", headers={"Content-Security-Policy": REPORT})

    async def case(request: Request) -> Response:
        return _file(session.opened().text.encode(), session.path.name)

    async def step(request: Request) -> Response:
        link = request.path_params["link"]
        return _file(await asyncio.to_thread(out.step, session.opened().text, str(session.path), link), f"{link}.step")

    async def drop(request: Request) -> Response:
        data = await _received(request, LARGEST_FILE)
        return JSONResponse(await asyncio.to_thread(dropped, request.path_params["name"], data, session.folder))

    async def act(request: Request) -> Response:
        if request.path_params["action"] not in ACTIONS:
            raise HTTPException(404)
        action, entries = ACTIONS[request.path_params["action"]]
        await action(session, **await _asked(request, entries))
        return JSONResponse({"revision": session.document.revision if session.document else 0})

    routes = [
        Route("/", page),
        Route("/page/{file}", page),
        Route("/events", events),
        Route("/starters", starters),
        Route("/schema", schema),
        Route("/model/{link}", model),
        Route("/out/report", report),
        Route("/out/case", case),
        Route("/out/step/{link}", step),
        Route("/drop/{name}", drop, methods=["POST"]),
        Route("/{action}", act, methods=["POST"]),
    ]
    app = Starlette(routes=routes, exception_handlers=dict.fromkeys((AlulaError, HTTPException, Exception), _refused))
    app.router.redirect_slashes = False  # it knows no token
    return app


def _page(name: str) -> Response:
    """Return a file of the page, if there is one of that name; a name is no path."""
    kind = next((kind for end, kind in KINDS.items() if name.endswith(end)), None)
    place = files(ELSEWHERE[name]) if name in ELSEWHERE else files("alula.reports.workbench") / "page"
    found = next((file for file in place.iterdir() if file.name == name), None)
    if found is None or kind is None:
        return _sentence(404, f"there is no '{printable(name)}' here")
    return Response(found.read_bytes(), media_type=kind)


@cache
def _starters() -> list[dict[str, str]]:
    titles = {DRAWING: "begins with two pins of the ground"}
    titles |= {name: read_tables(name)["title"] for name in built_in_cases()}
    return [{"name": name, "title": title} for name, title in titles.items()]


async def _received(request: Request, most: int) -> bytes:
    """Return the body of a request, of which no more is read than the limit [bytes]."""
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > most:
            raise CaseError(f"what was sent is larger than {most / 1e6:.0f} MB, the limit; send less")
    return bytes(body)


async def _asked(request: Request, entries: Entries) -> dict[str, Any]:
    """Return these entries of the JSON object that a page posted; others are left out."""
    if request.headers.get("content-type", "").partition(";")[0] != "application/json":
        raise CaseError("what was sent is not marked as application/json")
    try:
        found = json.loads(await _received(request, LARGEST_REQUEST) or b"{}", parse_constant=_no_number)
        json.dumps(found, ensure_ascii=False).encode()  # half of a surrogate pair is no text
    except (ValueError, RecursionError):
        raise CaseError("what was sent is no JSON") from None
    if not isinstance(found, dict):
        raise CaseError("what was sent is no JSON object")
    asked = {}
    for name, (kind, default) in entries.items():
        value = found.get(name.rstrip("_"), default)
        if type(value) is not kind and (value is ... or value is not default):
            raise CaseError(f"{name.rstrip('_')}: it is missing, or no {kind.__name__}")
        asked[name] = value
    return asked


def _no_number(text: str) -> None:
    raise ValueError(text)


def _file(data: bytes, name: str) -> Response:
    """Return a file to be kept, whose name is told in a way that holds any text."""
    headers = {"Content-Disposition": f"attachment; filename*=UTF-8''{quote(name, safe='')}"}
    return Response(data, media_type="application/octet-stream", headers=headers)


def _sentence(status: int, sentence: str) -> Response:
    return JSONResponse({"sentence": " ".join(sentence.split())}, status)


async def _refused(request: Request, error: Exception) -> Response:
    if isinstance(error, HTTPException):
        return _sentence(error.status_code, "there is nothing at this address")
    if isinstance(error, AlulaError):
        return _sentence(409 if isinstance(error, ConflictError) else 422, str(error))
    return _sentence(500, f"internal error of alula, not of the case: {type(error).__name__}: {printable(str(error))}")


def _listening(port: int) -> socket.socket:
    """Return a socket at a port that this machine alone can reach; 0 for one that is free."""
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


def serve(
    case: Path | None,
    folder: Path,
    port: int,
    ready: Callable[[str], None],
    *,
    threads: int = 2,
    memory: str | None = None,
) -> None:
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
    threads : int, optional
    memory : str, optional
        Limits of this process, and of that which solves links as solids.

    Raises
    ------
    CaseError
        For a port that is in use or forbidden, a memory that is none, and for a case that cannot be read, or whose
        path is no text.
    """
    try:
        str(case or folder).encode()
    except UnicodeEncodeError:
        shown = printable((case or folder).name)
        raise CaseError(f"'{shown}' or a folder above it has a name that is no UTF-8 text; rename it") from None
    with contextlib.closing(_listening(port)) as bound, limited(threads, memory), keeping():
        asyncio.run(_serve(case, lambda: Session(folder, threads, memory), bound, ready))


class _Connection(H11Protocol):
    """A connection that has asked nothing yet is closed where more than some wait: whoever opens many blocks nobody."""

    _silent: ClassVar[dict["_Connection", None]] = {}

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._silent[self] = None
        if len(self._silent) > MOST_SILENT:
            oldest = next(iter(self._silent))
            del self._silent[oldest]
            oldest.transport.close()

    def connection_lost(self, exc: Exception | None) -> None:
        self._silent.pop(self, None)
        super().connection_lost(exc)

    def handle_events(self) -> None:
        super().handle_events()
        if self.cycle is not None:  # a whole head of a request was there
            self._silent.pop(self, None)


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


async def _serve(
    case: Path | None, begun: Callable[[], Session], bound: socket.socket, ready: Callable[[str], None]
) -> None:
    session = begun()
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
        Guard(application(session), token, port), http=_Connection, ws="none", loop="asyncio", lifespan="off",
        log_config=None, log_level="critical", access_log=False, server_header=False, proxy_headers=False,
        timeout_graceful_shutdown=1,
    )  # fmt: skip
    server = _Server(config)
    server.session, server.ready = session, lambda: ready(f"http://127.0.0.1:{port}/{token}/")
    await server.serve(sockets=[bound])
