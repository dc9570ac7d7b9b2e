"""The command ``alula``. Heavy libraries are imported by the command that needs them."""

import os
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from alula.reports.commands import options
from alula.reports.commands.ending import progress, run
from alula.reports.commands.frequencies import app as frequencies
from alula.reports.commands.materials import app as materials
from alula.reports.commands.open import app as opening
from alula.reports.commands.size import app as size
from alula.reports.commands.starters import app as starters
from alula.reports.commands.study import app as study
from alula.reports.commands.telling import begun, tell, write
from alula.reports.commands.tolerance import app as tolerance

if TYPE_CHECKING:
    from alula.loads.case.case import Case

app = typer.Typer(
    name="alula",
    help="Check planar linkages: pose, statics, stress, verdict.\n\n"
    "Exit status: 0 pass, 1 fail, 2 bad input, 3 undecided, 4 could not run.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
AccuracyOption = Annotated[
    str | None,
    typer.Option(
        metavar="<percent>",
        help='Discretisation error to reach in every link, such as "5 %"; default: a clear verdict, or 5 %.',
    ),
]
UnknownsOption = Annotated[
    int, typer.Option(metavar="<number>", min=1000, help="Largest number of unknowns of a refined mesh.")
]
TimeOption = Annotated[
    float, typer.Option(metavar="<seconds>", min=0.0, help="Time after which no finer mesh is started [s].")
]


def main() -> NoReturn:
    """Run the command line."""
    run(partial(app, standalone_mode=False))


def _version(wanted: bool) -> None:
    if wanted:
        from alula.geometry.base.version import alula_version

        print(f"alula {alula_version()}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Options of the command itself."""


@app.command()
def check(
    case: options.CaseArgument,
    output: Annotated[
        Path | None, options.folder_option("Folder for report.html, result.json, pictures and VTU files.")
    ] = None,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
    fidelity: Annotated[
        str,
        typer.Option(
            metavar="<model>",
            help="Model that decides: auto (the cheapest that can), beam (also called frame) or solid.",
        ),
    ] = "auto",
    threads: options.ThreadsOption = 2,
    memory: options.MemoryOption = None,
    accuracy: AccuracyOption = None,
    max_unknowns: UnknownsOption = 600_000,
    time_limit: TimeOption = 600.0,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Mesh and solve all links anew, and keep nothing of it for later checks.")
    ] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Print all numbers; without it what decides, on one screen.")
    ] = False,
    second_opinion: Annotated[
        bool,
        typer.Option(
            "--second-opinion",
            help="Write a CalculiX deck of each link; if ccx is installed, run it and compare the results "
            "(with every link as a solid, unless --fidelity is given).",
        ),
    ] = False,
) -> None:
    """Check a case: pose, joint forces, stress, verdict; of a case with a level all tests, one after the other."""
    from alula.fea.check.run import check_case, effort_of
    from alula.fea.findings.of_check import with_findings
    from alula.fea.level.check_level import has_tests
    from alula.geometry.keeping.kept import keeping
    from alula.reports.check.changes import changes_section
    from alula.reports.check.screen import print_result, print_screen
    from alula.reports.check.whole_check import check_record, check_sections
    from alula.reports.level.folder import checked_names

    if second_opinion and fidelity == "auto":
        fidelity = "solid"  # a link that hand calculation decides has no mesh for CalculiX
    beginning = begun("check", case, overrides, output, threads=threads, memory=memory, names=checked_names)
    with keeping(anew=fresh), beginning as parsed, ExitStack() as scratch:
        effort = effort_of(parsed, accuracy, max_unknowns=max_unknowns, time_limit=time_limit)
        told = progress if output is None or threads == 1 else _solving
        if has_tests(parsed):
            given = {"fidelity": fidelity, "threads": threads, "effort": effort, "progress": told}
            raise SystemExit(_check_tests(parsed, case, given, output, json=json, second_opinion=second_opinion))
        result = check_case(parsed, name=case, fidelity=fidelity, threads=threads, effort=effort, progress=told)
        if result.kept[0]:
            found, asked = result.kept
            progress(f"{found} of {asked} meshes and solutions were kept from earlier checks; --fresh finds them anew")
        decks = None
        if second_opinion:
            from alula.fea.calculix.second_opinion import second_opinions
            from alula.geometry.base.tidying import scratch_folder
            from alula.reports.check.opinion import with_second_opinions

            decks = scratch.enter_context(scratch_folder("alula-"))
            result = with_second_opinions(result, second_opinions(result, decks, threads=threads, progress=progress))
        result = with_findings(result)
        sections = check_sections(result) if json or verbose else (changes_section(result),)  # all that a screen needs
        show = partial(print_result if verbose else print_screen, result)
        tell(sections, json=json, record=partial(check_record, result, sections), show=show)
        if output is not None:
            from alula.fea.claims.sources import claims_of
            from alula.reports.check.folder import write_report

            write_report(result, output, claims=claims_of(result), decks=decks, progress=progress)
            if not json:
                print(f"Report: {output / 'report.html'}")
    raise SystemExit(result.verdict.exit_status)


