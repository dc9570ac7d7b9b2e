"""Reading a case: a TOML file or a built-in name, overrides, and errors in one sentence each."""

import hashlib
import json
import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from functools import partial
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import BODY_WEIGHT, weight_of
from alula.geometry.base.version import CASE_SCHEMA_VERSION
from alula.geometry.imported.files_read import files_read, note_read, refuse_elsewhere
from alula.loads.acting.cycle import read_cycle
from alula.loads.case.case import Case
from alula.loads.stated.level_file import in_level_file, with_level_file
from alula.loads.stated.part_points import with_part_points
from alula.loads.text.entries import alike, as_meant, names_tables
from alula.loads.text.explain import printable, sentence
from alula.loads.text.file_text import LARGEST_FILE, file_text
from alula.loads.text.nesting import refuse_deep, too_deep
from alula.loads.text.revisable import Origin


class Change(NamedTuple):
    """An entry of a case and its new value; `who` sets it and begins the message where that cannot be."""

    path: str
    value: object
    who: str = "--set"


def built_in_cases() -> tuple[str, ...]:
    """Names of the cases that alula ships."""
    folder = files("alula.loads.cases")
    return tuple(sorted(f.name[:-5] for f in folder.iterdir() if f.name.endswith(".toml")))


def read_case(name_or_path: str, overrides: Sequence[str] = ()) -> Case:
    """Read and validate a case.

    Parameters
    ----------
    name_or_path : str
        Name of a built-in case, or path of a case file.
    overrides : sequence of str
        Other values for some entries, each as ``path=value``.

    Returns
    -------
    Case
        The case; it can be read once more with other values.

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.
    """
    with files_read() as read:
        tables = read_tables(name_or_path)
    return changed_case(tables, stated_changes(overrides), name_or_path, folder_of(name_or_path), read)


def read_tables(name_or_path: str) -> dict[str, Any]:
    """Read the tables of a case or of another TOML file, with those of its level file, without validating them.

    Parameters
    ----------
    name_or_path : str
        Name of a built-in case, or path of a file.

    Returns
    -------
    dict of str to object
        As ``tomllib`` reads them.

    Raises
    ------
    CaseError
        As ``read_text``, for text that is no TOML, and as ``with_level_file``.
    """
    return with_level_file(parse_tables(*read_text(name_or_path)), folder_of(name_or_path), parse_tables)


def parse_tables(text: str, where: str) -> dict[str, Any]:
    """Return the tables that the text of a case states, without validating them.

    Parameters
    ----------
    text : str
        TOML.
    where : str
        What messages call the file.

    Returns
    -------
    dict of str to object
        As ``tomllib`` reads them.

    Raises
    ------
    CaseError
        For text that is no TOML.
    """
    try:
        tables = tomllib.loads(text)
        repr(tables)  # which no sentence could tell, were it one of thousands of hexadecimal digits
    except RecursionError:
        raise too_deep(where) from None
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise CaseError(f"{where}: this is not valid TOML: {printable(str(error))}; {_toml_remedy(error)}") from None
    refuse_deep(tables, where)
    return tables


def _toml_remedy(error: ValueError) -> str:
    if re.match(r"Cannot (declare .* twice|overwrite a value)", str(error)):
        return "TOML takes a heading or an entry once: write its lines under the one that is there, or remove one"
    place = "the end of the file, where something is left open" if "at end of document" in str(error) else "that line"
    return f"correct {place}"


def stated_changes(overrides: Sequence[str]) -> tuple[Change, ...]:
    """Read other values for some entries.

    Parameters
    ----------
    overrides : sequence of str
        Each as ``path=value``; a value that is not TOML is text.

    Returns
    -------
    tuple of Change

    Raises
    ------
    CaseError
        For text of another form.
    """
    return tuple(map(_stated, overrides))


def changed_tables(tables: Mapping[str, Any], changes: Sequence[Change]) -> dict[str, Any]:
    """Return the tables of a case after some changes, with what its tables for sources derive from them.

    Parameters
    ----------
    tables : mapping
        Of a case file; they stay as they are.
    changes : sequence of Change
        In the order in which they are made, whole parts first: ``parts.tube = "rod"`` makes the part ``tube`` what the
        part ``rod`` is in ``tables``, for every link that is made of it.

    Returns
    -------
    dict of str to object
        Not validated yet.

    Raises
    ------
    CaseError
        For an entry that there is not.
    """
    data, changes = _made(tables, changes)
    derived = Case.derived(data)
    for table, entries in derived.items():
        for path, value in entries.items():
            _override(data, Change(path, value, f"{table} sets"))
    for change in changes if derived else ():  # what is stated outright wins
        _override(data, change)
    return data


def stated_tables(tables: Mapping[str, Any], changes: Sequence[Change]) -> dict[str, Any]:
    """Return the tables of a case after some changes, as a user would state them: without what derives from them.

    Parameters
    ----------
    tables : mapping
        Of a case file; they stay as they are.
    changes : sequence of Change
        As for ``changed_tables``.

    Returns
    -------
    dict of str to object

    Raises
    ------
    CaseError
        For an entry that there is not.
    """
    return _made(tables, changes)[0]


