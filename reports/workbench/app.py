"""Routes of the page to work in, and who may use them: pages that this server itself gave to this machine's browser."""

import json
import secrets
from collections.abc import Awaitable, Callable, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from alula.geometry.base.errors import AlulaError, CaseError
from alula.loads.case.case_file import built_in_cases, read_tables
from alula.loads.text.explain import printable
from alula.reports.workbench.session import ConflictError, Session

LARGEST_REQUEST = 8 << 20
"""Bytes: a case of 1 MiB, each of whose characters JSON may write with six."""
LARGEST_DROP = 64 << 20
"""Bytes of a file that is dropped in."""
KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
"""Files that a page consists of, by how their names end."""
ELSEWHERE = {"viewer.js": "alula.reports.turnable", "report.css": "alula.reports.templates"}
"""Files of the page that stand in other packages."""
Answer = Callable[[Request], Awaitable[Response]]


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
        rules = {
            "default-src": "'none'",
            "script-src": own,
            "style-src": own,
            "img-src": "'self' data: blob:",
            "connect-src": "'self'",
            "base-uri": "'none'",
            "form-action": "'none'",
            "frame-ancestors": "'none'",
        }
        seals = {
            b"content-security-policy": "; ".join(f"{name} {value}" for name, value in rules.items()),
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
    Starlette
    """

    def done() -> Response:
        return JSONResponse({"revision": session.document.revision if session.document else 0})

    async def index(request: Request) -> Response:
        return _page("index.html")

    async def page(request: Request) -> Response:
        return _page(request.path_params["file"])

    async def events(request: Request) -> Response:
        hearing = session.listen()

        async def stream() -> Any:
            try:
                async for message in hearing.messages():
                    yield message
            finally:
                session.leave(hearing)

        return StreamingResponse(stream(), media_type="text/event-stream")

    async def edit(request: Request) -> Response:
        asked = await _asked(request, revision=int, operations=list)
        if not all(isinstance(one, dict) for one in asked["operations"]):
            raise CaseError("operations: each must be an object with 'op'")
        session.edit(asked["revision"], asked["operations"], _text(asked, "gesture"))
        return done()

    async def text(request: Request) -> Response:
        asked = await _asked(request, revision=int, text=str)
        session.write(asked["revision"], asked["text"], _text(asked, "gesture"))
        return done()

    async def undo(request: Request) -> Response:
        session.undo()
        return done()

    async def redo(request: Request) -> Response:
        session.redo()
        return done()

    async def save(request: Request) -> Response:
        asked = await _asked(request)
        await session.save(asked["always"] if isinstance(asked.get("always"), bool) else None)
        return done()

    async def reload(request: Request) -> Response:
        await session.reload()
        return done()

    async def overwrite(request: Request) -> Response:
        await session.overwrite()
        return done()

    async def draft(request: Request) -> Response:
        session.take_draft((await _asked(request, take=bool))["take"])
        return done()

    async def opened(request: Request) -> Response:
        asked = await _asked(request)
        await session.open(_text(asked, "path"))
        return done()

    async def starters(request: Request) -> Response:
        found = sorted(file.name for file in session.folder.glob("*.toml") if file.is_file())
        return JSONResponse({"starters": _starters(), "files": found, "folder": str(session.folder)})

    async def solids(request: Request) -> Response:
        asked = await _asked(request, do=str)
        session.check_solids(asked["do"] == "start", _text(asked, "fidelity") or "solid")
        return done()

    async def model(request: Request) -> Response:
        return JSONResponse(session.solids.model(request.path_params["link"]))

    async def schema(request: Request) -> Response:
        return Response(_schema(), media_type="application/json")

    get: Mapping[str, Answer] = {
        "/": index,
        "/page/{file}": page,
        "/events": events,
        "/starters": starters,
        "/model/{link}": model,
        "/schema": schema,
    }
    post: Mapping[str, Answer] = {
        "/edit": edit,
        "/text": text,
        "/undo": undo,
        "/redo": redo,
        "/save": save,
        "/reload": reload,
        "/overwrite": overwrite,
        "/draft": draft,
        "/open": opened,
        "/solids": solids,
    }
    return Starlette(
        routes=[
            *(Route(path, answer, methods=["GET"]) for path, answer in get.items()),
            *(Route(path, answer, methods=["POST"]) for path, answer in post.items()),
        ],
        exception_handlers={AlulaError: _explained, HTTPException: _unknown, Exception: _broken},
    )


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
    return [{"name": name, "title": str(read_tables(name)["title"])} for name in built_in_cases()]


@cache
def _schema() -> str:
    from alula.loads.compose.entry_examples import schema_with_examples

    return json.dumps(schema_with_examples())


async def received(request: Request, most: int) -> bytes:
    """Return the body of a request.

    Parameters
    ----------
    request : Request
    most : int
        Bytes that are taken.

    Returns
    -------
    bytes

    Raises
    ------
    CaseError
        For a larger one, of which no more is read.
    """
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > most:
            raise CaseError(f"what was sent is larger than {most >> 20} MiB, the limit; send less")
    return bytes(body)


async def _asked(request: Request, **kinds: type) -> dict[str, Any]:
    """Return what a page posted: a JSON object, which has the entries named, of these types."""
    if request.headers.get("content-type", "").partition(";")[0] != "application/json":
        raise CaseError("what was sent is not marked as application/json")
    try:
        found = json.loads(await received(request, LARGEST_REQUEST) or b"{}", parse_constant=_no_number)
        json.dumps(found, ensure_ascii=False).encode()  # half of a surrogate pair is no text
    except (ValueError, RecursionError):
        raise CaseError("what was sent is no JSON") from None
    if not isinstance(found, dict):
        raise CaseError("what was sent is no JSON object")
    for name, kind in kinds.items():
        if type(found.get(name)) is not kind:
            raise CaseError(f"{name}: it is missing, or of another type than {kind.__name__}")
    return found


def _no_number(text: str) -> None:
    raise ValueError(text)


def _text(asked: Mapping[str, Any], name: str) -> str:
    found = asked.get(name, "")
    if not isinstance(found, str):
        raise CaseError(f"{name}: it must be text")
    return found


def _sentence(status: int, sentence: str) -> Response:
    return JSONResponse({"sentence": " ".join(sentence.split())}, status)


async def _explained(request: Request, error: Exception) -> Response:
    return _sentence(409 if isinstance(error, ConflictError) else 422, str(error))


async def _unknown(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return _sentence(error.status_code, "there is nothing at this address")


async def _broken(request: Request, error: Exception) -> Response:
    return _sentence(500, f"internal error of alula, not of the case: {type(error).__name__}: {printable(str(error))}")
