"""``alula mcp``: functions of the Python face as tools of the Model Context Protocol (MCP).

A program that speaks the protocol, such as an assistant, starts the command and asks it over standard input and output.
Name, arguments and text of a tool are those of the function; its answer is what the report tells, with one table.
"""

import inspect
import re
import threading
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

from pydantic import BaseModel, PlainValidator, ValidationError, WithJsonSchema

import alula
from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError
from alula.geometry.base.model import refusal
from alula.geometry.base.version import extra_command
from alula.geometry.imported.files_read import reading_within
from alula.loads.case.case_file import folder_of
from alula.loads.text.explain import printable, sentence

if TYPE_CHECKING:
    from mcp.server import MCPServer

TOOLS = ("check", "statics", "motion", "inspect", "materials")
_LEFT_OUT = ("progress", "threads")
"""Arguments of functions that no program states: the command says how many threads there are."""
_ABOUT = (
    "alula checks planar linkages: pose, joint forces, stress with error bands, verdict. A case is the name of a "
    "built-in one or the path of a case file below the folder of this server; values replaces entries of it, such as "
    '{"parts.bar.thickness": "6 mm"}. Units are mm, N, N*mm and MPa unless a name says otherwise.'
)


class Answer(TypedDict):
    """What a tool answers.

    Attributes
    ----------
    told : str
        What the report tells.
    verdict : str or None
        Of a check: pass, fail or undecided.
    table : list of dict
        The rows of its first table, with low and high ends of bands; numbers that are not finite are None.
    """

    told: str
    verdict: str | None
    table: list[dict[str, str | float | int | None]]


def serve(folder: Path, threads: int) -> None:
    """Answer a program until it closes standard input.

    Parameters
    ----------
    folder : Path
        Files outside of it are not read; nothing is written.
    threads : int
        Threads that each library may use, and child processes at a time.

    Raises
    ------
    CaseError
        For a folder that is not there.
    CannotRunError
        Where the package ``mcp`` is not installed.
    """
    if not folder.is_dir():
        raise CaseError(f"'{printable(str(folder))}' is no folder; name the one that holds the case files")
    made(folder, threads).run()


def made(folder: Path, threads: int) -> "MCPServer":
    """Return a server with its tools, an ``mcp.server.MCPServer``; arguments and errors are those of ``serve``."""
    try:
        import anyio
        from mcp.server import MCPServer
        from mcp.server.mcpserver.exceptions import ToolError
        from mcp.server.stdio import stdio_server
        from mcp_types import ToolAnnotations
    except ImportError:
        raise CannotRunError(f"mcp: the package mcp is not installed; run {extra_command('mcp')}") from None

    class Server(MCPServer):
        """A server that answers lines that are no messages, and tells of wrong arguments in one sentence."""

        async def run_stdio_async(self) -> None:
            send, messages = anyio.create_memory_object_stream[Any]()
            async with stdio_server() as (lines, answers), anyio.create_task_group() as beside:
                beside.start_soon(_pass_on, lines, send, answers)
                server = self._lowlevel_server
                await server.run(messages, answers, server.create_initialization_options())

        async def call_tool(self, name: str, arguments: dict[str, Any], context: Any = None) -> Any:
            known = [
                key for tool in await self.list_tools() if tool.name == name for key in tool.input_schema["properties"]
            ]
            if known and (strange := [key for key in arguments if key not in known]):
                raise ToolError(f"{printable(strange[0])}: {name} has no such argument; it has {', '.join(known)}")
            try:
                return await super().call_tool(name, arguments, context)
            except ToolError as error:
                if isinstance(error.__cause__, ValidationError):
                    raise ToolError(sentence(error.__cause__, BaseModel)) from None
                raise

    server = Server("alula", instructions=_ABOUT, version=alula.__version__, log_level="CRITICAL")
    one_at_a_time = threading.Lock()
    for name in TOOLS:
        function = getattr(alula, name)
        server.add_tool(
            _tool(function, folder.absolute(), threads, one_at_a_time),
            description=_description(function),
            annotations=ToolAnnotations(read_only_hint=True, open_world_hint=False),
        )
    return server


