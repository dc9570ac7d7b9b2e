"""Output of ``alula inspect``: what is found in a STEP file or a mesh, and the entries of a case file for it."""

import json as jsonlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.base.version import result_stamp
from alula.geometry.imported.arrangement import angle_between, coaxial, parallel_groups
from alula.geometry.imported.facts import MESH_FORMATS, Bore, PartFacts, Vector
from alula.geometry.imported.read import part_facts
from alula.geometry.materials.material import Material, library
from alula.geometry.parts.mesh_part import UNITS
from alula.loads.exchange.part import FoundPart, part_entries
from alula.loads.text.explain import printable
from alula.reports.sections.data import entries
from alula.reports.words.numbers import fixed, joined, number, plain
from alula.reports.words.terminal import KEPT, say, say_table

if TYPE_CHECKING:
    from rich.console import Console

ENTRIES, PICTURE, RECORD = "parts.toml", "part.png", "result.json"
"""Files that go to the output folder."""
MOST_FACES = 40
"""Flat faces in the printed list."""
GRAMS = 1e6
"""In a tonne."""


@dataclass(frozen=True, kw_only=True)
class Inspection(FoundPart):
    """What is found in the file of a part, with a material."""

    @property
    def card(self) -> Material | None:
        """The material's card."""
        return None if self.material is None else library()[self.material]

    @property
    def mass(self) -> float | None:
        """Mass [tonne]; None without a material."""
        return None if self.card is None else self.facts.volume * self.card.density


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


def record(found: Inspection) -> dict[str, Any]:
    """Return what was found as plain data.

    Parameters
    ----------
    found : Inspection

    Returns
    -------
    dict
        In mm and g, in the file's frame.
    """
    facts, frame, mass = found.facts, found.frame, found.mass
    return {
        **result_stamp(),
        "units": {"length": "mm", "area": "mm^2", "volume": "mm^3", "mass": "g", "inertia": "mm^5"},
        "file": printable(str(found.path)),
        **entries(facts, "digest volume surface centroid inertia low high"),
        "material": found.material,
        "mass": None if mass is None else mass * GRAMS,
        "bores": [
            {
                **entries(bore, "name axis centre diameter length through spans share slot slot_axis"),
                "coaxial_with_outside": bore.around,
                "coaxial_with": [other.name for other in _coaxial_with(bore, facts)],
            }
            for bore in facts.bores
        ],
        "faces": [entries(face, "name normal centre area") for face in facts.faces],
        "parallel": [[bore.name for bore in group] for group in parallel_groups(facts.bores)],
        "link_points": {} if frame is None else {name: list(at) for name, at in frame.points.items()},
        "link_bores": {} if frame is None else {name: bore.name for name, bore in frame.bores.items()},
        "link_slots": {} if frame is None else {name: list(ends) for name, ends in frame.slots.items()},
        "entries": part_entries(found),
    }


def as_json(found: Inspection) -> str:
    """Return what was found as JSON.

    Parameters
    ----------
    found : Inspection

    Returns
    -------
    str
    """
    return jsonlib.dumps(record(found), indent=2, ensure_ascii=False)


