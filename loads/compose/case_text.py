"""The text of the file that states a case."""

from pathlib import Path
from typing import Any

import tomlkit

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.keeping.whole_file import write_whole
from alula.loads.stated.part_points import named_files
from alula.loads.text.explain import printable


def case_text(tables: dict[str, Any]) -> str:
    """Return the text of a case file.

    Parameters
    ----------
    tables : dict of str to object
        As ``tomllib`` reads them.

    Returns
    -------
    str
    """
    return tomlkit.dumps(_with_lines(tables))


def name_files(tables: dict[str, Any], sought: str, folder: Path) -> None:
    """Name the files of a case from another folder: those below it from there, others by their whole path.

    Parameters
    ----------
    tables : dict of str to object
        Of a case; changed in place.
    sought : str
        Folder from which they are named so far.
    folder : Path
        Absolute.
    """
    for _, table, key in named_files(tables):
        table[key] = _named(Path(sought, table[key]).absolute(), folder)


def _named(file: Path, folder: Path) -> str:
    return (file.relative_to(folder) if file.is_relative_to(folder) else file).as_posix()


def _with_lines(value: Any) -> Any:
    """Return tables whose texts of several lines are written in as many."""
    if isinstance(value, dict):
        return {key: _with_lines(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_with_lines(inner) for inner in value]
    several = isinstance(value, str) and "\n" in value
    return tomlkit.string(value, multiline=True) if several else value


def write_case(path: Path, text: str, *, replace: bool) -> None:
    """Write a case file, whole or not at all.

    Parameters
    ----------
    path : Path
        Of the file.
    text : str
        What is to stand in it.
    replace : bool
        True to write over a file that is there.

    Raises
    ------
    CaseError
        For a file that is there, where it must not be written over.
    CannotRunError
        Where the disk refuses.
    """
    shown = printable(str(path))
    try:
        if replace:
            write_whole(path, text.encode())
        else:
            with path.open("x", encoding="utf-8", newline="\n") as file:
                try:
                    file.write(text)
                    file.flush()
                except BaseException:
                    path.unlink()
                    raise
    except FileExistsError:
        raise CaseError(f"'{shown}' is there already; choose another name, or say replace=True") from None
    except OSError as error:
        raise CannotRunError(f"'{shown}' cannot be written: {error.strerror}") from None
