"""Names and texts of a case file are data: in the report, in file names, on the terminal and in CAD files."""

import html.parser
import io
import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from told import as_json, print_result, render, sections

from alula.fea.check.run import check_case
from alula.fea.claims.sources import check_claims
from alula.fea.outcomes.result import CheckResult
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, read_companion, read_text, validate
from alula.reports.check.folder import write_report
from alula.reports.check.published import as_markdown
from alula.reports.check.whole_check import check_page, check_pictures
from alula.reports.commands.telling import text_of
from alula.reports.sections.published import claims_section
from alula.reports.turnable.pack import data_block

OWL = "owl-wing-static"
HOSTILE = (
    "</title><script>alert('1')</script><img src=x onerror=alert(2)> \"'&{{7*7}}{% x %} [red]x[/] [/nothing] ../../x"
)
NAMES = (
    "../x", "..", ".", ".hidden", "/etc/passwd", "a/b", "a\\b", "C:x", "a\x00b", "a\nb", "\x1b[2J", "<b>", 'a"b', "a'b",
    "a&b",
    "{{x}}", "$HOME", "`id`", "*", "?", "~", "-rf", " a", "a ", "", "x" * 65, "\U0001d49c" * 60, "\u202eabc", "\ud800",
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES, ids=ascii)
@pytest.mark.parametrize("table", ["links", "joints", "load_cases", "parts", "checks", "materials", "points"])
def test_names_that_could_leave_a_folder_or_a_page_are_refused(name: str, table: str) -> None:
    tables = _tables()
    holder = tables["links"]["GF"]["points"] if table == "points" else tables.setdefault(table, {})
    holder[name] = next(iter(holder.values()), {})
    with pytest.raises(CaseError) as refused:
        validate(tables)
    assert all(c.isprintable() for c in str(refused.value))
    assert "letters, digits" in str(refused.value)


def _tables() -> dict[str, Any]:
    return tomllib.loads(read_text(OWL)[0])


def test_the_longest_name_makes_file_names_that_every_disk_takes() -> None:
    """64 letters of four bytes each made names of files of more than 255 bytes: the report failed at its end."""
    tables = _tables()
    longest = "\U0001d49c" * 50
    tables["load_cases"] = {longest: next(iter(tables["load_cases"].values()))}
    del tables["ways_to_hold"]  # it names a load case that is gone
    case = validate(tables)
    assert len(f"linkage-{next(iter(case.load_cases))}.png".encode()) <= 255


@pytest.mark.parametrize("table", ["links", "load_cases"])
@pytest.mark.parametrize(("one", "other"), [("a", "A"), ("straße", "STRASSE"), ("\u212b", "\u00c5")])
def test_names_that_some_disks_take_for_one_are_refused(table: str, one: str, other: str) -> None:
    """Files are named after links and load cases: one would overwrite the other's."""
    tables = _tables()
    entry = next(iter(tables[table].values()))
    tables[table] |= {one: entry, other: entry}
    with pytest.raises(CaseError, match=f"^{table}: .* in case alone"):
        validate(tables)


