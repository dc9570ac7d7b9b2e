"""The command ``alula study``: many variants of a case, and what became of them."""

import csv
import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

import typer
import typer.core

from alula.reports.commands import options
from alula.reports.commands.telling import tell

if TYPE_CHECKING:
    from alula.fea.study.study import Progress
    from alula.loads.plans.plan import StudyPlan
    from alula.loads.plans.variants import Variants

MANY = 10_000
"""Points above which ``--yes`` is asked for."""


class _Group(typer.core.TyperGroup):
    """``alula study CASE`` runs a study; ``alula study show FOLDER`` shows one."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        return super().resolve_command(ctx, args if args and args[0] in self.commands else ["run", *args])

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """List what a study takes, whose command has no name of its own to ask for it."""
        self.commands["run"].format_options(ctx, formatter)
        self.format_commands(ctx, formatter)


app = typer.Typer(
    name="study",
    cls=_Group,
    no_args_is_help=True,
    subcommand_metavar="CASE | show FOLDER",
    help="Compute many variants of a case into one file: alula study CASE --vary ... -o FOLDER. "
    "Show them: alula study show FOLDER.",
)


@app.command(hidden=True)
def run(
    case: Annotated[str, typer.Argument(help="A case, as for check, or a plan (study.toml, with a table [vary]).")],
    output: Annotated[Path, options.folder_option("Folder for study.sqlite, on a local disk.")],
    vary: options.VaryOption = None,
    link: options.LinkOption = None,
    points: Annotated[str, typer.Option(metavar="<file>", help="CSV file of points; entries in its first line.")] = "",
    sample: Annotated[
        str, typer.Option(metavar="<method:count>", help="latin-hypercube or sobol, and how many: sobol:64.")
    ] = "",
    seed: Annotated[int, typer.Option(metavar="<number>", min=0, help="Of the sample.")] = 0,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="<entry=value>", help="Override an entry of the case in all variants."),
    ] = None,
    analysis: Annotated[
        str | None, typer.Option(metavar="<analysis>", help="check (default), motion or envelope.")
    ] = None,
    fidelity: Annotated[
        str | None, typer.Option(metavar="<model>", help="Model of a check: auto (default), beam or solid.")
    ] = None,
    accuracy: options.AccuracyOption = None,
    mass: Annotated[
        bool | None, typer.Option("--mass/--no-mass", help="Weigh the links; default: where solids are built.")
    ] = None,
    threads: options.VariantsOption = None,
    workers: options.WorkersOption = None,
    scheduler: Annotated[
        str, typer.Option(metavar="<address>", help="Dask scheduler whose workers compute, tcp://host:8786.")
    ] = "",
    retry: Annotated[bool, typer.Option("--retry", help="Try crashed points again that had three attempts.")] = False,
    yes: Annotated[bool, typer.Option("--yes", help=f"Run more than {MANY} points.")] = False,
    pictures: Annotated[
        Path | None,
        options.folder_option("Folder for study.html and pictures, drawn at the end.", "--pictures"),
    ] = None,
) -> None:
    """Compute the variants of a case that are missing in a folder."""
    from alula.fea.study.compute import compute_study
    from alula.loads.case.case_file import stated_changes
    from alula.loads.plans.variants import Variants
    from alula.reports.study.sections import headline

    workers = options.at_a_time(threads, workers)
    varied: dict[str, Any] = {
        "vary": options.stated(vary, "--vary"),
        "link": options.stated(link, "--link"),
        "points": points,
        "sample": _sample(sample, seed),
        "set": {change.path: change.value for change in stated_changes(overrides or ())},
    }
    model = {"analysis": analysis, "fidelity": fidelity, "accuracy": accuracy, "mass": mass}
    plan, folder = _plan(case, varied, {name: value for name, value in model.items() if value is not None})
    variants = Variants(plan, folder)
    if pictures is not None:
        from alula.reports.study.page import refuse_folder

        refuse_folder(output, pictures)
    if len(variants) > MANY and not yes:
        _refuse_many(variants, workers)
    done, counts = compute_study(variants, output, workers=workers, scheduler=scheduler, retry=retry, tell=_teller())
    stood = f"; {done.stood} stood already" if done.stood else ""
    print(f"{headline(counts, done.total)} Computed {done.computed}{stood}.")
    if pictures is not None:
        _draw(output, pictures, (), sys.stdout)
    print(f"Show them: alula study show {output}")


def _draw(folder: Path, output: Path, wanted: Sequence[str], told: TextIO) -> None:
    from alula.reports.study.page import write_study

    print(f"Pictures: {write_study(folder, output, wanted)}", file=told)


def _sample(text: str, seed: int) -> dict[str, object] | None:
    from alula.geometry.base.errors import CaseError

    if not text:
        return None
    method, _, count = text.partition(":")
    if not (count.isascii() and count.isdigit()):
        raise CaseError(f"--sample '{text}': write method and number of points, for example sobol:64")
    return {"method": method, "count": int(count), "seed": seed}


def _plan(case: str, varied: Mapping[str, Any], model: Mapping[str, object]) -> "tuple[StudyPlan, Path]":
    """The plan of the options, or of a file of its own, of which options change analysis and model alone."""
    from alula.loads.case.case_file import built_in_cases, read_tables
    from alula.loads.plans.plan import plan_of, read_plan

    if not any(varied.values()) and case not in built_in_cases() and "case" in read_tables(case):
        return read_plan(Path(case), model)
    return plan_of({"case": case, **varied, **model}), Path()


def _refuse_many(variants: "Variants", workers: int | None) -> None:
    """Estimate time and bytes from one point, and ask for ``--yes``."""
    from alula.fea.study.engine import usable_cores
    from alula.fea.study.evaluate import evaluate
    from alula.fea.study.study import task_of
    from alula.geometry.base.errors import CaseError

    tables = variants.tables(variants.points[0])
    contents = {name: path.read_bytes() for name, path in variants.files.items()}
    answer = evaluate(task_of(variants.plan, tables), contents)
    cores = workers or usable_cores()
    hours = len(variants) * answer.seconds / cores / 3600.0
    megabytes = len(variants) * (300 + 60 * len(answer.numbers)) / 1e6
    raise CaseError(
        f"study: {len(variants)} points would take some {hours:.2g} hours with {cores} threads (the first took "
        f"{answer.seconds:.2g} s) and {megabytes:.2g} MB; add --yes to compute them, or vary less"
    )


def _teller() -> "Callable[[Progress], None]":
    """Tell on standard error how far the study is, every second at most."""
    begun = last = time.monotonic()

    def tell(progress: "Progress") -> None:
        nonlocal last
        now = time.monotonic()
        if now - last < 1.0:
            return
        last = now
        left = progress.total - progress.stood - progress.computed
        seconds = left * (now - begun) / max(progress.computed, 1)
        print(
            f"{progress.stood + progress.computed} of {progress.total} points; about {_duration(seconds)} left",
            file=sys.stderr,
            flush=True,
        )

    return tell


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{math.ceil(seconds)} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


@app.command()
def show(
    folder: Annotated[Path, typer.Argument(help="Folder of a study.")],
    csv_file: Annotated[
        Path | None, typer.Option("--csv", help="Write all points and numbers to a CSV file.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print points as JSON.")] = False,
    most: Annotated[int, typer.Option(metavar="<number>", min=1, help="Rows of the table.")] = 40,
    output: Annotated[
        Path | None,
        options.folder_option("Folder for study.html and pictures, in its subfolder study."),
    ] = None,
    numbers: Annotated[
        list[str] | None,
        typer.Option("--number", metavar="<name>", help='Show numbers of this name as well, such as "drive torque".')
    ] = None,
) -> None:  # fmt: skip
    """Show what became of the points of a study: table, best, worst, undecided; pictures with -o."""
    from alula.fea.study.store import Store
    from alula.reports.renderers.record import as_json, as_record
    from alula.reports.study.columns import read_study
    from alula.reports.study.rows import lines, results_section
    from alula.reports.study.sections import study_sections

    options.refuse_closed(folder)
    with Store.reading(folder) as store:
        if csv_file is not None:
            _write_csv(csv_file, lines(store))
        if json:
            print(as_json(as_record([results_section(store)])))
        else:
            tell(study_sections(read_study(store, numbers or (), most)))
    if output is not None:
        _draw(folder, output, numbers or (), sys.stderr if json else sys.stdout)


def _write_csv(path: Path, rows: Iterator[Sequence[object]]) -> None:
    from alula.geometry.base.errors import CaseError, unwritable

    try:
        with path.open("x", encoding="utf-8", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows(rows)
    except FileExistsError:
        raise CaseError(f"'{path}' exists, and existing files are not overwritten; choose another name") from None
    except OSError as error:
        raise unwritable(f"'{path}' cannot be written ({error.strerror}); choose another place", error) from None
