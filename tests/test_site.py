"""The site: its index holds every page, and it builds without a warning or a foreign address."""

import json
import re
import runpy
import subprocess
import sys
import tomllib
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from urllib.parse import unquote, urlsplit

import programs
import pytest
from pydantic import BaseModel

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.plans.plan import StudyPlan, plan_of
from alula.loads.text.entries import file_schema
from docs.extensions import case_file, gallery, python
from docs.extensions.entries import tables
from docs.extensions.examples import FOLDER, STARTER_PLAN, Text, of_text, stretches
from docs.extensions.index import sections
from docs.extensions.links import OUTSIDE, moved, remove_others

DOCS = programs.ROOT / "docs"
INDEX = (DOCS / "index.md").read_text(encoding="utf-8")


def test_the_index_lists_every_page_once() -> None:
    listed = [page for section in sections(INDEX) for page in section.pages]
    pages = {file.relative_to(DOCS).as_posix() for file in DOCS.rglob("*") if file.suffix in (".md", ".rst")}
    inside = {page for page in pages if not page.startswith("generated/")} - {"index.md"}
    assert sorted(listed) == sorted(inside | {f"../{file.relative_to(programs.ROOT)}" for file in OUTSIDE})


def test_links_follow_a_page_to_where_the_site_has_it() -> None:
    text = "[a](docs/parts.md#forks) ![b](docs/images/fork.png) [c](CHANGELOG.md) [d](https://example.org) [e](#here)"
    source, target = programs.ROOT, DOCS / "generated/project"
    assert moved(text, source, target) == (
        "[a](../../parts.md#forks) ![b](../../images/fork.png) [c](changelog.md) [d](https://example.org) [e](#here)"
    )


def test_pages_of_what_is_gone_are_removed(tmp_path: Path) -> None:
    for name in ("index.rst", "old.rst", "old.py.md5", "new.rst"):
        (tmp_path / name).touch()
    (tmp_path / "images").mkdir()
    remove_others(tmp_path, {"index", "new"})
    assert {file.name for file in tmp_path.iterdir()} == {"index.rst", "new.rst", "images"}


def test_slow_examples_are_not_run_unless_asked_for(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "quick.py").write_text("import alula\n", encoding="utf-8")
    (tmp_path / "long.py").write_text("# slow: an hour\nimport alula\n", encoding="utf-8")
    monkeypatch.setattr(gallery, "FOLDER", tmp_path)
    pattern = gallery.run_pattern(gallery.not_run())
    assert re.search(pattern, "/docs/gallery/quick.py")
    assert re.search(pattern, "/docs/gallery/not_so_long.py")
    assert not re.search(pattern, "/docs/gallery/long.py")
    page = gallery.GENERATED / "gallery/long.rst"
    told = gallery.with_note(page, "\nLong\n====\n\nText.\n", gallery.not_run())
    assert told.startswith("\nLong\n====\n\n.. note::")
    assert told.endswith("\n\nText.\n")
    monkeypatch.setenv("GALLERY", "all")
    assert re.search(gallery.run_pattern(gallery.not_run()), "/docs/gallery/long.py")


def test_examples_run_anew_after_a_change_of_alula_alone() -> None:
    """Else pages from before stay, since the scripts are as they were."""
    assert runpy.run_path(str(DOCS / "conf.py"))["sphinx_gallery_conf"]["run_stale_examples"] is True


@pytest.mark.parametrize("model", [Case, StudyPlan])
def test_every_entry_has_a_description_a_unit_and_an_example(model: type[BaseModel]) -> None:
    entries = [entry for table in tables(file_schema(model)) for entry in table.entries]
    assert len(entries) > (300 if model is Case else 10)
    assert case_file.missing(model) == {"description": [], "example": [], "unit": []}


def test_the_page_of_an_entry_says_all_of_it() -> None:
    page = case_file.pages()["case-file/links.md"]
    entry = page.partition("### fork\n")[2].partition("\n### ")[0]
    assert ':Path: `links.NAME.eyes.NAME.fork`\n:Holds: length; such as `"125 mm"`\n:Rule: greater than zero\n' in entry
    assert 'fork = "' in entry.partition("```toml\n")[2].partition("```")[0]
    assert "](../../how-to/fork.md)" in entry
    every = case_file.pages()["case-file/all.md"]
    assert "| [title](#entry-case-title) | text | needed |" in every
    assert '| [parts.NAME.width](#entry-bar-width) (shape = "bar") | length |  |' in every


def test_the_page_on_python_has_what_the_functions_return() -> None:
    found = python.returned()
    assert all(hasattr(import_module(module), name) for module, name in found)
    assert ("alula.reports.notebook.check_report", "CheckReport") in found
    page = python.page()
    assert "autofunction:: alula.check\n" in page
    assert "autoclass:: alula.reports.notebook.check_report.CheckReport\n" in page
    assert "autoclass:: alula.Case\n" in page


