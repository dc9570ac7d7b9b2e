"""The output folder of a level: its page and result, and a report for each test."""

from collections.abc import Callable, Iterator
from pathlib import Path

from alula.fea.level.check_level import LevelResult, has_tests
from alula.fea.outcomes.result import CheckResult
from alula.loads.case.case import Case
from alula.reports.check.folder import PICTURES, fill_report, report_names
from alula.reports.level.page import PAGE, SET_UP, level_page, level_sections
from alula.reports.level.tests import OWN, TESTS, level_record
from alula.reports.page.output import MARK, write_folder
from alula.reports.renderers.folder import drawn_pictures
from alula.reports.renderers.page import as_page
from alula.reports.renderers.record import as_json


def checked_names(case: Case) -> set[str]:
    """Return the names of all files that a check of a case can write: of one report, or of a level and all its tests.

    Parameters
    ----------
    case : Case

    Returns
    -------
    set of str
    """
    if case.level is None or not has_tests(case):
        return report_names(case)
    variants = {f"{TESTS}/{name}": case.with_values({"level.test": name}) for name in case.level.tests}
    if not case.tests_alone:
        variants[OWN] = case
    own = {f"{folder}/{name}" for folder, one in variants.items() for name in report_names(one)}
    return own | {MARK, PAGE, f"{PICTURES}/{SET_UP}.png"}


def write_level(result: LevelResult, target: Path, *, progress: Callable[[str], None] = lambda message: None) -> None:
    """Write page and ``result.json`` of the level, and a report for each test in a folder of its name; or nothing.

    Parameters
    ----------
    result : LevelResult
        With what ``alula.fea.findings.of_check`` finds besides.
    target : Path
        The output folder.
    progress : callable, optional
        Receives messages.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """

    def fill(folder: Path) -> None:
        for place, found in _reports(result):
            (folder / place).mkdir(parents=True)
            fill_report(found, folder / place, progress=progress)
        sections = level_sections(result)
        page = level_page(result, sections)
        pictures = drawn_pictures(page)
        (folder / PAGE).write_text(as_page(page, pictures), encoding="utf-8")
        (folder / PICTURES).mkdir()
        (folder / PICTURES / f"{SET_UP}.png").write_bytes(pictures[SET_UP].png())
        (folder / MARK).write_text(as_json(level_record(result, sections)) + "\n", encoding="utf-8")

    write_folder(target, "check", fill)


def _reports(result: LevelResult) -> Iterator[tuple[str, CheckResult]]:
    """Yield the folder of each report, and what it is of."""
    for name, test in result.tests.items():
        yield f"{TESTS}/{name}", test.result
    if result.own is not None:
        yield OWN, result.own
