"""Names in a case, and all entries that refer to them: what a rename changes, and what a removal takes along."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name
from alula.loads.case.case_file import keys_of
from alula.reports.workbench.editing.toml_text import Path, TomlText, value_at

BY_KEY = {
    **dict.fromkeys(("near", "fit", "clearance"), "links"),
    **dict.fromkeys(("slots", "arms", "eyes", "bores", "faces"), "points"),
}
"""Key of a table -> what its own keys name."""
BY_VALUE = {
    **dict.fromkeys(("link", "links", "massless", "tight_in", "instant_centre", "against"), "links"),
    **dict.fromkeys(("joint", "joints", "crank_pivot", "crank_pin", "rocker_pin", "rocker_pivot"), "joints"),
    **dict.fromkeys(("at", "start", "end", "held_at", "points"), "points"),
    **dict.fromkeys(("material", "pin_material"), "materials"),
    "part": "parts",
    "load_case": "load_cases",
    "coordinate": "links",
}
"""Key of an entry -> what its text, or the texts of its list, name. A test holds both against the records."""
NAMED = (
    *("links", "joints", "parts", "materials", "load_cases", "checks"),
    *("springs", "tendons", "stops", "hand_calculations"),
)
"""Tables whose keys are names that a user chose."""


class Reference(NamedTuple):
    """An entry that names something.

    Attributes
    ----------
    path : tuple
        Of the entry.
    kind : str
        The table of what is named, or "points".
    name : str
        The name.
    links : tuple of str
        Of a point: the link that has it; several where the entry does not say which.
    by_key : bool
        Whether the entry's own key is the name.
    """

    path: Path
    kind: str
    name: str
    links: tuple[str, ...] = ()
    by_key: bool = False


def references(tables: Mapping[str, Any], there: Any = None, path: Path = ()) -> Iterator[Reference]:
    """Yield all entries that name a link, joint, point, part, material or load case.

    Parameters
    ----------
    tables : mapping
        Of a case.
    there : object, optional
        What is looked into; the whole case unless given.
    path : tuple
        Its path.

    Yields
    ------
    Reference
    """
    there = there if path else tables
    inner = there.items() if isinstance(there, dict) else enumerate(there) if isinstance(there, list) else ()
    for key, value in inner:
        here, named = (*path, key), path[:1] == path and path and path[0] in NAMED
        table, text = BY_KEY.get(str(key)), BY_VALUE.get(str(key))
        if named or key == "tolerances" or (not path and key in NAMED):
            pass
        elif table and isinstance(value, dict):
            for one, foot in value.items():
                yield Reference((*here, one), table, one, _owners(tables, there, here), True)
                if key == "arms":
                    yield Reference((*here, one), table, foot, _owners(tables, there, here))
            continue
        elif text and isinstance(value, str):
            kind = "joints" if key == "coordinate" and "travel" in there else text
            yield Reference(here, kind, value, _owners(tables, there, here))
        elif text and isinstance(value, list):
            for n, one in enumerate(value):
                yield Reference((*here, n), text, one, _owners(tables, there, (*here, n)))
            continue
        if key != "tolerances" and here[2:] != ("points",):
            yield from references(tables, value, here)


def _owners(tables: Mapping[str, Any], record: Any, path: Path) -> tuple[str, ...]:
    """Return the links that may have the point which an entry of a record names."""
    links = tables.get("links", {})
    if path[0] == "links":
        return (str(path[1]),)
    if path[0] == "joints":
        return (str(record["links"][path[-1]]),) if isinstance(path[-1], int) else ()
    if path[0] == "parts":
        return tuple(name for name, link in links.items() if link.get("part") == path[1])
    return (record["link"],) if "link" in record else tuple(links)


def _of_point(tables: Mapping[str, Any], link: str, name: str) -> list[Reference]:
    """Return what refers to a point of a link; not what may mean that of another moving link."""
    moving = {one: table for one, table in tables["links"].items() if one != link and not table.get("ground")}
    others = {one for one, table in moving.items() if name in table.get("points", {})}
    found = (one for one in references(tables) if one.kind == "points" and one.name == name and link in one.links)
    return [one for one in found if len(one.links) == 1 or not others & {*one.links}]


def _of_own_name(tables: Mapping[str, Any], link: str, name: str) -> bool:
    """Whether a joint stands at a point of a link because it has its name."""
    joint = value_at(tables, ("joints", name))
    return isinstance(joint, dict) and "points" not in joint and link in joint.get("links", ())


def rename(draft: TomlText, path: Path, to: str) -> None:
    """Give a link, joint, point, part, material, load case, check, spring or stop another name, wherever it is named.

    A joint takes the points along that have its name, a point no joint. Texts, such as assumptions, stay as they are.

    Parameters
    ----------
    draft : TomlText
        The case.
    path : tuple
        Such as ("links", "crank") or ("links", "crank", "points", "A").
    to : str
        The new name.

    Raises
    ------
    CaseError
        For a name that is taken, and where nothing has the old one.
    """
    name, told = str(path[-1]), ".".join(map(str, path))
    if _is_point(path):
        _rename_point(draft, str(path[1]), name, to, "")
        return
    if not (len(path) == 2 and path[0] in NAMED) or value_at(draft.tables, path) is None:
        raise CaseError(f"edit {told}: there is nothing of this name; choose one that is there")
    free(draft, path, to)
    if path[0] == "joints" and "points" not in value_at(draft.tables, path):
        links = value_at(draft.tables, (*path, "links"))
        if any(value_at(draft.tables, ("links", link, "points", to)) is not None for link in links):
            draft.put((*path, "points"), [name, name])
        else:
            for link in links:
                _rename_point(draft, link, name, to, name)
    for one in references(draft.tables):
        if one.kind == path[0] and one.name == name:
            draft.rename(one.path, to) if one.by_key else draft.put(one.path, to)
    draft.rename(path, to)
    _rename_tolerances(draft, path, to)


def _rename_point(draft: TomlText, link: str, name: str, to: str, joint: str) -> None:
    """Rename a point of a link; a joint that has its name, but for one that is renamed too, states its points then."""
    path = ("links", link, "points", name)
    if value_at(draft.tables, path) is None:
        raise CaseError(f"edit {'.'.join(path)}: there is no such point; choose one of the link's points")
    free(draft, path, to)
    if _of_own_name(draft.tables, link, name) and name != joint:
        links = draft.tables["joints"][name]["links"]
        draft.put(("joints", name, "points"), [to if one == link else name for one in links])
    for one in _of_point(draft.tables, link, name):
        draft.rename(one.path, to) if one.by_key else draft.put(one.path, to)
    draft.rename(path, to)
    _rename_tolerances(draft, path, to)


def hand_over(draft: TomlText, link: str, point: str, to: str, name: str) -> None:
    """Let all that refers to a point of a link refer to one of another link, and remove the point.

    Parameters
    ----------
    draft : TomlText
        The case.
    link, point : str
        Whose point it is so far.
    to, name : str
        The other link, and the point of it that is there already.

    Raises
    ------
    CaseError
        For a joint that would be of one link alone.
    """
    found: list[tuple[Path, str | None]] = [(one.path, None) for one in _of_point(draft.tables, link, point)]
    if _of_own_name(draft.tables, link, point):
        found.append((("joints", point, "links", draft.tables["joints"][point]["links"].index(link)), point))
    for path, joint in found:
        if path[0] == "joints":
            links = list(draft.tables["joints"][path[1]]["links"])
            if to in links:
                raise CaseError(f"joints.{path[1]}: it would join '{to}' to itself; give the point to a third link")
            draft.put((*path[:2], "links"), [to if n == path[-1] else one for n, one in enumerate(links)])
            if joint is None or joint != name:
                points = draft.tables["joints"][path[1]].get("points", [joint, joint])
                draft.put((*path[:2], "points"), [name if n == path[-1] else one for n, one in enumerate(points)])
        elif value_at(draft.tables, (*path[:-1], "link")) == link:
            draft.put((*path[:-1], "link"), to)
            draft.put(path, name)
    draft.remove(("links", link, "points", point))
    held = value_at(draft.tables, ("tolerances",)) or {}
    for entry, keys in _toleranced(draft, ("links", link, "points", point)):
        other = ".".join(["links", to, "points", name, *keys[4:]])
        draft.remove(("tolerances", entry)) if other in held else draft.rename(("tolerances", entry), other)


def _is_point(path: Path) -> bool:
    return len(path) == 4 and path[0] == "links" and path[2] == "points"


def free(draft: TomlText, path: Path, to: str) -> None:
    """Refuse a new name that is none, or that another has.

    Parameters
    ----------
    draft : TomlText
        The case.
    path : tuple
        Of what is named, or would be with an old name.
    to : str
        The name.

    Raises
    ------
    CaseError
        For such a name.
    """
    try:
        TypeAdapter(Name).validate_python(to)
    except ValidationError as wrong:
        raise CaseError(f"edit {'.'.join(map(str, path))}: {wrong.errors()[0]['msg']}") from None
    if to != path[-1] and value_at(draft.tables, (*path[:-1], to)) is not None:
        raise CaseError(f"edit {'.'.join(map(str, path))}: '{to}' is there already; choose another name")


def _rename_tolerances(draft: TomlText, path: Path, to: str) -> None:
    """Rename within the paths of [tolerances]."""
    for entry, keys in _toleranced(draft, path):
        draft.rename(("tolerances", entry), ".".join([*keys[: len(path) - 1], to, *keys[len(path) :]]))


def _toleranced(draft: TomlText, path: Path) -> list[tuple[str, list[str]]]:
    """Entries of [tolerances] that begin with a path, with their keys."""
    every = [(entry, list(map(str, keys_of(entry)))) for entry in value_at(draft.tables, ("tolerances",)) or ()]
    return [(entry, keys) for entry, keys in every if keys[: len(path)] == list(map(str, path))]


def _remove_tolerances(draft: TomlText, path: Path) -> None:
    """Remove tolerances of what was removed; those behind it in a list go with what they are of."""
    for entry, _ in _toleranced(draft, path):
        draft.remove(("tolerances", entry))
    place = path[-1]
    if isinstance(place, int):
        n = len(path) - 1
        behind = [(int(keys[n]), entry, keys) for entry, keys in _toleranced(draft, path[:-1]) if len(keys) > n]
        for number, entry, keys in sorted(one for one in behind if one[0] > place):
            draft.rename(("tolerances", entry), ".".join([*keys[:n], str(number - 1), *keys[n + 1 :]]))


def remove(draft: TomlText, path: Path) -> None:
    """Remove an entry, with the records that cannot be without it.

    A link takes its joints along, a joint what acts about it or drives there, a point the loads and masses at it; a
    check that was of removed links alone goes too, and so do tolerances. The points of a removed joint stay.

    Parameters
    ----------
    draft : TomlText
        The case.
    path : tuple
        Of the entry.

    Raises
    ------
    CaseError
        For a material of which parts are made.
    """
    name, gone, tables = str(path[-1]), [path], draft.tables
    found: list[Reference] = []
    if value_at(tables, path) is not None and _is_point(path):
        found = _of_point(tables, str(path[1]), name)
        gone += [("joints", name)] if _of_own_name(tables, str(path[1]), name) else []
    elif value_at(tables, path) is not None and len(path) == 2 and path[0] in NAMED:
        found = [one for one in references(tables) if one.kind == path[0] and one.name == name]
    if found and path[0] == "materials":
        where = ".".join(map(str, found[0].path))
        raise CaseError(f"edit materials.{name}: {where} is made of it; choose another material there first")
    gone += [_record(tables, one) for one in found]
    tops = [one for one in dict.fromkeys(gone) if not any(one[: len(other)] == other for other in gone if other != one)]
    for one in sorted(tops, key=lambda one: [key if isinstance(key, int) else -1 for key in one], reverse=True):
        if len(one) == 2 and one[0] == "joints" and one != path:
            remove(draft, one)
        else:
            draft.remove(one)
            _remove_tolerances(draft, one)


def _record(tables: Mapping[str, Any], one: Reference) -> Path:
    """Return the path of what goes with a reference: its key, its place in a list, or its whole record."""
    path, table = one.path, one.path[0]
    if one.by_key or table in ("pose", "motion", "massless", "links"):
        return path
    if table in ("drive", "flapping_wing", "ways_to_hold", "published_statics"):
        return path[:1]
    names = value_at(tables, path[:-1])
    several = isinstance(names, list) and len(names) > 1
    if table in NAMED and table != "load_cases" and not (table == "checks" and several):
        return path[:2]
    if path[-2] == "leaves":  # a load line that lost its far end would go to the ground
        return path[:-2]
    return path if isinstance(names, list) else path[:-1]
