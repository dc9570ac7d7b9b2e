"""What is found in the file of a part: its size and mass, bores, flat faces, and how they lie to one another."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.arrangement import angle_between, coaxial, parallel_groups
from alula.geometry.imported.facts import MESH_FORMATS, Bore, PartFacts, Vector
from alula.geometry.imported.read import part_facts
from alula.geometry.materials.material import Material, library
from alula.geometry.parts.mesh_part import UNITS
from alula.loads.exchange.part import FoundPart, part_entries
from alula.loads.text.explain import printable
from alula.reports.sections.data import entries
from alula.reports.sections.section import KEPT, Column, Number, Part, Section, Table, Text, say, words
from alula.reports.words.numbers import fixed, joined, number

GRAMS = 1e6
"""In a tonne."""
MOST_FACES = 40
"""Flat faces that are told."""
BORES, FACES = "bores", "faces"
"""Names of the tables."""


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


def part_section(found: Inspection) -> Section:
    """Return what was found in the file of a part.

    Parameters
    ----------
    found : Inspection

    Returns
    -------
    Section
        In mm and g, in the file's frame.
    """
    facts = found.facts
    sizes = [high - low for low, high in zip(facts.low, facts.high, strict=True)]
    parts: list[Part] = [
        say(
            "Size {box} mm along x, y, z of the file, from {low} to {high} mm",
            box=" × ".join(number(size) for size in sizes),
            low=_point(facts.low),
            high=_point(facts.high),
        ),
        say(
            "Volume {volume}, surface {surface}",
            volume=Number(facts.volume, "mm³", 7),
            surface=Number(facts.surface, "mm²", 6),
        ),
        say("Centroid {centroid} mm", centroid=_point(facts.centroid)),
    ]
    if found.card is not None:
        density = Number(found.card.density, "kg/m³", stated=True, factor=1e12)
        mass = Number(found.mass, "g", factor=GRAMS)
        parts.append(say("Mass {mass} of {title} ({density})", mass=mass, title=found.card.title, density=density))
    if facts.bores:
        parts.append(_bores(found))
    else:
        parts.append(Text("No bore was found: no cylinder of a full turn around empty space, and no slot."))
    parts += map(Text, _remarks(found))
    if facts.faces:
        parts += _faces(facts)
    return Section(
        key="part", title=f"{printable(found.path.name)}: one solid", parts=tuple(parts), data=_record(found)
    )


def _bores(found: Inspection) -> Table:
    points = {} if found.frame is None else {bore.name: point for point, bore in found.frame.bores.items()}
    rows = tuple(
        (
            bore.name.replace(" ", KEPT),
            points.get(bore.name, ""),
            _short(bore.diameter),
            _short(bore.length),
            *map(_place, bore.centre),
            *map(_share, bore.axis),
            "yes" if bore.through else "no",
            _kind(bore, found.facts),
        )
        for bore in found.facts.bores
    )
    columns = (
        *map(words, ("bore", "point")),
        *(Column(title, "mm") for title in ("diameter", "length", *"xyz")),
        *(Column(f"axis {axis}") for axis in "xyz"),
        words("through", hidden=True),
        words("kind", wraps=True),
    )
    return Table(key=BORES, columns=columns, rows=rows)


def _faces(facts: PartFacts) -> Iterator[Part]:
    least = sorted((face.area for face in facts.faces), reverse=True)[:MOST_FACES][-1]
    shown = [face for face in facts.faces if face.area >= least][:MOST_FACES]
    yield Table(
        key=FACES,
        caption="Flat faces, with their normals out of the material",
        columns=(
            words("face"),
            Column("area", "mm²"),
            *(Column(axis, "mm") for axis in "xyz"),
            *(Column(f"normal {axis}") for axis in "xyz"),
        ),
        rows=tuple(
            (face.name.replace(" ", KEPT), Number(face.area), *map(_place, face.centre), *map(_share, face.normal))
            for face in shown
        ),
    )
    if len(shown) < len(facts.faces):
        yield Text(f"The smaller ones of all {len(facts.faces)} are left out; --json lists them.")


def _kind(bore: Bore, facts: PartFacts) -> str:
    """Say what kind of hole a bore is."""
    told = ["through" if bore.through else "blind"]
    if bore.slot:
        told = [f"slot, {_short(bore.slot)} mm between the centres of its ends", *told]
    if bore.share < 1.0:
        told.append(f"{bore.share:.0%} of the circle is there")
    if len(bore.spans) > 1:
        told.append(f"{len(bore.spans)} walls (fork)" if len(bore.spans) == 2 else f"{len(bore.spans)} walls")
    if bore.around:
        told.append("coaxial with the outside")
    if others := _coaxial_with(bore, facts):
        told.append(f"coaxial with {joined(others)}")
    return ", ".join(told)


def _coaxial_with(bore: Bore, facts: PartFacts) -> list[str]:
    return [other.name for other in facts.bores if other is not bore and not other.slot and coaxial(bore, other)]


def _remarks(found: Inspection) -> Iterator[str]:
    """Yield sentences on how the bores lie to each other, and what does not become a point of the link."""
    bores, frame = found.facts.bores, found.frame
    groups = parallel_groups(bores)
    yield from (f"Parallel: {joined([bore.name for bore in group])}." for group in groups if len(group) > 1)
    for one in groups[1:]:
        angle = fixed(math.degrees(angle_between(groups[0][0], one[0])), 2)
        yield f"{one[0].name} stands at {angle}° to {groups[0][0].name}."
    if bores and frame is None:
        yield "No two bores are parallel: a link of this part has a single pin, and needs `along`."
    if frame is not None:
        middles = {point: float(frame.place(np.array(bore.centre))[2]) for point, bore in frame.bores.items()}
        if max(middles.values()) - min(middles.values()) > 1e-3 * min(bore.diameter for bore in frame.bores.values()):
            heights = joined([f"{point} {_place(height)}" for point, height in middles.items()])
            yield f"Middles of the bores along z of the link [mm]: {heights}; they are not in one plane."
        used = {bore.name for bore in frame.bores.values()}
        if left := [bore.name for bore in bores if bore.name not in used]:
            yield f"No point of the link: {joined(left)}."


def _point(values: Vector) -> str:
    return f"({', '.join(str(_place(value)) for value in values)})"


def _place(value: float) -> Number:
    return Number(float(value), decimals=3)


def _share(value: float) -> Number:
    return Number(float(value), decimals=4)


def _short(value: float) -> Number:
    return Number(float(value), stated=True)


def _record(found: Inspection) -> dict[str, Any]:
    facts, frame, mass = found.facts, found.frame, found.mass
    return {
        "units": {"length": "mm", "area": "mm^2", "volume": "mm^3", "mass": "g", "inertia": "mm^5"},
        "file": printable(str(found.path)),
        **entries(facts, "digest volume surface centroid inertia low high"),
        "material": found.material,
        "mass": None if mass is None else mass * GRAMS,
        "bores": [
            {
                **entries(bore, "name axis centre diameter length through spans share slot slot_axis"),
                "coaxial_with_outside": bore.around,
                "coaxial_with": _coaxial_with(bore, facts),
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
