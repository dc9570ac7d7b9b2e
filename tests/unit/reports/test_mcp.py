"""``alula mcp``: what a program sees that speaks the protocol, by the package's own client."""

import asyncio
import functools
import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import tomlkit
from levels import LEVEL, PLACED, PROOF, PYLON, TOP
from mcp import Client
from mcp.client.stdio import StdioServerParameters

import alula
from alula import server
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import folder_of
from alula.server import TOOLS, made, serve

CASE = "four-bar"


@pytest.fixture
def home(tmp_path):
    """Two cases below a folder, one of them with a part; and one beside it."""
    folder = tmp_path / "home"
    folder.mkdir()
    text = (Path(folder_of("step")) / "step.toml").read_text(encoding="utf-8")
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    (folder / "bell-crank.step").write_bytes((Path(folder_of("step")) / "bell-crank.step").read_bytes())
    (tmp_path / "secret.toml").write_text("title = 'secret'", encoding="utf-8")
    (folder / "away.toml").symlink_to(tmp_path / "secret.toml")
    (folder / "roll.csv").symlink_to(tmp_path / "secret.toml")
    roll = PROOF | {"steps": [{"profile": "roll.csv"}], "tilts_about": TOP}
    (folder / "level.toml").write_text(tomlkit.dumps(LEVEL | {"tests": {"roll": roll}}), encoding="utf-8")
    level = {"level": {"file": "level.toml", **PLACED}}
    (folder / "level-case.toml").write_text(tomlkit.dumps(PYLON | level), encoding="utf-8")
    (folder / "far.toml").write_text(text.replace("bell-crank.step", "../secret.toml"), encoding="utf-8")
    assert "../secret.toml" in (folder / "far.toml").read_text(encoding="utf-8")
    return folder


def asked(server, *questions):
    """Return what a server answers to questions, each a tool and its arguments, and the tools that it has."""

    async def ask():
        async with Client(server) as client:
            return [await client.call_tool(*one) for one in questions], (await client.list_tools()).tools

    return asyncio.run(ask())


def test_a_tool_is_a_function_of_the_face(home):
    _, tools = asked(made(home, 1))
    assert tuple(tool.name for tool in tools) == TOOLS
    for tool in tools:
        assert tool.description.splitlines()[0] == getattr(alula, tool.name).__doc__.splitlines()[0]
        assert ">>>" not in tool.description
        assert tool.annotations.read_only_hint
        assert not {"progress", "threads"} & tool.input_schema["properties"].keys()
        assert "threads :" not in tool.description
        assert "progress :" not in tool.description
    assert "accuracy : str" in tools[0].description
    assert "\n\nReturns\n" in tools[0].description
    assert tools[0].input_schema["required"] == ["case"]
    assert {"fidelity", "accuracy", "values"} < tools[0].input_schema["properties"].keys()
    (drawn,), _ = asked(made(home, 1), ("statics", {"case": CASE, "matrix": True}))
    assert "[A]" in drawn.structured_content["told"]


def test_tables_have_no_number_that_json_has_not(monkeypatch):
    rows = [{"value": end} for end in (float("-inf"), float("inf"), float("nan"), -3.0)]
    answer = server._answer(SimpleNamespace(table=lambda: rows))
    assert [row["value"] for row in answer["table"]] == [None, None, None, -3.0]


def test_questions_that_come_at_once_are_answered_one_after_the_other(home, monkeypatch):
    """The mesher knows one model at a time."""
    plain, within, most = alula.materials, [], []

    @functools.wraps(plain)
    def seen(*stated, **named):
        within.append(stated)
        most.append(len(within))
        time.sleep(0.1)
        within.pop()
        return plain(*stated, **named)

    async def ask():
        async with Client(made(home, 1)) as client:
            return await asyncio.gather(*(client.call_tool("materials", {"name": "steel-s235"}) for _ in range(3)))

    monkeypatch.setattr(alula, "materials", seen)
    assert not any(answer.is_error for answer in asyncio.run(ask()))
    assert most == [1, 1, 1]


def test_answers_are_those_of_the_face(home):
    values = {"parts.bar.thickness": "9 mm"}
    (one, other, still, part, card), _ = asked(
        made(home, 1),
        ("check", {"case": CASE, "fidelity": "beam"}),
        ("check", {"case": CASE, "fidelity": "beam", "values": values}),
        ("statics", {"case": "mine.toml"}),
        ("inspect", {"path": "bell-crank.step", "material": "steel-s235"}),
        ("materials", {"name": "steel-s235"}),
    )
    for answer, case in ((one, CASE), (other, alula.read_case(CASE, values))):
        report, found = alula.check(case, fidelity="beam"), answer.structured_content
        assert found["verdict"] == str(report.verdict)
        assert report.headline in found["told"]
        assert report.change in found["told"]
        assert [row["check value"] if "check value" in row else row["value"] for row in found["table"]] == [
            None if not abs(row["value"]) < float("inf") else row["value"] for row in report.table()
        ]
    assert one.structured_content["table"] != other.structured_content["table"]
    assert "bore" in part.structured_content["table"][0]
    assert "Joint forces" in still.structured_content["told"]
    assert "S235" in card.structured_content["told"]


