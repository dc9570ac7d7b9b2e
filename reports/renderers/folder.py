"""Sections as files of a folder: the page, its pictures, and tables."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from alula.reports.renderers.csv import files_of
from alula.reports.renderers.page import Page, as_page
from alula.reports.sections.section import Picture, parts_of


def drawn_pictures(page: Page) -> dict[str, Any]:
    """Draw all pictures of a page that know how.

    Parameters
    ----------
    page : Page

    Returns
    -------
    dict of str to Drawing
        By their names.
    """
    every = (part for section in page.every for part in parts_of(section.parts))
    return {part.name: part.draw() for part in every if isinstance(part, Picture) and part.draw is not None}


def write_sections(
    page: Page,
    folder: Path,
    name: str,
    *,
    pictures: Mapping[str, Any] = MappingProxyType({}),
    models: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Write a page, its pictures as PNG files, and its tables.

    Parameters
    ----------
    page : Page
    folder : Path
        An existing folder.
    name : str
        Of the page's file.
    pictures : mapping, optional
        Those that were drawn elsewhere, by their names; their files are not written.
    models : mapping, optional
        As of ``as_page``.
    """
    drawn = drawn_pictures(page)
    for title, picture in drawn.items():
        (folder / f"{title}.png").write_bytes(picture.png())
    for title, text in files_of(page.every).items():
        (folder / title).write_text(text, encoding="utf-8", newline="")
    (folder / name).write_text(as_page(page, {**pictures, **drawn}, models), encoding="utf-8")
