"""Numbers that are printed are those of the results beside them, and at a release those of its own version."""

import ast
import importlib.util
import json
import re
import tomllib
from pathlib import Path

import pytest
from pages import renewed_numbers
from programs import ROOT

from benchmarks import calibration, eye_limits, tables
from benchmarks.record import COMMANDED, RESULTS, _reached, printed, sources
from benchmarks.renew import older, results, stale

NOW = {"sources": "ab", "commands": "12"}
OF = {"alula": {"version": "1.0"} | NOW}


@pytest.mark.parametrize("name", list(tables.SECTIONS))
def test_a_table_is_that_of_its_result(name: str) -> None:
    assert printed(tables.PAGE, name) == tables.told(name).strip(), "run python -m benchmarks.tables"


def test_at_a_release_all_results_are_of_its_version() -> None:
    """While CHANGELOG says that the version is unreleased, `make numbers` lists what is older, and nothing fails."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    newest = re.search(r"^## (\S+)( \(unreleased\))?$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    assert newest
    assert newest[1] == version
    if not newest[2]:
        assert not {name: why for name, record in results().items() if (why := older(record, version))}


def test_what_calculations_take_from_results_follows_from_them() -> None:
    """It is measured once and stays, so that what makes it would be out of date unnoticed."""
    kept, eyes = (json.loads(one.KEPT.read_text(encoding="utf-8")) for one in (calibration, eye_limits))
    assert calibration.written(kept) == calibration.FILE.read_text(encoding="utf-8")
    assert eye_limits.table(eyes["eyes"]) == eye_limits.SCATTER.read_text(encoding="utf-8")


@pytest.mark.parametrize("file", sorted(RESULTS.glob("*.json")), ids=lambda file: file.stem)
def test_a_result_notes_when_and_by_which_version_it_was_made(file: Path) -> None:
    if file.stem in ("coverage-series", "coverage-truth"):
        file = RESULTS / "coverage.json"  # which is written with them
    record = json.loads(file.read_text(encoding="utf-8"))
    assert re.match(r"\d{4}-\d\d-\d\d", record["date"])
    assert record["alula"]["version"]


@pytest.mark.parametrize(
    ("record", "why"),
    [
        (OF, ""),
        ({}, "it was made before results noted their sources"),
        ({"alula": {"version": "0.9", "sources": "ab"}}, "of alula 0.9"),
        ({"alula": {"version": "1.0", "sources": "cd"}}, "sources have changed since"),
        ({"alula": {"version": "1.0", "sources": "cd", "commands": "12"}}, "sources have changed since"),
    ],
)
def test_a_result_is_older_than_the_code(record: dict[str, dict[str, str]], why: str) -> None:
    assert stale("stages", record, "1.0", NOW) == stale("draws", record, "1.0", NOW) == why
    assert older(record, "1.0") == ("" if record and record["alula"]["version"] == "1.0" else why)


def test_of_a_changed_command_only_results_that_run_commands_are_older() -> None:
    changed = {"alula": OF["alula"] | {"commands": "34"}}
    assert [stale(name, changed, "1.0", NOW) for name in ("draws", "stages")] == ["", "commands have changed since"]


def test_a_result_stands_on_what_its_benchmark_imports_wherever_it_does_so() -> None:
    """Also within functions, by scripts that it runs and tests that it names; solvers stand on no pins, checks do."""
    reached = {
        name: {file.relative_to(ROOT).as_posix() for file in _reached(ROOT / "benchmarks" / f"{name}.py")}
        for name in ("peers", "verification", "draws", "widths")
    }
    assert {"fea/solvers/two_level.py", "fea/solvers/direct.py", "benchmarks/peer_alula.py"} <= reached["peers"]
    assert not any(file.startswith(("fea/pins/", "fea/judging/")) for file in reached["peers"])
    assert "tests/validation/test_nafems.py" in reached["verification"]
    assert {"fea/pins/states.py", "fea/judging/bearing.py"} <= reached["draws"] & reached["widths"]
    assert "alula/__init__.py" in reached["widths"]  # it imports alula as users do
    assert len({sources(name)["sources"] for name in ("solvers", "draws", "stages")}) == 3
    assert sources("stability-scale")["sources"] == sources("stability-buckling")["sources"]


def test_results_that_run_commands_pages_or_the_workbench_are_known() -> None:
    """They name the package or run the program; what only words a number or a sentence by it is none."""
    running = re.compile(r'alula\.reports\.(?!sentences|words)|"alula", "check"|run\(\[alula, ')
    files = {
        file.stem for file in (ROOT / "benchmarks").glob("*.py") if running.search(file.read_text(encoding="utf-8"))
    }
    assert files & set(results()) == COMMANDED


@pytest.mark.parametrize(
    ("block", "said", "renewed"),
    [
        ("a  1.50 (1 to ∞)\nb", "a 2 (−1 to 3.25) b", "a  2 (−1 to 3.25)\nb"),
        ("share 12 %", "share 12 % of 5; share 13 %", None),
        ("rocker 1", "crank 2", None),
        ("link B2 is 5 mm", "link B2 is 6 mm", "link B2 is 6 mm"),
    ],
)
def test_numbers_of_a_block_are_renewed_where_its_words_stay(block: str, said: str, renewed: str | None) -> None:
    assert renewed_numbers(block, said) == renewed


@pytest.mark.parametrize("file", sorted((ROOT / "benchmarks").glob("*.py")), ids=lambda file: file.stem)
def test_what_a_benchmark_imports_of_alula_is_there(file: Path) -> None:
    """They run at a release alone, and a name that has gone would be missed then."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    taken = [one for one in ast.walk(tree) if isinstance(one, ast.ImportFrom) and str(one.module).startswith("alula.")]
    gone = []
    for one in taken:
        module = importlib.import_module(str(one.module))
        for name in one.names:
            inside = hasattr(module, "__path__") and importlib.util.find_spec(f"{one.module}.{name.name}")
            if not hasattr(module, name.name) and not inside:
                gone.append(f"{one.module}.{name.name}")
    assert not gone
