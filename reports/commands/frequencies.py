"""The command ``alula frequencies``: natural frequencies of a linkage over its motion, and of its links."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from alula.reports.commands import options
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import begun, tell, write

UNITS = {"angle": "deg", "length": "mm", "frequency": "Hz"}
PAGE = "frequencies.html"
app = typer.Typer()


@app.command()
def frequencies(
    case: options.CaseArgument,
    output: Annotated[
        Path | None,
        options.folder_option("Folder; page, tables, result.json and pictures go to its subfolder frequencies."),
    ] = None,
    json: options.JsonOption = False,
    overrides: options.SetOption = None,
    poses: Annotated[
        int, typer.Option(metavar="<number>", min=2, max=1000, help="Poses over the motion, ends included.")
    ] = 25,
    count: Annotated[
        int, typer.Option(metavar="<number>", min=1, max=20, help="Natural frequencies of every pose and link.")
    ] = 4,
    solid: Annotated[bool, typer.Option("--solid", help="Links by themselves as solids in place of beams.")] = False,
    threads: options.ThreadsOption = 2,
) -> None:
    """Natural frequencies over the motion and of each link, and the harmonics of the drive that meet them."""
    from alula.fea.asked.at_temperature import require_stiffness
    from alula.fea.vibration.over_motion import case_frequencies
    from alula.reports.page.provenance import provenance_section
    from alula.reports.renderers.folder import write_sections
    from alula.reports.renderers.page import Page, page_footer
    from alula.reports.renderers.record import as_brief_record
    from alula.reports.sections.frequencies import frequencies_section

    with begun("frequencies", case, overrides, output, threads=threads) as parsed:
        require_stiffness(parsed)
        found = case_frequencies(parsed, poses=poses, count=count, solid=solid, threads=threads)
    sections = frequencies_section(found, alone=True), provenance_section(parsed)
    page = Page(
        title=f"Natural frequencies: {parsed.title}",
        kind="Natural frequencies of a planar linkage",
        heading=parsed.title,
        sections=sections,
        footer=page_footer("frequencies.csv"),
    )

    def fill(folder: Path) -> None:
        progress("Drawing shapes and diagrams ...")
        write_sections(page, folder, PAGE)

    record = partial(as_brief_record, sections, case=case, title=parsed.title, units=UNITS)
    tell(sections, json=json, record=record, title=parsed.title)
    write("frequencies", output, record, fill, what="\nPage, tables and pictures", json=json)
