"""Fatigue of links in a pose: what comes and goes, what is borne so often, and how often it is borne."""

from collections.abc import Iterator
from typing import Any

from alula.fea.outcomes.fatigue import LinkFatigue
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.reports.sections.fatigue import fatigue_record, measure_of, scatter_of
from alula.reports.sections.section import Part
from alula.reports.sections.table import Cell, Column, Number, Table, words


def fatigue_parts(result: CheckResult, case: LoadCaseResult) -> Iterator[Part]:
    """Yield the fatigue of links under a load case.

    Parameters
    ----------
    result : CheckResult
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    if not case.fatigue:
        return
    columns = (
        words("link"),
        Column("stress from", "MPa"),
        Column("to", "MPa"),
        Column("as a cycle of the tests, its peak (band)", "MPa"),
        Column("borne so often", "MPa"),
        Column("cycles to failure (band)"),
    )
    materials = {result.case.part_of(link).material: result.case.material_of(link) for link in case.fatigue}
    told = "; ".join(f"{one.title}: {measure_of(one)}, {scatter_of(one)}" for one in materials.values())
    yield Table(
        key="fatigue",
        columns=columns,
        rows=tuple((link, *_cells(found)) for link, found in case.fatigue.items()),
        caption=f"Fatigue of links for {result.case.conditions.cycles:g} cycles. {told}",
        under=(("load case", case.name),),
    )


def _cells(found: LinkFatigue) -> tuple[Cell, ...]:
    strength = "unknown, no exponent" if found.strength is None else Number(found.strength, "", 3)
    lives = "unknown, no exponent" if found.repetitions is None else Number(found.repetitions, "", 2)
    return Number(found.life.smallest, "", 3), Number(found.life.largest, "", 3), Number(found.stress), strength, lives


def link_fatigue_record(result: CheckResult, case: LoadCaseResult) -> dict[str, Any]:
    """Return the fatigue of links as entries of ``result.json``.

    Parameters
    ----------
    result : CheckResult
    case : LoadCaseResult

    Returns
    -------
    dict
        By link.
    """
    return {link: fatigue_record(found, result.case.material_of(link)) for link, found in case.fatigue.items()}
