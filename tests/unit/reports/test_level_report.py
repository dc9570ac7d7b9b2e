"""The check of a level: each test judged as the case that it is, what it says, and the folder of its reports."""

import io
import json
import re
from copy import deepcopy
from dataclasses import replace
from types import SimpleNamespace

import pytest
import tomlkit
from levels import LEVEL, PLACED, PROOF, PYLON, pylon
from rich.console import Console
from typer.testing import CliRunner

import alula
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.level.check_level import check_level
from alula.fea.refine.refinement import Effort
from alula.loads.case.case_file import validate
from alula.loads.case.level_case import Demand
from alula.loads.compose.stated_case import StatedCase
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.reports.check.folder import REPORT
from alula.reports.commands.cli import app
from alula.reports.level import folder
from alula.reports.level.page import level_page, level_sections
from alula.reports.level.tests import level_besides, level_section, level_warnings, print_level, statement_words
from alula.reports.renderers.page import as_page

COARSE = Effort(max_unknowns=1000)
HARD = PROOF | {"steps": [{"force": "12 kN"}]}
TESTS = {"proof": PROOF, "hard": HARD}


def read(level, **changes):
    return StatedCase.from_dict(pylon(level=level, **changes)).record


@pytest.fixture(scope="module")
def checked():
    return check_level(read({"tests": TESTS}), effort=COARSE)


def value(result, quantity):
    [[outcome]] = [[x for x in of.checks if x.quantity is quantity] for of in result.load_cases.values()]
    return outcome.value


def test_each_test_is_judged_by_itself(checked):
    assert {name: test.verdict.value for name, test in checked.tests.items()} == {"proof": "pass", "hard": "fail"}
    assert checked.own is None
    said = {name: [statement_words(test, one) for one in test.statements] for name, test in checked.tests.items()}
    assert said == {"proof": ["stays elastic", "else"], "hard": ["yields", "else"]}


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("worse", [Verdict.UNDECIDED, Verdict.FAIL])
def test_the_worst_test_counts_wherever_it_stands(checked, worse, order):
    """What the case has besides counts for the command alone."""
    proof = checked.tests["proof"]
    other = replace(proof.result, verdict=worse)
    pair = [("proof", proof), ("other", replace(proof, result=other))]
    assert replace(checked, tests=dict(pair[::order])).verdict is worse
    found = replace(checked, tests=dict(pair[:1]), own=other)
    assert (found.verdict, found.worst) == (Verdict.PASS, worse)


def test_a_test_is_the_case_that_a_user_could_type():
    """Its load line lies 50 mm forward of the axis at the top, and comes back to a tenth of its force."""
    checked = check_level(read({}), fidelity="beam")
    line = {"link": "pylon", "at": "T", "to": ["-40 mm", "0 mm", "-10 mm"]}
    typed = pylon()
    del typed["level"]
    cases = {
        "proof": {"load_lines": [line | {"from": ["50 mm", "400 mm", "20 mm"], "force": "1 kN"}]},
        "cyclic": {"load_lines": [line | {"from": ["60 mm", "400 mm", "20 mm"], "force": "600 N"}], "least": 0.1},
    }
    for name, quantity in (("proof", Quantity.SAFETY_FACTOR), ("cyclic", Quantity.FATIGUE_STRESS)):
        case = typed | {"load_cases": {name: cases[name]}}
        if name == "cyclic":
            case |= {"conditions": {"cycles": 1e6}, "checks": {"f": {"type": "fatigue", "minimum": 1.0}}}
        own = value(check_case(validate(deepcopy(case)), fidelity="beam"), quantity)
        found = value(checked.tests[name].result, quantity)
        assert found.value == pytest.approx(own.value)


def test_each_outcome_is_told_with_what_was_asked():
    """Buckling, which no check asks for, belongs to what does not break; the worst is told, not the first."""
    tests = {"proof": HARD | {"permanent_set": "5 mm"}, "break": HARD | {"elastic": False, "no_break": True}}
    found = check_level(read({"tests": tests}), fidelity="beam")
    proof, broken = (found.tests[name].statements for name in tests)
    assert [one.demand for one in proof] == [Demand.ELASTIC, Demand.PERMANENT_SET, Demand.BESIDES]
    [asked] = broken
    assert asked.demand is Demand.NO_BREAK
    assert {one.quantity for one in asked.outcomes} == {
        Quantity.PLASTIC_COLLAPSE,
        Quantity.WALLS,
        Quantity.LOAD_SHARE,
        Quantity.BUCKLING_FACTOR,
    }
    assert asked.decides.quantity is Quantity.PLASTIC_COLLAPSE
    assert statement_words(found.tests["break"], asked) == "does not break?"
    buckled = tuple(
        replace(one, verdict=Verdict.FAIL) if one.quantity is Quantity.BUCKLING_FACTOR else one
        for one in asked.outcomes
    )
    worse = replace(asked, outcomes=buckled)
    assert worse.decides.quantity is Quantity.BUCKLING_FACTOR
    assert statement_words(found.tests["break"], worse) == "breaks"


