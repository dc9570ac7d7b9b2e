"""Output of ``alula inspect``: what is found in a STEP file or a mesh, and the entries of a case file for it."""

from collections.abc import Callable
from pathlib import Path

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.imported.facts import MESH_FORMATS
from alula.geometry.imported.read import part_facts
from alula.geometry.materials.material import library
from alula.geometry.parts.mesh_part import UNITS
from alula.loads.exchange.part import part_entries
from alula.reports.commands.telling import json_of, tell
from alula.reports.tools.part import Inspection, part_section

ENTRIES, PICTURE, RECORD = "parts.toml", "part.png", "result.json"
"""Files that go to the output folder."""


def inspect_file(path: Path, material: str | None, unit: str | None = None) -> Inspection:
    """Look into a STEP file or a mesh.

    Parameters
    ----------
    path : Path
        The file.
    material : str, optional
        Name of a material of the library.
    unit : str, optional
        Unit of length of a mesh, as the case file names it, or "inch"; mm unless stated.

    Returns
    -------
    Inspection
        What is found.

    Raises
    ------
    CaseError
        For an unknown material or unit, for a unit of a STEP file, and where the file holds no single solid.
    CannotRunError
        Where the geometry kernel fails.
    """
    if material is not None and material not in library():
        raise CaseError(f"--material: there is no material '{material}'; the library has {', '.join(library())}")
    if path.suffix.lower() not in MESH_FORMATS:
        if unit is not None:
            raise CaseError("--unit: it is that of a mesh, but a STEP file states its own unit; leave it out")
        return Inspection(path=path, facts=part_facts(path), material=material)
    unit = "in" if unit == "inch" else unit or "mm"
    if unit not in UNITS:
        raise CaseError(f"--unit: '{unit}' is no unit of a mesh; name one of {', '.join(UNITS)}")
    return Inspection(path=path, facts=part_facts(path, UNITS[unit]), material=material, unit=unit)


def print_inspection(found: Inspection, *, json: bool) -> None:
    """Print what was found, and below it the entries of a case file, as they are copied.

    Parameters
    ----------
    found : Inspection
    json : bool
        True to print JSON.
    """
    tell([part_section(found)], json=json)
    if (text := part_entries(found)) and not json:
        print(f"\nEntries of the case file\n\n{text}", end="", flush=True)


def write_inspection(found: Inspection, folder: Path, progress: Callable[[str], None] = lambda message: None) -> None:
    """Write the record, the entries and the picture.

    Parameters
    ----------
    found : Inspection
    folder : Path
        An existing folder.
    progress : callable, optional
        Receives a warning where the picture cannot be drawn.
    """
    from alula.reports.figures.part_picture import part_picture

    try:
        picture, trouble = part_picture(found.facts, found.surface)
    except AlulaError as error:
        picture, trouble = None, str(error)
    if picture is None:
        progress(f"Warning: no picture: {trouble}")
    else:
        (folder / PICTURE).write_bytes(picture.png())
    if text := part_entries(found):
        (folder / ENTRIES).write_text(text, encoding="utf-8")
    (folder / RECORD).write_text(json_of([part_section(found)]) + "\n", encoding="utf-8")
