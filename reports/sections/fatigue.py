"""Fatigue of a link as data and in words, in a pose and over a motion."""

from collections.abc import Iterator
from typing import Any

from alula.fea.outcomes.fatigue import LIFE_FACTOR, STRESS_FACTOR, LinkFatigue
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.geometry.materials.material import Material
from alula.reports.sections.data import data
from alula.reports.sections.section import Part
from alula.reports.sections.table import Cell, Column, Number, Table, words


def fatigue_record(fatigue: LinkFatigue, material: Material) -> dict[str, Any]:
    """Return the fatigue of a link as an entry of ``result.json``.

    Parameters
    ----------
    fatigue : LinkFatigue
    material : Material
        Of the link.

    Returns
    -------
    dict
    """
    assert material.fatigue is not None
    life = fatigue.life
    return {
        "measure": measure_of(material),
        "rule": material.fatigue.rule,
        "location": fatigue.location.tolist(),
        "smallest": life.smallest,
        "largest": life.largest,
        "range": life.stress_range,
        "cycles": [{"range": size, "mean": mean, "count": count} for size, mean, count in life.cycles],
        "harm_of_blocks": list(life.harm),
        "equivalent_peak_stress": data(fatigue.stress),
        "wanted_repetitions": fatigue.wanted,
        "strength_at_wanted": fatigue.strength,
        "repetitions": data(fatigue.repetitions),
        "scatter": scatter_of(material),
        "source": material.fatigue.source,
    }


def measure_of(material: Material) -> str:
    """Return the stress whose cycles count for fatigue.

    Parameters
    ----------
    material : Material

    Returns
    -------
    str
    """
    if material.brittle:
        return "the principal stress of largest magnitude"
    return "the von Mises stress with the sign of the principal stress of largest magnitude"


def scatter_of(material: Material) -> str:
    """Return the uncertainty of a fatigue life, in one sentence.

    Parameters
    ----------
    material : Material
        With fatigue data.

    Returns
    -------
    str
    """
    fatigue = material.fatigue
    assert fatigue is not None
    if fatigue.strength_range is not None:
        low, high = fatigue.strength_range
        return f"bands hold the scatter of the material card, {low:g} to {high:g} MPa at {fatigue.cycles:g} cycles"
    asked = (
        f"the factor asked for must cover it, {STRESS_FACTOR:g} on stress and {LIFE_FACTOR:g} on life if none is stated"
    )
    if fatigue.exponent is None:
        return f"the material card states one point of the S-N curve and no scatter; {asked}"
    return (
        f"the material card states no scatter; 10 % more stress shortens the life by a factor of "
        f"{1.1**fatigue.exponent:.2g}; {asked}"
    )


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
    every = case.of_links(LinkFatigue)
    if not every:
        return
    columns = (
        words("link"),
        Column("stress from", "MPa"),
        Column("to", "MPa"),
        Column("as a cycle of the tests, its peak (band)", "MPa"),
        Column("borne so often", "MPa"),
        Column("cycles to failure (band)"),
    )
    materials = {result.case.part_of(link).material: result.case.material_of(link) for link in every}
    told = "; ".join(f"{one.title}: {measure_of(one)}, {scatter_of(one)}" for one in materials.values())
    yield Table(
        key="fatigue",
        columns=columns,
        rows=tuple((link, *_cells(found)) for link, found in every.items()),
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
    every = case.of_links(LinkFatigue)
    return {link: fatigue_record(found, result.case.material_of(link)) for link, found in every.items()}
