"""The site: its index holds every page, and it builds without a warning or a foreign address."""

import re
import subprocess
import sys
from pathlib import Path

import programs
import pytest

from docs.extensions.index import sections
from docs.extensions.links import OUTSIDE, moved

DOCS = programs.ROOT / "docs"
INDEX = (DOCS / "index.md").read_text(encoding="utf-8")


def test_the_index_lists_every_page_once() -> None:
    listed = [page for section in sections(INDEX) for page in section.pages]
    pages = {file.relative_to(DOCS).as_posix() for file in DOCS.rglob("*.md")}
    inside = {page for page in pages if not page.startswith("generated/")} - {"index.md"}
    assert sorted(listed) == sorted(inside | {f"../{file.relative_to(programs.ROOT)}" for file in OUTSIDE})


def test_links_follow_a_page_to_where_the_site_has_it() -> None:
    text = "[a](docs/parts.md#forks) ![b](docs/images/fork.png) [c](CHANGELOG.md) [d](https://example.org) [e](#here)"
    source, target = programs.ROOT, DOCS / "generated/project"
    assert moved(text, source, target) == (
        "[a](../../parts.md#forks) ![b](../../images/fork.png) [c](changelog.md) [d](https://example.org) [e](#here)"
    )


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
