"""Checks on the terminal, of commands whose telling is no section yet."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from alula.fea.common.verdict import CheckOutcome, by_nearness
from alula.reports.renderers.console import print_table, verdict_line
from alula.reports.sections.checks import check_table
from alula.reports.words.terminal import say
from alula.reports.words.wording import inapplicable

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["say_checks", "verdict_line"]


def say_checks(checks: Sequence[CheckOutcome], console: "Console") -> None:
    """Print checks with value, band, limit and verdict; those that are not applicable together below them."""
    table = check_table(
        by_nearness(check for check in checks if check.applies),
        several=len({check.load_case for check in checks}) > 1,
    )
    print_table(type(table)(columns=table.columns, rows=table.rows), console)
    for line in inapplicable(checks):
        say(console, line)
