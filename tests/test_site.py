"""The site: its index holds every page, and it builds without a warning or a foreign address."""

import re
import subprocess
import sys
from pathlib import Path

import programs
import pytest

from docs.extensions import gallery
from docs.extensions.index import sections
from docs.extensions.links import OUTSIDE, moved

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


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site as ``make docs`` does."""
    folder = tmp_path_factory.mktemp("site")
    options = ("--fail-on-warning", "--keep-going", "--quiet", "--doctree-dir", folder / "cache")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, DOCS, folder / "site"],
        cwd=programs.ROOT,
        env=programs.environment(),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "site"


@pytest.mark.converged
def test_no_page_asks_for_a_foreign_address(site: Path) -> None:
    """What a page needs to be drawn is in its folder; links for readers may lead elsewhere."""
    pages = list(site.rglob("*.html"))
    assert len(pages) > 20
    asked = re.compile(r"""<(?:script|img|iframe|link|source|video)\b[^>]*?(?:src|href|srcset)=["']?(?:https?:)?//""")
    for page in pages:
        assert not asked.findall(page.read_text(encoding="utf-8")), page
    for style in site.rglob("*.css"):
        assert not re.findall(r"url\([\"']?(?:https?:)?//|@import", style.read_text(encoding="utf-8")), style