def _made(tables: Mapping[str, Any], changes: Sequence[Change]) -> tuple[dict[str, Any], list[Change]]:
    """Return a copy of tables with changes made, and the changes in the order in which they were."""
    data = deepcopy(dict(tables))
    made = sorted((_of_catalogue(data, change) for change in changes), key=lambda change: not _is_part(change.path))
    for change in made:
        _override(data, change)
    return data, made


def changed_case(
    tables: dict[str, Any],
    changes: Sequence[Change],
    name: str,
    folder: str,
    read: Mapping[str, str] = MappingProxyType({}),
) -> Case:
    """Return the case that tables state after some changes, which later ones can be added to.

    Parameters
    ----------
    tables : dict of str to object
        Of a case file.
    changes : sequence of Change
        As for ``changed_tables``.
    name : str
        Path or built-in name that they were read from; "" where they were put together in Python.
    folder : str
        Where the files of parts are sought.
    read : mapping of str to str, optional
        Files that the tables were read from: path, or built-in name -> SHA-256.

    Returns
    -------
    Case

    Raises
    ------
    CaseError
        As ``changed_tables`` and ``validate``.
    """
    with files_read() as found:
        case = validate(changed_tables(tables, changes), folder)
    of_tables = hashlib.sha256(json.dumps(tables, sort_keys=True, default=str).encode()).hexdigest()
    return case.read_from(
        Origin(
            name=name,
            revise=partial(_revised, tables, tuple(changes), name, folder, dict(read)),
            changes=tuple((change.path, _as_stated(change.value)) for change in changes),
            digest=read.get(name, of_tables),
            files={_from(folder, path): own for path, own in {**read, **found}.items() if path != name},
        )
    )


def _from(folder: str, path: str) -> str:
    """Return the path of a file from a folder, with slashes; its name alone where there is none."""
    try:
        return Path(os.path.relpath(path, folder or ".")).as_posix()
    except ValueError:  # on another drive
        return Path(path).name


def _as_stated(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)


def _revised(
    tables: dict[str, Any],
    changes: Sequence[Change],
    name: str,
    folder: str,
    read: Mapping[str, str],
    values: Mapping[str, object],
) -> Case:
    more = (Change(path, value, "with_values") for path, value in values.items())
    return changed_case(tables, [*changes, *more], name, folder, read)


def read_text(name_or_path: str) -> tuple[str, str]:
    """Read the text of a case.

    Parameters
    ----------
    name_or_path : str
        Name of a built-in case, or path of a case file.

    Returns
    -------
    tuple of str
        The text, and what messages call the file.

    Raises
    ------
    CaseError
        For a file that is missing, too large, unreadable, empty or no text.
    """
    if name_or_path in built_in_cases():
        content = files("alula.loads.cases").joinpath(f"{name_or_path}.toml").read_bytes()
        note_read(name_or_path, hashlib.sha256(content).hexdigest())
        return content.decode("utf-8"), name_or_path
    text = file_text(
        name_or_path,
        "case",
        missing="there is no such file or built-in case; give a path to a case file or one of "
        + ", ".join(built_in_cases())
        + alike(name_or_path, built_in_cases()),
        empty="the file is empty; start from 'alula new'",
    )
    return text, printable(Path(name_or_path).name)


def read_companion(case_path: str, name: str) -> str:
    """Read a text file that stands beside a case file, or ships with a built-in case.

    Parameters
    ----------
    case_path : str
        Name of a built-in case, or path of a case file.
    name : str
        Plain name of the file beside it.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    CaseError
        For a path instead of a name, and for a file that cannot be read.
    """
    if Path(name).name != name or name.startswith("."):
        raise CaseError(f"'{printable(name)}' must be the plain name of a file beside the case file")
    built_in = case_path in built_in_cases()
    source = files("alula.loads.cases").joinpath(name) if built_in else Path(case_path).parent / name
    refuse_elsewhere(str(source))
    try:
        if source.is_file() and (built_in or Path(str(source)).stat().st_size <= LARGEST_FILE):
            content = source.read_bytes()
            text = content.decode("utf-8-sig").replace("\r\n", "\n")
            note_read(str(source), hashlib.sha256(content).hexdigest())
            return text
    except (OSError, ValueError):  # no permission, a name too long, not UTF-8
        pass
    raise CaseError(f"'{printable(name)}' is not a readable file beside the case file; put it there")


def folder_of(name: str) -> str:
    """Return the folder in which the files of a case's parts are sought.

    Parameters
    ----------
    name : str
        Built-in name or path of the case.

    Returns
    -------
    str
    """
    return str(files("alula.loads.cases")) if name in built_in_cases() else str(Path(name).parent)


