"""How CalculiX's answer is told beside ours: warnings, table and record."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fea.calculix.second_opinion import second_opinions
from fea.outcomes.opinion import SecondOpinion
from fea.outcomes.result import CheckResult
from reports.words.terminal import say_table
from reports.words.wording import number

if TYPE_CHECKING:
    from rich.console import Console

UNITS = {
    "second_opinions.*.von_mises": "MPa",
    "second_opinions.*.von_mises_nodal": "MPa",
    "second_opinions.*.displacement": "mm",
    "second_opinions.*.calculix.von_mises": "MPa",
    "second_opinions.*.calculix.von_mises_nodal": "MPa",
    "second_opinions.*.calculix.displacement": "mm",
    "second_opinions.*.calculix.stress_gap": "ratio",
    "second_opinions.*.calculix.displacement_gap": "ratio",
    "second_opinions.*.calculix.seconds": "s",
}


def with_second_opinions(
    result: CheckResult, folder: Path, *, threads: int, progress: Callable[[str], None]
) -> CheckResult:
    """Return the result with CalculiX's opinion on every link; decks are written into ``folder``.

    What does not agree, or was not answered, becomes a warning.
    """
    found = second_opinions(result, folder, threads=threads, progress=progress)
    warnings = tuple(opinion.sentence for opinion in found if opinion.sentence)
    warnings += tuple(
        f"{opinion.link}: the stresses of the second opinion are those of one mesh, whose peak is no result"
        for opinion in found
        if not opinion.known
    )
    if not found:
        warnings = ("no second opinion: no link has a solid model that CalculiX could be asked about",)
    return replace(result, second_opinions=found, warnings=(*result.warnings, *warnings))


def opinion_records(opinions: tuple[SecondOpinion, ...]) -> dict[str, Any]:
    """Return the opinions by link as data that JSON can hold."""
    return {
        opinion.link: {
            "load_case": opinion.load_case,
            "variant": opinion.variant,
            "deck": opinion.deck,
            "von_mises": opinion.von_mises,
            "von_mises_nodal": opinion.von_mises_nodal,
            "displacement": opinion.displacement,
            "known": opinion.known,
            "calculix": None
            if opinion.answer is None
            else {
                "von_mises": opinion.answer.von_mises,
                "von_mises_nodal": opinion.answer.von_mises_nodal,
                "displacement": opinion.answer.displacement,
                "stress_gap": opinion.answer.stress_gap,
                "displacement_gap": opinion.answer.displacement_gap,
                "agrees": opinion.answer.agrees,
                "seconds": opinion.answer.seconds,
            },
            "reason": opinion.reason,
        }
        for opinion in opinions
    }


def say_opinions(opinions: tuple[SecondOpinion, ...], console: "Console") -> None:
    """Print ours and CalculiX's values, in pairs, with the largest difference anywhere in the link."""
    columns = [("link", False)]
    for quantity, unit in (("von Mises", "MPa"), ("displaced", "mm")):
        columns += [(f"{quantity}, ours\n[{unit}]", True), (f"CalculiX\n[{unit}]", True), ("differs\nby", True)]
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
