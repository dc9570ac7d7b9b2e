import json
import re
from importlib.resources import files

import pytest
import solved
from typer.testing import CliRunner

from alula.geometry.base.errors import CaseError
from alula.loads.sources.expression import _FUNCTIONS
from alula.reports.commands.cli import app


def run(*arguments: str):
    return CliRunner().invoke(app, ["claims", *arguments])


def test_findings_do_not_change_the_exit_status_unless_asked():
    found = run("four-bar-synthesis")
    assert found.exit_code == 0
    assert "do not hold" in found.stdout.splitlines()[-1]
    assert run("four-bar-synthesis", "--strict").exit_code == 1


def test_strict_passes_where_nothing_is_refuted(tmp_path):
    claims = """
        [[claims]]
        name = "mobility"
        quantity = "pose.mobility"
        published = "1"
        source = "Someone (2000)"
        [[claims]]
        name = "mass"
        quantity = "not_stated.mass"
        not_stated = { mass = "the mass" }
        published = "1 g"
        source = "Someone (2000)"
    """
    path = tmp_path / "case.toml"
    starter = files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8")
    path.write_text(starter + claims, encoding="utf-8")
    found = run(str(path), "--strict")
    assert found.exit_code == 0, found.output
    assert found.stdout.splitlines()[-1] == (
        "2 claims: 1 holds, 0 do not hold, 0 do not follow, 1 cannot be re-derived."
    )


def test_a_case_without_claims_is_bad_input():
    with pytest.raises(CaseError, match=r"^'pylon' states no claims, so that none could hold; add \[\[claims\]\]$"):
        CliRunner().invoke(app, ["claims", "pylon", "--strict"], catch_exceptions=False)


def test_json_is_a_list_of_findings():
    found = json.loads(run("flapping-wing-tables", "--json").stdout)
    assert len(found) == 444
    assert found[0] == {
        "name": "1.1.ground_d_mm",
        "quantity": "tables.1.1.ground",
        "published": "22.36 mm",
        "ours": "22.3607 mm",
        "finding": "holds",
        "source": "Freitas (2022), table 1, row 1",
        "note": "It follows within its printed digits.",
    }


def test_the_page_in_the_documentation_is_the_one_that_the_command_prints(request, monkeypatch):
    monkeypatch.setattr("alula.fea.claims.sources.check_all", lambda **options: solved.claims())
    page = (request.config.rootpath / "docs" / "claims.md").read_text(encoding="utf-8")
    assert run("--markdown").stdout == page, "make it anew: alula claims --markdown > docs/claims.md"


def test_the_readme_counts_as_the_page_does(request):
    texts = [(request.config.rootpath / name).read_text(encoding="utf-8") for name in ("docs/claims.md", "README.md")]
    page, readme = (re.findall(r"^\|[^|]+\| (\d+) \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|$", t, re.M) for t in texts)
    assert sorted(page) == sorted(readme)
    assert f"re-derives {sum(int(row[0]) for row in page)} figures" in texts[1]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("nobody",), "no such file or built-in case; give a path to a case file or one of those that have claims: f"),
        (("owl-wings",), "owl-wing-static; did you mean 'owl-wing'?"),
        (("--set", "a=1"), "it needs a case"),
        (("owl-wing", "--fidelity", "x"), "fidelity: 'x' is unknown"),
    ],
)
def test_mistakes_are_explained(arguments, sentence):
    found = run(*arguments)
    assert isinstance(found.exception, CaseError)
    assert sentence in str(found.exception)


def test_the_documented_claims_run(request, tmp_path):
    page = (request.config.rootpath / "docs" / "claims-format.md").read_text(encoding="utf-8")
    claims = page.split("```toml\n")[1].split("```")[0]
    folder = files("alula.loads.cases")
    for name in ("owl-wing-static.toml", "owl-wing-statics-exact.csv", "owl-wing-statics-printed.csv"):
        (tmp_path / name).write_text(folder.joinpath(name).read_text(encoding="utf-8"), encoding="utf-8")
    path = tmp_path / "owl-wing-static.toml"
    path.write_text(path.read_text(encoding="utf-8") + claims, encoding="utf-8")
    found = run(str(path), "--json")
    assert [claim["finding"] for claim in json.loads(found.stdout)] == [
        "does-not-follow",
        "does-not-hold",
        "does-not-hold",
        "cannot-be-rederived",
    ]
    listed = page.split("functions `")[1].split("`")[0].split()
    assert set(listed) == set(_FUNCTIONS)