class _Page(html.parser.HTMLParser):
    """Collects what a browser would run or load."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def _written(value: Any) -> str:
    """Return a value as TOML, on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_written(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    return json.dumps(value)


@pytest.fixture(scope="module")
def checked(hostile: tuple[Case, str]) -> CheckResult:
    return check_case(hostile[0], name=hostile[1], fidelity="beam")


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> tuple[Case, str]:
    """The owl wing with every free text hostile, and the path of its file."""
    tables = _tables()
    tables["title"] = tables["source"] = tables["description"] = HOSTILE
    tables["assumptions"] = [HOSTILE]
    for load_case in tables["load_cases"].values():
        load_case["title"] = HOSTILE
    del tables["published_statics"]  # its tables stand beside the built-in case
    card = read_case(OWL).all_materials[next(iter(tables["parts"].values()))["material"]]
    tables["materials"] = {
        "own": {
            "title": HOSTILE, "density": "1200 kg/m^3", "youngs_modulus": "3 GPa", "poissons_ratio": 0.38,
            "yield_strength": "40 MPa", "strength": "yield", "minimum_safety_factor": card.minimum_safety_factor or 2.0,
            "sources": {"density": HOSTILE, "youngs_modulus": HOSTILE, "poissons_ratio": HOSTILE,
                        "yield_strength": HOSTILE, "minimum_safety_factor": HOSTILE},
            "status": {"density": "assumed", "youngs_modulus": "assumed", "poissons_ratio": "assumed",
                       "yield_strength": "assumed", "minimum_safety_factor": "assumed"},
        }
    }  # fmt: skip
    for part in tables["parts"].values():
        part["material"] = "own"
    tables["claims"] = [
        {"name": "a", "stated": "1 N + 1 N", "published": "3 N", "source": HOSTILE, "note": HOSTILE + "\n| x |"},
        {
            "name": "b",
            "stated": "below(2, 1)",
            "published": HOSTILE[:200],
            "source": HOSTILE,
            "not_stated": {"x": HOSTILE},
        },
    ]
    path = tmp_path_factory.mktemp("cases") / "<script>{{7*7}} [red] & x.toml"
    path.write_text("\n".join(f"{key} = {_written(value)}" for key, value in tables.items()), encoding="utf-8")
    case = read_case(str(path))
    assert case.title == HOSTILE
    return case, str(path)


def test_the_report_shows_hostile_text_as_text(checked: CheckResult) -> None:
    page = _Page()
    page.feed(render(checked, check_pictures(checked, check_page(checked, sections(checked)))[0]))
    assert "svg" in page.tags
    assert "script" not in page.tags
    assert not [value for key, value in page.attributes if key.startswith("on")]
    for key, value in page.attributes:
        if key in ("src", "href"):
            assert value is not None
            assert value.startswith(("data:image/png;base64,", "data:image/webp;base64,", "#")), value
    assert HOSTILE in " ".join("".join(page.text).split())
    assert "{{7*7}}" in "".join(page.text)


def test_the_control_finds_a_script() -> None:
    page = _Page()
    page.feed(f"<p>{HOSTILE}</p>")
    assert "script" in page.tags
    assert any(key == "onerror" for key, _ in page.attributes)


def test_json_and_terminal_show_hostile_text_as_text(hostile: tuple[Case, str], checked: CheckResult) -> None:
    record = json.loads(as_json(checked))
    assert record["title"] == HOSTILE
    assert record["case"] == hostile[1]
    screen = io.StringIO()
    print_result(checked, Console(file=screen, width=10_000, force_terminal=True, color_system="truecolor"))
    assert "[red]x[/] [/nothing]" in screen.getvalue()


def test_only_the_output_folder_is_written(checked: CheckResult, tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    write_report(checked, inner / "out")
    assert [p.name for p in tmp_path.iterdir()] == ["inner"]
    assert [p.name for p in inner.iterdir()] == ["out"]


def test_claims_show_hostile_text_as_text(hostile: tuple[Case, str]) -> None:
    results = check_claims(hostile[1])
    assert [result.claim.name for result in results] == ["a", "b"]
    page = as_markdown({HOSTILE: results}, {HOSTILE: HOSTILE})
    assert "<script" not in page
    assert "<img" not in page
    rows = [line for line in page.splitlines() if line.startswith(("| a ", "| b "))]
    assert len(rows) == 2
    assert text_of([claims_section(results, HOSTILE)])


def test_a_data_block_in_a_page_shows_hostile_text_as_text(checked: CheckResult) -> None:
    """A link of such a name is refused where a case is read; a model's record could have other texts."""
    for text in (HOSTILE, "</script><script>alert(1)", "<!--<script>", "]]>"):
        page = _Page()
        page.feed(f'<script type="application/json">{data_block({text: text})}</script>')
        assert page.tags == ["script"]
        assert json.loads("".join(page.text)) == {text: text}


@pytest.mark.parametrize("name", ["../cases/x.csv", "/etc/passwd", "..", ".", "a/../b", "~/x", "\x00", ".x"])
def test_a_companion_file_stands_beside_the_case(name: str, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("x = 1")
    for case in (OWL, str(tmp_path / "case.toml")):
        with pytest.raises(CaseError):
            read_companion(case, name)
