"""Operations of the drawing on a case: each becomes a few changes of entries."""

import cmath
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.case_file import keys_of
from alula.loads.compose.starting import shipped
from alula.loads.stated.part_points import KINDS
from alula.loads.text.nesting import refuse_deep
from alula.reports.workbench.editing.moves import lengthen, move, turn
from alula.reports.workbench.editing.plane import SAME, Plane, Point, told
from alula.reports.workbench.editing.references import free, hand_over, remove, rename
from alula.reports.workbench.editing.toml_text import TomlText, value_at

EMPTY = shipped("alula.loads.plans", "starter-linkage.toml.txt").decode()
"""A case to start a drawing from: ground, part and checks; links, joints and loads are missing."""
BAR = tomllib.loads(EMPTY)["parts"]["bar"]
"""Part and, below, pins of the built-in six-bar, for the first link and joint of a case. On bars of this width a load's
usual patch of 5 mm is within what hand calculation is calibrated for."""
PIN = "3 mm"
OF_PIN = ("pin_diameter", "pin_material", "pin_gap", "friction", "friction_range", "tight_in", "clearance", "fit")
"""Entries of a joint that one beside it takes over."""


def perform(draft: TomlText, operation: Mapping[str, Any], pose: Pose | None) -> None:
    """Make one edit.

    Parameters
    ----------
    draft : TomlText
        The case.
    operation : mapping
        "op" and what it needs: set, append, remove, rename, move, length, turn, link, join, hand, load, layer,
        ground.
        Places are [x, y] in mm in the pose shown, angles in degrees.
    pose : Pose, optional
        The pose shown.

    Raises
    ------
    CaseError
        For an operation that cannot be made, or is none.
    """
    before = draft.tables
    refuse_deep(operation, "edit")
    try:
        _perform(draft, operation, pose)
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError, StopIteration):  # of another form
        raise CaseError(f"edit {operation.get('op')}: it does not fit the case; undo, or correct the text") from None
    shaped = operation.get("op") in ("move", "length", "rename")
    for table, entries in Case.derived(draft.tables).items() if shaped else ():
        for path in entries:
            keys = keys_of(path)
            if value_at(before, keys) != value_at(draft.tables, keys):
                raise CaseError(f"{path}: the table {table} sets it; change {table} in the text, or remove that table")


def _perform(draft: TomlText, operation: Mapping[str, Any], pose: Pose | None) -> None:
    match operation:
        case {"op": "set", "path": [*path], "value": value}:
            draft.put(path, value)
        case {"op": "append", "path": [*path], "value": value}:
            draft.put((*path, len(value_at(draft.tables, path) or ())), value)
        case {"op": "remove", "path": [*path]}:
            remove(draft, tuple(path))
        case {"op": "rename", "path": [*path], "to": str(to)}:
            rename(draft, tuple(path), to)
        case {"op": "move", "to": [x, y]}:
            plane = Plane(draft.tables, pose)
            move(draft, plane, _end(draft, plane, operation), complex(x, y))
        case {"op": "length", "link": str(link), "points": [first, second], "value": str(value)}:
            lengthen(draft, Plane(draft.tables, pose), link, (first, second), value)
        case {"op": "turn", "to": int() | float() as to}:
            turn(draft, to)
        case {"op": "link", "from": start, "to": end}:
            _link(draft, pose, operation, start, end)
        case {"op": "join", "ends": [first, second]}:
            _join(draft, pose, first, second)
        case {"op": "hand", "link": str(link), "point": str(point), "to": str(to)}:
            _hand(draft, Plane(draft.tables, pose), (link, point), to)
        case {"op": "load", "load_case": str(name), "link": str(link), "point": str(point), "force": [*force]}:
            Plane(draft.tables).place(link, point)
            forces = value_at(draft.tables, ("load_cases", name, "forces")) or []
            load = {"link": link, "at": point, "force": force}
            draft.put(("load_cases", name, "forces"), [*forces, load])
        case {"op": "layer", "link": str(link), "to": int(to)}:
            _layer(draft, link, to)
        case {"op": "ground", "at": [x, y]}:
            _ground_point(draft, Plane(draft.tables), complex(x, y))
        case _:
            raise CaseError(f"edit: '{operation.get('op')}' is no operation, or something of it is missing")