def _description(function: Callable[..., Any]) -> str:
    """Return the text of a function without its examples and the arguments that the tool has not."""
    text = str(inspect.getdoc(function)).partition("\nExamples\n")[0]
    return re.sub(rf"^(?:{'|'.join(_LEFT_OUT)}) : .*\n(?: +.*\n)+", "", text, flags=re.MULTILINE)


async def _pass_on(lines: Any, send: Any, answers: Any) -> None:
    """Pass on the messages of a program; the package drops a line that is none, which JSON-RPC wants answered."""
    from mcp.shared.message import SessionMessage
    from mcp_types import INVALID_REQUEST, PARSE_ERROR, ErrorData, JSONRPCError

    async with send:
        async for line in lines:
            if isinstance(line, ValidationError):
                no_json = line.errors()[0]["type"] == "json_invalid"
                code, what = (PARSE_ERROR, "JSON") if no_json else (INVALID_REQUEST, "message of JSON-RPC 2.0")
                error = ErrorData(code=code, message=f"the line is no {what}")
                await answers.send(SessionMessage(JSONRPCError(jsonrpc="2.0", id=None, error=error)))
            else:
                await send.send(line)


def _tool(
    function: Callable[..., Any], home: Path, threads: int, one_at_a_time: threading.Lock
) -> Callable[..., Answer]:
    """Return a function of the face as a tool: with plain arguments, below a folder, one at a time."""
    from mcp.server.mcpserver.exceptions import ToolError

    stated = inspect.signature(function).parameters
    asked = [_plain(one) for name, one in stated.items() if name not in _LEFT_OUT]
    of_case = "case" in stated
    if of_case:
        asked.append(inspect.Parameter("values", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=_VALUES))

    @wraps(function)
    def tool(**arguments: Any) -> Answer:
        if "threads" in stated:
            arguments["threads"] = threads
        try:
            # the mesher knows one model at a time
            with one_at_a_time, reading_within(home, Path(folder_of(alula.cases()[0]))):
                if of_case:
                    name, values = arguments["case"], arguments.pop("values", None)
                    arguments["case"] = alula.read_case(name if name in alula.cases() else home / name, values)
                elif "path" in stated:
                    arguments["path"] = home / arguments["path"]
                return _answer(function(**arguments))
        except AlulaError as error:
            raise ToolError(str(error)) from None

    tool.__signature__ = inspect.Signature(asked, return_annotation=Answer)  # type: ignore[attr-defined]
    tool.__annotations__ = {one.name: one.annotation for one in asked} | {"return": Answer}
    return tool


def _entry(stated: object) -> object:
    """Return what stands in an entry of a case, so that one sentence tells of what cannot."""
    if not isinstance(stated, str | float | int):
        raise refusal('it must be a text, a number, true or false; write for example "6 mm"')
    return stated


_ENTRY = Annotated[Any, PlainValidator(_entry), WithJsonSchema({"type": ["string", "number", "boolean"]})]
_VALUES = dict[str, _ENTRY] | None


def _plain(parameter: inspect.Parameter) -> inspect.Parameter:
    """Return a parameter as a program can state it: a path or a case is a text."""
    kind = {"case": str, "path": str}.get(parameter.name)
    if kind is None:
        kind = bool if isinstance(parameter.default, bool) else str if parameter.default else str | None  # type: ignore[assignment]
    return parameter.replace(annotation=kind, kind=inspect.Parameter.KEYWORD_ONLY)


def _answer(report: Any) -> Answer:
    verdict = getattr(report, "verdict", None)
    rows = [{name: _finite(value) for name, value in row.items()} for row in report.table()]
    change = getattr(report, "change", "")
    told = "\n\n".join(filter(None, (str(report), change)))
    return {"told": told, "verdict": None if verdict is None else str(verdict), "table": rows}


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not abs(value) < float("inf") else value