def test_the_section_has_a_row_for_each_thing_that_is_asked(checked):
    section = level_section(checked)
    table = section.parts[0]
    assert [(row[0], row[1]) for row in table.rows][:2] == [("proof", "stays elastic"), ("hard", "yields")]
    record = section.data["level"]
    assert record["verdict"] == "fail"
    assert record["tests"]["hard"]["force"] == 12000.0
    assert record["tests"]["proof"]["hold"] == 20.0
    assert record["tests"]["proof"]["top"] == [50.0, 400.0, 20.0]
    [elastic, _] = record["tests"]["hard"]["statements"]
    assert (elastic["asks"], elastic["verdict"], elastic["decides"]["limit"]) == ("stays elastic", "fail", 1.0)


def test_warnings_tell_of_which_tests_they_are(checked):
    """A warning of one load case is that of its test; what several tests share is told once."""
    with_warnings = {
        "proof": ("load case proof: it buckles at 3 times its load", "it is hot"),
        "hard": ("load case hard: it buckles at 2 times its load", "it is hot", "it is hot"),
    }
    tests = {
        name: replace(test, result=replace(test.result, warnings=with_warnings[name]))
        for name, test in checked.tests.items()
    }
    expected = (
        "Warning (proof): it buckles at 3 times its load.",
        "Warning (all tests): it is hot.",
        "Warning (hard): it buckles at 2 times its load.",
    )
    warned = replace(checked, tests=tests)
    assert level_warnings(warned) == expected
    alone = replace(checked, tests={"proof": tests["proof"]})
    assert level_warnings(alone) == (expected[0], "Warning (proof): it is hot.")
    console = Console(file=io.StringIO(), width=200, color_system=None)
    print_level(warned, [level_section(warned)], console)
    printed = console.file.getvalue()
    page = as_page(level_page(warned, level_sections(warned)))
    assert all(text in printed and text in page for text in expected)


def test_what_is_assumed_says_of_which_tests_it_is(checked):
    """Each thing once: of all tests without their names, of some behind them."""
    proof = checked.tests["proof"]
    both, own, missing = (
        Caveat(heading=heading, topic=Topic.LOADS, what=what)
        for heading, what in (
            (Heading.ASSUMED, "a lever"),
            (Heading.ASSUMED, "a step"),
            (Heading.NOT_CHECKED, "creep"),
        )
    )
    of = {"proof": (own, both), "hard": (both, missing), "other": (both, missing)}
    tests = {name: replace(proof, name=name, result=SimpleNamespace(caveats=caveats)) for name, caveats in of.items()}
    assert level_besides(replace(checked, tests=tests)) == (
        "Assumed: a lever.",
        "Assumed (proof): a step.",
        "Not checked (hard and other): creep.",
    )


def test_the_command_writes_a_report_for_each_test(tmp_path, monkeypatch):
    """Load cases of the case's own are checked besides; the reports themselves have tests of their own."""
    monkeypatch.setattr(folder, "fill_report", lambda found, into, **_: (into / REPORT).write_text(found.verdict))
    own = {"push": {"forces": [{"link": "pylon", "at": "T", "force": ["20 kN", "0 N"]}]}}
    case = {**PYLON, "level": {"file": "level.toml", **PLACED}, "load_cases": own, "checks": {}}
    case["checks"] = {"strength": {"type": "safety-factor"}}
    (tmp_path / "case.toml").write_text(tomlkit.dumps(case), encoding="utf-8")
    (tmp_path / "level.toml").write_text(tomlkit.dumps(LEVEL | {"tests": {"proof": PROOF}}), encoding="utf-8")
    path, out = str(tmp_path / "case.toml"), tmp_path / "out"
    run = CliRunner().invoke(app, ["check", path, "--fidelity", "beam", "-o", str(out)])
    assert run.exit_code == 3, run.output
    assert "In the manner of ISO 10328, example, condition I: undecided." in run.output
    assert re.search(r"proof +stays elastic\?", run.output)
    assert re.search(r"^Proof: \w", run.output, re.M)
    assert "Load cases of the case itself, which are of no test: undecided." in run.output
    assert {str(x.relative_to(out)) for x in out.rglob("report.html")} == {
        "tests/proof/report.html",
        "own/report.html",
    }
    record = json.loads((out / "result.json").read_text(encoding="utf-8"))
    assert record["level"]["read_from"] == f"level.toml, SHA-256 {record['provenance']['files']['level.toml']}"
    assert 'href="own/report.html"' in (out / "level.html").read_text(encoding="utf-8")
    assert (out / "pictures" / "set-up.png").is_file()
    assert (out / "tests/proof/report.html").read_text(encoding="utf-8") == "undecided"
    refused = CliRunner().invoke(app, ["check", path, "--second-opinion"])
    assert 'choose one with --set level.test="proof"' in str(refused.exception)


def test_python_gives_the_same():
    report = alula.check(StatedCase.from_dict(pylon()), fidelity="beam")
    assert report.verdict == "undecided"
    assert report.tests["proof"].safety_factors["pylon"].value > 5.0
    assert [row["test"] for row in report.table()][:2] == ["proof", "cyclic"]
    assert "proof undecided" in str(report)