@pytest.mark.parametrize(
    ("tool", "arguments"),
    [
        ("check", {"case": "../secret.toml"}),
        ("check", {"case": "away.toml"}),
        ("statics", {"case": "far.toml"}),
        ("statics", {"case": "/etc/passwd"}),
        ("motion", {"case": "mine.toml", "values": {"parts.bell-crank.file": "../secret.toml"}}),
        ("check", {"case": "step", "values": {"parts.bell-crank.file": "/etc/passwd"}}),
        ("check", {"case": "step", "values": {'parts.bell-crank."file"': "/etc/passwd"}}),
        ("statics", {"case": "level-case.toml"}),  # its level file names a link out of the folder
        ("inspect", {"path": "../secret.toml"}),
    ],
)
def test_nothing_is_read_outside_of_the_folder(home, tool, arguments):
    (answer,), _ = asked(made(home, 1), (tool, arguments))
    assert answer.is_error
    [text] = answer.content
    assert "is not in the folder of this server" in text.text
    assert "secret'" not in text.text
    assert "\n" not in text.text.strip()


def test_a_mistake_is_one_sentence(home):
    (answer, other, *wrong), _ = asked(
        made(home, 1),
        ("check", {"case": CASE, "fidelity": "plate"}),
        ("check", {"case": "mine.toml", "values": {"x": 1}}),
        ("statics", {"case": 3}),
        ("statics", {"case": CASE, "fidelity": "beam"}),
        ("statics", {}),
        ("statics", {"case": CASE, "values": {"title": ["a"]}}),
    )
    assert [one.content[0].text for one in wrong] == [
        "case (it is 3): it must be text; write it in double quotes",
        "fidelity: statics has no such argument; it has case, matrix, values",
        "case: this entry is missing; add it",
        "values.title (it is ['a']): it must be a text, a number, true or false; write for example \"6 mm\"",
    ]
    assert answer.is_error
    assert "fidelity: 'plate' is unknown" in answer.content[0].text
    assert other.is_error
    with pytest.raises(CaseError, match="is no folder"):
        serve(home / "nowhere", 1)


THICK = {"parts.bar.thickness": "9 mm"}
"""Of the four-bar: by default hand calculation decides no strength, and one mesh of each link does."""


def test_the_command_speaks_it_over_standard_input_and_output(home):
    started = StdioServerParameters(
        command=sys.executable, args=["-m", "alula", "mcp", str(home), "--threads", "1"], env=dict(os.environ)
    )
    (by_hand, solved, part), _ = asked(
        started,
        ("check", {"case": CASE, "fidelity": "beam"}),
        ("check", {"case": CASE, "values": THICK}),
        ("inspect", {"path": "bell-crank.step"}),
    )
    assert by_hand.structured_content["verdict"] == "undecided"
    assert solved.structured_content["verdict"] == "pass"
    assert not part.is_error


NO_JSON, NO_MESSAGE = (-32700, "JSON"), (-32600, "message of JSON-RPC 2.0")


def test_a_line_that_is_no_message_is_answered_and_the_next_one_too(home):
    """As JSON-RPC 2.0 has it in section 5.1: without an identifier, since none was read."""
    lines = ["check four-bar", '"\\ud800"', "[]", '{"jsonrpc": "2.0", "id": 7}']
    lines += ['{"jsonrpc": "2.0", "id": 8, "method": "ping"}', "{", '{"jsonrpc": "2.0", "id": 9, "method": "ping"}']
    command = [sys.executable, "-m", "alula", "mcp", str(home)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        late = threading.Timer(120, server.kill)
        late.start()
        server.stdin.write("\n".join(lines) + "\n")
        server.stdin.flush()
        answers = [json.loads(server.stdout.readline()) for _ in lines]
        late.cancel()
        server.stdin.close()
        assert server.stdout.read() == ""
    assert [one["error"] for one in answers if one["id"] is None] == [
        {"code": code, "message": f"the line is no {what}"}
        for code, what in (NO_JSON, NO_JSON, NO_MESSAGE, NO_MESSAGE, NO_JSON)
    ]
    assert sorted(one["id"] for one in answers if one["id"] is not None) == [8, 9]
