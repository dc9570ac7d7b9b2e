"""Comparison with CalculiX: warnings, table and plain data."""

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from alula.fea.outcomes.opinion import SecondOpinion
from alula.fea.outcomes.result import CheckResult
from alula.reports.sections.data import entries
from alula.reports.sentences import told
from alula.reports.words.numbers import number
from alula.reports.words.terminal import say_table

if TYPE_CHECKING:
    from rich.console import Console

_VALUES = "von_mises von_mises_nodal displacement"


def with_second_opinions(result: CheckResult, found: tuple[SecondOpinion, ...]) -> CheckResult:
    """Return the result with CalculiX's opinion on every link; differences and failures become warnings.

    Parameters
    ----------
    result : CheckResult
    found : tuple of SecondOpinion
        CalculiX's opinions.

    Returns
    -------
    CheckResult
    """
    warnings = tuple(told(opinion.warning) for opinion in found if opinion.warning)
    warnings += tuple(
        f"{opinion.link}: the second opinion compares stresses of one mesh whose peak is not a result"
        for opinion in found
        if not opinion.known
    )
    if not found:
        warnings = ("no second opinion: no link has a solid model",)
    return replace(result, second_opinions=found, warnings=(*result.warnings, *warnings))


def opinion_records(opinions: tuple[SecondOpinion, ...]) -> dict[str, Any]:
    """Return the opinions by link as plain data.

    Parameters
    ----------
    opinions : tuple of SecondOpinion

    Returns
    -------
    dict
        Link -> opinion.
    """
    return {
        opinion.link: entries(opinion, f"load_case variant deck {_VALUES} known reason")
        | {
            "calculix": opinion.answer
            and entries(opinion.answer, f"{_VALUES} stress_gap displacement_gap agrees seconds")
        }
        for opinion in opinions
    }


def say_opinions(opinions: tuple[SecondOpinion, ...], console: "Console") -> None:
    """Print the values of alula and CalculiX with the largest difference anywhere in the link.

    Parameters
    ----------
    opinions : tuple of SecondOpinion
    console : rich.console.Console
    """
    columns = [("link", False)]
    for quantity, unit in (("von Mises", "MPa"), ("displacement", "mm")):
        columns += [(f"{quantity}, alula\n[{unit}]", True), (f"CalculiX\n[{unit}]", True), ("difference", True)]
    rows = []
    for opinion in opinions:
        theirs = opinion.answer
        rows.append(
            (
                opinion.link if opinion.known else f"{opinion.link} (no result)",
                number(opinion.von_mises),
                "-" if theirs is None else number(theirs.von_mises),
                "-" if theirs is None else f"{theirs.stress_gap:.2%}",
                number(opinion.displacement),
                "-" if theirs is None else number(theirs.displacement),
                "-" if theirs is None else f"{theirs.displacement_gap:.3%}",
            )
        )
    say_table(console, columns, rows, title="Second opinion")
