"""A check on one screen of the console: verdict, why, what would change it, the checks that matter, warnings."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from alula.fea.common.verdict import CheckOutcome, worst_of_each
from alula.fea.outcomes.result import CheckResult
from alula.reports.check.changes import first_change
from alula.reports.renderers.console import print_sections, print_table, verdict_line
from alula.reports.sections.checks import check_table
from alula.reports.sections.section import Section
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import besides, checks_of, first_lines, opening
from alula.reports.words.numbers import joined, sentence
from alula.reports.words.terminal import height, say, say_command, shortened

if TYPE_CHECKING:
    from rich.console import Console

SCREEN = 23
"""Lines of a check on a terminal of 25: one is that of its progress, one says where the report is."""
MATTER = 5
"""Checks, and warnings, of which a screen tells."""
_LEAST = 2
"""Checks of which it tells before warnings."""
_REASON, _TIER, _CHANGE, _BESIDES, _WARNING = 4, 2, 3, 2, 3
"""Lines of a screen that a text may take."""


def print_result(result: CheckResult, sections: Sequence[Section], console: "Console") -> None:
    """Print all of a check.

    Parameters
    ----------
    result : CheckResult
    sections : sequence of Section
        As ``check_sections``.
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    verdict_line(result.verdict, result.case.title, console)
    lines = first_lines(result)
    for line in lines:
        say(console, line)
    print_sections(sections, console, said=lines)


def print_screen(result: CheckResult, sections: Sequence[Section], console: "Console") -> None:
    """Print what decides a check on one screen.

    Parameters
    ----------
    result : CheckResult
    sections : sequence of Section
        As ``check_sections``, or that of what would change it alone.
    console : rich.console.Console
        The screen has ``SCREEN`` lines of 80 columns.
    """
    checks, several = checks_of(result), len(result.load_cases) > 1
    told_first = opening(result.case, result.verdict, checks, several=several, short=True)
    why, tiers = shortened(console, told_first[0], _REASON), [shortened(console, one, _TIER) for one in told_first[1:]]
    besides_it = shortened(console, besides(result.caveats), _BESIDES)
    change, command = first_change(sections, said=" ".join(told_first))
    change = shortened(console, change, _CHANGE)
    taken = 1 + sum(height(console, text) for text in (why, *tiers, change, besides_it) if text) + 2 * bool(command)
    left = SCREEN - taken - 1  # the last line counts what is not told
    rows, warnings = worst_of_each(checks)[:MATTER], list[str]()
    least = _table_height(rows[:_LEAST], console, several=several)
    for warning in (shortened(console, f"Warning: {told(text)}", _WARNING) for text in result.warnings[:MATTER]):
        if height(console, warning) <= left - least:
            warnings.append(warning)
            left -= height(console, warning)
    while len(rows) > _LEAST and _table_height(rows, console, several=several) > left:
        rows.pop()
    badge = f" {result.verdict.value}  "
    verdict_line(result.verdict, shortened(console, f"{badge}{result.case.title}", 1)[len(badge) :], console)
    for line in (why, *tiers):
        say(console, line)
    if change:
        say(console, change)
    if command:
        say_command(console, "Find the size:", command)
    if rows:
        _print_checks(rows, console, several=several)
    if besides_it:
        say(console, besides_it)
    for warning in warnings:
        say(console, warning, style="yellow")
    more = [
        f"{count} more {what}{'s' if count > 1 else ''}"
        for count, what in ((len(checks) - len(rows), "check"), (len(result.warnings) - len(warnings), "warning"))
        if count
    ]
    say(console, f"{sentence(joined([*more, 'all numbers']))[:-1]}: --verbose")


def _table_height(checks: Sequence[CheckOutcome], console: "Console", *, several: bool) -> int:
    """Return how many lines the table of checks takes, whose rows a narrow terminal breaks."""
    with console.capture() as printed:
        _print_checks(checks, console, several=several)
    return len(printed.get().splitlines())


def _print_checks(checks: Sequence[CheckOutcome], console: "Console", *, several: bool) -> None:
    table = check_table(checks, several=several)
    print_table(type(table)(columns=table.columns, rows=table.rows), console)
