"""The command ``alula frequencies``: natural frequencies of a linkage over its motion, and of its links."""

import csv
import json as jsonlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.reports.commands.ending import progress
from alula.reports.commands.options import CaseArgument, JsonOption, SetOption, ThreadsOption, folder_option

if TYPE_CHECKING:
    from rich.console import Console

    from alula.fea.vibration.over_motion import CaseFrequencies

UNITS = {"angle": "deg", "length": "mm", "frequency": "Hz"}
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

        print_frequencies(found, Console())
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
    from alula.geometry.base.version import result_stamp
    from alula.reports.renderers.record import finite
    from alula.reports.tables.frequencies import frequencies_record

    record: dict[str, Any] = {**result_stamp(), "case": name, "title": found.case.title, "units": UNITS}
    record["frequencies"] = finite(frequencies_record(found), {})
    return jsonlib.dumps(record, indent=2, ensure_ascii=False, allow_nan=False)


def print_frequencies(found: "CaseFrequencies", console: "Console") -> None:
    """Print natural frequencies.

    Parameters
    ----------
    found : CaseFrequencies
    console : rich.console.Console
    """
    from alula.reports.sentences import told as in_words
    from alula.reports.tables.frequencies import history_sentence, mode_rows
    from alula.reports.words.numbers import band
    from alula.reports.words.terminal import say, say_table

    say(console, found.case.title)
    rows = mode_rows(found)
    for name, history in found.histories.items():
        say(console, "")
        if len(found.histories) > 1:
            say(console, f"Load case {name}", style="bold")
        say(console, history_sentence(found.case, history))
        own = [row for row in rows if row["load_case"] == name]
        columns = [("no.", True), ("frequency [Hz]\n(band)", True), ("shape", False), ("moves most", False)]
        ratio = [("over the\ndriving one", True)] if history.driving else []
        say_table(
            console,
            [*columns[:2], *ratio, *columns[2:]],
            [
                (
                    str(row["number"]),
                    band(row["frequency"]),
                    *([band(row["ratio"])] if history.driving else []),
                    row["moves"],
                    row["most"],
                )
                for row in own
            ],
        )
        for note in history.lowest.notes:
            say(console, f"Note: {in_words(note)}.")
    links = [row for row in rows if not row["load_case"]]
    if links:
        say(console, "\nLinks by themselves")
        columns = [("link", False), ("no.", True), ("frequency [Hz]\n(band)", True), ("shape", False), ("held", False)]
        cells = [(x["subject"], str(x["number"]), band(x["frequency"]), x["moves"], x["most"]) for x in links]
        say_table(console, columns, cells)


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
    from alula.reports.figures.vibration.pictures import frequency_pictures
    from alula.reports.page.frequencies_page import PAGE, frequencies_page

    pictures = frequency_pictures(found, every=True)
    (folder / "result.json").write_text(as_json(found, name) + "\n", encoding="utf-8")
    _write_table(found, folder / "frequencies.csv")
    for title, picture in pictures.items():
        (folder / f"{title}.png").write_bytes(picture.png())
    (folder / PAGE).write_text(frequencies_page(found, pictures, name=name), encoding="utf-8")


def _write_table(found: "CaseFrequencies", path: Path) -> None:
    """Write natural frequencies over the motion, one load case below the other."""
    from alula.fea.vibration.frequency_outcomes import told, unit

    case = found.case
    count = max(history.frequencies.shape[1] for history in found.histories.values())
    columns = [f"{n} {what} [Hz]" for n in range(1, count + 1) for what in ("frequency", "low", "high")]
    at = "pose" if case.motion is None else f"{case.motion_coordinate} [{unit(case)}]"
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["load case", at, *columns])
        for name, history in found.histories.items():
            for i, value in enumerate(history.at):
                triples = zip(history.frequencies[i], history.low[i], history.high[i], strict=True)
                cells = [f"{number:.12g}" for triple in triples for number in triple]
                writer.writerow([name, f"{told(case, float(value)):.12g}", *cells])