def _check_tests(
    case: "Case", name: str, options: dict[str, Any], output: Path | None, *, json: bool, second_opinion: bool
) -> int:
    """Check all tests of a case, tell what they say and write their reports; return the exit status of the worst."""
    from alula.fea.findings.of_check import with_findings
    from alula.fea.level.check_level import check_level
    from alula.geometry.base.errors import CaseError
    from alula.reports.level.folder import write_level
    from alula.reports.level.page import level_sections
    from alula.reports.level.tests import level_record, print_level

    if second_opinion:
        first = next(iter(case.level.tests)) if case.level else ""
        raise CaseError(f'--second-opinion: it is on one test; choose one with --set level.test="{first}"')
    result = check_level(case, name=name, **options).of_each(with_findings)
    sections = level_sections(result)
    tell(sections, json=json, record=partial(level_record, result, sections), show=partial(print_level, result))
    if output is not None:
        write_level(result, output, progress=progress)
        if not json:
            print(f"Level: {output / 'level.html'}")
    return result.worst.exit_status


@app.command()
def statics(
    case: options.CaseArgument,
    matrix: Annotated[bool, typer.Option("--matrix", help="Print [A] and [b] with named rows and columns.")] = False,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
) -> None:
    """Solve pose and joint forces only."""
    from alula.fea.standing.case_statics import solve_case_statics
    from alula.loads.case.case_file import read_case
    from alula.reports.commands.statics import UNITS, statics_sections
    from alula.reports.renderers.record import as_brief_record

    solved = solve_case_statics(read_case(case, overrides or ()), case)
    sections = statics_sections(solved, matrix=matrix)
    tell(sections, json=json, record=partial(as_brief_record, sections, units=UNITS))


@app.command()
def motion(
    case: options.CaseArgument,
    output: Annotated[
        Path | None,
        options.folder_option("Folder; tables, figures and the animation go to its subfolder motion."),
    ] = None,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
    threads: options.ThreadsOption = 2,
) -> None:
    """Analyse a motion: link directions, paths, joint forces and drive torque."""
    from alula.fea.common.verdict import Verdict
    from alula.fea.findings.of_motion import motion_findings
    from alula.fea.whole.rubbed_motion import rubbed_motion
    from alula.reports.commands.motion import tell_motion

    with begun("motion", case, overrides, output, threads=threads) as parsed:
        result = rubbed_motion(parsed)
        tell_motion(motion_findings(result), case, output, json=json)
    for sentence in result.locks:
        progress(f"Warning: {sentence}.")
    if result.locks:
        raise SystemExit(Verdict.UNDECIDED.exit_status)


