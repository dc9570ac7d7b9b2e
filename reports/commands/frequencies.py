"""The command ``alula frequencies``: natural frequencies of a linkage over its motion, and of its links."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from alula.reports.commands.ending import progress
from alula.reports.commands.options import CaseArgument, JsonOption, SetOption, ThreadsOption, folder_option

if TYPE_CHECKING:
    from alula.fea.vibration.over_motion import CaseFrequencies

UNITS = {"angle": "deg", "length": "mm", "frequency": "Hz"}
PAGE = "frequencies.html"
app = typer.Typer()


@app.command()
def frequencies(
    case: CaseArgument,
    output: Annotated[
        Path | None,
        folder_option("Folder; page, tables, result.json and pictures go to its subfolder frequencies."),
    ] = None,
    json: JsonOption = False,
    overrides: SetOption = None,
    poses: Annotated[int, typer.Option(min=2, max=1000, help="Poses over the motion, ends included.")] = 25,
    count: Annotated[int, typer.Option(min=1, max=20, help="Natural frequencies of every pose and link.")] = 4,
    solid: Annotated[bool, typer.Option("--solid", help="Links by themselves as solids in place of beams.")] = False,
    threads: ThreadsOption = 2,
) -> None:
    """Natural frequencies over the motion and of each link, and the harmonics of the drive that meet them."""
    from alula.fea.common.at_temperature import require_stiffness
    from alula.fea.common.threads import bounded
    from alula.fea.vibration.over_motion import case_frequencies
    from alula.loads.case.case_file import read_case
    from alula.reports.page.output import refuse_unusable, write_folder

    parsed = read_case(case, overrides or ())
    require_stiffness(parsed)
    refuse_unusable(output, "frequencies")
    with bounded(threads):
        found = case_frequencies(parsed, poses=poses, count=count, solid=solid, threads=threads)
    if json:
        print(as_json(found, case), flush=True)
    else:
        from rich.console import Console

        from alula.reports.renderers.console import print_sections
        from alula.reports.sections.frequencies import frequencies_section
        from alula.reports.words.terminal import say

        console = Console()
        say(console, parsed.title)
        print_sections([frequencies_section(found, alone=True)], console)
    if output is not None:
        progress("Drawing shapes and diagrams ...")
        write_folder(output, "frequencies", lambda folder: write_frequencies(found, folder, case))
        if not json:
            print(f"\nPage, tables and pictures: {output / 'frequencies'}")


def as_json(found: "CaseFrequencies", name: str) -> str:
    """Return natural frequencies as the text of ``result.json``.

    Parameters
    ----------
    found : CaseFrequencies
    name : str
        Of the case, as the command was given it.

    Returns
    -------
    str
    """
    from alula.reports.renderers.record import as_brief_record
    from alula.reports.renderers.record import as_json as written
    from alula.reports.sections.frequencies import frequencies_section

    return written(as_brief_record([frequencies_section(found)], case=name, title=found.case.title, units=UNITS))


def write_frequencies(found: "CaseFrequencies", folder: Path, name: str) -> None:
    """Write ``frequencies.html``, ``frequencies.csv``, ``result.json`` and two pictures of every load case.

    Parameters
    ----------
    found : CaseFrequencies
    folder : Path
        An existing folder.
    name : str
        Of the case, as the command was given it.
    """
    from alula.reports.renderers.folder import write_sections
    from alula.reports.renderers.page import Page, page_footer
    from alula.reports.sections.frequencies import frequencies_section

    page = Page(
        title=f"Natural frequencies: {found.case.title}",
        kind="Natural frequencies of a planar linkage",
        heading=found.case.title,
        sections=(frequencies_section(found, alone=True),),
        footer=page_footer(name, "frequencies.csv"),
    )
    (folder / "result.json").write_text(as_json(found, name) + "\n", encoding="utf-8")
    write_sections(page, folder, PAGE)
