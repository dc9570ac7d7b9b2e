"""The output folder of a check: report, result, pictures and VTU files."""

import shutil
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.loads.case.case import Case
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.figures.vibration.pictures import campbell_name, shapes_name
from alula.reports.page.claims_page import CLAIMS, write_claims
from alula.reports.page.output import MARK, write_folder
from alula.reports.page.pictures import (
    ASSEMBLY,
    CONTACT,
    diagram_name,
    flapping_name,
    layers_name,
    linkage_name,
    stress_name,
)
from alula.reports.tables.record import as_json, worst_load_case

REPORT = "report.html"
PICTURES = "pictures"
FIELDS = "vtu"
DECKS = "calculix"


def report_names(case: Case) -> set[str]:
    """Return the names of all files that the report of a case can contain.

    Parameters
    ----------
    case : Case

    Returns
    -------
    set[str]
    """
    links, pictures = case.checked_links, {*map(linkage_name, case.load_cases), ASSEMBLY, CONTACT}
    of_load_case = shapes_name, campbell_name, flapping_name
    pictures |= {name(load_case) for load_case in case.load_cases for name in of_load_case}
    pictures |= {name(link) for link in links for name in (diagram_name, layers_name, stress_name)}
    return {
        REPORT,
        CLAIMS,
        MARK,
        *(f"{PICTURES}/{name}.png" for name in pictures),
        *(f"{FIELDS}/{link}.vtu" for link in links),
        *(f"{DECKS}/{link}.inp" for link in links),
    }


def write_report(
    result: CheckResult,
    target: Path,
    *,
    decks: Path | None = None,
    progress: Callable[[str], None] = lambda message: None,
) -> None:
    """Write ``report.html``, ``result.json``, pictures and VTU files, or nothing.

    Where figures were published that belong to the case, ``claims.html`` holds them. The VTU file of a link has the
    load case with the least safety factor. A picture that cannot be rendered is left out with a warning.

    Parameters
    ----------
    result : CheckResult
    target : Path
        The output folder.
    decks : Path, optional
        Folder whose CalculiX decks go into ``calculix/``.
    progress : callable, optional
        Receives messages.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    from alula.reports.page.html import render
    from alula.reports.page.pictures import draw_pictures
    from alula.reports.turnable.link import link_models
    from alula.reports.turnable.moving import LINKAGE, check_linkage
    from alula.reports.turnable.pack import data_block

    def fill(folder: Path) -> None:
        with ThreadPoolExecutor(1) as beside:
            drawn = beside.submit(draw_pictures, result, progress)
            _write_fields(result, folder / FIELDS)
            models = link_models(result) | {LINKAGE: data_block(check_linkage(result))}
            pictures, warnings = drawn.result()
            files = beside.submit(_write_pictures, pictures, folder / PICTURES)  # packing them lets others run
            tell(folder, warnings, pictures, models)
            files.result()
        if decks is not None and result.second_opinions:
            shutil.copytree(decks, folder / DECKS)

    def tell(
        folder: Path, warnings: tuple[str, ...], pictures: Mapping[str, Drawing], models: Mapping[str, str]
    ) -> None:
        # The result itself where it can be: it knows already what was worked out for the console.
        told = replace(result, warnings=(*result.warnings, *warnings)) if warnings else result
        for warning in warnings:
            progress(f"Warning: {warning}")
        published = write_claims(told, folder, REPORT)
        (folder / REPORT).write_text(render(told, pictures, published, models), encoding="utf-8")
        (folder / MARK).write_text(as_json(told) + "\n", encoding="utf-8")

    write_folder(target, "check", fill)


def _write_pictures(pictures: Mapping[str, Drawing], folder: Path) -> None:
    folder.mkdir()
    for name, picture in pictures.items():
        (folder / f"{name}.png").write_bytes(picture.png())


def _write_fields(result: CheckResult, folder: Path) -> None:
    """Write the VTU file of every link that was solved as a solid."""
    links = {link: worst_load_case(result, link).links[link] for link in next(iter(result.load_cases.values())).links}
    solids = {link: found for link, found in links.items() if isinstance(found, SolidResult)}
    if not solids:
        return
    from alula.reports.page.export import write_vtu

    folder.mkdir()
    for link, found in solids.items():
        write_vtu(folder / f"{link}.vtu", found.governing_case.displacement, found.stress)
