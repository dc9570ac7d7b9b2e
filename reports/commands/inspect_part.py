"""Output of ``alula inspect``: what is found in a STEP file or a mesh, and the entries of a case file for it."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from alula.geometry.base.errors import AlulaError
from alula.loads.exchange.part import part_entries
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell, write
from alula.reports.renderers.record import as_brief_record
from alula.reports.tools.part import Inspection, part_section
from alula.reports.words.numbers import joined

if TYPE_CHECKING:
    from alula.reports.figures.sheet.canvas import Canvas

ENTRIES, PICTURE = "parts.toml", "part.png"
"""Files that go to the output folder."""


def tell_inspection(found: Inspection, output: Path | None = None, *, json: bool = False) -> None:
    """Print what was found with the entries of a case file, as they are copied, and write both with a picture.

    Parameters
    ----------
    found : Inspection
    output : Path, optional
        The output folder; the files go to its subfolder ``inspect``.
    json : bool, optional
        True to print JSON.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    sections, text = [part_section(found)], part_entries(found)

    def fill(folder: Path) -> None:
        if picture is not None:
            (folder / PICTURE).write_bytes(picture.png())
        if text:
            (folder / ENTRIES).write_text(text, encoding="utf-8")

    tell(sections, json=json)
    if text and not json:
        print(f"\nEntries of the case file\n\n{text}", end="", flush=True)
    picture = None if output is None else _picture(found)
    what = joined(["Record", *(["entries"] if text else []), *(["picture"] if picture else [])])
    write("inspect", output, partial(as_brief_record, sections), fill, what=f"\n{what}", json=json)


def _picture(found: Inspection) -> "Canvas | None":
    from alula.reports.figures.part_picture import part_picture

    progress("Drawing the part ...")
    try:
        picture, trouble = part_picture(found.facts, found.surface)
    except AlulaError as error:
        picture, trouble = None, str(error)
    if picture is None:
        progress(f"Warning: no picture: {trouble}")
    return picture