def _names(tables: Mapping[str, Any]) -> Iterator[str]:
    """Yield names A, B, ... Z, A2, ... that neither a joint nor a point has."""
    taken = set(tables.get("joints", {})).union(*(link.get("points", {}) for link in tables.get("links", {}).values()))
    for number in range(1, 1000):
        for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ":
            name = letter + (str(number) if number > 1 else "")
            if name not in taken:
                yield name


def _ground_point(draft: TomlText, plane: Plane, at: complex) -> Point:
    name = next(_names(draft.tables))
    if not plane.ground:
        raise CaseError("links: no link is the ground; write ground = true in one")
    draft.put(("links", plane.ground, "points", name), [told(at.real, "length"), told(at.imag, "length")])
    return plane.ground, name


def _end(draft: TomlText, plane: Plane, end: Mapping[str, Any]) -> Point:
    """Return link and point of an end on what is there; a new point of the ground is made."""
    match end:
        case {"joint": str(joint)}:
            if joint not in plane.joints:
                raise CaseError(f"joints.{joint}: there is no such joint; choose one that is there")
            first, second = plane.ends[joint]
            return second if plane.joints[joint].slides else first
        case {"link": str(link), "point": str(point)}:
            plane.place(link, point)
            return link, point
        case {"ground": [x, y]}:
            return _ground_point(draft, plane, complex(x, y))
    raise CaseError("edit: an end is a joint, a point of a link, a place of the ground, or a free place of a new link")


def _link(draft: TomlText, pose: Pose | None, operation: Mapping[str, Any], *ends: Mapping[str, Any]) -> None:
    """Draw a link; the first that is drawn from the ground turns the linkage, unless something does already."""
    plane = Plane(draft.tables, pose)
    keys = [None if "at" in end else _end(draft, plane, end) for end in ends]
    if keys == [None, None]:
        raise CaseError("edit link: it hangs nowhere; begin it at the ground, at a joint or at a point of another link")
    if keys[0] and keys[1] and keys[0][0] == keys[1][0]:
        raise CaseError(f"edit link: both ends are on link '{keys[0][0]}'; end it on another link")
    plane = Plane(draft.tables, pose)
    first, last = (plane.place(*key) if key else complex(*end["at"]) for key, end in zip(keys, ends, strict=True))
    if abs(last - first) < SAME:
        raise CaseError("edit link: it has no length; end it elsewhere")
    links = draft.tables.get("links", {})
    name = operation.get("name") or next(n for i in range(1, 1000) if (n := f"link-{i}") not in links)
    free(draft, ("links", ""), name)
    parts = draft.tables.get("parts", {})
    part = operation.get("part") or next((n for n, one in parts.items() if one.get("shape") in ("bar", "tube")), None)
    if part is None:
        part = next(n for n in ("bar", "bar-2", "bar-3") if n not in parts)
        draft.put(("parts", part), BAR)
    fresh, points = _names(draft.tables), []
    for key in keys:
        own = key is not None and key[1] not in draft.tables.get("joints", {})
        points.append(key[1] if key and own and key[1] not in points else next(n for n in fresh if n not in points))
    table: dict[str, Any] = {"part": part}
    if any("layer" in link for link in links.values()):
        beside = {links[key[0]].get("layer") for key in keys if key}
        layers = [link["layer"] for link in links.values() if "layer" in link]
        table["layer"] = next(n for n in range(min(layers), max(layers) + 2) if n not in beside)
    length = told(abs(last - first), "length")
    draft.put(("links", name), table | {"points": {points[0]: ["0 mm", "0 mm"], points[1]: [length, "0 mm"]}})
    direction = told(cmath.phase(last - first), "angle")
    for key, point in zip(keys, points, strict=True):
        if key is not None:
            _joint(draft, plane, key, (name, point))
    if "coordinate" in draft.tables.get("pose", {}) or plane.ground not in [key[0] for key in keys if key]:
        draft.put(("pose", "near", name), direction)
        return
    draft.put(("pose", "coordinate"), name)
    draft.put(("pose", "angle"), direction)
    if "drive" not in draft.tables:
        joints = draft.tables["joints"].items()
        shaft = next(joint for joint, one in joints if set(one["links"]) == {plane.ground, name})
        draft.put(("drive",), {"link": name, "joint": shaft})


