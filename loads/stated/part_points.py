"""The points that an imported part gives its link: the centres of its bores, before the case is validated.

A link states its points and the part must agree within its tolerance, or it takes them from the part
(``points = "from-part"``). Either way the case goes on with the places that the bores have.
"""

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.base.units import parse
from alula.geometry.bodies.features import Slot
from alula.geometry.imported.read import file_digest
from alula.geometry.joints.joint import Joint
from alula.geometry.parts.mesh_part import MeshPart
from alula.geometry.parts.part import Part
from alula.geometry.parts.step import FilePart, StepPart
from alula.geometry.placement.fit import Fit, Wanted
from alula.geometry.placement.load_faces import load_faces
from alula.geometry.placement.match import place, points_of_part, with_loaded_bores
from alula.geometry.placement.placed_body import bores_of
from alula.loads.stated.level_file import profiled_steps
from alula.loads.text.explain import printable, sentence

FROM_PART = "from-part"
KINDS: dict[str, type[FilePart]] = {"step": StepPart, "mesh": MeshPart}
"""Shapes of parts that are imported."""
DIGITS = 9
"""Of a place in mm."""


class _Parts(BaseModel):
    """Where a part stands in a case, among those of all kinds."""

    parts: dict[str, Part]


def with_part_points(tables: dict[str, Any], context: Mapping[str, object]) -> dict[str, Any]:
    """Return the tables of a case with the points of links whose parts are imported.

    Parameters
    ----------
    tables : dict of str to object
        The case as nested tables, not validated; they stay as they are.
    context : mapping of str to object
        ``folder`` in which the files of parts are sought.

    Returns
    -------
    dict of str to object
        The same tables unless a part is imported. What is malformed is left for validation to find.

    Raises
    ------
    CaseError
        Where a file is no part, or its bores do not fit the link.
    CannotRunError
        Where the kernel fails.
    """
    links, parts = tables.get("links"), tables.get("parts")
    if not isinstance(links, dict) or not isinstance(parts, dict):
        return tables
    changed = dict(links)
    for name, link in links.items():
        stated = parts.get(link.get("part")) if isinstance(link, dict) and isinstance(link.get("part"), str) else None
        if isinstance(stated, dict) and stated.get("shape") in tuple(KINDS):  # a tuple, since it may be unhashable
            part = _part(link["part"], stated, context)
            changed[name] = link | _placed(name, link, part, tables.get("joints"))
        elif isinstance(link, dict) and link.get("points") == FROM_PART:
            raise CaseError(
                f'links.{name}.points: "{FROM_PART}" needs a part of shape "step" or "mesh"; state the points'
            )
    return tables | {"links": changed}


def named_files(tables: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any], str]]:
    """Yield the tables of a case that name a file beside it.

    Parameters
    ----------
    tables : mapping
        The case as nested tables, not validated.

    Yields
    ------
    tuple of (str, dict, str)
        The entry that names the file, its table, and its key there: of imported parts, of a cycle, of a level, and of
        steps of a level's tests.
    """
    parts = tables.get("parts")
    every = {f"parts.{name}": part for name, part in parts.items()} if isinstance(parts, dict) else {}
    every = {name: part for name, part in every.items() if isinstance(part, dict) and part.get("shape") in tuple(KINDS)}
    for name, table in (*every.items(), *((name, tables.get(name)) for name in ("cycle", "level"))):
        if isinstance(table, dict) and isinstance(table.get("file"), str):
            yield f"{name}.file", table, "file"
    for name, step in profiled_steps(tables.get("level"), "level"):
        yield name, step, "profile"


def _part(name: str, stated: dict[str, Any], context: Mapping[str, object]) -> FilePart:
    try:
        part = _Parts.model_validate({"parts": {name: stated}}, context=dict(context)).parts[name]
    except ValidationError as error:
        raise CaseError(sentence(error, _Parts)) from None
    assert isinstance(part, FilePart)
    try:
        file_digest(Path(part.file), mesh=part.mesh_unit is not None)
    except CaseError as error:
        raise CaseError(f"parts.{printable(name)}.file: {error}") from None
    return part


