"""``alula check`` of a case with a level: all its tests."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell

if TYPE_CHECKING:
    from alula.loads.case.case import Case


def checked_names(case: "Case") -> set[str]:
    """Return the names of all files that a check of a case can write.

    Parameters
    ----------
    case : Case

    Returns
    -------
    set of str
    """
    from alula.fea.check.level import has_tests
    from alula.reports.check.folder import report_names
    from alula.reports.level.folder import level_names

    return level_names(case) if has_tests(case) else report_names(case)


def run_level(
    case: "Case", name: str, options: Mapping[str, Any], output: Path | None, *, json: bool, second_opinion: bool
) -> int:
    """Check all tests of a case, tell what they say and write their reports.

    Parameters
    ----------
    case : Case
        With a level of which no test is chosen.
    name : str
        As the command was given it.
    options : mapping of str to object
        Of ``check_case``.
    output : Path or None
        The folder that the user named, if any.
    json : bool
        True to print the record.
    second_opinion : bool
        Whether one was asked for.

    Returns
    -------
    int
        Exit status, of the worst verdict.

    Raises
    ------
    CaseError
        Where a second opinion is asked for, which is one on a single check.
    """
    from alula.fea.check.level import check_level
    from alula.fea.findings.of_check import with_findings
    from alula.geometry.base.errors import CaseError
    from alula.reports.level.folder import write_level
    from alula.reports.level.page import level_sections
    from alula.reports.level.tests import level_record, print_level

    if second_opinion:
        assert case.level is not None
        first = next(iter(case.level.tests))
        raise CaseError(f'--second-opinion: it is on one test; choose one with --set level.test="{first}"')
    result = check_level(case, name=name, **options).of_each(with_findings)
    sections = level_sections(result)
    tell(sections, json=json, record=partial(level_record, result, sections), show=partial(print_level, result))
    if output is not None:
        write_level(result, output, progress=progress)
        if not json:
            print(f"Level: {output / 'level.html'}")
    return result.worst.exit_status