def print_inspection(found: Inspection, console: "Console") -> None:
    """Print what was found.

    Parameters
    ----------
    found : Inspection
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    facts = found.facts
    sizes = [high - low for low, high in zip(facts.low, facts.high, strict=True)]
    say(console, f"{printable(found.path.name)}: one solid", style="bold")
    box = " × ".join(number(size) for size in sizes)
    say(console, f"Size {box} mm along x, y, z of the file, from {_point(facts.low)} to {_point(facts.high)} mm.")
    say(console, f"Volume {number(facts.volume, 7)} mm³, surface {number(facts.surface, 6)} mm².")
    say(console, f"Centroid {_point(facts.centroid)} mm.")
    if found.card is not None and found.mass is not None:
        density = found.card.density / 1e-12  # kg/m³
        say(console, f"Mass {number(found.mass * GRAMS)} g of {found.card.title} ({plain(density)} kg/m³).")
    if not facts.bores:
        say(console, "\nNo bore was found: no cylinder of a full turn around empty space, and no slot.")
    else:
        _bores(found, console)
    for line in _remarks(found):
        say(console, line)
    if facts.faces:
        _faces(found, console)
    text = part_entries(found)
    if text:
        say(console, "\nEntries of the case file")
        print(f"\n{text}", end="", flush=True)


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
    (folder / RECORD).write_text(as_json(found) + "\n", encoding="utf-8")


def _bores(found: Inspection, console: "Console") -> None:
    """Print the table of the bores."""
    points = {} if found.frame is None else {bore.name: point for point, bore in found.frame.bores.items()}
    rows = [
        [
            bore.name.replace(" ", KEPT),
            points.get(bore.name, ""),
            _short(bore.diameter),
            _short(bore.length),
            *(_place(value) for value in bore.centre),
            *(fixed(value, 4) for value in bore.axis),
            _kind(bore, found.facts),
        ]
        for bore in found.facts.bores
    ]
    heads = ["bore", "point", "diameter\n[mm]", "length\n[mm]", "centre\nx [mm]", "\ny [mm]", "\nz [mm]",
             "axis\nx", "\ny", "\nz", "kind"]  # fmt: skip
    columns = [(head, 2 <= k <= 9) for k, head in enumerate(heads)]
    say_table(console, columns, rows)


def _faces(found: Inspection, console: "Console") -> None:
    """Print the table of the flat faces, at most the largest."""
    say(console, "\nFlat faces, with their normals out of the material:")
    least = sorted((face.area for face in found.facts.faces), reverse=True)[:MOST_FACES][-1]
    shown = [face for face in found.facts.faces if face.area >= least][:MOST_FACES]
    rows = [
        [
            face.name.replace(" ", KEPT),
            number(face.area),
            *(_place(value) for value in face.centre),
            *(fixed(value, 4) for value in face.normal),
        ]
        for face in shown
    ]
    heads = ["face", "area\n[mm²]", "centre\nx [mm]", "\ny [mm]", "\nz [mm]", "normal\nx", "\ny", "\nz"]
    say_table(console, [(head, k >= 1) for k, head in enumerate(heads)], rows)
    if len(shown) < len(found.facts.faces):
        say(console, f"The smaller ones of all {len(found.facts.faces)} are left out; --json lists them.")


def _kind(bore: Bore, facts: PartFacts) -> str:
    """Say what kind of hole a bore is."""
    words = ["through" if bore.through else "blind"]
    if bore.slot:
        words = [f"slot, {_short(bore.slot)} mm between the centres of its ends", *words]
    if bore.share < 1.0:
        words.append(f"{bore.share:.0%} of the circle is there")
    if len(bore.spans) > 1:
        words.append(f"{len(bore.spans)} walls (fork)" if len(bore.spans) == 2 else f"{len(bore.spans)} walls")
    if bore.around:
        words.append("coaxial with the outside")
    if others := _coaxial_with(bore, facts):
        words.append(f"coaxial with {joined([other.name for other in others])}")
    return ", ".join(words)


def _coaxial_with(bore: Bore, facts: PartFacts) -> list[Bore]:
    return [other for other in facts.bores if other is not bore and not other.slot and coaxial(bore, other)]


def _remarks(found: Inspection) -> list[str]:
    """Return sentences on how the bores lie to each other, and what does not become a point of the link."""
    bores, frame = found.facts.bores, found.frame
    groups = parallel_groups(bores)
    told = [f"Parallel: {joined([bore.name for bore in group])}." for group in groups if len(group) > 1]
    for one in groups[1:]:
        angle = math.degrees(angle_between(groups[0][0], one[0]))
        told.append(f"{one[0].name} stands at {fixed(angle, 2)}° to {groups[0][0].name}.")
    if bores and frame is None:
        told.append("No two bores are parallel: a link of this part has a single pin, and needs `along`.")
    if frame is not None:
        middles = {point: float(frame.place(_array(bore.centre))[2]) for point, bore in frame.bores.items()}
        if max(middles.values()) - min(middles.values()) > 1e-3 * min(bore.diameter for bore in frame.bores.values()):
            heights = joined([f"{point} {_place(height)}" for point, height in middles.items()])
            told.append(f"Middles of the bores along z of the link [mm]: {heights}; they are not in one plane.")
        left = [bore.name for bore in bores if bore.name not in {b.name for b in frame.bores.values()}]
        if left:
            told.append(f"No point of the link: {joined(left)}.")
    return told


def _array(values: Vector) -> Any:
    import numpy as np

    return np.array(values)


def _point(values: Vector) -> str:
    return f"({', '.join(_place(value) for value in values)})"


def _place(value: float) -> str:
    return fixed(value, 3)


def _short(value: float) -> str:
    return plain(round(value, 4))
