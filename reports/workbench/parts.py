"""STEP files dropped on the page: looked into, copied in beside the case, and offered to the pins of a link."""

import os
import re
import tomllib
from pathlib import Path
from typing import Any

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.base.tidying import scratch_folder
from alula.geometry.imported.arrangement import single_frame
from alula.geometry.imported.read import LARGEST_FILE
from alula.loads.compose.starting import place_for, write_new
from alula.loads.exchange.part import FoundPart, part_entries
from alula.loads.text.explain import printable
from alula.reports.tools.part import inspect_file

ENDINGS = (".step", ".stp")
"""Ends of names of STEP files."""
_LONGEST = 80
"""Letters of a name that are kept; file systems take 255 bytes."""


def dropped(name: str, data: bytes, folder: Path) -> dict[str, Any]:
    """Look into a dropped STEP file and keep it beside the case; no file that stands there is written over.

    Parameters
    ----------
    name : str
        What the browser says that the file is called; a path before it is left out.
    data : bytes
        Its content.
    folder : Path
        Of the case.

    Returns
    -------
    dict
        ``file`` (its name beside the case), ``part`` (a name for part and link), ``size`` (of its box along its own
        x, y and z) [mm], ``table`` (the entries of the part; its material is a guess),
        ``link`` (those of its link) and ``bores``: of each that may be a pin's the ``point`` of the link, ``bore``
        (its name in the part), ``diameter`` [mm], ``at`` (x, y in the link's frame) [mm] and whether it is a ``slot``.

    Raises
    ------
    CaseError
        Where it is no STEP file, is too large, holds no single solid, or has no bore.
    CannotRunError
        Where the geometry kernel fails, or the file cannot be written.
    """
    kept = plain_file_name(name)
    if len(data) > LARGEST_FILE:
        raise CaseError(f"'{kept}' has more than the {LARGEST_FILE / 1e6:.0f} MB that are read; export the part alone")
    with scratch_folder("alula-") as scratch:
        file = scratch / kept
        file.write_bytes(data)
        try:
            found = inspect_file(file, None)
        except AlulaError as error:
            raise type(error)(str(error).replace(str(file), kept)) from None
        entries = part_entries(found)
    if not entries:
        raise CaseError(f"'{kept}': no bore was found that may be a pin's, so that nothing can hold the part")
    place = place_for(folder / kept, data)
    if not place.exists():
        write_new({place: data})
    tables = tomllib.loads(entries)
    [(part, table)], [link] = tables["parts"].items(), tables["links"].values()
    return {
        "file": place.name,
        "part": part,
        "size": [high - low for low, high in zip(found.facts.low, found.facts.high, strict=True)],
        "table": table | {"file": place.name},
        "link": link,
        "bores": _bores(found),
    }


def plain_file_name(name: str) -> str:
    """Return the name under which a dropped file is kept: letters, digits and a few marks, with the end of its kind.

    Parameters
    ----------
    name : str

    Returns
    -------
    str

    Raises
    ------
    CaseError
        Where it is not that of a STEP file.
    """
    stem, end = os.path.splitext(name.replace("\\", "/").rpartition("/")[2])
    if end.lower() not in ENDINGS:
        raise CaseError(f"'{printable(name[:_LONGEST])}' is no STEP file by its name; drop one that ends with .step")
    return (re.sub(r"[^\w+ -]+", "-", stem).strip("-_+ ")[:_LONGEST] or "part") + end.lower()


def _bores(found: FoundPart) -> list[dict[str, Any]]:
    frame = found.frame or single_frame(found.facts)
    if frame is None:
        return []
    return [
        {
            "point": point,
            "bore": frame.bores[point].name,
            "diameter": frame.bores[point].diameter,
            "at": list(at),
            "slot": point in frame.slots,
        }
        for point, at in frame.points.items()
    ]
