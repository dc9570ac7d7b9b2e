"""``alula cases``, ``alula new`` and ``alula schema``: what a case of one's own starts from."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def cases() -> None:
    """List the built-in cases."""
    from loads.case.case_file import built_in_cases, read_case

    width = max(map(len, built_in_cases()))
    for name in built_in_cases():
        print(f"{name:<{width}}  {read_case(name).title}")


@app.command()
def schema(
    study: Annotated[bool, typer.Option("--study", help="Of the plan of a study instead.")] = False,
) -> None:
    """Print the JSON Schema of the case file."""
    import json

    from loads.case.case import Case
    from loads.plans.plan import StudyPlan

    print(json.dumps((StudyPlan if study else Case).model_json_schema(), indent=2))


@app.command()
def new(
    path: Annotated[Path, typer.Argument(help="The file to write.", show_default=False)],
    study: Annotated[bool, typer.Option("--study", help="Write the plan of a study instead.")] = False,
) -> None:
    """Write a commented starter case: a four-bar linkage."""
    from importlib.resources import files

    from geometry.base.errors import CannotRunError, CaseError

    source = files("loads.plans" if study else "loads.cases")
    text = source.joinpath("starter-study.toml.txt" if study else "starter.toml.txt").read_text(encoding="utf-8")
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        raise CaseError(f"'{path}' exists, and existing files are not overwritten; choose another name") from None
    except OSError as error:
        if path.is_file():
            path.unlink()  # half of it
        raise CannotRunError(f"'{path}' cannot be written ({error.strerror}); choose another place") from None
    command = "study" if study else "check"
    print(f"Wrote {path}. {command.capitalize()} it with: alula {command} {path} -o out")
