"""The command as a user meets it: output, exit status, one sentence per mistake."""

import errno
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import programs
import pytest

from alula.loads.case.case_file import built_in_cases, read_case, read_companion


def test_schema_is_a_json_schema() -> None:
    import jsonschema

    schema = json.loads(programs.inside("schema").stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert {"schema_version", "links", "joints"} <= set(schema["required"])
    assert schema["additionalProperties"] is False
    for table in (schema, *schema["$defs"].values()):
        for name, entry in table["properties"].items():
            if "default" in entry:  # as a case file may state it: text with a unit for quantities
                root = {"$defs": schema["$defs"], "properties": {name: entry}}
                found = jsonschema.Draft202012Validator(root)  # the schema as a whole was looked at above
                found.validate({name: entry["default"]} if entry["default"] != {} else {})


def test_statics_prints_the_published_system(tmp_path: Path) -> None:
    done = programs.inside("statics", "owl-wing-static", "--matrix", folder=tmp_path)
    assert done.returncode == 0
    assert "15×15" in done.stdout
    assert "Drive torque on AE about A: −130.6 N·mm" in done.stdout
    assert "AE Mz" in done.stdout
    record = json.loads(programs.inside("statics", "owl-wing-static", "--matrix", "--json").stdout)
    system = record["load_cases"]["weight"]["system"]
    assert len(system["matrix"]) == len(system["rows"]) == len(system["columns"]) == 15


def test_the_beam_check_as_json() -> None:
    done = programs.inside(*programs.BEAM, "--json")
    record = json.loads(done.stdout)
    assert done.returncode == {"pass": 0, "fail": 1, "undecided": 3}[record["verdict"]]
    assert record["links"]["rear"]["elements"] is None


def test_new_writes_a_case_that_checks_and_overwrites_nothing(tmp_path: Path) -> None:
    assert programs.inside("new", "four-bar.toml", folder=tmp_path).returncode == 0
    assert programs.inside("statics", "four-bar.toml", folder=tmp_path).returncode == 0
    again = programs.inside("new", "four-bar.toml", folder=tmp_path)
    assert again.returncode == 2
    assert "exists" in again.stderr


@pytest.mark.parametrize("name", built_in_cases())
def test_a_case_starts_from_any_built_in_one_with_the_files_that_it_names(name: str, tmp_path: Path) -> None:
    """The copy says what the built-in case says; a second one in the same folder shares its files."""
    path = tmp_path / "my-case.toml"
    done = programs.inside("new", "--from", name, str(path))
    written = sorted(file.name for file in tmp_path.iterdir())
    assert done.returncode == 0
    assert done.stdout.startswith(f"Wrote {path}")
    assert all(file in done.stdout for file in written)
    case, original = read_case(str(path)), read_case(name)
    imported = {part: str(tmp_path / Path(kind.file).name) for part, kind in case.parts.items() if kind.shape == "step"}
    assert case == original.model_copy(  # but for the place of what it imports
        update={
            "parts": {
                k: v.model_copy(update={"file": imported[k]} if k in imported else {})
                for k, v in original.parts.items()
            }
        }
    )
    if case.published_statics is not None:
        assert read_companion(str(path), case.published_statics.exact)
    second = tmp_path / "second.toml"
    assert programs.inside("new", "--from", name, str(second)).returncode == 0
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted([*written, "second.toml"])
    assert read_case(str(second)) == case


def test_what_is_in_the_way_of_a_new_case_stays_and_its_part_gets_another_name(tmp_path: Path) -> None:
    (tmp_path / "bell-crank.step").write_text("mine")
    (tmp_path / "bell-crank-2.step").mkdir()
    (tmp_path / "other.toml").write_text("mine")
    done = programs.inside("new", "--from", "step", "other.toml", folder=tmp_path)
    assert (done.returncode, "'other.toml' exists" in done.stderr) == (2, True)
    done = programs.inside("new", "--from", "step", "own.toml", folder=tmp_path)
    assert done.stdout.startswith("Wrote own.toml and bell-crank-3.step.")
    assert Path(read_case(str(tmp_path / "own.toml")).parts["bell-crank"].file).name == "bell-crank-3.step"
    assert {(tmp_path / file).read_text() for file in ("bell-crank.step", "other.toml")} == {"mine"}
    assert len(list(tmp_path.iterdir())) == 5


def test_new_lists_the_built_in_cases() -> None:
    listed = programs.inside("new", "--list").stdout
    assert listed == programs.inside("cases").stdout
    assert [line.split()[0] for line in listed.splitlines()] == list(built_in_cases())
    assert all(read_case(name).title in listed for name in built_in_cases())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "no-such-case"], ["no-such-case", "owl-wing-static"]),
        (["check", "owlwing-static"], ["or one of finger, ", "; did you mean 'owl-wing-static'?"]),
        (["check", "owl-wing-static", "--set", "pose.angle=20"], ["pose.angle", "20", "unit", '"30 deg"']),
        (["check", "owl-wing-static", "--set", "nonsense"], ["nonsense", "path=value"]),
        (["check", "owl-wing-static", "--fidelity", "magic"], ["magic", "beam"]),
        (["statics", "owl-wing-static", "--set", 'links.ED.points.D=["300 mm", "0 mm"]'], ["stays open by", "mm"]),
        (["check", "owl-wing-static", "--memory", "4"], ["memory", "needs its unit", '"4 GB"']),
        (["envelope", "owl-wing-static", "--memory", "-4 GB"], ["memory", "-4 GB", "must be positive"]),
        (["export", "owl-wing-static"], ["--step"]),
        (["frobnicate"], ["alula: no such command 'frobnicate'; see alula --help"]),
        ([], ["Usage: alula [OPTIONS] COMMAND", "\n  check "]),
        (["new"], ["PATH", "missing", "alula new my-case.toml"]),
        (["new", "--from", "fourbar", "a.toml"], ["no built-in case 'fourbar'", "did you mean 'four-bar'?"]),
        (["new", "--from", "qqq", "a.toml"], ["no built-in case 'qqq'", "alula new --list"]),
        (["new", "--from", "four-bar", "--study", "a.toml"], ["--from", "leave out one"]),
        (["new", "none/a.toml"], ["'none/a.toml' cannot be written (No such file or directory)", "another place"]),
        (["check", "four-bar", "--sett", "a"], ["alula: no such option: --sett", "--set", "; see alula check --help"]),
        (["check"], ["alula: missing argument 'case'; see alula check --help"]),
        (
            ["check", "four-bar", "--threads", "0"],
            ["alula: --threads (it is '0'): it must be at least 1; make it larger; see alula check --help"],
        ),
        (["check", "four-bar", "--threads", "x"], ["alula: --threads (it is 'x'): it must be a whole number"]),
        (["check", "four-bar", "--time-limit", "-1"], ["--time-limit (it is '-1'): it must be at least 0"]),
        (["open", "--port", "99999"], ["alula: --port (it is '99999'): it must be at most 65535; make it smaller"]),
        (["envelope", "four-bar", "--growth", "nan"], ["--growth (it is 'nan'): it must be a number without unit"]),
        (["synth", "-o", f"{__file__}/out"], ["output: ", "(Not a directory)", "choose another folder"]),
        (["study", "four-bar", "--vary", "parts.bar.width=8 mm", "-o", f"{__file__}/out"], ["(Not a directory)"]),
        (["size", "four-bar", "--vary", "parts.bar.thickness=-3 mm..8 mm"], ["parts.bar.thickness (it is '-3 mm')"]),
        (["new", "--list", "a.toml"], ["--list", "leave out all else"]),
        (["new", "--list", "--unit", "cm"], ["--list", "leave out all else"]),
        (["new", "a.toml", "--unit", "cm"], ["--unit", "a mesh", "leave it out"]),
        (["new", "--study", "a.toml", "--unit", "cm"], ["--unit", "a mesh", "leave it out"]),
        (["new", "--from", "four-bar", "a.toml", "--unit", "cm"], ["--unit", "a mesh", "leave it out"]),
        (["new", "--from-pmks", "none.txt", "a.toml", "--unit", "cm"], ["--unit", "a mesh", "leave it out"]),
        (["new", "--from", "owl-wing-anchor", "owl-wing-anchor.step"], ["a file that the case names"]),
    ],
)
def test_a_mistake_ends_with_status_2_and_says_why(arguments: list[str], words: list[str]) -> None:
    done = programs.inside(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for word in words:
        assert word in done.stderr


@pytest.mark.parametrize("command", [("inspect",), ("mcp",), ("study", "show")])
def test_what_may_not_be_read_has_a_remedy(command: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *asked, **more: False)
    done = programs.inside(*command, __file__ if command == ("inspect",) else str(Path(__file__).parent))
    assert done.returncode == 2
    assert f"is not readable; check its permissions; see alula {' '.join(command)} --help\n" in done.stderr


@pytest.mark.parametrize("command", [("mcp",), ("study", "show")])
@pytest.mark.parametrize(("name", "why"), [("closed/in", "Permission denied"), ("x" * 300, "File name too long")])
def test_a_folder_that_may_not_be_looked_into(
    command: tuple[str, ...], name: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both ended as a fault of alula's own; root may enter all folders, so that a test makes up the refusal."""
    ask = os.stat

    def stat(path: Any, **more: Any) -> os.stat_result:
        if "closed" in str(path):
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return ask(path, **more)

    monkeypatch.setattr(os, "stat", stat)
    done = programs.inside(*command, name, folder=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"alula: '{name[:40]}")
    assert done.stderr.endswith(f"' cannot be looked into ({why}); check its permissions or name another folder\n")


def test_help_names_what_an_option_takes_and_no_type_of_python() -> None:
    for command in ("check", "claims", "envelope", "inspect", "size", "study", "synth", "tolerance"):
        told = programs.inside(command, "--help").stdout
        assert "Options:" in told
        assert "--output" in told or command == "claims"
        assert not re.search(r"--\S+ <(list|str|int|float)|<list\[", told), told


def test_a_fault_of_the_program_is_status_4_without_traceback(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(
        "import alula.loads.case.case_file\n"
        "def read_case(*args):\n    raise ZeroDivisionError('made up')\n"
        "alula.loads.case.case_file.read_case = read_case\n"
    )
    root = str(Path(__file__).parents[3])
    code = "import sitecustomize; from alula.reports.commands.cli import main; main()"
    for more, shown in (({}, False), ({"ALULA_TRACEBACK": "1"}, True)):
        done = subprocess.run(
            [sys.executable, "-c", code, "statics", "owl-wing-static"],
            env={**os.environ, "PYTHONPATH": f"{tmp_path}:{root}", **more},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert ("Traceback" in done.stderr) is shown
        if not shown:
            assert done.returncode == 4
            assert "ZeroDivisionError: made up" in done.stderr


def test_a_closed_pipe_is_no_traceback() -> None:
    root = str(Path(__file__).parents[3])
    code = "from alula.reports.commands.cli import main; main()"
    command = f"{sys.executable} -c '{code}' schema | head -c 10"
    done = subprocess.run(
        ["bash", "-c", command],
        env={**os.environ, "PYTHONPATH": root},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert "Traceback" not in done.stderr
