"""``alula cases``, ``alula new`` and ``alula schema``: what a case of one's own starts from."""

import itertools
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Literal

import typer

STARTER = "four-bar"
"""The built-in case that ``alula new`` writes where none is named."""
Unit = Literal["um", "mm", "cm", "m", "in"]
app = typer.Typer()


@app.command()
def cases() -> None:
    """List the built-in cases."""
    from alula.loads.case.case_file import built_in_cases, read_tables

    width = max(map(len, built_in_cases()))
    for name in built_in_cases():
        print(f"{name:<{width}}  {read_tables(name)['title']}")  # to validate a case may take the CAD kernel


@app.command()
def schema(
    study: Annotated[bool, typer.Option("--study", help="Of the plan of a study instead.")] = False,
) -> None:
    """Print the JSON Schema of the case file."""
    import json

    from alula.loads.compose.entry_examples import schema_with_examples
    from alula.loads.plans.plan import StudyPlan
    from alula.loads.text.entries import file_schema

    print(json.dumps(file_schema(StudyPlan) if study else schema_with_examples(), indent=2))


@app.command()
def new(
    path: Annotated[Path | None, typer.Argument(help="The file to write.")] = None,
    start: Annotated[
        str | None,
        typer.Option("--from", metavar="NAME", help="The built-in case to start from.", show_default=STARTER),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List the built-in cases to start from.")] = False,
    study: Annotated[bool, typer.Option("--study", help="Write the plan of a study instead.")] = False,
    pylinkage: Annotated[
        Path | None,
        typer.Option("--from-pylinkage", metavar="FILE", help="Start from a mechanism that pylinkage saved."),
    ] = None,
    pmks: Annotated[
        Path | None, typer.Option("--from-pmks", metavar="FILE", help="Start from a text file with a link of PMKS+.")
    ] = None,
    step: Annotated[
        Path | None,
        typer.Option(
            "--from-step",
            metavar="FILE",
            help="Start from a part (STEP file or mesh): what holds and loads it is guessed from its bores.",
        ),
    ] = None,
    unit: Annotated[
        Unit | None,
        typer.Option(help="Unit of the lengths, which pylinkage and a mesh do not state.", show_default="mm"),
    ] = None,
) -> None:
    """Write a commented case to start from: a four-bar linkage, any built-in case, or one for a part from CAD."""
    from alula.geometry.base.errors import CaseError
    from alula.reports.words.numbers import joined

    if listed:
        if path is not None or start is not None or study or pylinkage or pmks or step:
            raise CaseError("--list: it lists the built-in cases and writes nothing; leave out all else")
        cases()
        return
    if path is None:
        raise CaseError("PATH: it is missing; name the file to write, for example: alula new my-case.toml")
    if study and start is not None:
        raise CaseError(
            "--from: it names a built-in case, but --study writes the plan of a study; leave out one of them"
        )
    sources = {"--from": start, "--from-pylinkage": pylinkage, "--from-pmks": pmks, "--from-step": step}
    if sum(source is not None for source in (*sources.values(), study or None)) > 1:
        raise CaseError(f"{', '.join(sources)}, --study: they name different things; keep one of them")
    if step is not None:
        from alula.loads.exchange.part import part_case
        from alula.reports.tools.part import inspect_file

        write_new({path: part_case(inspect_file(step, None, unit), path).encode()})
        print(f"Wrote {path}. Correct its lines marked GUESS. Check it with: alula check {path} -o out")
        return
    if pylinkage is not None or pmks is not None:
        write_new({path: sketched(pylinkage, pmks, unit or "mm")})
        print(f"Wrote {path}. It has no parts yet. See its joint forces with: alula statics {path}")
        return
    contents = (
        {path: _text("alula.loads.plans", "starter-study.toml.txt")} if study else case_files(start or STARTER, path)
    )
    write_new(contents)
    command = "study" if study else "check"
    print(
        f"Wrote {joined([str(file) for file in contents])}. "
        f"{command.capitalize()} it with: alula {command} {path} -o out"
    )


def sketched(pylinkage: Path | None, pmks: Path | None, unit: Unit) -> bytes:
    """Return the case of a linkage that another program saved.

    Parameters
    ----------
    pylinkage, pmks : Path, optional
        The file, of one of them.
    unit : str
        Of the lengths of pylinkage.

    Returns
    -------
    bytes

    Raises
    ------
    CaseError
        For a file that cannot be read, or whose linkage is no case.
    """
    from alula.geometry.parts.mesh_part import UNITS
    from alula.loads.exchange.exchange import case_of_linkage
    from alula.loads.text.explain import printable
    from alula.loads.text.file_text import file_text

    source = pylinkage or pmks
    assert source is not None
    text = file_text(
        str(source),
        "mechanism",
        missing="there is no such file; name the file that was saved",
        empty="the file is empty; save the mechanism anew",
    )
    name = printable(source.name)  # it stands in a comment of the case
    return case_of_linkage("pylinkage" if pylinkage else "pmks", text, name, UNITS[unit]).encode()


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
    from importlib.resources import files

    from alula.geometry.base.errors import CaseError
    from alula.loads.case.case_file import built_in_cases, read_tables
    from alula.loads.text.entries import alike
    from alula.loads.text.explain import printable

    if name not in built_in_cases():
        meant = alike(name, built_in_cases()) or "; alula new --list shows the names"
        raise CaseError(f"--from: there is no built-in case '{printable(name)}'{meant}")
    shipped = {file.name for file in files("alula.loads.cases").iterdir()}
    beside = [text for text in _texts(read_tables(name)) if text in shipped]
    if path.name in beside:
        raise CaseError(f"PATH: '{printable(path.name)}' is a file that the case names; choose another name")
    case, companions = _text("alula.loads.cases", f"{name}.toml"), dict[Path, bytes]()
    for file in beside:
        content = _text("alula.loads.cases", file)
        place = _place_for(path.parent / file, content)
        case = case.replace(f'"{file}"'.encode(), f'"{place.name}"'.encode())
        if not place.exists():
            companions[place] = content
    return {path: case, **companions}


def _place_for(file: Path, content: bytes) -> Path:
    """Return where a file with this content may stand: its own place, unless something else stands there."""
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


def _text(package: str, name: str) -> bytes:
    from importlib.resources import files

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
        Where one of them exists.
    CannotRunError
        Where the disk refuses.
    """
    from alula.geometry.base.errors import CannotRunError, CaseError

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
            raise CannotRunError(f"'{path}' cannot be written ({error.strerror}); choose another place") from None
        raise
