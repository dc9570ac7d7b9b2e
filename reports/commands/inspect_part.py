"""Output of ``alula inspect``: what is found in a STEP file or a mesh, and the entries of a case file for it."""

from functools import partial
from pathlib import Path

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.imported.facts import MESH_FORMATS
from alula.geometry.imported.read import part_facts
from alula.geometry.materials.material import library
from alula.geometry.parts.mesh_part import UNITS
from alula.loads.exchange.part import part_entries
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell, write
from alula.reports.renderers.record import as_brief_record
from alula.reports.tools.part import Inspection, part_section

ENTRIES, PICTURE = "parts.toml", "part.png"
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
        from alula.reports.figures.part_picture import part_picture

        progress("Drawing the part ...")
        try:
            picture, trouble = part_picture(found.facts, found.surface)
        except AlulaError as error:
            picture, trouble = None, str(error)
        if picture is None:
            progress(f"Warning: no picture: {trouble}")
        else:
            (folder / PICTURE).write_bytes(picture.png())
        if text:
            (folder / ENTRIES).write_text(text, encoding="utf-8")

    tell(sections, json=json)
    if text and not json:
        print(f"\nEntries of the case file\n\n{text}", end="", flush=True)
    record = partial(as_brief_record, sections)
    write("inspect", output, record, fill, what="\nEntries, record and picture", json=json)