def validate(data: dict[str, Any], folder: str = "") -> Case:
    """Validate a case.

    Parameters
    ----------
    data : dict of str to object
        The case as nested tables, as ``tomllib`` reads them.
    folder : str
        Where the files of its parts are sought; the present one unless given.

    Returns
    -------
    Case
        The case.

    Raises
    ------
    CaseError
        With one sentence for the first problem.
    """
    refuse_deep(data, "case")
    _check_version(data)
    data = with_level_file(data, folder, parse_tables)
    cycle = read_cycle(data, folder)
    context = {"folder": folder, "cycle": cycle, BODY_WEIGHT: weight_of(data.get("body_mass"))}
    tables = with_part_points(data if cycle is None else cycle.tables, context)
    try:
        return Case.model_validate(tables, context=context)
    except ValidationError as error:
        raise CaseError(in_level_file(sentence(error, Case), data)) from None


def _check_version(data: Mapping[str, Any]) -> None:
    """Refuse a case of another version of the format; ``docs/versions.md`` says what changes it."""
    remedy = f"write schema_version = {CASE_SCHEMA_VERSION}"
    if "schema_version" not in data:
        for key in data:
            if meant := alike(key, ("schema_version",)):
                raise CaseError(f"{printable(key)}: this key is unknown{meant}")
        raise CaseError(f"schema_version: it is missing; {remedy}, the version of the case file's format")
    stated = data["schema_version"]
    shown = printable(repr(stated))
    if type(stated) is int and stated > CASE_SCHEMA_VERSION:
        raise CaseError(
            f"schema_version: the case is written in version {shown} of the format, but this alula reads version "
            f"{CASE_SCHEMA_VERSION}; install a newer alula"
        )
    if type(stated) is not int or stated != CASE_SCHEMA_VERSION:
        raise CaseError(f"schema_version: it is {shown}, but there is no such version of the format; {remedy}")


def _stated(override: str) -> Change:
    """Read ``path=value``; a value that is not TOML is text."""
    path, sign, text = override.partition("=")
    try:
        override.encode()
    except UnicodeEncodeError:  # what a terminal hands over of bytes that are no text
        raise CaseError(f"--set '{printable(override)}': it is not UTF-8 text; write it in UTF-8") from None
    if not sign or not all(keys_of(path)):
        raise CaseError(f"--set '{printable(override)}': write it as path=value, for example pose.angle=\"30 deg\"")
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        value = text.strip()
    return Change(path.strip(), value)


def keys_of(path: str) -> list[str]:
    """Return the keys of the path of an entry.

    Parameters
    ----------
    path : str
        With dots; keys may stand in quotes.

    Returns
    -------
    list of str
    """
    return [key.strip().strip("\"'") for key in path.strip().split(".")]


def _is_part(path: str) -> bool:
    keys = keys_of(path)
    return len(keys) == 2 and keys[0] == "parts"


def _of_catalogue(data: dict[str, Any], change: Change) -> Change:
    """Return a change of a part to another one by its name as the change to that one's table."""
    parts = data.get("parts")
    if not (_is_part(change.path) and isinstance(change.value, str) and isinstance(parts, dict)):
        return change
    if not isinstance(parts.get(change.value), dict):
        known = ", ".join(sorted(printable(name) for name in parts))
        raise CaseError(
            f"{change.who} {printable(change.path)}: the case has no part '{printable(change.value)}'; "
            f"choose among {known}"
        )
    return change._replace(value=deepcopy(parts[change.value]))


def _override(data: dict[str, Any], change: Change) -> None:
    """Set an entry anew.

    A name that the case does not have is refused where names stand for tables or points: mistyped, it would add one
    beside the one that is meant, and change nothing else.
    """
    path, who = change.path, change.who
    keys = keys_of(path)
    if not all(keys):
        raise CaseError(f"{who} '{printable(path)}': write keys with dots between them, for example pose.angle")
    refuse_deep(change.value, f"{who} {printable(path)}", above=len(keys))
    here: Any = data
    for i, key in enumerate(keys):
        last = i == len(keys) - 1
        if isinstance(here, list):
            if not (key.isascii() and key.isdigit() and len(key) < 6 and int(key) < len(here)):
                raise CaseError(
                    f"{who} {printable(path)}: '{printable(key)}' does not name one of the {len(here)} entries of this "
                    "list; the first one is 0"
                )
            index: Any = int(key)
        elif isinstance(here, dict):
            index = key
            if key not in here and names_tables(Case, keys[:i]):
                there = printable(".".join(keys[:i]))
                remedy = alike(key, here) or f"; correct the name, or add '{printable(key)}' to the case file"
                raise CaseError(f"{who} {printable(path)}: '{there}' has no '{printable(key)}' to change{remedy}")
            if not last and key not in here:
                here[key] = {}
        else:
            above = printable(".".join(keys[:i]))
            raise CaseError(
                f"{who} {printable(path)}: '{above}' is a value, so nothing can be set below it; correct the path"
            )
        if last:
            here[index] = deepcopy(as_meant(Case, keys, change.value))  # a later change may be about a part of it
        else:
            here = here[index]