@pytest.mark.parametrize(("base", "stretch"), list(stretches()), ids=lambda value: getattr(value, "source", value))
def test_stretches_are_read_with_their_case(base: str, stretch: Text, tmp_path: Path) -> None:
    """Examples come from built-in cases and recipes, which other tests read, and from these."""
    if base == STARTER_PLAN:
        plan_of(stretch.tables)
        return
    for file in (*files("alula.loads.cases").iterdir(), *FOLDER.iterdir()):
        (tmp_path / file.name).symlink_to(str(file))
    case = validate(stretch.tables, str(tmp_path))
    assert case.solve_pose()
    for link in case.checked_links:
        assert case.body(link).part.section.area > 0.0


def test_an_example_is_the_first_statement_of_its_entry() -> None:
    whole = """
schema_version = 1
[links.a]
points.P = ["0 mm", "0 mm"]   # here
# nothing
points.Q = [
  "1 mm", "0 mm"]

[parts.b]
shape = "disc"
[[load_cases.c.forces]]
link = "a"
force = ["1 N", "0 N"]
"""
    found = of_text(Text(text=whole, source="it", tables=tomllib.loads(whole)), Case)
    assert found["Link", "points"].toml == '[links.a]\npoints.P = ["0 mm", "0 mm"]   # here'
    assert found["PointForce", "force"].toml == '[[load_cases.c.forces]]\nforce = ["1 N", "0 N"]'
    assert found["Case", "load_cases"].toml == '[[load_cases.c.forces]]\nlink = "a"\nforce = ["1 N", "0 N"]'
    assert ("Disc", "shape") in found
    assert ("Bar", "shape") not in found


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site as ``make docs`` does."""
    return built(DOCS, tmp_path_factory.mktemp("site"))


def built(source: Path, folder: Path) -> Path:
    """Build a site without a warning."""
    options = ("--fail-on-warning", "--keep-going", "--quiet", "--fresh-env", "--doctree-dir", folder / "cache")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, source, folder / "site"],
        cwd=programs.ROOT,
        env=programs.environment(),
        capture_output=True,
        text=True,
        timeout=1800,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "site"


@pytest.mark.converged
def test_no_page_asks_for_a_foreign_address(site: Path) -> None:
    """What a page needs to be drawn is in its folder; links for readers may lead elsewhere."""
    pages = list(site.rglob("*.html"))
    assert len(pages) > 50
    asked = re.compile(r"""<(?:script|img|iframe|link|source|video)\b[^>]*?(?:src|href|srcset)=["']?(?:https?:)?//""")
    for page in pages:
        assert not asked.findall(page.read_text(encoding="utf-8")), page
    for style in site.rglob("*.css"):
        assert not re.findall(r"url\([\"']?(?:https?:)?//|@import", style.read_text(encoding="utf-8")), style


@pytest.mark.converged
def test_links_within_the_site_lead_somewhere(site: Path) -> None:
    """Generated pages and anchors too, which the links of the Markdown files do not show."""
    anchors: dict[Path, set[str]] = {}
    dead = []
    for page in site.rglob("*.html"):
        for link in re.findall(r'(?:href|src)="([^"]+)"', page.read_text(encoding="utf-8")):
            parts = urlsplit(link)
            if parts.scheme or link == "#":
                continue
            there = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            if there.suffix == ".html" and there.exists() and there not in anchors:
                anchors[there] = set(re.findall(r'\bid="([^"]+)"', there.read_text(encoding="utf-8")))
            if not there.exists() or (parts.fragment and unquote(parts.fragment) not in anchors[there]):
                dead.append(f"{page.relative_to(site)}: {link}")
    assert not dead


@pytest.mark.converged
def test_a_search_for_a_word_finds_the_recipe_and_the_entry(site: Path) -> None:
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))
    places = {
        f"{index['docnames'][page]}#{anchor or ''}"
        for title, found in index["alltitles"].items()
        if "fork" in re.findall(r"\w+", title.lower())
        for page, anchor in found
    }
    assert {"how-to/fork#", "generated/case-file/links#entry-eyesizes-fork"} <= places


@pytest.mark.converged
def test_formulas_are_mathml_with_their_numbers(tmp_path: Path) -> None:
    source = tmp_path / "source"
    source.mkdir()
    (source / "conf.py").write_text(
        'extensions = ["docs.extensions.mathml", "myst_parser"]\nmyst_enable_extensions = ["dollarmath"]\n'
        'html_math_renderer = "mathml"\nhtml_theme = "basic"\n',
        encoding="utf-8",
    )
    text = "# Title\n\n$a_1$\n\n$$\n\\frac{N}{A}\n$$ (eq-stress)\n\nSee {eq}`eq-stress`.\n"
    (source / "index.md").write_text(text, encoding="utf-8")
    page = (built(source, tmp_path) / "index.html").read_text(encoding="utf-8")
    assert re.search(r'<math [^>]*display="inline".*?<msub><mi>a</mi><mn>1</mn></msub>', page)
    assert re.search(r'id="equation-eq-stress">\s*<span class="eqno">\(1\)</span><math .*?<mfrac>', page)
    assert re.search(r'href="#equation-eq-stress">\(1\)</a>', page)
    assert "<script" not in page.partition("<body")[2].partition("</math>")[0]
