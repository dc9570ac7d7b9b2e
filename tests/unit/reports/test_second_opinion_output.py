import json
from dataclasses import replace

import pytest
from rich.console import Console
from told import print_result, render, result_record, tables
from typer.testing import CliRunner

import alula.fea.check.run
from alula.fea.calculix import program as calculix
from alula.fea.calculix.second_opinion import second_opinions
from alula.fea.outcomes.opinion import Answer
from alula.fea.outcomes.result import HandResult
from alula.reports.check.opinion import with_second_opinions
from alula.reports.commands.cli import app


@pytest.fixture(scope="module")
def unanswered(result, tmp_path_factory):
    """The result with a second opinion that no CalculiX gave, and the folder of its deck."""
    folder = tmp_path_factory.mktemp("decks")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(calculix, "installed", lambda: None)
        return with_second_opinions(result, second_opinions(result, folder, threads=1)), folder


def test_without_calculix_the_deck_is_there_and_the_report_says_so(unanswered):
    told, folder = unanswered
    assert [path.name for path in folder.iterdir()] == ["GF.inp"]
    (opinion,) = told.second_opinions
    assert opinion.answer is None
    assert told.warnings[-1] == "GF: no second opinion: CalculiX (ccx) is not on PATH; its deck is GF.inp"
    assert result_record(told)["second_opinions"]["GF"]["calculix"] is None
    assert "CalculiX (ccx) is not on PATH" in render(told, {})


def test_values_stand_beside_ours(unanswered):
    told, _ = unanswered
    answer = Answer(
        von_mises=1.25, von_mises_nodal=1.5, displacement=0.0125, stress_gap=0.004, displacement_gap=0.0002, seconds=2.0
    )
    told = replace(told, second_opinions=(replace(told.second_opinions[0], answer=answer, reason=""),))
    console = Console(width=100)
    with console.capture() as shown:
        print_result(told, console)
    [table] = tables(told, "second-opinion")
    [row] = [dict(zip([column.head for column in table.columns], map(str, row), strict=True)) for row in table.rows]
    assert row["difference of von Mises [%]"] == "0.40"
    assert row["difference of displacement [%]"] == "0.020"
    assert (row["von Mises, CalculiX [MPa]"], row["displacement, CalculiX [mm]"]) == ("1.250", "0.01250")
    assert "reason" not in row  # a column of nothing
    page = render(told, {})
    for text in (shown.get(), page):
        assert all(figures in text for figures in row.values())
        assert "Second opinion" in text
    record = result_record(told)["second_opinions"]["GF"]
    assert record["calculix"]["agrees"] is True
    assert record["calculix"]["von_mises"] == 1.25
    assert record["von_mises"] == told.second_opinions[0].von_mises


def test_a_result_of_beams_alone_has_nothing_to_ask_about(result, tmp_path):
    beams = {
        name: replace(case, links={link: found for link, found in case.links.items() if isinstance(found, HandResult)})
        for name, case in result.load_cases.items()
    }
    beams_alone = replace(result, load_cases=beams)
    told = with_second_opinions(beams_alone, second_opinions(beams_alone, tmp_path, threads=1))
    assert told.second_opinions == ()
    assert told.warnings[-1].startswith("no second opinion")


def test_the_command_writes_the_decks_into_the_folder(result, tmp_path, monkeypatch):
    monkeypatch.setattr(calculix, "installed", lambda: None)
    monkeypatch.setattr(alula.fea.check.run, "check_case", lambda *a, **k: result)
    monkeypatch.setattr("alula.reports.check.folder.check_pictures", lambda *a: ({}, ()))
    out = tmp_path / "out"
    ran = CliRunner().invoke(app, ["check", result.name, "--second-opinion", "--json", "-o", str(out)])
    assert ran.exit_code == result.verdict.exit_status
    assert (out / "calculix" / "GF.inp").read_text(encoding="ascii").startswith("*HEADING\nGF, load case")
    assert json.loads((out / "result.json").read_text(encoding="utf-8"))["second_opinions"]["GF"]["deck"] == "GF.inp"