def _placed(name: str, link: dict[str, Any], part: FilePart, joints: object) -> dict[str, object]:
    """Return points and slots of a link, in the form of the case file; those that bores give stand where bores are."""
    points, slots = link.get("points"), link.get("slots", {})
    try:
        if points == FROM_PART:
            points = {point: _stated(*at) for point, at in points_of_part(part, bores_of(part)).items()}
            slots = _slots_of_part(part, slots) if isinstance(slots, dict) else slots
        wanted = pinned(name, points, slots, joints)
        if wanted is None or not isinstance(points, dict) or not isinstance(slots, dict):
            return {"points": points, "slots": slots}
        places = _places(points)
        taken = {*(one.name for one in wanted), *part.faces}
        others = {point: at for point, at in places.items() if point not in taken}
        fit = with_loaded_bores(part, place(part, bores_of(part), wanted, others), bores_of(part), others)
        points = _with_faces(part, fit, points, places)
    except AlulaError as error:
        raise type(error)(f"links.{printable(name)}, part {Path(part.file).name}: {error}") from None
    own = {point: fit.middle(point)[:2].tolist() for point in fit.bores}
    own |= {one.name: (places[one.name][0], own[one.name][1]) for one in wanted if one.slot is not None}
    ends = {one.name: _stated(*fit.span(one.name)) for one in wanted if one.slot is not None}
    return {
        "points": points | {point: _stated(*at) for point, at in own.items()},
        "slots": slots | {point: slots[point] | {"first": a, "last": b} for point, (a, b) in ends.items()},
    }


def _with_faces(
    part: FilePart, fit: Fit, points: dict[str, Any], places: Mapping[str, tuple[float, float]]
) -> dict[str, Any]:
    """Return the points of a link with those that are the centres of named faces."""
    found = dict(points)
    for point, face in load_faces(part, fit.turn, fit.shift).items():
        if point in fit.bores:
            raise CaseError(
                f"faces.{point}: the point {point} is that of a bore; name another point for {part.faces[point]}"
            )
        x, y, _ = face.centre
        away = math.dist(places.get(point, (x, y)), (x, y))
        if away > part.place_tolerance:
            raise CaseError(
                f"the point {point} stands {away:.4g} mm from the centre of {part.faces[point]} at "
                f"({round(x, 6):g}, {round(y, 6):g}) mm, more than place_tolerance {part.place_tolerance:g} mm; "
                "leave it out of the link's points"
            )
        if point in places or point not in points:  # what is malformed is left for validation to find
            found[point] = _stated(x, y)
    return found


def _slots_of_part(part: FilePart, stated: dict[str, Any]) -> dict[str, Any]:
    """Return the slots that a part's named bores give its link, whose points are their middles."""
    bores = bores_of(part)
    lengths = {bore.name: bore.slot for bore in bores if bore.slot}
    points = points_of_part(part, bores)
    found: dict[str, Any] = dict(stated)
    for point, name in part.bores.items():
        if name in lengths and isinstance(own := stated.get(point, {}), dict):
            first, last = _stated(*(points[point][0] + side * lengths[name] / 2.0 for side in (-1.0, 1.0)))
            found[point] = {"first": first, "last": last} | own
    return found


def _places(points: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    """Return the points that are well-formed [mm]."""
    found = {}
    for point, at in points.items():
        with suppress(PydanticCustomError, TypeError, ValueError):
            x, y = (parse(size, "length") for size in at)
            found[point] = x, y
    return found


def _stated(x: float, y: float) -> list[str]:
    return [f"{round(x, DIGITS)!r} mm", f"{round(y, DIGITS)!r} mm"]


def pinned(name: str, points: object, slots: object, joints: object) -> tuple[Wanted, ...] | None:
    """Return the points of a link that are pins, or slots in which pins slide.

    Parameters
    ----------
    name : str
        Of the link.
    points, slots, joints : object
        Tables of the case file, not validated.

    Returns
    -------
    tuple of Wanted or None
        None where something is malformed.
    """
    if not isinstance(points, dict) or not isinstance(slots, dict) or not isinstance(joints, dict):
        return None
    found: dict[str, Wanted] = {}
    places = _places(points)
    for joint, stated in joints.items():
        try:
            record = Joint.model_validate(stated)
            if name in record.links:
                if record.pin_diameter is None:
                    return None
                side = record.links.index(name)
                point = record.points[side] if record.points else joint
                wanted = Wanted(name=point, place=places[point], diameter=record.pin_diameter)
                if record.slotted == name:
                    wanted = _slotted(wanted, Slot.model_validate(slots[point]))
                found.setdefault(point, wanted)
        except (ValidationError, KeyError):
            return None
    return tuple(found[point] for point in points if point in found)


def _slotted(point: Wanted, slot: Slot) -> Wanted:
    middle = (slot.first + slot.last) / 2.0, point.place[1]
    return replace(point, place=middle, slot=(slot.first, slot.last), clearance=slot.wider)
