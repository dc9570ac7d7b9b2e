"""``alula cases``, ``alula new`` and ``alula schema``: what a case of one's own starts from."""

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
    from alula.loads.compose.starting import case_files, shipped, write_new
    from alula.reports.words.numbers import joined

    if listed:
        if path is not None or start is not None or study or pylinkage or pmks or step or unit:
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
    if unit is not None and step is None and pylinkage is None:
        raise CaseError("--unit: it is that of a mesh (--from-step) or of pylinkage (--from-pylinkage); leave it out")
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
        {path: shipped("alula.loads.plans", "starter-study.toml.txt")} if study else case_files(start or STARTER, path)
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
