"""What sphinx-gallery needs to know of alula: which scripts it runs, and how a picture gets onto a page."""

import os
import re
from pathlib import Path
from typing import Any

from alula.reports.notebook.shown import ShownPicture
from docs.extensions.links import DOCS, GENERATED

FOLDER = DOCS / "gallery"
SLOW = re.compile(r"^# slow: .+$", re.M)
"""The line by which a script says that it takes too long for `make docs`, and how long."""
NOT_RUN_PICTURE = GENERATED / "not-run.png"
"""Stands in the list for a script that was not run and names no picture."""
_NOT_RUN = """
.. note::

   This script was not run when the page was made, since it takes long. The tests run it and its assertions
   (``make verify``); ``make docs GALLERY=all`` runs it and shows its results.
"""


def not_run() -> tuple[str, ...]:
    """Return the names of the scripts that are shown without being run: the slow ones, unless all are asked for.

    Returns
    -------
    tuple of str
        Without suffix.
    """
    if os.environ.get("GALLERY") == "all":
        return ()
    return tuple(sorted(file.stem for file in FOLDER.glob("*.py") if SLOW.search(file.read_text(encoding="utf-8"))))


def run_pattern(slow: tuple[str, ...]) -> str:
    """Return the pattern of the paths of scripts that are run.

    Parameters
    ----------
    slow : tuple of str
        Names of those that are not.

    Returns
    -------
    str
        A regular expression.
    """
    return rf"/(?!(?:{'|'.join(slow)})\.py$)[^/]+\.py$" if slow else r"\.py$"


def draw_not_run() -> None:
    """Draw the picture of scripts that were not run."""
    from PIL import Image, ImageDraw, ImageFont

    picture = Image.new("RGB", (400, 280), "#f2f4f6")
    text, font = "not run for this page", ImageFont.load_default(28)
    ImageDraw.Draw(picture).text((200, 140), text, fill="#6b7280", font=font, anchor="mm")
    NOT_RUN_PICTURE.parent.mkdir(exist_ok=True)
    picture.save(NOT_RUN_PICTURE)


def pictures(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Put the picture that a block ends with onto its page.

    Parameters
    ----------
    block
        The block; it is not looked at.
    block_vars : dict
        ``example_globals`` with the last expression's value, ``image_path_iterator`` with the next file.
    gallery_conf : dict
        Settings of sphinx-gallery.

    Returns
    -------
    str
        reStructuredText.
    """
    from sphinx_gallery.scrapers import figure_rst

    values = block_vars["example_globals"]
    last = values.get("___")
    if not isinstance(last, ShownPicture):
        return ""
    values["___"] = None  # else the next block without a value, and its text, would show it again
    file = Path(next(block_vars["image_path_iterator"]))
    last.save(file)
    return str(figure_rst([str(file)], gallery_conf["src_dir"]))


def with_note(page: Path, text: str, slow: tuple[str, ...]) -> str:
    """Add to the page of a script that was not run that it was not.

    Parameters
    ----------
    page : Path
        The file of the page.
    text : str
        What it holds, as sphinx-gallery wrote it.
    slow : tuple of str
        Names of the scripts that were not run.

    Returns
    -------
    str
        reStructuredText.
    """
    if page.parent != GENERATED / "gallery" or page.stem not in slow:
        return text
    return re.sub(r"(\n=+\n.+\n=+\n|\n.+\n=+\n)", lambda title: title[0] + _NOT_RUN, text, count=1)
