"""A level in a file of its own beside the case, so that whoever owns a standard types its numbers once."""

import hashlib
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.loads.stated.level_spec import IN_FILE
from alula.loads.text.entries import alike
from alula.loads.text.explain import printable
from alula.loads.text.file_text import file_text

Tables = dict[str, Any]
_STATED = re.compile(rf"\blevel\.({'|'.join(IN_FILE)})\b")


def with_level_file(tables: Tables, folder: str, parse: Callable[[str, str], Tables]) -> Tables:
    """Return the tables of a case with what its level file states in place of the file's name.

    Parameters
    ----------
    tables : dict of str to object
        Of a case file, not validated.
    folder : str
        Where the file is sought: that of the case.
    parse : callable
        Returns the tables of a text of TOML, given what sentences call it.

    Returns
    -------
    dict of str to object
        The same where no level names a file.

    Raises
    ------
    CaseError
        For a path instead of a name, a file that cannot be read or is no TOML, and an entry that it must not have.
    """
    level = tables.get("level")
    if not isinstance(level, dict) or not isinstance(level.get("file"), str):
        return tables
    if "read_from" in level:
        raise CaseError(
            "level.file: the case has read its level already, so that a change cannot name another file; write it in "
            "the case file, which has no read_from"
        )
    name = level["file"]
    _refuse_path("level.file", name)
    text = file_text(
        str(Path(folder) / name),
        "level file",
        missing="there is no such file beside the case; put it there, or correct level.file",
        empty="the file is empty; write standard, name, source and tests",
    )
    shown = _shown(name)
    stated = parse(text, shown)
    for key in stated:
        if key not in IN_FILE:
            meant = alike(key, IN_FILE) or f"; a level file has {', '.join(IN_FILE)}, all else stands in the case"
            raise CaseError(f"{shown}: {printable(key)}: this key is unknown{meant}")
        if key in level:
            raise CaseError(f"level.{key}: it stands in {shown} too; state it in one of the two")
    for entry, step in profiled_steps(stated):
        _refuse_path(f"{shown}: {entry}", step["profile"])
    digest = hashlib.sha256(text.encode()).hexdigest()
    rest = {key: value for key, value in level.items() if key != "file"}
    return tables | {"level": rest | stated | {"read_from": f"{name}, SHA-256 {digest}"}}


def profiled_steps(level: object, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the steps of the tests of a level that name the file of a profile.

    Parameters
    ----------
    level : object
        What is stated, not validated.
    path : str, optional
        Of it.

    Yields
    ------
    tuple of (str, dict)
        The entry that names the file, and its table.
    """
    tests = level.get("tests") if isinstance(level, dict) else None
    for name, test in tests.items() if isinstance(tests, dict) else ():
        steps = test.get("steps") if isinstance(test, dict) else None
        for i, step in enumerate(steps if isinstance(steps, list) else ()):
            if isinstance(step, dict) and isinstance(step.get("profile"), str):
                yield f"{path}{'.' if path else ''}tests.{name}.steps.{i}.profile", step


def _refuse_path(entry: str, name: str) -> None:
    if not name or Path(name).name != name or name.startswith(".") or "\0" in name or "\\" in name:
        raise CaseError(f"{entry}: '{printable(name)}' must be the plain name of a file beside the case file")


def in_level_file(sentence: str, tables: Mapping[str, Any]) -> str:
    """Return a sentence on an entry of a case so that it names the level file, where the entry stands in one.

    Parameters
    ----------
    sentence : str
        As it begins with the path of an entry.
    tables : mapping of str to object
        Of the case.

    Returns
    -------
    str
    """
    level = tables.get("level")
    read_from = level.get("read_from") if isinstance(level, dict) else None
    if not isinstance(read_from, str) or not _STATED.match(sentence):
        return sentence
    return f"{_shown(read_from.rpartition(', ')[0])}: " + _STATED.sub(r"\1", sentence)


def _shown(name: str) -> str:
    return f"level file '{printable(name)}'"
