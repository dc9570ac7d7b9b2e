"""Links between Markdown files: as a repository browser follows them, turned to where the site has its pages."""

import os
import re
from collections.abc import Collection
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
ROOT = DOCS.parent
GENERATED = DOCS / "generated"
OUTSIDE = {
    ROOT / "README.md": GENERATED / "project/readme.md",
    ROOT / "benchmarks/README.md": GENERATED / "project/benchmarks.md",
    ROOT / "CONTRIBUTING.md": GENERATED / "project/contributing.md",
    ROOT / "CHANGELOG.md": GENERATED / "project/changelog.md",
}
"""Page of the repository outside of docs/ -> its copy in the site."""
_TURNED = OUTSIDE | {DOCS / "gallery/README.rst": GENERATED / "gallery/index.rst"}
_LINK = re.compile(r"(?<=\]\()(?!\w+:|#)(?P<path>[^)#\s]+)")


def moved(text: str, source: Path, target: Path) -> str:
    """Turn the relative links of a page to where the site has what they lead to.

    Parameters
    ----------
    text : str
        Markdown.
    source : Path
        Folder of the repository from which its links start.
    target : Path
        Folder from which they start in the site.

    Returns
    -------
    str
        The same text with other links.
    """

    def turn(link: re.Match[str]) -> str:
        place = Path(os.path.normpath(source / link["path"]))
        return Path(os.path.relpath(_TURNED.get(place, place), target)).as_posix()

    return _LINK.sub(turn, text)


def copy_outside_pages() -> None:
    """Write the site's copies of the pages outside of docs/."""
    for page, copy in OUTSIDE.items():
        text = moved(page.read_text(encoding="utf-8"), page.parent, copy.parent)
        write_changed(copy, text)


def write_changed(file: Path, text: str) -> None:
    """Write a text unless the file holds it, so that Sphinx reads again only what changed.

    Parameters
    ----------
    file : Path
        Its folder is made.
    text : str
        What it is to hold.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists() or file.read_text(encoding="utf-8") != text:
        file.write_text(text, encoding="utf-8")


def remove_others(folder: Path, stems: Collection[str]) -> None:
    """Remove pages of former builds whose entry or script is gone.

    Parameters
    ----------
    folder : Path
        Folder of generated pages.
    stems : collection of str
        Names of the pages that are made now, without suffix.
    """
    for file in folder.glob("*"):
        if file.is_file() and file.name.partition(".")[0] not in stems:
            file.unlink()