@app.command()
def envelope(
    case: options.CaseArgument,
    output: Annotated[
        Path | None,
        options.folder_option("Folder; result.json, curves, pictures and VTU files go to its subfolder envelope."),
    ] = None,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
    repetitions: Annotated[
        float | None,
        typer.Option(
            metavar="<number>",
            min=1.0,
            help="Repetitions of the motion for fatigue; default: the cycles of the material card.",
        ),
    ] = None,
    growth: Annotated[
        float,
        typer.Option(
            metavar="<number>",
            min=1.0,
            help="Growth of the drive torque towards a dead point above which poses are left out.",
        ),
    ] = 20.0,
    threads: options.ThreadsOption = 2,
    memory: options.MemoryOption = None,
    accuracy: AccuracyOption = None,
    max_unknowns: UnknownsOption = 600_000,
    time_limit: TimeOption = 600.0,
) -> None:
    """Check every link over the whole motion: least safety factor and fatigue."""
    from alula.fea.check.run import effort_of
    from alula.fea.motion.envelope import envelope_case
    from alula.reports.commands.motion import tell_envelope

    with begun("envelope", case, overrides, output, threads=threads, memory=memory) as parsed:
        result = envelope_case(
            parsed,
            name=case,
            threads=threads,
            repetitions=repetitions,
            growth=growth,
            effort=effort_of(parsed, accuracy, max_unknowns=max_unknowns, time_limit=time_limit),
            progress=progress,
        )
        tell_envelope(result, output, json=json)
    raise SystemExit(result.verdict.exit_status)


@app.command()
def claims(
    case: Annotated[
        str | None,
        typer.Argument(
            help="Path to a case file, or the name of a built-in case or source document; default: all sources."
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="End with exit status 1 if a claim does not hold or does not follow.")
    ] = False,
    json: options.JsonOption = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print a page of Markdown.")] = False,
    overrides: options.SetOption = None,
    fidelity: Annotated[
        str, typer.Option(metavar="<model>", help="Model for claims on stress: solid or beam.")
    ] = "solid",
    threads: options.ThreadsOption = 2,
    memory: options.MemoryOption = None,
) -> None:
    """Re-derive published figures and report which of them hold."""
    from alula.fea.claims.sources import check_all, check_claims
    from alula.geometry.base.errors import CaseError
    from alula.loads.sources.claim import read_source, sources
    from alula.loads.text.explain import printable
    from alula.reports.check.published import as_json, as_markdown
    from alula.reports.sections.published import claims_section, count
    from alula.reports.words.limits import limited

    if case is None and overrides:
        raise CaseError("--set: it needs a case; name one")
    with limited(threads, memory):
        if case is None:
            found = check_all(fidelity=fidelity, threads=threads)
        else:
            _require_claims(case)
            found = {case: check_claims(case, overrides=overrides or (), fidelity=fidelity, threads=threads)}
            if not found[case]:
                raise CaseError(f"'{printable(case)}' states no claims, so that none could hold; add [[claims]]")
    results = [result for group in found.values() for result in group]
    titles = {name: read_source(name).title if name in sources() else name for name in found}
    if json:
        print(as_json(results))
    elif markdown:
        print(as_markdown(found, titles), end="")
    else:
        tell([claims_section(group, titles[name]) for name, group in found.items()])
        print(count(results))
    if strict and any(result.finding.refutes for result in results):
        raise SystemExit(1)


def _require_claims(name: str) -> None:
    """Refuse a name of nothing with those that have claims, which are not those of all built-in cases."""
    from alula.geometry.base.errors import CaseError
    from alula.loads.case.case_file import built_in_cases, read_tables
    from alula.loads.sources.claim import read_source, sources
    from alula.loads.text.entries import alike
    from alula.loads.text.explain import printable

    if name in (*sources(), *built_in_cases()) or Path(name).suffix == ".toml" or os.path.lexists(name):
        return
    known = {claim.case for source in sources() for claim in read_source(source).claims if claim.case}
    known |= {*sources(), *(case for case in built_in_cases() if read_tables(case).get("claims"))}
    raise CaseError(
        f"case '{printable(name)}': there is no such file or built-in case; give a path to a case file or one of those "
        f"that have claims: {', '.join(sorted(known))}{alike(name, known)}"
    )


