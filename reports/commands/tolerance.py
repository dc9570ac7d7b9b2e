"""The command ``alula tolerance``: samples of a case's tolerances, with their probabilities."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.reports.commands import options
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import begun, tell, write

if TYPE_CHECKING:
    from alula.fea.tolerance.result import ToleranceResult
    from alula.loads.case.case import Case

SAMPLES = "samples.npz"
app = typer.Typer()


@app.command()
def tolerance(
    case: options.CaseArgument,
    output: Annotated[
        Path | None,
        options.folder_option("Folder; result.json, samples.npz and pictures go to its subfolder tolerance."),
    ] = None,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
    tolerances: Annotated[
        list[str] | None,
        typer.Option(
            "--tolerance",
            metavar="<entry=size>",
            help='Besides those of the case: pins="0.2 mm", links.AE.points.E="0.1 mm".',
        ),
    ] = None,
    samples: Annotated[
        int, typer.Option(metavar="<number>", min=100, max=10_000_000, help="Independent samples.")
    ] = 100_000,
    seed: Annotated[int, typer.Option(metavar="<number>", min=0, help="Of the samples.")] = 0,
    threads: options.ThreadsOption = 2,
    memory: options.MemoryOption = None,
    accuracy: options.AccuracyOption = None,
) -> None:
    """Sample the tolerances of a case: how likely every check passes, and which tolerance matters."""
    from alula.fea.check.run import effort_of
    from alula.fea.tolerance.analysis import tolerance_case
    from alula.reports.renderers.record import as_record
    from alula.reports.study.tolerance import tolerance_sections

    with begun("tolerance", case, overrides, output, threads=threads, memory=memory) as parsed:
        tolerant = with_tolerances(parsed, options.stated(tolerances, "--tolerance"))
        effort = effort_of(tolerant, accuracy)
        result = tolerance_case(
            tolerant, name=case, samples=samples, seed=seed, threads=threads, effort=effort, progress=progress
        )
        sections = tolerance_sections(result)
        record = partial(as_record, sections, case=case, samples=result.samples, seed=result.seed)
        tell(sections, json=json, record=record)
        fill = partial(write_samples, result)
        write("tolerance", output, record, fill, what="Record, samples and pictures", json=json)


def with_tolerances(case: "Case", more: Mapping[str, str]) -> "Case":
    """Return a case with more tolerances, or others.

    Parameters
    ----------
    case : Case
    more : mapping of str to str
        Path of an entry -> half the width.

    Returns
    -------
    Case
    """
    if not more:
        return case
    kept = {path: one.model_dump() for path, one in case.tolerances.items()}
    return case.with_values({"tolerances": kept | dict(more)})


def write_samples(result: "ToleranceResult", folder: Path) -> None:
    """Write ``samples.npz``, the deviations and all numbers of every sample, and pictures.

    Parameters
    ----------
    result : ToleranceResult
    folder : Path
        An existing folder.
    """
    import numpy as np

    from alula.reports.figures.study.tolerance_pictures import tolerance_pictures

    arrays: dict[str, Any] = {
        name: np.array([getattr(one, name) for one in result.numbers]) for name in ("values", "low", "high")
    }
    np.savez_compressed(folder / SAMPLES, deviations=result.deviations, **arrays)
    for name, picture in tolerance_pictures(result).items():
        (folder / name).write_bytes(picture.png())