def _joint(draft: TomlText, plane: Plane, first: Point, second: Point) -> None:
    """Add a joint of two points, with what joints beside it state: one at the same hole, or the first of the case."""
    alike = [name for end in (first, second) for name in plane.joints if end in plane.ends[name]] + [*plane.joints]
    models = [name for name in alike if not plane.joints[name].slides and not plane.joints[name].fixed]
    model = draft.tables["joints"][models[0]] if models else {"links": ["", ""], "pin_diameter": PIN}
    links = dict(zip(model["links"], (first[0], second[0]), strict=True))
    if model["links"][1] == first[0] or model["links"][0] == second[0]:
        links = dict(zip(model["links"], (second[0], first[0]), strict=True))
    named = first[1] == second[1] and first[1] not in draft.tables.get("joints", {})
    name = first[1] if named else second[1] if second[1] not in draft.tables.get("joints", {}) else None
    name = name or next(_names(draft.tables))
    kept: dict[str, Any] = {"links": [first[0], second[0]]}
    if not named:
        kept["points"] = [first[1], second[1]]
    for key in OF_PIN:
        value = model.get(key)
        if isinstance(value, dict):
            value = {links[link]: one for link, one in value.items() if link in links}
        elif key == "tight_in" and value is not None:
            value = [links[link] for link in ([value] if isinstance(value, str) else value) if link in links]
        if value is not None:
            kept[key] = value
    draft.put(("joints", name), kept)


def _join(draft: TomlText, pose: Pose | None, first: Mapping[str, Any], second: Mapping[str, Any]) -> None:
    """Bring two points of different links together in a joint; the second moves, unless it alone is a joint."""
    plane = Plane(draft.tables, pose)
    one, other = _end(draft, plane, first), _end(draft, plane, second)
    if one[0] == other[0]:
        raise CaseError(f"edit join: both points are of link '{one[0]}'; choose points of two links")
    plane = Plane(draft.tables, pose)
    if plane.node[one] == plane.node[other]:
        raise CaseError(f"edit join: the points are joined already; choose another than {other[0]}.{other[1]}")
    held = {end for ends in plane.ends.values() for end in ends}
    still, moved = (other, one) if other in held and one not in held else (one, other)
    if abs(plane.place(*moved) - plane.place(*still)) > SAME:
        move(draft, plane, moved, plane.place(*still))
    _joint(draft, plane, one, other)


def _hand(draft: TomlText, plane: Plane, key: Point, to: str) -> None:
    """Give a point to another link, at the place where it is; on a straight one at the nearest place of its axis."""
    place = plane.place(*key)
    if to not in plane.links or to == key[0]:
        raise CaseError(f"edit hand: '{to}' is no other link; choose one that is there")
    if {plane.shapes[key[0]], plane.shapes[to]} & {*KINDS}:
        raise CaseError("edit hand: points of a part from a file come from its bores; change that file, or the part")
    origin, angle = plane.frames[to]
    at = (place - origin) / cmath.rect(1.0, angle)
    at = complex(at.real, 0.0) if to in plane.straight else at
    taken = draft.tables["links"][to].get("points", {})
    name = key[1] if key[1] not in taken else next(_names(draft.tables))
    draft.put(("links", to, "points", name), [told(at.real, "length"), told(at.imag, "length")])
    hand_over(draft, *key, to, name)


def _layer(draft: TomlText, link: str, to: int) -> None:
    """Lay a link in a layer; where none has one so far, the others lie in layer 0, with washers as starters have."""
    links = draft.tables.get("links", {})
    if link not in links:
        raise CaseError(f"links.{link}: there is no such link; choose one that is there")
    if not any("layer" in one for one in links.values()):
        for name in links:
            draft.put(("links", name, "layer"), 0)
        if not {"layer_spacing", "washer"} & draft.tables.keys():
            draft.put(("washer",), "0.5 mm")
    draft.put(("links", link, "layer"), to)