@app.command()
def synth(
    points: Annotated[
        list[str] | None,
        typer.Option(
            "--point",
            metavar="<point>",
            help='A precision point "theta, psi"; give three. Default: those of Arango and Hurtado, '
            '"0 deg, 30 deg", "20 deg, 110 deg", "5 deg, 130 deg".',
        ),
    ] = None,
    ground: Annotated[str, typer.Option(metavar="<length>", help="Length d of the ground link.")] = "10 m",
    output: Annotated[
        Path | None,
        options.folder_option("Folder; result.json and the drawing go to its subfolder synth."),
    ] = None,
    json: options.JsonOption = False,
) -> None:
    """Synthesise a four-bar through three precision points, and report its defects."""
    from alula.reports.commands.synthesis import PUBLISHED_POINTS, read_synthesis
    from alula.reports.figures.four_bar import precision_points_png
    from alula.reports.page.output import refuse_unusable
    from alula.reports.renderers.record import as_brief_record
    from alula.reports.tools.synthesis import synthesis_section

    refuse_unusable(output, "synth")
    found = read_synthesis(points or PUBLISHED_POINTS, ground)
    sections = [synthesis_section(found)]
    tell(sections, json=json)

    def fill(folder: Path) -> None:
        (folder / "linkage.png").write_bytes(precision_points_png(found))

    write("synth", output, partial(as_brief_record, sections), fill, what="\nRecord and drawing", json=json)


app.add_typer(opening)
app.add_typer(starters)
app.add_typer(materials)
app.add_typer(study)
app.add_typer(size)
app.add_typer(frequencies)
app.add_typer(tolerance)


@app.command()
def inspect(
    file: Annotated[Path, typer.Argument(help="A STEP file, or a mesh (.msh, .inp, .vtu), of one solid.")],
    material: Annotated[
        str | None, typer.Option(metavar="<name>", help="Material of the library, for the mass.")
    ] = None,
    unit: Annotated[
        str | None, typer.Option(metavar="<unit>", help="Unit of length of a mesh: um, mm (if left out), cm, m or in.")
    ] = None,
    output: Annotated[
        Path | None,
        options.folder_option("Folder; result.json, parts.toml and part.png go to its subfolder inspect."),
    ] = None,
    json: options.JsonOption = False,
) -> None:
    """List what a STEP file or a mesh holds: solid, mass, bores, and the entries of a case file for it."""
    from alula.reports.commands.inspect_part import tell_inspection
    from alula.reports.figures.figures import start_renderer
    from alula.reports.page.output import refuse_unusable
    from alula.reports.tools.part import inspect_file

    refuse_unusable(output, "inspect")
    if output is not None:
        start_renderer()
    tell_inspection(inspect_file(file, material, unit), output, json=json)


@app.command()
def mcp(
    folder: Annotated[Path, typer.Argument(help="Folder below which case files and parts are read.")] = Path(),
    threads: options.ThreadsOption = 2,
) -> None:
    """Answer another program, such as an assistant, by the Model Context Protocol over standard input and output."""
    from alula.reports.words.limits import limited
    from alula.server import serve

    options.refuse_closed(folder)
    with limited(threads):
        serve(folder, threads)


@app.command()
def export(
    case: options.CaseArgument,
    step: Annotated[bool, typer.Option("--step", help="Write the parts as STEP files (mm).")] = False,
    output: Annotated[Path, options.folder_option("Folder for the files.")] = Path("parts"),
    overrides: options.SetOption = None,
) -> None:
    """Write the parts of a case to CAD files."""
    from alula.geometry.base.errors import CaseError
    from alula.geometry.meshing.mesh import export_step, step_names
    from alula.loads.case.case_file import read_case
    from alula.reports.page.output import EXPORT, refuse_unusable, write_folder

    if not step:
        raise CaseError("export: no format is given; add --step")
    parsed = read_case(case, overrides or ())
    bodies = {link: parsed.body_to_make(link) for link in parsed.checked_links}
    refuse_unusable(output, EXPORT, step_names(bodies))
    write_folder(output, EXPORT, lambda folder: export_step(bodies, folder))
    for name in step_names(bodies):
        print(output / name)


def _solving(message: str) -> None:
    """Tell of a solid that is being solved, and start what will draw its stress."""
    from alula.reports.figures.figures import start_renderer

    progress(message)
    start_renderer()
