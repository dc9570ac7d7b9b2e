"""The files that a case of one's own starts from: a built-in case with what it names, written where nothing stands."""

import itertools
import os
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path

from alula.geometry.base.errors import CaseError, unwritable
from alula.loads.case.case_file import built_in_cases, read_tables
from alula.loads.text.entries import alike
from alula.loads.text.explain import printable


def case_files(name: str, path: Path) -> dict[Path, bytes]:
    """Return what a case of one's own starts from: a built-in case, and beside it the files that it names.

    Parameters
    ----------
    name : str
        Of the built-in case.
    path : Path
        Where the case is to stand.

    Returns
    -------
    dict of Path to bytes
        The case first. A file that stands there already as it ships is left out; beside one of its name with another
        content it gets another name, in the case too.

    Raises
    ------
    CaseError
        For a name that is no built-in case, and for a path with the name of a file that the case names.
    """
    if name not in built_in_cases():
        meant = alike(name, built_in_cases()) or "; alula new --list shows the names"
        raise CaseError(f"--from: there is no built-in case '{printable(name)}'{meant}")
    known = {file.name for file in files("alula.loads.cases").iterdir()}
    beside = [text for text in _texts(read_tables(name)) if text in known]
    if path.name in beside:
        raise CaseError(f"PATH: '{printable(path.name)}' is a file that the case names; choose another name")
    case, companions = shipped("alula.loads.cases", f"{name}.toml"), dict[Path, bytes]()
    for file in beside:
        content = shipped("alula.loads.cases", file)
        place = place_for(path.parent / file, content)
        case = case.replace(f'"{file}"'.encode(), f'"{place.name}"'.encode())
        if not place.exists():
            companions[place] = content
    return {path: case, **companions}


def place_for(file: Path, content: bytes) -> Path:
    """Return where a file with this content may stand: its own place, unless something else stands there.

    Parameters
    ----------
    file : Path
    content : bytes

    Returns
    -------
    Path
        Where nothing stands, or a file of this content.
    """
    places = itertools.chain([file], (file.with_stem(f"{file.stem}-{k}") for k in itertools.count(2)))
    return next(p for p in places if not os.path.lexists(p) or (p.is_file() and p.read_bytes() == content))


def _texts(entry: object) -> Iterator[str]:
    """Yield all texts in the tables of a case."""
    if isinstance(entry, str):
        yield entry
    elif isinstance(entry, Mapping):
        yield from _texts(list(entry.values()))
    elif isinstance(entry, list):
        for part in entry:
            yield from _texts(part)


def shipped(package: str, name: str) -> bytes:
    """Return a file that alula ships.

    Parameters
    ----------
    package : str
        In which it stands.
    name : str

    Returns
    -------
    bytes
    """
    return files(package).joinpath(name).read_bytes()


def write_new(contents: Mapping[Path, bytes]) -> None:
    """Write files that are not there yet: all of them, or none.

    Parameters
    ----------
    contents : mapping of Path to bytes
        By where they go.

    Raises
    ------
    CaseError
        Where one of them exists, or its folder does not.
    CannotRunError
        Where the disk refuses.
    """
    begun: list[Path] = []
    try:
        for path, content in contents.items():
            with path.open("xb") as stream:
                begun.append(path)
                stream.write(content)
    except BaseException as error:
        for half in begun:
            half.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            raise CaseError(f"'{path}' exists, and existing files are not overwritten; choose another place") from None
        if isinstance(error, OSError):
            told = f"'{path}' cannot be written ({error.strerror}); choose another place"
            raise unwritable(told, error) from None
        raise
