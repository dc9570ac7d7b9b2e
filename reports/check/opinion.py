"""A second opinion: CalculiX on the same meshes."""

from dataclasses import replace

from alula.fea.outcomes.opinion import SecondOpinion
from alula.fea.outcomes.result import CheckResult
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Cell, Column, Number, Section, Table, Text, words
from alula.reports.sentences import told

_VALUES = "von_mises von_mises_nodal displacement"


def opinion_section(result: CheckResult) -> Section:
    """Return what CalculiX finds on the same meshes.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where it was not asked.
    """
    found = result.second_opinions
    numbers = [
        Column(f"{what}, {whose}", unit) if unit else Column(f"difference of {what}", "%")
        for what, unit in (("von Mises", "MPa"), ("displacement", "mm"))
        for whose, unit in (("alula", unit), ("CalculiX", unit), ("", ""))
    ]
    reason = words("reason", wraps=True) if any(one.reason for one in found) else None
    table = Table.of((words("link"), words("load case"), *numbers, reason), map(_row, found), key="second opinions")
    text = (
        "CalculiX solved the same mesh with the same material, supports and nodal loads. The table compares the "
        "largest von Mises stress at the integration points and the largest displacement. A difference is the "
        "largest one anywhere in the link, relative to alula’s largest value. This verifies assembly and solution; it "
        "does not verify the mesh or the loads."
    )
    return Section(
        key="second-opinion",
        title="Second opinion",
        parts=(Text(text, "note"), table) if found else (),
        data={"second_opinions": {one.link: _record(one) for one in found}},
    )


def _row(opinion: SecondOpinion) -> tuple[Cell, ...]:
    theirs = opinion.answer
    return (
        opinion.link if opinion.known else f"{opinion.link} (no result)",
        opinion.load_case,
        Number(opinion.von_mises),
        Number(None if theirs is None else theirs.von_mises),
        Number(None if theirs is None else theirs.stress_gap, decimals=2, factor=100.0),
        Number(opinion.displacement),
        Number(None if theirs is None else theirs.displacement),
        Number(None if theirs is None else theirs.displacement_gap, decimals=3, factor=100.0),
        told(opinion.reason or ""),
    )


def _record(opinion: SecondOpinion) -> dict[str, object]:
    calculix = None
    if opinion.answer is not None:
        calculix = entries(opinion.answer, f"{_VALUES} stress_gap displacement_gap agrees seconds")
    return entries(opinion, f"load_case variant deck {_VALUES} known") | {
        "reason": data(opinion.reason),
        "calculix": calculix,
    }


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
