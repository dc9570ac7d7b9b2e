"""The output folder of a check: report, result, pictures and VTU files."""

import shutil
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from alula.fea.claims.audit import ClaimResult
from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.loads.case.case import Case
from alula.loads.states.rubbing import each_direction
from alula.reports.check.plastic_collapse import governing_collapses
from alula.reports.check.published import CLAIMS, published_page
from alula.reports.check.whole_check import check_json, check_page, check_pictures, check_sections
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.page.output import MARK, write_folder
from alula.reports.renderers.page import as_page

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

    Raises
    ------
    CaseError
        As ``each_direction``.
    """
    links, pictures = case.checked_links, {"assembly", "clearance", "box"}
    load_cases = {*each_direction(case).load_cases, *each_direction(case, moving=True).load_cases}
    pictures |= {f"{kind}-{name}" for name in load_cases for kind in ("linkage", "shapes", "campbell", "air")}
    pictures |= {f"{kind}-{name}" for name in links for kind in ("diagram", "layers", "stress", "plastic")}
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
    claims: Sequence[ClaimResult] = (),
    decks: Path | None = None,
    progress: Callable[[str], None] = lambda message: None,
) -> None:
    """Write ``report.html``, ``result.json``, pictures and VTU files, or nothing.

    Where figures were published that belong to the case, ``claims.html`` holds them. The VTU file of a link has the
    load case with the least safety factor. A picture that cannot be rendered is left out with a warning.

    Parameters
    ----------
    result : CheckResult
        With what ``alula.fea.findings.of_check`` finds besides.
    target : Path
        The output folder.
    claims : sequence of ClaimResult, optional
        Of figures that were published of the case.
    decks : Path, optional
        Folder whose CalculiX decks go into ``calculix/``.
    progress : callable, optional
        Receives messages.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """

    def fill(folder: Path) -> None:
        fill_report(result, folder, claims=claims, progress=progress)
        if decks is not None and result.second_opinions:
            shutil.copytree(decks, folder / DECKS)

    write_folder(target, "check", fill)


def fill_report(
    result: CheckResult,
    folder: Path,
    *,
    claims: Sequence[ClaimResult] = (),
    progress: Callable[[str], None] = lambda message: None,
) -> None:
    """Write the files of a report, but for decks of CalculiX, into an empty folder.

    Parameters
    ----------
    result, claims, progress
        As of ``write_report``.
    folder : Path
    """
    from alula.reports.turnable.link import collapse_models, link_models
    from alula.reports.turnable.moving import LINKAGE, check_linkage
    from alula.reports.turnable.pack import data_block

    told, (beside_it, published) = result, published_page(result, claims, REPORT)
    if beside_it:
        (folder / CLAIMS).write_text(beside_it, encoding="utf-8")
    sections = check_sections(told, published)
    page = check_page(told, sections)
    with ThreadPoolExecutor(1) as beside:
        drawn = beside.submit(check_pictures, result, page, progress)
        _write_fields(result, folder / FIELDS)
        models = link_models(result) | {LINKAGE: data_block(check_linkage(result))}
        models |= collapse_models(governing_collapses(result), result.case)
        pictures, warnings = drawn.result()
        files = beside.submit(_write_pictures, pictures, folder / PICTURES)  # packing them lets others run
        if warnings:
            for warning in warnings:
                progress(f"Warning: {warning}")
            told = replace(result, warnings=(*result.warnings, *warnings))
            sections = check_sections(told, published)
            page = check_page(told, sections)
        (folder / REPORT).write_text(as_page(page, pictures, models), encoding="utf-8")
        (folder / MARK).write_text(check_json(told, sections) + "\n", encoding="utf-8")
        files.result()


def _write_pictures(pictures: Mapping[str, Drawing], folder: Path) -> None:
    folder.mkdir()
    for name, picture in pictures.items():
        (folder / f"{name}.png").write_bytes(picture.png())


def _write_fields(result: CheckResult, folder: Path) -> None:
    """Write the VTU file of every link that was solved as a solid."""
    links = {link: result.governing(link).links[link] for link in next(iter(result.load_cases.values())).links}
    solids = {link: found for link, found in links.items() if isinstance(found, SolidResult)}
    if not solids:
        return
    from alula.reports.page.export import write_vtu

    folder.mkdir()
    for link, found in solids.items():
        write_vtu(folder / f"{link}.vtu", found.governing_case.displacement, found.stress)
