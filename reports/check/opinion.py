"""A second opinion: CalculiX on the same meshes."""

from dataclasses import replace
from typing import Any

from alula.fea.outcomes.opinion import SecondOpinion
from alula.fea.outcomes.result import CheckResult
from alula.reports.sections.data import entries
from alula.reports.sections.section import Section, Text
from alula.reports.sections.table import Column, Number, Table, numbers, words
from alula.reports.sentences import told

_VALUES = "von_mises von_mises_nodal displacement"
_ANSWER = f"{_VALUES} stress_gap displacement_gap agrees seconds"


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
    answers = [entries(one.answer, _ANSWER) if one.answer else {} for one in found]
    reasons = [told(one.reason or "") for one in found]

    def theirs(name: str, **as_number: Any) -> list[Number]:
        return numbers((answer.get(name) for answer in answers), **as_number)

    table = Table.by_columns(
        {
            words("link"): [one.link if one.known else f"{one.link} (no result)" for one in found],
            words("load case"): [one.load_case for one in found],
            Column("von Mises, alula", "MPa"): numbers(one.von_mises for one in found),
            Column("von Mises, CalculiX", "MPa"): theirs("von_mises"),
            Column("difference of von Mises", "%"): theirs("stress_gap", decimals=2, factor=100.0),
            Column("displacement, alula", "mm"): numbers(one.displacement for one in found),
            Column("displacement, CalculiX", "mm"): theirs("displacement"),
            Column("difference of displacement", "%"): theirs("displacement_gap", decimals=3, factor=100.0),
            words("reason", wraps=True): reasons if any(reasons) else None,
        },
        key="second opinions",
    )
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


def _record(opinion: SecondOpinion) -> dict[str, object]:
    return entries(opinion, f"load_case variant deck {_VALUES} known reason") | {
        "calculix": entries(opinion.answer, _ANSWER) if opinion.answer else None,
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
